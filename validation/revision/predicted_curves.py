"""What each hypothesis predicts for a planned test: the model as it is, and with one effect more, calibrated again."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from geom.arrays import Array, Numbers
from geom.errors import InputError, ThermoscopeError
from lumped.model.network import Network
from measured.case import Case, Model, Test
from validation.calibration.calibrate import Progress, no_progress
from validation.comparison.predict import predict
from validation.inference.result import CurrentLevel
from validation.parameters.unknowns import standing
from validation.planning.candidate_tests import Experiment, candidate_tests
from validation.planning.permissible_current import current_levels, heat_limits, permissible_tests
from validation.revision.revise import add

UNCHANGED = "nothing missing"  # the hypothesis that the model is right as it is


@dataclass(frozen=True)
class PredictedCurves:
    """experiment, test : what would be driven;  curves : hypothesis -> channel -> (n_time,) degC

    currents : what they amount to
    """

    experiment: Experiment
    test: Test
    curves: Mapping[str, Mapping[str, Array]]
    currents: tuple[CurrentLevel, ...] = ()

    def spread_K(self, channel: str) -> float:
        """Largest rms difference between two hypotheses at a channel."""
        courses = [y[channel] for y in self.curves.values()]
        return max((float(np.sqrt(np.mean((a - b) ** 2))) for a, b in combinations(courses, 2)), default=0.0)

    def closest(self) -> float:
        """Root mean square over the channels, in their one-sigma, by which the two that stay closest differ."""
        gaps = [np.sqrt(np.mean(gap**2)) for gap in self._gaps()]
        return float(min(gaps, default=0.0))

    def decisive(self) -> int:
        """Number of the sample at which the two that stay closest are furthest apart, over all channels."""
        gaps = [np.mean(gap**2, axis=0) for gap in self._gaps()]
        return int(np.argmax(np.min(gaps, axis=0))) if gaps else len(self.test.time) - 1

    def _gaps(self) -> list[Array]:
        """(n_channels, n_time) by which two hypotheses differ, in one-sigma of each channel; one for each pair."""
        sigma = np.array([[np.hypot(c.sigma_K, c.model_K)] for c in self.test.channels])
        every = [np.stack([y[c.name] for c in self.test.channels]) for y in self.curves.values()]
        return [(a - b) / sigma for a, b in combinations(every, 2)]


def hypotheses(case: Case, effects: Sequence[str], tell: Progress = no_progress) -> dict[str, Model]:
    """Hypothesis -> model: as it is, and with each effect 'kind@place' added and all calibrated again."""
    out = {UNCHANGED: case.model}
    for name in effects:
        tell(f"calibrating with {name}")
        out[name] = add(case, name).model
    return out


def predicted_curves(case: Case, models: Mapping[str, Model], experiment: str | None = None) -> PredictedCurves:
    """Of the named experiment, or of the one that per hour sets the closest two hypotheses furthest apart.

    Currents are those that every hypothesis permits: each is held against what it says of the tests at hand.
    """
    before, network = case.tests[-1], standing(case)
    names = [e.name for e, _ in candidate_tests(before, network)]
    if experiment is not None and experiment not in names:
        raise InputError(f"unknown test '{experiment}'", case.name, f"one of: {'; '.join(names)}")
    hypothetical = {name: _network(case, model) for name, model in models.items()}
    limits = [heat_limits(*model, case.tests) for model in hypothetical.values()]
    predictions = [
        PredictedCurves(e, test, curves, current_levels(test, before, network))
        for e, test in permissible_tests(before, network, limits, experiment)
        if (curves := _curves(hypothetical, test))
    ]
    if not predictions:
        right = "fewer hypotheses, or another test"
        raise InputError("has no test that keeps every hypothesis as cool as the tests so far", case.name, right)
    return max(predictions, key=lambda p: p.closest() / p.experiment.hours)


def _network(case: Case, model: Model) -> tuple[Network, dict[str, float]]:
    """The network of a hypothesis, and those of the model's values that it has."""
    network = standing(replace(case, model=model))
    names = {p.name for p in network.parameters}
    return network, {k: v for k, v in model.values.items() if k in names}


def _curves(hypothetical: Mapping[str, tuple[Network, Numbers]], test: Test) -> dict[str, dict[str, Array]] | None:
    """None where a model runs away: it lacks what would cool it."""
    curves = {}
    try:
        for name, (network, values) in hypothetical.items():
            y = predict(network, test, values).y
            curves[name] = {c.name: y[:, j] for j, c in enumerate(test.channels)}
    except ThermoscopeError:
        return None
    return curves


def schedule(test: Test, before: Test) -> list[tuple[str, float, float, float]]:
    """What to hold when, of the inputs and boundaries that the plan changes: name, from and to (s), value (SI).

    before : a test as it was driven; what the plan holds for the whole of it or in steps is listed, nothing else
    """
    out: list[tuple[str, float, float, float]] = []
    for name, values in (*test.inputs.items(), *test.boundaries.items()):
        value = np.broadcast_to(np.asarray(values, float), test.time.shape)
        starts = np.flatnonzero(np.diff(value, prepend=np.nan))
        record = before.inputs.get(name, before.boundaries.get(name))
        as_before = record is not None and np.array_equal(np.unique(np.asarray(record, float)), np.unique(value))
        if len(starts) > STEPS or as_before:
            continue
        ends = [*starts[1:], len(value) - 1]
        out += [(name, float(test.time[a]), float(test.time[b]), float(value[a])) for a, b in zip(starts, ends)]
    return out


STEPS = 12  # of one input: what changes more often is a record that is driven again
