"""What is known of a model after its calibration: one normal distribution of parameters and doubts together.

    H = [J D]' S^-1 [J D] + diag(prior),   covariance = H^-1

J: tangents of the calibrated readings to the parameters, D: to one deviation of every doubt (model_error.py), S: the
noise that the residual shows. A doubt that the readings have settled counts no more, one that no sensor sees keeps its
whole size, and what trades with a parameter stays tied to it.

    offset = covariance ([J D]' S^-1 r - theta / prior^2)

A fit follows the readings as if the model had no error of its own. Knowing of that, it would stand elsewhere: by the
offset, which no reading shows where there is no sensor. Source: Laplace's approximation; Kennedy and O'Hagan
2001.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from geom.arrays import Array
from geom.constants import NORMAL_95
from geom.one_thread import one_blas_thread
from lumped.model.multipliers import parameter_values
from lumped.model.network import Network, Parameter, Row
from measured.case import Case, Test
from measured.doubt import Doubt
from measured.sensors.operators import of_measurement, starts
from validation.calibration.calibrate import CachedSegments, Fit, minimise, with_model_error
from validation.calibration.model_error import with_cores, with_doubts
from validation.comparison.linearisation import Segment, segments
from validation.comparison.uncertainty import FLOWS, moved_inputs
from validation.parameters.unknowns import nuisances, working

Progress = Callable[[str], None]


@dataclass(frozen=True)
class ParameterPosterior:
    """network : with a neutral parameter for every doubt;  values : of its parameters

    names (p,) : of the covariance (p, p): parameters in fitting coordinates, doubts and inputs in deviations
    doubts : of the network;  fitted : tests that it was calibrated on;  doubt : the table of doubt
    read : what sensors read in these tests, as rows over z
    offset (p,) : from where the model stands to the mean of the distribution; empty before a calibration
    """

    network: Network
    values: dict[str, float]
    names: tuple[str, ...]
    covariance: Array
    doubts: tuple[str, ...]
    fitted: tuple[str, ...]
    doubt: Doubt
    read: tuple[Row, ...] = ()
    offset: Array = field(default_factory=lambda: np.empty(0))

    def offsets(self, names: Sequence[str]) -> Array:
        """(k,) of some names; those that it does not know have none."""
        offset_of = dict(zip(self.names, self.offset)) if self.offset.size else {}
        return np.array([offset_of.get(name, 0.0) for name in names])

    def slow(self, row: Row) -> float:
        """Share of its rise by which a temperature is off for reasons that no parameter has.

        What a sensor read was held against it. Elsewhere the place has another share of the rise than its node's mean,
        as a thermocouple's has; a mean or point of a field is what it says.
        """
        alike = any(np.array_equal(row.index, r.index) and np.allclose(row.weights, r.weights) for r in self.read)
        representative = alike or self.network.recovery is not None
        return self.doubt["slow"] if representative else float(np.hypot(self.doubt["slow"], self.doubt["gain"]))

    def of(self, names: Sequence[str], sd: Array) -> Array:
        """(k, k) covariance of some names; those that it does not know are independent with the given deviations."""
        at = {name: i for i, name in enumerate(self.names)}
        estimated = np.array([name in at for name in names], bool)
        index = [at[name] for name in names if name in at]
        out = np.diag(np.where(estimated, 0.0, sd) ** 2)
        out[np.ix_(estimated, estimated)] += self.covariance[np.ix_(index, index)]
        return out


def silent(message: str) -> None:
    """No progress."""


@one_blas_thread
def parameter_posterior(case: Case, progress: Progress = silent) -> ParameterPosterior:
    """Of the model as it stands: on the tests that it was fitted to; before any calibration the priors alone.

    Of fitted tests that are not there any more the intervals say what they told of each parameter by itself.
    """
    tests = case.fitted if case.model.revision else ()
    network, unknowns = working(replace(case, tests=tests or case.tests))
    values = parameter_values(network, case.model.values)
    larger, doubts = with_doubts(network, case.doubt, case.fitted or case.tests)
    of_network = tuple(p.name for p in doubts)
    if not tests:
        sd = np.array([p.prior_sd for p in unknowns.parameters])
        covariance, _ = interval_covariance(case, unknowns.parameters, np.diag(sd**2), np.zeros(sd.size))
        return ParameterPosterior(larger, values, unknowns.names, covariance, of_network, (), case.doubt)
    progress("uncertainty of the calibrated model")
    parts = segments(network, tests, values, unknowns.parameters)
    start = unknowns.coordinates(values)
    plain = minimise(network, tests, unknowns, start, None, values, 0, CachedSegments(parts, nearby=False))
    fit = with_model_error(plain, tests, values, case.doubt)
    inputs = input_columns(network, tests, values, case.doubt, parts)
    names = (*unknowns.names, *uncertain_names(larger, doubts, tests[0], values, fit, case.doubt), *inputs)
    covariance, offset = interval_covariance(case, unknowns.parameters, *joint(fit, inputs))
    have = {p.name for p in larger.parameters}
    others = [p for p in nuisances(network, case.tests, case.doubt) if p.name not in have]  # starts of other tests
    return ParameterPosterior(
        replace(larger, parameters=(*larger.parameters, *others)),
        values,
        names,
        covariance,
        of_network,
        tuple(t.name for t in tests),
        case.doubt,
        rows_read(tests),
        offset,
    )


def interval_covariance(
    case: Case, parameters: Sequence[Parameter], covariance: Array, offset: Array
) -> tuple[Array, Array]:
    """A covariance and its offset with no parameter, the first of its rows, wider than the interval that a fit gave it;
    as they are where all tests of that fit are there, which say more."""
    fitted = case.model.reference.tests if case.model.reference and case.model.revision else ()
    if {t.name for t in case.usable} >= set(fitted):
        return covariance, offset
    sd, most = np.sqrt(np.diag(covariance)), np.full(len(covariance), np.inf)
    most[: len(parameters)] = [
        deviation(p, ci) if (ci := case.model.intervals.get(p.name)) else np.inf for p in parameters
    ]
    H = np.linalg.inv(covariance)
    new = np.linalg.inv(H + np.diag(np.maximum(np.maximum(most, 1e-12) ** -2.0 - sd**-2.0, 0.0)))
    return new, new @ (H @ offset)


def deviation(parameter: Parameter, interval: Sequence[float] | None) -> float:
    """One standard deviation of a parameter in its own coordinate: of its 95 % interval, else of its prior."""
    if interval is None:
        return parameter.prior_sd
    low, high = np.log(interval) if parameter.mapping == "log" else interval
    return min(float(high - low) / (2 * NORMAL_95), parameter.prior_sd)


def rows_read(tests: Sequence[Test]) -> tuple[Row, ...]:
    """Of all channels."""
    return tuple({c.name: c.row for t in tests for c in t.channels}.values())


def input_columns(
    network: Network, tests: Sequence[Test], values: dict[str, float], doubt: Doubt, plain: Sequence[Segment]
) -> dict[str, list[Array]]:
    """Input -> what its standard uncertainty does to every segment (K): one instrument serves all tests.

    Flows are among the columns of the model error already.
    """
    out: dict[str, list[Array]] = {}
    for test in tests:
        for name, variant in moved_inputs(network, test, doubt):
            if name not in FLOWS.values():
                change = {s.channel: s for s in segments(network, [variant], values)}
                column = out.setdefault(name, [np.zeros_like(s.r) for s in plain])
                for i, s in enumerate(plain):
                    if s.test == test.name:
                        column[i] = s.r - change[s.channel].r
    return out


def uncertain_names(
    larger: Network, doubts: Sequence[Parameter], test: Test, values: dict[str, float], fit: Fit, doubt: Doubt
) -> list[str]:
    """A name for every column of the model error: links and capacities, cores, placements, flows."""
    with_core = with_cores(larger, test, values, doubt)
    first = [p.name for p in (*doubts, *with_core.parameters[len(larger.parameters) :])]
    assert fit.error is not None
    rest = fit.error.size - len(first)
    return [*first, *(f"placement {i}" for i in range(rest - 2)), "flow of air", "flow of liquid"]


def joint(fit: Fit, inputs: Mapping[str, Sequence[Array]]) -> tuple[Array, Array]:
    """Covariance (p, p) of parameters, doubts and inputs, and how far (p,) from the fit their mean is."""
    error = fit.error
    assert error is not None
    H = np.diag(np.concatenate([fit.unknowns.sd**-2.0, np.ones(error.size + len(inputs))]))
    pull = np.zeros(len(H))
    pull[: fit.theta.size] = -fit.theta / fit.unknowns.sd**2
    for i, s in enumerate(fit.parts):
        beside = (columns[i] for columns in inputs.values())
        X = fit.noise.whiten(s, np.column_stack([s.J, error.of(s), *beside, s.r]))
        H, pull = H + X[:, :-1].T @ X[:, :-1], pull + X[:, :-1].T @ X[:, -1]
    covariance = np.asarray(np.linalg.inv(H), float)
    return covariance, covariance @ pull


def acting(of: ParameterPosterior, test: Test) -> tuple[Network, tuple[Parameter, ...], Array]:
    """The network with the cores that a record gives its nodes; all in it that is uncertain but sensors; for each of
    these the size of one deviation where it is a doubt, else 1."""
    with_core = with_cores(of.network, test, of.values, of.doubt)
    cores = {p.name for p in with_core.parameters[len(of.network.parameters) :]}
    doubts = cores | set(of.doubts)
    free = tuple(
        p
        for p in with_core.parameters
        if p.name in doubts or ((p.name in of.names or of_measurement(p)) and not _of_sensor(p, test))
    )
    return with_core, free, np.array([p.prior_sd if p.name in doubts else 1.0 for p in free])


def _of_sensor(p: Parameter, test: Test) -> bool:
    """A sensor's or a clock's: no temperature of the machine depends on it. Nor on how another test starts."""
    if not of_measurement(p):
        return False
    kind, _, of = p.targets[0][0].partition(":")
    return not (kind == "boundary" and of in test.boundaries) and not starts(p.targets[0][0], test.name)
