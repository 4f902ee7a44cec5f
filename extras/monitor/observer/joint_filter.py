"""Temperatures, missing heat and constants together, over recordings: an extended Kalman filter with constant states.

    C(w) dx/dt = F(x, u, w) + E q ,     dq/dt = -q / tau + white noise ,     dw/dt = 0 ,     y = H(w) x + noise

Because heat may be missing, a recording that the model cannot follow moves the constants w by what it tells of them
and no further. From test to test only w and its covariance are carried. Source: Jazwinski 1970, chapter 8.
"""

from dataclasses import dataclass, field

import numpy as np

from extras.monitor.observer.constants import Constants
from extras.monitor.observer.kalman import ProcessNoise, thinned
from extras.monitor.observer.process import Process
from thermoscope import Record, plugin as th

LASTS_S = 600.0  # an error of a whole recording is that of a place or of its rig: it lasts as long as the heat does
CLOSE = 1e-3  # deviations of a constant that change no heat worth the work
STEP_K = 0.01  # of the difference that says how a law turns with temperature


@dataclass
class JointFilter:
    """bodies : where heat may be missing;  w (k,), P (k, k) : the constants as they stand, and their covariance"""

    constants: Constants
    bodies: tuple[str, ...]
    noise: ProcessNoise
    w: th.Array = field(init=False)
    P: th.Array = field(init=False)

    def __post_init__(self) -> None:
        self.w, self.P = np.zeros(self.constants.sd.size), np.diag(self.constants.sd**2)
        self.terms = _Terms(self.constants, CLOSE)
        self.process = _Varying(self.constants.network, {}, self.bodies, self.terms)

    def over(self, test: th.Test) -> None:
        """What a test says of the constants."""
        run = _Run(self, thinned(test))
        for k in range(test.time.size):
            run.take(k)
        n = run.n
        self.w, self.P = run.w, run.P[n:, n:]


class _Run:
    """The filter along one test.  P (n + k, n + k) : of slow states, heats and constants"""

    def __init__(self, of: JointFilter, test: th.Test) -> None:
        self.of, self.test, self.process, self.terms = of, test, of.process, of.terms
        self.n = self.process.size
        self.w, self.q = of.w, np.zeros(len(of.bodies))
        course = th.record(test, {})
        self.time = np.asarray(course.time, float)
        self.f = self.terms.factors(course)
        names = self.process.network.boundaries
        self.u = np.column_stack([np.broadcast_to(course.boundaries[b], self.time.shape) for b in names])
        self.at = {c.name: j for j, c in enumerate(of.constants.channels)}
        first = {c.place: float(c.y[0]) for c in self.test.channels if np.isfinite(c.y[0])}
        x = th.initial_state(self.process.network, first or float(self.u[0].mean()))
        around = np.std([*first.values(), *self.u[0]])
        sd = np.full(self.process.slow.size, float(np.hypot(th.USUAL_DOUBT["start"], around)))
        read = {self.process.state(c) for c in self.test.channels if c.place in first}
        sd[[int(i) in read for i in self.process.slow]] = th.USUAL_DOUBT["start"]
        P, s = np.zeros((self.n + self.w.size,) * 2), self.process.slow.size
        P[:s, :s], P[s : self.n, s : self.n] = np.diag(sd**2), of.noise.covariance
        P[self.n :, self.n :] = self.of.P
        self.x, self.P = np.asarray(x, float), P
        self.along = self.process.slow_only
        self.lagged = np.zeros(len(test.channels))

    def take(self, k: int) -> None:
        """To sample k, and its readings."""
        seconds = float(self.time[k] - self.time[k - 1]) if k else 0.0
        for share, h in self.process.inner(seconds):
            f = self.f[k - 1] + share * (self.f[k] - self.f[k - 1])
            self._step(f, self.u[k - 1] + share * (self.u[k] - self.u[k - 1]), h)
        z = np.concatenate([self.x, self.u[k]])
        keeps = [np.exp(-seconds / c.lag_s) if k and c.lag_s > 0.0 else 0.0 for c in self.test.channels]
        places, of = [self.at[c.name] for c in self.test.channels], self.of.constants
        readings = np.array([of.sensor_row(j, self.w).at(z) + of.bias(j, self.w) for j in places])
        self.lagged = readings + np.array(keeps) * (self.lagged - readings)
        change = np.zeros(len(self.P))
        for i, c in enumerate(self.test.channels):
            if np.isfinite(c.y[k]):
                self._reading(i, c, float(c.y[k]), z, change, seconds or 1.0)
        s = self.process.slow.size
        for i, c in enumerate(self.test.channels):
            self.lagged[i] += self._slope(c, z) @ change
        self.x = self.x + self.along @ change[:s]
        self.q, self.w = self.q + change[s : self.n], self.w + change[self.n :]

    def _step(self, f: th.Array, u: th.Array, h: float) -> None:
        s, m, keeps = self.process.slow.size, self.q.size, float(np.exp(-h / self.of.noise.time_s))
        self.terms.at(self.w, f)
        B = self.terms.by_constants(np.concatenate([self.x, u, [1.0]]), self.w.size)
        B = np.column_stack([self.process.E, B])
        self.x, G = self.process.predicted(self.x, self.q, u, h)
        into = np.zeros((self.x.size, s + m + self.w.size))
        C = self.terms.C
        into[self.process.slow, np.arange(s)] = C[self.process.slow]
        into[:, s:] = h * B
        diagonal = np.zeros(C.size)
        diagonal[self.process.slow] = C[self.process.slow]
        Phi = np.linalg.solve(np.diag(diagonal) + h * G, into)[self.process.slow]
        self.along = self.process.balance(G)
        P = self.P
        top = Phi @ P
        P[:s, s:], P[:s, :s] = top[:, s:], top @ Phi.T
        P[:s, s : self.n] *= keeps
        P[s : self.n, self.n :] *= keeps
        P[s : self.n, s : self.n] *= keeps**2
        P[s : self.n, s : self.n] += (1.0 - keeps**2) * self.of.noise.covariance
        P[s:, :s], P[self.n :, s : self.n] = P[:s, s:].T, P[s : self.n, self.n :].T
        self.q = keeps * self.q

    def _slope(self, c: th.Channel, z: th.Array) -> th.Array:
        """(N,) what a reading sees of everything."""
        j, h = self.at[c.name], np.zeros(len(self.P))
        h[: self.process.slow.size] = self.process.sensed(self.of.constants.sensor_row(j, self.w), self.along)
        for k, slope in self.of.constants.by_sensor(j, z):
            h[self.n + k] = slope
        return h

    def _reading(self, i: int, c: th.Channel, y: float, z: th.Array, change: th.Array, seconds: float) -> None:
        h = self._slope(c, z)
        through = self.P @ h
        total = float(h @ through) + c.sigma_K**2 * max(LASTS_S / seconds, 1.0)
        change += through * ((y - self.lagged[i] - float(h @ change)) / total)
        self.P -= np.outer(through, through) / total


class _Terms:
    """Every term of a network at one instant, at constants that move: by less than `close` deviations, by nothing."""

    def __init__(self, constants: Constants, close: float = 0.0) -> None:
        network = self.network = constants.network
        self.constants, self.every, self.n = constants, th.assembly(network), len(network.states)
        patterns = self.every.patterns
        owner = np.repeat(np.arange(len(patterns)), [p.cols.size for p in patterns])
        self._col = np.concatenate([p.cols for p in patterns]).astype(int)
        self._val = np.concatenate([p.vals for p in patterns])
        self._flat = owner * self.n + np.concatenate([p.row[p.to] for p in patterns]).astype(int)
        self._seen, self._place = th.input_sizes(patterns)
        self._bent = [(e, p.law.temperature, p.hot, p.cold) for e, p in enumerate(patterns) if p.bends]
        self._known, self._close = np.full(constants.sd.size, np.inf), close * constants.sd

    def factors(self, record: Record) -> th.Array:
        """(nt, ne and more) of a record: of all terms, then what their temperature laws see of inputs."""
        u, nt = record.inputs, record.time.shape
        signals = u if isinstance(u, th.Signals) else th.Signals(u, record.time.size)
        with th.within_silence():  # a comparison says so
            every = [signals.factor(p.name, p.law) for p in self.every.patterns]
            every += [signals.factor(x.name, x.law) for x in self._seen]
        return np.column_stack([np.broadcast_to(f, nt) for f in every])

    def at(self, w: th.Array, f: th.Array) -> None:
        """At constants w and input factors f."""
        if np.any(np.abs(w - self._known) > self._close):
            values = self.constants.values(w)
            acting = th.multipliers(self.network, values)
            self.m = np.array([acting.get(name, 1.0) for name in self.every.names])
            self.C = self.network.C * th.capacity_multipliers(self.network, acting)
            # by (ne, p), C_by (n, p) : slopes of the coefficients, and of the logarithm of the capacities
            moves = th.slopes(self.network, values, self.constants.parameters)
            at = {name: e for e, name in enumerate(self.every.names)}
            self.by = np.zeros((len(at), len(moves)))
            for j, slope in enumerate(moves):
                for target, value in slope.items():
                    if target in at:
                        self.by[at[target], j] += value
            capacity_by = [th.capacity_slopes(self.network, slope) for slope in moves]
            self.C_by = np.reshape(capacity_by, (-1, self.n)).T * (self.network.C / np.maximum(self.C, 1e-30))[:, None]
            self._known = w.copy()
        self.f, self._sizes = f[: len(self.every.names)], f[self._place]

    def _unit(self, z: th.Array) -> th.Array:
        """(ne, n) heat into every state by a coefficient of one."""
        ne = len(self.every.patterns)
        heat = np.bincount(self._flat, -self._val * z[self._col], ne * self.n)
        return np.asarray(heat, float).reshape(ne, self.n)

    def _laws(self, z: th.Array) -> th.Array:
        out = np.ones(len(self.every.patterns))
        for e, law, hot, cold in self._bent:
            out[e] = th.temperature_value(law, hot.at(z), cold.at(z), self._sizes[e])
        return out

    def heat(self, z: th.Array) -> tuple[th.Array, th.Array]:
        """F (n,) into the states, and -dF/dx (n, n)."""
        coefficient = self.m * self.f
        now = coefficient * self._laws(z)
        K = self.every.matrix(now)
        G, unit = K[:, : self.n].copy(), self._unit(z) if self._bent else np.empty((0, 0))
        for e, law, hot, cold in self._bent:
            size = float(self._sizes[e])
            for row, slope in ((hot, _slope(law, hot, cold, z, 0, size)), (cold, _slope(law, hot, cold, z, 1, size))):
                inside = row.index < self.n
                if slope and inside.any():
                    np.subtract.at(
                        G.T, row.index[inside], coefficient[e] * slope * np.outer(row.weights[inside], unit[e])
                    )
        return -(K @ z), G

    def by_constants(self, z: th.Array, count: int) -> th.Array:
        """(n, count) how the heat into the states changes with each constant; those of sensors change none."""
        per = (self.f * self._laws(z))[:, None] * self._unit(z)
        columns = per.T @ self.by - self.C_by * (self.m @ per)[:, None]
        return np.pad(columns, ((0, 0), (0, count - columns.shape[1])))


@dataclass(frozen=True)
class _Varying(Process):
    """A process whose heat is that of its terms as they stand."""

    terms: _Terms

    def predicted(self, x: th.Array, q: th.Array, u: th.Array, h: float) -> tuple[th.Array, th.Array]:
        return self.stepped(lambda x: self.terms.heat(np.concatenate([x, u, [1.0]])), self.terms.C, x, q, h)


def _slope(law: th.TemperatureLaw, hot: th.Row, cold: th.Row, z: th.Array, side: int, size: float) -> float:
    """Of a law with one of its temperatures, at a size of the input that it sees."""
    if law == th.CONSTANT:
        return 0.0
    a, b = hot.at(z), cold.at(z)
    more = th.temperature_value(law, a + STEP_K * (side == 0), b + STEP_K * (side == 1), size)
    return (more - th.temperature_value(law, a, b, size)) / STEP_K
