"""What an observer is made of: the model as the calibration tests correct it, and how much heat may be missing."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from extras.monitor.observer.constants import Constants, Sensor, with_motion
from extras.monitor.observer.joint_filter import JointFilter
from extras.monitor.observer.kalman import ProcessNoise
from extras.monitor.observer.observer import Observer, observer
from extras.monitor.observer.process import Process
from thermoscope import Network, Parameter, plugin as th

HALF = 0.5  # of an effect: correlations that an effect follows are known within a factor
TIME_S = 1200.0  # that missing heat lasts: between a winding's time constant and a machine's


@dataclass(frozen=True)
class Design:
    """process : the corrected model;  noise : by the table of doubt;  learned : name -> sensor as it was learned

    rise_K : usual rise of the tests
    """

    process: Process
    noise: ProcessNoise
    learned: Mapping[str, Sensor]
    rise_K: float

    def started(self, sensors: Sequence[th.Channel], readings: th.Array, boundaries: Mapping[str, float]) -> Observer:
        """With some sensors, from their first readings (s,)."""
        sensor_models = [self.as_learned(c) for c in sensors]
        bias, channels = np.array([s.bias_K for s in sensor_models]), [s.channel for s in sensor_models]
        return observer(self.process, self.noise, channels, readings, boundaries, self.rise_K, bias)

    def as_learned(self, c: th.Channel) -> Sensor:
        """A sensor by its name; as declared where no test had it."""
        constants = self.learned.get(c.name)
        return Sensor(c) if constants is None else constants.of(c)


def unsettled(case: th.MeasuredCase) -> th.ParameterPosterior:
    """The model as it stands, as unsure as before any calibration; an effect that was added by half of itself."""
    prior = th.parameter_posterior(replace(case, model=replace(case.model, revision=0)))
    network = narrowed(prior.network, prior.values, case)
    sd = {p.name: p.prior_sd for p in network.parameters}
    return replace(prior, network=network, covariance=np.diag([sd[n] ** 2 for n in prior.names]))


def narrowed(network: Network, values: Mapping[str, float], case: th.MeasuredCase) -> Network:
    """With priors of added effects that say half of what was found: in a fit they say nothing."""
    effects = {e.name for e in case.model.effects}

    def prior(p: Parameter) -> Parameter:
        deviation = abs(values.get(p.name, p.value) - p.neutral)
        return replace(p, prior_sd=min(p.prior_sd, HALF * deviation)) if p.name in effects else p

    return replace(network, parameters=tuple(prior(p) for p in network.parameters))


@dataclass(frozen=True)
class Lesson:
    """bodies : where heat may be missing;  table (m, m) W2 : how much, by the table of doubt;  constants (k,)"""

    bodies: tuple[str, ...]
    table: th.Array
    constants: th.Array


def taught(
    network: Network,
    values: Mapping[str, float],
    bodies: Sequence[str],
    table: th.Array,
    tests: Sequence[th.Test],
    doubt: th.Doubt,
    progress: th.CaseProgress = lambda message: None,
) -> Lesson:
    """What some tests, those of a calibration, tell of the constants."""
    one = JointFilter(constants_of(network, values, tests, doubt), tuple(bodies), ProcessNoise(table, TIME_S))
    for test in tests:
        progress(f"learning from {test.name}")
        one.over(test)
    return Lesson(tuple(bodies), table, one.w)


def design_of(
    network: Network, values: Mapping[str, float], lesson: Lesson, tests: Sequence[th.Test], doubt: th.Doubt
) -> Design:
    """tests : those of the lesson"""
    constants = constants_of(network, values, tests, doubt)
    process = Process(constants.network, constants.values(lesson.constants), lesson.bodies)
    noise = ProcessNoise(lesson.table, TIME_S)
    return Design(process, noise, constants.sensors(lesson.constants), usual_rise(tests))


def constants_of(network: Network, values: Mapping[str, float], tests: Sequence[th.Test], doubt: th.Doubt) -> Constants:
    """Of the network's heat, and of every sensor of the tests."""
    bare, start = th.heat_model(network, values)
    channels = {c.name: c for t in tests for c in t.channels}
    return Constants(with_motion(bare, tests), start, tuple(channels.values()), doubt)


def usual_rise(tests: Sequence[th.Test]) -> float:
    """Root mean square (K) of what the sensors of some tests read above the surroundings."""
    rises = list(_rises(tests))
    return float(np.sqrt(np.nanmean(np.concatenate(rises) ** 2))) if rises else 0.0


def _rises(tests: Sequence[th.Test]) -> Iterator[th.Array]:
    for t in tests:
        around = np.mean([np.broadcast_to(u, t.time.shape) for u in t.boundaries.values()], axis=0)
        for c in t.channels:
            yield c.y - around
