"""Innovation tests, and readings that say nothing: lost, impossible, or frozen.

Does one sensor drift, or is heat missing that the filter does not expect, and how surely? Each hypothesis, a constant
error of one sensor or constant heat in one body, leaves a signature in the innovations (Willsky and Jones 1976). With
a = sum of signature times innovation over its variance and V = sum of squared signatures over the variance, the log
evidence for an amplitude of prior variance v, against none, is

    e(v) = a^2 / (V + 1 / v) / 2 - log(1 + v V) / 2

A sensor that only has the bias it may have, of variance v0, is not a fault: its evidence is e(v0 + v) - e(v0). The sums
forget, so that what was long ago is not evidence now. Odds and temper are those of the diagnosis.
"""

from dataclasses import dataclass, field

import numpy as np

from thermoscope import plugin as th

FORGETS_S = 1800.0  # half an hour: a motor's own time constant
SURE = 0.95  # probability from which a hypothesis is said
OVER = 0.5  # and below which it is withdrawn
DRIFT = 20.0  # times a sensor's accuracy: how far a broken one is off
TOLERANCE = 2.0  # deviations of the table of doubt: missing heat beyond is a failure of the model


@dataclass
class Hypotheses:
    """names (h,) : sensors, then bodies;  spread, tolerance (h,) K or W, deviations of a fault and of what is none

    prior (h,) log odds;  score, information (h,) : a and V
    """

    names: tuple[str, ...]
    spread: th.Array
    tolerance: th.Array
    prior: th.Array
    score: th.Array
    information: th.Array

    def forget(self, seconds: float) -> None:
        keeps = float(np.exp(-seconds / FORGETS_S))
        self.score *= keeps
        self.information *= keeps

    def weigh(self, signature: th.Array, innovation: float, variance: float) -> None:
        self.score += signature * innovation / variance
        self.information += signature**2 / variance

    @property
    def amplitude(self) -> th.Array:
        """(h,) K or W, shrunk by the prior."""
        return self.score / (self.information + 1.0 / (self.spread**2 + self.tolerance**2))

    def _evidence(self, variance: th.Array) -> th.Array:
        """(h,) e(v)"""
        V = self.information
        return 0.5 * variance * self.score**2 / (1.0 + variance * V) - 0.5 * np.log1p(variance * V)

    @property
    def probability(self) -> th.Array:
        """(h,) of each against nothing and the others."""
        gain = self._evidence(self.spread**2 + self.tolerance**2) - self._evidence(self.tolerance**2)
        log = np.concatenate([[0.0], self.prior + gain / th.temper(float(gain.max(initial=0.0)))])
        weight = np.exp(log - log.max())
        return np.asarray(weight[1:] / weight.sum())

    def clear(self) -> None:
        """Begin anew, as after a sensor was dropped."""
        self.score[:], self.information[:] = 0.0, 0.0


def hypotheses(
    sensors: tuple[str, ...], sigma: th.Array, tolerance_K: th.Array, bodies: tuple[str, ...], table_sd: th.Array
) -> Hypotheses:
    """sigma, tolerance_K (s,) K of the sensors;  table_sd (m,) W that the table of doubt allows the bodies"""
    fault = th.PRIOR["fault"].share / max(len(sensors), 1)
    fails = sum(th.PRIOR[name].share for name in ("effect", "condition", "heat")) / max(len(bodies), 1)
    log = np.log(np.array([*[fault] * len(sensors), *[fails] * len(bodies)]) / th.PRIOR["nothing"].share)
    spread = np.concatenate([DRIFT * sigma, th.USUAL_DOUBT["switched"] * table_sd])
    tolerance = np.concatenate([tolerance_K, np.zeros(len(bodies))])
    return Hypotheses((*sensors, *bodies), spread, tolerance, log, np.zeros(spread.size), np.zeros(spread.size))


LOST_S = 30.0  # a plug that is wiggled comes back sooner
BACK_S = 60.0  # of good readings, before a sensor is believed again
FROZEN_S = 120.0  # a recorder that hangs for less does little harm
LONGER = 5.0  # times the longest run of equal readings so far: coarse readings stand still by themselves
MOTION = 2.0  # of a sensor's accuracy: what another sensor, or the model, has to move while the reading stands still
OUTLIER = 5.0  # deviations of the innovation: one reading in two million


@dataclass
class SensorState:
    """One sensor as it goes.  dropped : "", "lost", "frozen" or "drifting";  since_s : from when

    missing_s, good_s : how long there was none, or were only good readings;  same_s : how long the last one has stood
    longest_s : of all times that a reading stood before;  then (s,) degC at all sensors when the last new value came
    """

    dropped: str = ""
    since_s: float = 0.0
    missing_s: float = 0.0
    good_s: float = 0.0
    same_s: float = 0.0
    longest_s: float = 0.0
    last: float = np.nan
    then: th.Array = field(default_factory=lambda: np.empty(0))

    def take(
        self,
        reading: float,
        predicted: float,
        sd: float,
        around: th.Array,
        sigma_K: th.Array,
        time_s: float,
        step_s: float,
    ) -> bool:
        """Whether the reading is to be used.  sd : of the innovation;  around, sigma_K (s,) : of all sensors"""
        good = bool(th.COLDEST <= reading <= th.HOTTEST) and abs(reading - predicted) <= OUTLIER * sd
        self.missing_s, self.good_s = (0.0, self.good_s + step_s) if good else (self.missing_s + step_s, 0.0)
        if reading == self.last:
            self.same_s += step_s
        else:
            self.longest_s = max(self.longest_s, self.same_s)
            self.same_s, self.last, self.then = 0.0, reading, around
        if self.dropped:
            moves = self.dropped != "frozen" or self.same_s == 0.0
            if self.dropped != "drifting" and self.good_s >= BACK_S and moves:
                self.dropped = ""
        elif self.missing_s >= max(LOST_S, 3.0 * step_s):
            self.dropped, self.since_s = "lost", time_s - self.missing_s
        elif self.same_s >= max(FROZEN_S, LONGER * self.longest_s) and np.any(
            np.abs(around - self.then) > MOTION * sigma_K
        ):
            self.dropped, self.since_s = "frozen", time_s - self.same_s
        return good and not self.dropped
