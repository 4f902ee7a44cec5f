"""Temperatures of a network under constant load, at rest, after a time, and over a repeated period.

Places whose largest temperature is limited are the hot spot of a part that was meshed, else a node; or its mean.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from extras.rating.operation import Operation
from thermoscope import Network, Record, ThermoscopeError, plugin as th, simulate, steady

MEAN = ".mean"  # after the name of a place: its mean instead of its hottest point
CHUNK = 64  # instants that are looked at together: a part of 10,000 points then takes 5 MB


@dataclass(frozen=True)
class HotSpots:
    """name, limit (degC);  states (k,);  V (m, k) temperatures of points as sums over the states"""

    name: str
    limit: float
    states: th.Ints
    V: th.Array

    def along(self, z: th.Array) -> th.Array:
        """(nt,) degC of the hottest point at every instant.  z : (nt, n_states + n_boundaries)"""
        x = z[:, self.states]
        return np.concatenate([(x[k : k + CHUNK] @ self.V.T).max(axis=1) for k in range(0, len(x), CHUNK)])

    def hottest(self, z: th.Array) -> tuple[float, th.Row]:
        """degC, and the point's row."""
        T = self.V @ z[self.states]
        k = int(np.argmax(T))
        return float(T[k]), th.Row(self.states, self.V[k])


def hot_spots(network: Network, rows: Mapping[str, th.Row], limits: Mapping[str, float]) -> tuple[HotSpots, ...]:
    """One per limited place, by its hottest point; "NAME.mean" is the mean of a place.  rows : place -> its mean"""
    parts = network.recovery.parts if isinstance(network.recovery, th.Shapes) else {}
    out = []
    for name, limit in limits.items():
        if name in parts:
            out.append(HotSpots(name, limit, parts[name].states, np.unique(parts[name].V, axis=0)))
        else:
            mean = rows[name if name in rows else name.removesuffix(MEAN)]
            out.append(HotSpots(name, limit, mean.index, mean.weights[None, :]))
    return tuple(out)


TOGETHER, ROUNDS = 2, 40  # periods that run as one record; of these at most
REPEATS_K = 0.02  # change per period below which a duty repeats itself
DEPTH = 4  # earlier rounds that Anderson's mixing looks back at
SAMPLES = 24  # of a period
RUNAWAY_C = 1e4  # what a load without rest counts as


@dataclass(frozen=True)
class Model:
    """A network at some values of its parameters, looked at in the places that are limited: mean or hottest point."""

    network: Network
    values: Mapping[str, float]
    rows: Sequence[th.Row | HotSpots]

    def place_temperatures(self, z: th.Array) -> th.Array:
        """(nt, n_rows) degC of the limited places.  z : (nt, n_states + n_boundaries)"""
        return np.column_stack(
            [r.along(z) if isinstance(r, HotSpots) else z[:, r.index] @ r.weights for r in self.rows]
        )

    def run(self, record: Record, begin: th.Stand) -> tuple[th.Array, th.Stand]:
        """(nt, n_rows) degC over a record, and where it ends."""
        run = simulate(self.network, record, self.values, keep_states=True, begin=begin)
        return self.place_temperatures(np.asarray(run.z)), run.end

    def rest(self, op: Operation, load: float, speed: float | None) -> th.Array:
        """(n_rows,) degC under the load for ever; RUNAWAY_C where losses grow faster than the cooling."""
        try:
            return self.place_temperatures(
                steady(self.network, op.at(load, speed), op.boundaries, self.values).z[None]
            )[0]
        except ThermoscopeError:
            return np.full(len(self.rows), RUNAWAY_C)

    def start(self, op: Operation, load: float | None, speed: float | None) -> th.Stand:
        """A stand to begin from: all at the mean of what is around, or at rest under a load."""
        if load is None:
            return self.at(op, th.initial_state(self.network, float(np.mean(list(op.boundaries.values())))))
        z = steady(self.network, op.at(load, speed), op.boundaries, self.values).z
        return self.at(op, z[: len(self.network.states)])

    def at(self, op: Operation, x: th.Array) -> th.Stand:
        """A stand at a state x (n_states,)."""
        means = x[["#" not in s for s in self.network.states]]
        none = np.zeros((x.size + len(self.network.boundaries), 0))  # no tangents
        return th.Stand(x, none, 1.0, float(min(means.min(), *op.boundaries.values())))

    def course(
        self, op: Operation, load: float, speed: float | None, begin: th.Stand, seconds: float
    ) -> tuple[th.Array, th.Array]:
        """times (nt,) s and temperatures (nt, n_rows) under a constant load; RUNAWAY_C where a run goes astray."""
        time = np.concatenate([[0.0], seconds * np.geomspace(1e-3, 1.0, SAMPLES)])
        record = Record(time, {n: np.full(time.size, u) for n, u in op.at(load, speed).items()}, op.boundaries)
        try:
            return time, self.run(record, begin)[0]
        except ThermoscopeError:
            return time, np.full((time.size, len(self.rows)), RUNAWAY_C)

    def repeated(self, op: Operation, load: float, speed: float | None, duty: "Duty") -> th.Array:
        """(n_rows,) largest temperatures of a duty that is repeated until it repeats itself."""
        time, share = th.s3(duty.period_s, duty.share, TOGETHER, duty.period_s / SAMPLES)
        pause = op.at(duty.idle * load, 0.0 if duty.stops else speed)
        inputs = {n: np.where(share > 0.5, u, pause[n]) for n, u in op.at(load, speed).items()}
        mean = load * np.sqrt(duty.share + (1.0 - duty.share) * duty.idle**2)
        return self.again_and_again(op, Record(time, inputs, op.boundaries), mean, speed)

    def again_and_again(self, op: Operation, record: Record, load: float, speed: float | None) -> th.Array:
        """(n_rows,) largest temperatures of a record that follows on itself until it repeats itself.

        load : whose rest is a first guess;  RUNAWAY_C where there is no rest
        """
        try:
            record = replace(record, inputs=th.Signals(record.inputs, record.time.size))  # factors are worked out once
            x = self.start(op, load, speed).x
            iterates: list[tuple[th.Array, th.Array]] = []
            for _ in range(ROUNDS):
                T, end = self.run(record, self.at(op, x))
                iterates = [*iterates, (x, end.x)][-DEPTH:]
                if np.abs(end.x - x).max() < REPEATS_K * TOGETHER:
                    break
                x = mixed(iterates)
            return np.asarray(T.max(axis=0))
        except ThermoscopeError:
            return np.full(len(self.rows), RUNAWAY_C)


def mixed(history: Sequence[tuple[th.Array, th.Array]]) -> th.Array:
    """Where x = g(x) is, from pairs (x, g(x)): Anderson 1965, without damping."""
    x, g = (np.array(side).T for side in zip(*history, strict=True))
    if x.shape[1] == 1:
        return np.asarray(g[:, -1])
    f = g - x
    share = np.linalg.lstsq(np.diff(f), f[:, -1], rcond=1e-8)[0]
    return np.asarray(g[:, -1] - np.diff(g) @ share)


@dataclass(frozen=True)
class Duty:
    """IEC 60034-1: load for a share of a period; then a share `idle` of it, at standstill where it `stops`."""

    period_s: float = 600.0
    share: float = 0.4
    idle: float = 0.0
    stops: bool = True


S3, S6 = Duty(), Duty(stops=False)
