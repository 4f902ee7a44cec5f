"""When a model agrees with a sensor: one rule for tables, bars, dots, curves and the report.

    u_val^2 = u_reading^2 + u_input^2 + u_numeric^2 ,   within: rms of (measured - model) <= 2 u_val

Inputs are moved one at a time by their own standard uncertainty. The arithmetic is the error budget of mesh,
condensation and time steps where there is one, else what the integrator leaves.
Source: ASME V&V 20-2009, chapters 3 and 6; JCGM 100 (expanded uncertainty).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from geom.arrays import Array
from geom.errors import ThermoscopeError
from lumped.integration.simulate import simulate
from lumped.model.network import Network
from lumped.model.quantities import AIR, LIQUID
from measured.case import Test
from measured.doubt import USUAL, Doubt, boundary_doubt
from validation.comparison.predict import heat_model, predict, record

FLOWS = {AIR: "flow of air", LIQUID: "flow of liquid", "flow_share": "flow by its share"}
COVERAGE = 2.0  # standard uncertainties: 95 %
RULE = f"within: rms up to {COVERAGE:g} times the uncertainty of reading, inputs and arithmetic"


def moved_inputs(network: Network, test: Test, doubt: Doubt) -> Iterator[tuple[str, Test]]:
    """The record with one input at a time off by its standard uncertainty; flows of one kind are off together.

    What no law reads, and what is zero throughout, moves nothing and is left out.
    """
    read = network.inputs
    groups: dict[str, list[str]] = {}
    for name, u in test.inputs.items():
        if name in read and np.any(u):
            groups.setdefault(FLOWS.get(network.measures(name), f"input {name}"), []).append(name)
    for group, names in groups.items():
        share = doubt["flow" if group in FLOWS.values() else "input"]
        yield group, test.scaled(dict.fromkeys(names, 1.0 + share))


def moved_boundaries(test: Test, doubt: Doubt) -> Iterator[tuple[str, Test]]:
    """The record with one boundary at a time off by what its thermometer may be."""
    for name, T in test.boundaries.items():
        off = np.asarray(T, float) + boundary_doubt(doubt, name)
        yield f"boundary:{name}", replace(test, boundaries={**test.boundaries, name: off})


@dataclass(frozen=True)
class Uncertainty:
    """Standard uncertainties (K, rms over the test) of one sensor, and what is left of the error.

    inputs : what each input contributes;  error_K : rms of measured - model
    """

    test: str
    channel: str
    reading_K: float
    inputs: Mapping[str, float]
    numeric_K: float
    error_K: float

    @property
    def input_K(self) -> float:
        return float(np.sqrt(sum(u**2 for u in self.inputs.values())))

    @property
    def u_val_K(self) -> float:
        return float(np.sqrt(self.reading_K**2 + self.input_K**2 + self.numeric_K**2))

    @property
    def limit_K(self) -> float:
        """The expanded uncertainty (K): the largest error that counts as agreement."""
        return COVERAGE * self.u_val_K

    @property
    def explained(self) -> bool:
        """Is the error no more than what all this leaves open?"""
        return self.error_K <= self.limit_K

    def document(self) -> dict:
        components = {"reading_K": self.reading_K, "input_K": self.input_K, "numeric_K": self.numeric_K}
        total = {"u_val_K": self.u_val_K, "error_K": self.error_K, "explained": self.explained}
        return {"test": self.test, "channel": self.channel, **components, **total, "inputs": dict(self.inputs)}


def uncertainties(
    network: Network,
    test: Test,
    values: Mapping[str, float],
    doubt: Doubt = USUAL,
    budget: Mapping[str, float] | None = None,
    y: Array | None = None,
) -> list[Uncertainty]:
    """One row per channel that was read.

    budget : channel -> what the model's own numbers may be wrong by (K), None for the integrator's estimate alone
    y : (n_time, n_channel) degC, the prediction where it is known already
    """
    plain = predict(network, test, values).y if y is None else y
    contributions = dict(_contributions(network, test, values, doubt, plain))
    numeric = _time_steps(network, test, values) if budget is None else budget
    out = []
    for j, c in enumerate(test.channels):
        read = np.isfinite(c.y)
        if read.any():
            inputs = {name: float(u[j]) for name, u in contributions.items()}
            # estimates of discretisation errors are bounds, as Roache's factor of 3 makes them: expanded uncertainties
            numeric_K = numeric.get(c.name, 0.0) / COVERAGE
            out.append(Uncertainty(test.name, c.name, c.sigma_K, inputs, numeric_K, _rms((c.y - plain[:, j])[read])))
    return out


def _contributions(
    network: Network, test: Test, values: Mapping[str, float], doubt: Doubt, plain: Array
) -> Iterator[tuple[str, Array]]:
    """Input or boundary -> what its standard uncertainty does to every channel (K)."""
    for name, other in chain(moved_inputs(network, test, doubt), moved_boundaries(test, doubt)):
        try:
            change = predict(network, other, values).y - plain
        except ThermoscopeError:  # a thermal runaway within the input's uncertainty: nothing bounds the temperature
            change = np.full_like(plain, np.inf)
        change = np.where(np.isfinite(change), change, np.inf)
        yield name.removeprefix("input ").removeprefix("boundary:"), np.sqrt(np.mean(change**2, axis=0))


def _time_steps(network: Network, test: Test, values: Mapping[str, float]) -> dict[str, float]:
    """Error of the time steps at every channel (K)."""
    bare, heat = heat_model(network, values)
    late = simulate(bare, record(test, {}), heat, [c.row for c in test.channels]).time_error_K
    return dict(zip((c.name for c in test.channels), late.tolist(), strict=True))


def _rms(a: Array) -> float:
    return float(np.sqrt(np.mean(a**2)))
