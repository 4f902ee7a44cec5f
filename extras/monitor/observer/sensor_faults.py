"""Readings that say nothing: lost, impossible, or frozen."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from thermoscope import plugin as th

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
        elif self.same_s >= max(FROZEN_S, LONGER * self.longest_s) and self._others_moved(around, sigma_K):
            self.dropped, self.since_s = "frozen", time_s - self.same_s
        return good and not self.dropped

    def _others_moved(self, around: th.Array, sigma_K: th.Array) -> bool:
        return bool(np.any(np.abs(around - self.then) > MOTION * sigma_K))
