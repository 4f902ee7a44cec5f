"""The model against each test: error per sensor against the sensor's uncertainty and the 3-4 % rule."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from geom.description.identity import Identity
from geom.errors import ThermoscopeError
from lumped.integration.runaway import checked_run
from validation.calibration.unknowns import nuisances, working
from validation.case import Case, Channel, Test
from validation.comparison.predict import predict
from validation.comparison.tolerance import limit, rise_K


@dataclass(frozen=True)
class ChannelError:
    """Error of one sensor in one test, measured - model (K).

    percent_of_rise : rmse over the largest rise measured in the test;  limit_K : see validation.comparison.tolerance
    verdict : "within" when rmse is no more than limit_K, else "over"
    """

    channel: str
    place: str
    n: int
    rmse_K: float
    bias_K: float
    max_abs_K: float
    sigma_K: float
    percent_of_rise: float
    limit_K: float

    @property
    def verdict(self) -> str:
        return "within" if self.rmse_K <= self.limit_K else "over"

    def document(self) -> dict:
        return {**vars(self), "verdict": self.verdict}


@dataclass(frozen=True)
class TestError:
    """Errors of one test."""

    name: str
    role: str
    channels: tuple[ChannelError, ...]
    __test__ = False

    @property
    def rmse_K(self) -> float:
        return pooled(self.channels)

    def document(self) -> dict:
        rows = [c.document() for c in self.channels]
        return {"name": self.name, "role": self.role, "rmse_K": self.rmse_K, "channels": rows}


@dataclass(frozen=True)
class Comparison:
    """A model held against the tests of its case; floor_K is what the sensors alone would leave.

    identities : what its parts, nodes, fluids and boundaries are, said or guessed
    """

    case: str
    revision: int
    effects: tuple[str, ...]
    tests: tuple[TestError, ...]
    identities: Mapping[str, Identity] = field(default_factory=dict)

    @property
    def rmse_K(self) -> float:
        return pooled([c for t in self.tests for c in t.channels])

    @property
    def floor_K(self) -> float:
        channels = [c for t in self.tests for c in t.channels]
        return float(np.sqrt(np.average([c.sigma_K**2 for c in channels], weights=[c.n for c in channels])))

    @property
    def agrees(self) -> bool:
        return all(c.verdict == "within" for t in self.tests for c in t.channels)

    def document(self) -> dict:
        return {
            "case": self.case,
            "model": {"revision": self.revision, "effects": list(self.effects)},
            "tests": [t.document() for t in self.tests],
            "rmse_K": self.rmse_K,
            "floor_K": self.floor_K,
            "roles": [
                {
                    "name": name,
                    "role": i.role,
                    "turns": i.turns,
                    "known": "declared" if i.declared else "guessed",
                    "evidence": i.why,
                }
                for name, i in self.identities.items()
            ],
        }


def pooled(channels: list[ChannelError] | tuple[ChannelError, ...]) -> float:
    """Root mean square error (K) over all readings of several channels."""
    if not channels:
        return float("nan")
    return float(np.sqrt(np.average([c.rmse_K**2 for c in channels], weights=[c.n for c in channels])))


def compare(case: Case, values: Mapping[str, float] | None = None) -> Comparison:
    """Run the model as it stands on every test. Fitted sensor biases are not used: the raw reading counts."""
    network, _ = working(case)
    now = physical(case, values)
    tests = tuple(test_error(network, t, now) for t in case.tests)
    effects = tuple(e.name for e in case.model.effects)
    return Comparison(case.name, case.model.revision, effects, tests, case.model.network.identities)


def physical(case: Case, values: Mapping[str, float] | None = None) -> dict[str, float]:
    """Values, the model's own if none are given, without the nuisances of its measurements: bias, slope, lag, start."""
    measured = {p.name for p in nuisances(case.model.network, case.tests)}
    return {k: v for k, v in (case.model.values if values is None else values).items() if k not in measured}


def test_error(network, test: Test, values: Mapping[str, float]) -> TestError:
    names = tuple(c.name for c in test.channels)
    try:
        y = checked_run(predict(network, test, values).y, test.time, names, network)
    except ThermoscopeError as fault:
        raise type(fault)(f"test '{test.name}': {fault}") from None
    rows = [channel_error(c, y[:, j]) for j, c in enumerate(test.channels) if np.isfinite(c.y).any()]
    return TestError(test.name, test.role, tuple(rows))


def channel_error(channel: Channel, predicted: np.ndarray) -> ChannelError:
    read = np.isfinite(channel.y)
    e = channel.y[read] - predicted[read]
    rmse, rise = float(np.sqrt(np.mean(e**2))), rise_K(channel)
    percent = 100.0 * rmse / rise if rise > 0 else float("inf")
    return ChannelError(
        channel.name,
        channel.place,
        int(read.sum()),
        rmse,
        float(e.mean()),
        float(np.abs(e).max()),
        channel.sigma_K,
        percent,
        limit(channel.sigma_K, rise),
    )


test_error.__test__ = False  # type: ignore[attr-defined]
