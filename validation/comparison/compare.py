"""The model against each test: error per sensor against the uncertainty of reading, inputs and arithmetic."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from geom.description.roles import Identity
from geom.errors import ThermoscopeError
from geom.table import Table, TableResult, TableRow, select_fields
from geom.text import table
from lumped.integration.runaway import checked_run
from lumped.model.network import Network
from measured.case import Case, Channel, Test, seconds_read
from measured.doubt import USUAL, Doubt
from measured.sensors.operators import start_target
from validation.comparison.linearisation import largest_rise
from validation.comparison.predict import predict
from validation.comparison.uncertainty import Uncertainty, uncertainties
from validation.parameters.unknowns import hidden_starts, measured, standing, start_name, value_words
from validation.tables import comparison_tables
from validation.threads import run_by_run

Budget = Mapping[str, float]


@dataclass(frozen=True)
class ChannelError(TableRow):
    """Error of one sensor in one test, measured - model (K).

    percent_of_rise : rmse over the largest rise measured in the test;  u_input_K, u_numeric_K : standard uncertainties
    fitted_rmse_K : the same with the biases, slopes, lags, starts and clocks of the fit; None before a fit
    limit_K : expanded uncertainty, see validation.comparison.uncertainty; None where only the errors were asked for
    n, seconds : readings, and the time that they stand for: by it the errors of several sensors and tests are pooled
    verdict : "within" when rmse is no more than limit_K, "over" when it is, "unknown" without a limit
    """

    properties = ("verdict",)

    channel: str
    place: str
    n: int
    seconds: float
    rmse_K: float
    bias_K: float
    max_abs_K: float
    sigma_K: float
    percent_of_rise: float
    limit_K: float | None = None
    u_input_K: float | None = None
    u_numeric_K: float | None = None
    fitted_rmse_K: float | None = None

    @property
    def verdict(self) -> str:
        if self.limit_K is None:
            return "unknown"
        return "within" if self.rmse_K <= self.limit_K else "over"


@dataclass(frozen=True)
class TestError:
    """Errors of one test, and where they were judged what they were held against, channel by channel."""

    name: str
    role: str
    channels: tuple[ChannelError, ...]
    uncertainty: tuple[Uncertainty, ...] = ()
    __test__ = False

    @property
    def rmse_K(self) -> float:
        return pooled(self.channels)

    @property
    def fitted_rmse_K(self) -> float | None:
        """The error with sensors as the fit has them; None before a fit."""
        return _fitted(self.channels)

    @property
    def summary(self) -> dict:
        """Its error over all channels, for a document."""
        return select_fields(self, "name", "role", "rmse_K", "fitted_rmse_K")

    @property
    def over(self) -> int:
        """How many sensors are off by more than is uncertain."""
        return sum(c.verdict == "over" for c in self.channels)

    def document(self) -> dict:
        return {**self.summary, **select_fields(self, "channels")}


@dataclass(frozen=True)
class Comparison(TableResult):
    """A model held against the tests of its case; floor_K is what the sensors alone would leave.

    identities : what its parts, nodes, fluids and boundaries are, said or guessed
    """

    case: str
    revision: int
    effects: tuple[str, ...]
    tests: tuple[TestError, ...]
    identities: Mapping[str, Identity] = field(default_factory=dict)

    def __repr__(self) -> str:
        rows = [[t.name, t.role, len(t.channels), t.over, t.rmse_K] for t in sorted(self.tests, key=lambda t: -t.over)]
        return f"{self.words}\n{table(['test', 'role', 'sensors', 'over', 'rms (K)'], rows)}"

    def tables(self) -> tuple[Table, ...]:
        """The tests, the sensors of each test, and the roles that nobody declares."""
        return comparison_tables(self.document())

    @property
    def words(self) -> str:
        """How many sensors are over, and by how much the model is off, in a sentence."""
        verdicts = [c.verdict for t in self.tests for c in t.channels]
        over, every = verdicts.count("over"), len(verdicts)
        effects = f" with {', '.join(map(value_words, self.effects))}" if self.effects else ""
        records = f"{over} of {every} sensor records are over" if over else f"all {every} sensor records are within"
        if "unknown" in verdicts:
            records = f"{every} sensor records, held against no limit"
        return (
            f"{self.case}, revision {self.revision}{effects}: {records}; rms {self.rmse_K:.2f} K, "
            f"the sensors' own uncertainty explains {self.floor_K:.2f} K."
        )

    @property
    def rmse_K(self) -> float:
        return pooled([c for t in self.tests for c in t.channels])

    @property
    def fitted_rmse_K(self) -> float | None:
        """The same with sensors as the fit has them; None before a fit."""
        return _fitted([c for t in self.tests for c in t.channels])

    @property
    def sensor_errors(self) -> dict[str, tuple[float, str]]:
        """Sensor -> rms error (K) over the tests of the strictest role that has any, and that role."""
        rows = [(t.role, c) for t in self.tests for c in t.channels]
        return {
            name: (pooled([c for r, c in rows if (r, c.channel) == (role, name)]), role)
            for role in ("calibrate", "validate", "hold-out")
            for name in sorted({c.channel for r, c in rows if r == role})
        }

    @property
    def floor_K(self) -> float:
        return pooled([replace(c, rmse_K=c.sigma_K) for t in self.tests for c in t.channels])

    @property
    def limits(self) -> dict[str, dict[str, float]]:
        """Test -> channel -> the largest error that counts as agreement (K)."""
        rows = {t.name: t.channels for t in self.tests}
        return {name: {c.channel: c.limit_K for c in of if c.limit_K is not None} for name, of in rows.items()}

    @property
    def agrees(self) -> bool:
        return all(c.verdict == "within" for t in self.tests for c in t.channels)

    def document(self) -> dict:
        origin = {n: "declared" if i.declared else "guessed" for n, i in self.identities.items()}
        return {
            "case": self.case,
            "model": {"revision": self.revision, "effects": list(self.effects)},
            **select_fields(self, "tests", "rmse_K", "fitted_rmse_K", "floor_K", "words"),
            "roles": [
                {"name": n, "role": i.role, "turns": i.turns, "known": origin[n], "evidence": i.why}
                for n, i in self.identities.items()
            ],
        }


def pooled(channels: Sequence[ChannelError]) -> float:
    """Root mean square error (K) of several channels, each counted by the time that it was read."""
    if not channels:
        return float("nan")
    return float(np.sqrt(np.average([c.rmse_K**2 for c in channels], weights=[c.seconds for c in channels])))


def _fitted(channels: Sequence[ChannelError]) -> float | None:
    rows = [replace(c, rmse_K=c.fitted_rmse_K) for c in channels if c.fitted_rmse_K is not None]
    return pooled(rows) if rows else None


def compare(
    case: Case, values: Mapping[str, float] | None = None, budgets: Mapping[str, Budget] | None = None
) -> Comparison:
    """Run the model as it stands on every test. The raw reading counts; what sensors as fitted leave stands beside it.

    budgets : test -> channel -> what the model's own numbers may be wrong by (K), see `uncertainties`
    """

    def judged(network: Network, test: Test, now: Mapping[str, float]) -> TestError:
        return judged_error(network, test, now, case.doubt, None if budgets is None else budgets[test.name])

    return _of_every_test(case, values, judged)


class StoppedComparisonError(KeyboardInterrupt):
    """The user stopped a comparison.  so_far : of the tests that were compared until then"""

    def __init__(self, so_far: Comparison) -> None:
        super().__init__()
        self.so_far = so_far


def errors(case: Case, values: Mapping[str, float] | None = None) -> Comparison:
    """The errors alone, for searches: nothing says whether they are within the uncertainty."""
    return _of_every_test(case, values, test_error)


def _of_every_test(case: Case, values: Mapping[str, float] | None, error_of: Callable[..., TestError]) -> Comparison:
    network, now = standing(case), physical(case, values)
    effects, rows = tuple(e.name for e in case.model.effects), dict[str, TestError]()
    sensors_fitted = values is None and len(now) < len(case.model.values)

    def look(test: Test) -> None:
        error = error_of(network, test, now)
        rows[test.name] = _with_sensors(network, test, error, case.model.values) if sensors_fitted else error

    def comparison() -> Comparison:
        some = tuple(rows[test.name] for test in case.tests if test.name in rows)
        return Comparison(case.name, case.model.revision, effects, some, case.model.network.identities)

    try:
        run_by_run(look, case.tests, network.size)
    except KeyboardInterrupt:
        if rows:
            raise StoppedComparisonError(comparison()) from None
        raise
    return comparison()


def physical(case: Case, values: Mapping[str, float] | None = None) -> dict[str, float]:
    """Values, the model's own if none are given, without the nuisances of its measurements: bias, slope, lag, start.

    Where a state began that no sensor sees is not a reading's, but the machine's. In a test that was not fitted it
    began as it did in those that were, on average.
    """
    of, began = case.model.values if values is None else values, dict[str, float]()
    for test in case.tests:
        for p in hidden_starts(case.model.network, test, case.doubt):
            state = p.targets[0][0].removeprefix(start_target(test.name, ""))
            others = [of[name] for t in case.tests if (name := start_name(state, t.name)) in of]
            began |= {p.name: of.get(p.name, float(np.mean(others)))} if others else {}
    return {**{k: v for k, v in of.items() if not measured(k)}, **began}


def _with_sensors(network: Network, test: Test, error: TestError, values: Mapping[str, float]) -> TestError:
    """The errors beside what is left of them with sensors, boundaries, start and clock as the fit has them."""
    fitted = {row.channel: row.rmse_K for row in _rows(test, _checked(network, test, values))}
    return replace(error, channels=tuple(replace(c, fitted_rmse_K=fitted[c.channel]) for c in error.channels))


def judged_error(
    network: Network, test: Test, values: Mapping[str, float], doubt: Doubt = USUAL, budget: Budget | None = None
) -> TestError:
    """The errors of a test, each with the expanded uncertainty it is held against."""
    y = _checked(network, test, values)
    uncertainty = uncertainties(network, test, values, doubt, budget, y)
    rows = tuple(
        replace(row, limit_K=u.limit_K, u_input_K=u.input_K, u_numeric_K=u.numeric_K)
        for row, u in zip(_rows(test, y), uncertainty, strict=True)
    )
    return TestError(test.name, test.role, rows, tuple(uncertainty))


def test_error(network: Network, test: Test, values: Mapping[str, float]) -> TestError:
    """The errors of a test alone."""
    return TestError(test.name, test.role, tuple(_rows(test, _checked(network, test, values))))


def _checked(network: Network, test: Test, values: Mapping[str, float]) -> np.ndarray:
    names = tuple(c.name for c in test.channels)
    try:
        return checked_run(predict(network, test, values).y, test.time, names, network)
    except ThermoscopeError as fault:
        raise type(fault)(f"test '{test.name}': {fault}") from None


def _rows(test: Test, y: np.ndarray) -> list[ChannelError]:
    return [channel_error(c, test.time, y[:, j]) for j, c in enumerate(test.channels) if np.isfinite(c.y).any()]


def channel_error(channel: Channel, time: np.ndarray, predicted: np.ndarray) -> ChannelError:
    """The error of one sensor.  time : (n_time,) s;  predicted : (n_time,) degC"""
    read = np.isfinite(channel.y)
    e = channel.y[read] - predicted[read]
    rmse, rise = float(np.sqrt(np.mean(e**2))), largest_rise(channel)
    percent = 100.0 * rmse / rise if rise > 0 else float("inf")
    what = channel.name, channel.place, int(read.sum()), seconds_read(time[read])
    return ChannelError(*what, rmse, float(e.mean()), float(np.abs(e).max()), channel.sigma_K, percent)


test_error.__test__ = False  # type: ignore[attr-defined]
