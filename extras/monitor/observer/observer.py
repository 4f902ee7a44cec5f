"""The observer: sample by sample all temperatures and the missing heat, dropped sensors, and where the model fails."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.special import ndtr

from extras.monitor.observer.hypotheses import OVER, SURE, TOLERANCE, Hypotheses, SensorState, hypotheses
from extras.monitor.observer.kalman import Filter, ProcessNoise, begun
from extras.monitor.observer.process import Driven, Process
from thermoscope import Record, plugin as th

CORRELATION_S = 60.0  # a reading's error lasts about a minute: more readings within it are no more evidence


@dataclass(frozen=True)
class Event:
    """A sensor that is dropped, or a body where the model fails.  amplitude : K or W, the largest

    kind : "lost", "frozen", "drifting" or "model";  to_s : None while it lasts;  probability : the largest
    """

    kind: str
    where: str
    from_s: float
    to_s: float | None
    probability: float
    amplitude: float
    unit: str


@dataclass(frozen=True)
class Sample:
    """time_s;  x (n,) degC all states;  u (nb,) boundaries;  heat, heat_sd (m,) W

    S (N, N) : S S' is the covariance of slow states and heats;  open : what was said by then and still holds
    """

    time_s: float
    x: th.Array
    u: th.Array
    heat: th.Array
    heat_sd: th.Array
    S: th.Array
    along: th.Array
    open: tuple[Event, ...] = ()

    def at(self, row: th.Row) -> tuple[float, float]:
        """Temperature (degC) and its deviation (K) at a row over z = [x; u]."""
        z = np.concatenate([self.x, self.u])
        inside = row.index < self.x.size
        h = row.weights[inside] @ self.along[row.index[inside]]
        return row.at(z), float(np.linalg.norm(h @ self.S[: h.size]))


@dataclass
class Observer:
    """What it is made of and how it stands; `follow` takes it over a record.

    sensors : channels, whose readings do not matter
    bias (s,) K that each sensor reads too much;  lagged (s,) degC that it would show by its own inertia
    open : hypothesis -> what was said of it
    """

    filter: Filter
    sensors: tuple[th.Channel, ...]
    bias: th.Array
    states: list[SensorState]
    tests: Hypotheses
    lagged: th.Array
    started: bool = False
    open: dict[int, Event] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)

    def follow(self, record: Record, readings: th.Array) -> list[Sample]:
        """Samples of a record, its first being where the last record ended (or the start).

        readings (nt, s) degC, NaN where nothing was read
        """
        by, out, readings = self.filter.process.driven(record), [], readings - self.bias
        for k in range(1 if self.started else 0, by.time.size):
            seconds = float(by.time[k] - by.time[k - 1]) if k else 0.0
            if k:
                self.filter.predict(by, k)
                self.tests.forget(seconds)
            self._update(by, k, readings[k], seconds)
            out.append(self._sample(by, k))
            self.started = True
        return out

    def _update(self, by: Driven, k: int, readings: th.Array, seconds: float) -> None:
        z = np.concatenate([self.filter.x, by.u[k]])
        expected = np.array([c.row.at(z) for c in self.sensors])
        lag = np.array([c.lag_s for c in self.sensors])
        keeps = np.exp(-seconds / np.maximum(lag, 1e-9)) if self.started else np.zeros(lag.size)
        self.lagged = expected + keeps * (self.lagged - expected)
        change = np.zeros(len(self.filter.S))
        for j in range(len(self.sensors)):
            self._reading(j, float(readings[j]), change, float(by.time[k]), seconds or 1.0)
        self.filter.correct(change)
        n = self.filter.process.slow.size
        for j, c in enumerate(self.sensors):
            self.lagged[j] += self.filter.process.sensed(c.row, self.filter.along) @ change[:n]
        self._judge(float(by.time[k]))

    def _reading(self, j: int, reading: float, change: th.Array, time: float, seconds: float) -> None:
        """One reading into the filter; change (N,) grows by what it moves."""
        c, state, f = self.sensors[j], self.states[j], self.filter
        h = np.zeros(len(f.S))
        h[: f.process.slow.size] = f.process.sensed(c.row, f.along)
        variance, expected = c.sigma_K**2 * max(CORRELATION_S / seconds, 1.0), float(self.lagged[j] + h @ change)
        sd, was = float(np.sqrt(np.sum((f.S.T @ h) ** 2) + variance)), state.dropped
        sigma = np.array([one.sigma_K for one in self.sensors])
        usable = state.take(reading, expected, sd, self.lagged.copy(), sigma, time, seconds)
        if state.dropped != was:
            self._dropped(j, time)
        if not usable:
            return
        gain, total = f.gain(h, variance)
        innovation, signature = reading - expected, h @ f.error
        signature[j] += 1.0
        self.tests.weigh(signature, innovation, total)
        f.error = f.error - np.outer(gain, signature)
        change += gain * innovation

    def _dropped(self, j: int, time: float) -> None:
        """A sensor is dropped or comes back."""
        state = self.states[j]
        if j in self.open:
            self._close(j, time)
        if state.dropped:
            self._say(j, Event(state.dropped, self.sensors[j].name, state.since_s, None, 1.0, float("nan"), "K"))

    def _say(self, i: int, event: Event) -> None:
        self.open[i] = event
        self.events.append(event)

    def _close(self, i: int, time: float) -> None:
        event = self.open.pop(i)
        self.events[self.events.index(event)] = replace(event, to_s=time)

    def _judge(self, time: float) -> None:
        """Say what has become sure, withdraw what no longer is."""
        count = len(self.sensors)
        sd = np.linalg.norm(self.filter.S[self.filter.process.slow.size :], axis=1)
        for i, chance in enumerate(
            np.asarray(ndtr((np.abs(self.filter.q) - TOLERANCE * self.filter.noise.sd) / np.maximum(sd, 1e-9))), count
        ):
            size = float(self.filter.q[i - count])
            if i not in self.open:
                if chance > SURE:
                    self._say(i, Event("model", self.tests.names[i], time, None, float(chance), size, "W"))
            elif chance < OVER:
                self._close(i, time)
            elif abs(size) > abs(self.open[i].amplitude):
                event = replace(self.open[i], probability=float(chance), amplitude=size)
                self.events[self.events.index(self.open[i])] = self.open[i] = event
        drifts = self.tests.probability[:count]
        if count and drifts.max() > SURE:
            self._drop_drifting(int(drifts.argmax()), time, float(drifts.max()))

    def _drop_drifting(self, j: int, time: float, chance: float) -> None:
        """Without the sensor; where it has led the estimate is forgotten."""
        size = float(self.tests.amplitude[j])
        self.filter.restart(abs(size))
        self.states[j].dropped, self.states[j].since_s = "drifting", time
        if j in self.open:
            self._close(j, time)
        self._say(j, Event("drifting", self.sensors[j].name, time, None, chance, size, "K"))
        self.tests.clear()

    def _sample(self, by: Driven, k: int) -> Sample:
        f = self.filter
        sd = np.linalg.norm(f.S[f.process.slow.size :], axis=1)
        return Sample(float(by.time[k]), f.x.copy(), by.u[k], f.q.copy(), sd, f.S, f.along, tuple(self.open.values()))


def observer(
    process: Process,
    noise: ProcessNoise,
    sensors: Sequence[th.Channel],
    readings: th.Array,
    boundaries: Mapping[str, float],
    rise_K: float,
    bias: th.Array | None = None,
) -> Observer:
    """At its start, from the first readings (s,): places without a sensor begin at the mean of the others.

    rise_K : usual rise, of which a sensor may miss a share
    bias (s,) K that the sensors read too much, none by default
    """
    off = np.zeros(len(sensors)) if bias is None else bias
    start_T = {c.place: float(y) for c, y in zip(sensors, readings - off, strict=True) if np.isfinite(y)}
    x = th.initial_state(process.network, start_T or float(np.mean([*boundaries.values()])))
    around = np.array([*start_T.values(), *boundaries.values()])
    sd = {process.state(c): th.USUAL_DOUBT["start"] for c in sensors if c.place in start_T}
    count, m = len(sensors), len(process.bodies)
    heats = np.hstack([np.zeros((m, count)), np.eye(m)])
    start = begun(process, noise, x, sd, float(np.hypot(th.USUAL_DOUBT["start"], np.std(around))), heats)
    sigma = np.array([c.sigma_K for c in sensors])
    tolerance_K = np.hypot(sigma, th.USUAL_DOUBT["gain"] * rise_K)
    tests = hypotheses(tuple(c.name for c in sensors), sigma, tolerance_K, process.bodies, noise.sd)
    states = [SensorState() for _ in sensors]
    return Observer(start, tuple(sensors), off, states, tests, np.zeros(count))
