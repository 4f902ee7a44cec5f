"""How well an observer who knows the machine and the shape of every effect could see them and tell them apart.

Along the run of a machine with nothing missing, whatever differs (a parameter, an effect, an explanation) adds heat;
the readings answer linearly. Parameters as uncertain as a user's priors, biases of thermometers and a wrong ambient are
adjusted freely; what is left is weighed against model error of 0.4 K that is correlated over ten minutes. The unit of
size is the amplitude that makes a deviation of ten.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hidden.truth.archetype import Archetype, Plan, sensors, truly
from hidden.truth.body import Array
from hidden.truth.change import NOTHING, Change
from hidden.truth.draw import Draw
from hidden.truth.machine import Machine
from hidden.truth.profile import fine_times

MODEL_K, CORRELATED_S, DEVIATION = 0.4, 600.0, 10.0
EVERY_S = 60.0
WIDER = 1.5  # a user's prior over the scatter of the true parameters
BIAS_K, AMBIENT_K, LAG_S, STEP = 0.5, 0.35, 5.0, 1e-3


@dataclass(frozen=True)
class Course:
    """A machine's run through one test: temperatures (n, cells), inputs, Jacobians (n, cells, cells)."""

    machine: Machine
    time: Array
    T: Array
    inputs: Sequence[Mapping[str, float]]
    jacobian: Array
    cells: Sequence[int]

    def answer(self, heating: Array) -> Array:
        """Readings (n, channels, m) that answer slopes (n, cells, m) in K/s; implicit Euler."""
        dt, one = float(self.time[1] - self.time[0]), np.eye(self.T.shape[1])
        state, out = np.zeros(heating.shape[1:]), np.zeros((self.time.size, len(self.cells), heating.shape[2]))
        for k in range(1, self.time.size):
            state = np.linalg.solve(one - dt * self.jacobian[k], state + dt * heating[k])
            out[k] = state[self.cells]
        return out

    def slopes(self, changed: Machine, change: Change, room_K: float = 0.0) -> Array:
        """What a change adds to the slopes (n, cells)."""
        signals = {k: s(self.time) for k, s in change.signals.items()}
        planned = {k: np.array([u[k] for u in self.inputs]) for k in change.driven}
        signals |= {k: true(self.time, planned[k]) for k, true in change.driven.items()}
        return np.stack(
            [
                changed.slope(
                    T, {**u, **{k: float(v[i]) for k, v in signals.items()}, "T_ambient": u["T_ambient"] + room_K}
                )
                - self.machine.slope(T, u)
                for i, (T, u) in enumerate(zip(self.T, self.inputs, strict=True))
            ]
        )

    def added(self, change: Change) -> Array:
        """The same for a change of terms alone, which is quicker."""
        terms, C = change.terms(self.machine.skeleton), self.machine.skeleton.capacity(self.T)
        out = np.zeros_like(self.T)
        for q, T, u in zip(out, self.T, self.inputs, strict=True):
            for term in terms:
                term.into(q, T, u)
        return np.asarray(out / C)


def course(kind: Archetype, plan: Plan, seed: int) -> Course:
    draw = Draw(seed)
    machine = kind.build(draw, NOTHING)
    at, _, driving = truly(kind, plan, seed, NOTHING)
    fine = fine_times(at, kind.logger.fine)
    every = round(EVERY_S / float(fine[1] - fine[0]))
    T = machine.run(fine, driving, np.full(machine.skeleton.C.size, float(driving["T_ambient"][0])))[::every]
    inputs = [{k: float(v[i * every]) for k, v in driving.items()} for i in range(T.shape[0])]
    slow = [machine.jacobian(T[i], inputs[i]) for i in range(0, T.shape[0], 2)]  # every other minute
    jacobian = np.stack([slow[i // 2] for i in range(T.shape[0])])
    return Course(machine, fine[::every], T, inputs, jacobian, [s.cell for s in sensors(kind, machine, draw, NOTHING)])


def whitened(columns: Array) -> Array:
    """Columns (n, channels, m) of one test as independent numbers (n * channels, m)."""
    keep = np.exp(-EVERY_S / CORRELATED_S)
    fresh = np.concatenate([columns[:1], (columns[1:] - keep * columns[:-1]) / np.sqrt(1.0 - keep**2)])
    return np.asarray(fresh.reshape(-1, columns.shape[2]) / MODEL_K)


def adjustable(kind: Archetype, seed: int, one: Course) -> Array:
    """Answers (n, channels, p) to everything that calibration may move in all tests alike, at one deviation."""
    columns = []
    for key, sd in kind.spreads().items():
        changed = kind.build(Draw(seed, {key: 1.0 + STEP}), NOTHING)
        columns.append(one.slopes(changed, NOTHING) * WIDER * sd / STEP)
    moved = one.answer(np.stack(columns, axis=2))
    n, channels = one.time.size, len(one.cells)
    bias = np.tile(BIAS_K * np.eye(channels), (n, 1, 1))
    rate = np.gradient(one.T[:, one.cells], one.time, axis=0)
    return np.concatenate([moved, bias, LAG_S * rate[:, :, None] * np.eye(channels)], axis=2)


@dataclass(frozen=True)
class Seen:
    """Whitened answers: J (rows, p) to what is adjusted, E (rows, m) to effects at one unit; the rows of every test."""

    names: tuple[tuple[str, ...], ...]
    J: Array
    E: Array
    rows: Mapping[str, slice]

    def left(self, test: str = "") -> Array:
        """Second moments V (m, m) of what is left of the effects after calibration; with a test, in it alone."""
        E = self.E
        if test:
            E = np.zeros_like(self.E)
            E[self.rows[test]] = self.E[self.rows[test]]
        cross = self.J.T @ E
        return np.asarray(E.T @ E - cross.T @ np.linalg.solve(self.J.T @ self.J + np.eye(self.J.shape[1]), cross))


def unlike(V: Array, i: int, j: int) -> float:
    """Share of effect i's squared deviation that effect j cannot explain, were it of the right sign."""
    both = V[i, i] * V[j, j]
    return 1.0 - float(V[i, j] ** 2 / both) if V[i, j] > 0.0 and both > 0.0 else 1.0


def seen(kind: Archetype, seed: int, changes: Mapping[tuple[str, ...], Change], roles: Sequence[str]) -> Seen:
    """Answers to every change in all tests of these roles."""
    plans = [p for p in kind.plans if p.role in roles]
    blocks = [_block(kind, seed, plan, changes) for plan in plans]
    ends = np.cumsum([0, *(own.shape[0] for _, own, _ in blocks)])
    rows = {p.name: slice(int(a), int(b)) for p, a, b in zip(plans, ends[:-1], ends[1:], strict=True)}
    alone = np.zeros((int(ends[-1]), len(blocks)))
    for k, (plan, (_, own, _)) in enumerate(zip(plans, blocks, strict=True)):
        alone[rows[plan.name], k] = own[:, 0]
    J, E = (np.concatenate([b[k] for b in blocks]) for k in (0, 2))
    return Seen(tuple(changes), np.concatenate([J, alone], axis=1), E, rows)


def _block(kind: Archetype, seed: int, plan: Plan, changes: Mapping[tuple[str, ...], Change]) -> list[Array]:
    """Whitened answers in one test: to what calibration moves, to its ambient, to every change."""
    one = course(kind, plan, seed)
    heating = np.stack([_heating(kind, seed, one, c.during(plan.name)) for c in changes.values()], axis=2)
    ambient = one.answer(one.slopes(one.machine, NOTHING, AMBIENT_K)[:, :, None])
    return [whitened(columns) for columns in (adjustable(kind, seed, one), ambient, one.answer(heating))]


def _heating(kind: Archetype, seed: int, one: Course, change: Change) -> Array:
    if change.factors or change.joints or change.signals or change.driven:
        return one.slopes(kind.build(Draw(seed, change.factors), change), change)
    return one.added(change)
