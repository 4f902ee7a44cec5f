"""What the sensors of a test would read: the network's run, seen through each channel's operator (operators.py).

Long tests are looked at in stretches, so that their tangents are never in memory as a whole.
"""

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array, Numbers
from lumped.integration.compiled import READINGS, Precision
from lumped.integration.simulate import Record, Stand, simulate
from lumped.model.network import Network, Parameter
from lumped.model.once import once
from measured.case import Test
from measured.sensors import operators
from validation.effects.time_window import IN, holds, lasts

MOVING = tuple(f"{kind}:" for kind in operators.SHIFTS)
SENSORS = tuple(f"{kind}:" for kind in operators.OPERATORS if kind != "swap")
CACHED_NUMBERS = 100_000  # of a run whose readings are cached: a clock or a sensor that differs needs no new one
MARGIN = 40  # samples on either side of a stretch after which a spline no longer feels where it was cut


@dataclass(frozen=True)
class Prediction:
    """y : (n_time, n_channel) degC;  J : (n_time, n_channel, n_parameter), see simulate() for its coordinates."""

    y: Array
    J: Array


@once
def thermal(network: Network) -> Network:
    """The network with only the parameters that act on heat."""
    return replace(network, parameters=tuple(p for p in network.parameters if operators.head(p) == "thermal"))


def heat_model(network: Network, values: Numbers) -> tuple[Network, dict[str, float]]:
    """That network, and those of the values that act on it."""
    bare = thermal(network)
    names = {p.name for p in bare.parameters}
    return bare, {k: v for k, v in values.items() if k in names}


def predict(
    network: Network, test: Test, values: Numbers, tangents: Sequence[Parameter] = (), precision: Precision = READINGS
) -> Prediction:
    """Readings of every channel of a test and their derivatives with respect to `tangents`."""
    return Watch(network, test, values, tangents, precision).until(len(test.time))


def record(test: Test, shift: Numbers) -> Record:
    """The test's inputs, its time, and that it is this test; offsets of boundaries and start applied."""
    return stretch_of_record(test, shift, slice(0, len(test.time)))


def stretch_of_record(test: Test, shift: Numbers, some: slice) -> Record:
    """The samples of the record from some.start to some.stop, beginning as the whole does."""
    air = {n: np.broadcast_to(np.asarray(u, float), test.time.shape)[some] for n, u in test.boundaries.items()}
    boundaries = {n: u + sum(a for target, a in shift.items() if moves(target, n, test)) for n, u in air.items()}
    move, initial = shift.get(f"initial:{test.name}", 0.0), test.initial
    start = {k: v + move for k, v in initial.items()} if isinstance(initial, Mapping) else initial + move
    here = operators.start_target(test.name, "")
    above = {t.removeprefix(here): a for t, a in shift.items() if t.startswith(here)}
    return Record(test.time[some], test.signals.part(some), boundaries, start, above)


def moves(target: str, boundary: str, test: Test) -> bool:
    """Does what acts on a target offset this boundary, in every test or all through this one?"""
    everywhere = f"boundary:{boundary}"
    here = target.startswith(f"{everywhere}{IN}") and lasts(target.removeprefix(f"{everywhere}{IN}"), test)
    return target == everywhere or here


@once
def last_runs(test: Test) -> deque[tuple[Network, tuple[tuple[tuple[str, float], ...], Precision], Array, Stand]]:
    """Temperatures and ends of the last runs over a test, newest last; they go with it. A run itself holds all that
    drove it, thousands of numbers a sample in a large network."""
    return deque(maxlen=16)


class Course:
    """A run of the network over a test, as far as it was asked for."""

    def __init__(
        self,
        network: Network,
        test: Test,
        heat: Numbers,
        shift: Numbers,
        tangents: Sequence[Parameter] = (),
        shifts: Sequence[str | None] = (),
        precision: Precision = READINGS,
    ) -> None:
        self.precision = precision
        self.network, self.test, self.heat, self.tangents = network, test, heat, tangents
        self.shift, self.shifts, self.kept = shift, shifts, slice(0, 0)
        self.end: Stand | None = None
        self.T, self.dT = np.empty((0, 0)), np.empty((0, 0, 0))

    def over(self, some: slice) -> tuple[Array, Array]:
        """Temperatures (n, n_channel) at the sensors and their tangents (n, n_channel, n_tangent) of some samples.

        What was asked for last is kept, so the next may begin, and end, anywhere from its beginning, and end, on.
        """
        first = some.start - self.kept.start
        T, dT = self.T, self.dT = self.T[first:].copy(), self.dT[first:].copy()
        if some.stop > self.kept.stop:
            y, dy, end = self._run(slice(max(self.kept.stop - 1, 0), some.stop))
            T, dT = (np.concatenate([T, y[1:]]), np.concatenate([dT, dy[1:]])) if self.end else (y, dy)
            self.end = end
        self.T, self.dT, self.kept = T, dT, some
        return T, dT

    def _run(self, some: slice) -> tuple[Array, Array, Stand]:
        whole = some == slice(0, len(self.test.time)) and self.end is None
        if not whole or self.tangents or self.shifts or self.test.time.size * len(self.test.channels) > CACHED_NUMBERS:
            return self._simulated(some)
        key = (*self.heat.items(), *((k, v) for k, v in self.shift.items() if k.startswith(MOVING)))
        how = (key, self.precision)
        for network, at, y, end in tuple(last_runs(self.test)):
            if network is self.network and at == how:
                return y, np.empty((*y.shape, 0)), end
        y, dy, end = self._simulated(some)
        last_runs(self.test).append((self.network, how, y, end))
        return y, dy, end

    def _simulated(self, some: slice) -> tuple[Array, Array, Stand]:
        part, rows = stretch_of_record(self.test, self.shift, some), [c.row for c in self.test.channels]
        # a step at every sample: then a test cut in two, or looked at in stretches, is the same to the bit
        of = self.network, part, self.heat, rows, self.tangents
        run = simulate(*of, begin=self.end, shifts=self.shifts, precision=self.precision)
        return run.y, np.empty((*run.y.shape, 0)) if run.dy is None else run.dy, run.end


class Watch:
    """A test as its sensors read it under some values, from its beginning on, as far as it was asked for.

    tangents : parameters with respect to which the readings are differentiated
    """

    def __init__(
        self,
        network: Network,
        test: Test,
        values: Numbers,
        tangents: Sequence[Parameter] = (),
        precision: Precision = READINGS,
    ) -> None:
        self.network, self.test, self.tangents = network, test, tangents
        self.now, self.done, self.memory = operators.setting(network.parameters, values), 0, operators.Memory()
        (bare, heat), self.heads = heat_model(network, values), [operators.head(p) for p in tangents]
        each = list(enumerate(zip(tangents, self.heads, strict=True)))
        hot = [i for i, (_, kind) in each if kind == "thermal"]
        shift_of = {
            i: _shift(network, test, p) for i, (p, kind) in each if kind in operators.SHIFTS and _felt(network, test, p)
        }
        self.hot = [*hot, *shift_of]
        moving = [tangents[i] for i in hot], list(shift_of.values())
        self.course = Course(bare, test, heat, self.now, *moving, precision)
        every = {*self.now, *(target for p in tangents for target, _ in p.targets)}
        self.whiles = {
            target: operators.While.of(*channel_of(target), test.time, holds(target.rpartition(IN)[2], test))
            for target in every
            if IN in target and target.startswith(SENSORS)
        }
        self.late_s, self.spread = abs(self.now.get(f"delay:{test.name}", 0.0)), test.spread

    def until(self, stop: int) -> Prediction:
        """Readings and derivatives from where the last look ended to sample `stop`."""
        some = slice(max(self.done - 1, 0), stop)
        self.around = self._around(some)
        look = operators.stretch_of(self.network, self.test, some, self.memory, self.whiles)
        T, dT = self.course.over(self.around)
        late = self._late(T, some, self.now)
        y = look.read(late, self.now)
        J = np.zeros((*y.shape, len(self.tangents)))
        if self.hot:
            J[:, :, self.hot] = look.read(self._late(dT, some, self.now), self.now, "heat", linear=True)
        for i, kind in enumerate(self.heads):
            if kind in operators.OPERATORS:
                J[:, :, i] = self._operator(look, T, late, y, some, i)
        fresh, self.done = self.done - some.start, stop
        return Prediction(y[fresh:], J[fresh:])

    def _around(self, some: slice) -> slice:
        """The samples that a late clock makes those depend on."""
        time = self.test.time
        if not (self.late_s or "delay" in self.heads):
            beside = 1 if self.spread else 0
            return slice(max(some.start - beside, 0), min(some.stop + beside, time.size))
        low, high = np.searchsorted(time, [time[some.start] - self.late_s, time[some.stop - 1] + self.late_s])
        return slice(max(int(low) - MARGIN, 0), min(int(high) + MARGIN, time.size))

    def _late(self, T: Array, some: slice, now: Numbers) -> Array:
        """Temperatures as the samples have them, out of those around: means over a step, a late recorder's clock."""
        delay, time = now.get(f"delay:{self.test.name}", 0.0), self.test.time
        T = softened(T, self.spread)
        if not delay:
            return T[some.start - self.around.start : some.stop - self.around.start]
        return operators.shifted(time[self.around], T, delay, time[some], (float(time[0]), float(time[-1])))

    def _operator(self, look: operators.Stretch, T: Array, late: Array, y: Array, some: slice, i: int) -> Array:
        """Tangent by a step of what the i-th parameter acts on. T: around, late: with the delay, y: as read."""
        now, step = operators.moved(self.now, self.tangents[i])
        if self.heads[i] == "delay":
            return (look.read(self._late(T, some, now), now, f"step {i}") - y) / step
        if any(key.startswith("swap:") for key in now):
            return (look.read(late, now, f"step {i}") - y) / step
        out, (_, name) = np.zeros_like(y), channel_of(self.tangents[i].targets[0][0])
        for j, c in enumerate(look.channels):
            if c.name == name:
                out[:, j] = (look.through([c], late[:, j : j + 1], now, f"step {i}")[:, 0] - y[:, j]) / step
        return out


def channel_of(target: str) -> tuple[str, str]:
    """Kind of sensor's error and channel that a parameter acts on, always or for a while."""
    kind, _, name = target.partition(":")
    return kind, name.rpartition(IN)[0] or name


def softened(T: Array, spread: float) -> Array:
    """(n, ...) means over a sample step from the instants in their middles; both ends as they are."""
    if not spread:
        return T
    out = T.copy()
    out[1:-1] += spread * (T[2:] - 2.0 * T[1:-1] + T[:-2])
    return out


def _shift(network: Network, test: Test, p: Parameter) -> str | None:
    """The boundary that a parameter offsets, the state whose start it offsets, None for the start of all."""
    target = p.targets[0][0]
    if target.startswith(operators.start_target(test.name, "")):
        return target.removeprefix(operators.start_target(test.name, ""))
    return next((b for b in network.boundaries if moves(target, b, test)), None)


def _felt(network: Network, test: Test, p: Parameter) -> bool:
    """Is the boundary one of the network's and of this test's, or the start this test's?"""
    target, both = p.targets[0][0], [b for b in network.boundaries if b in test.boundaries]
    return operators.starts(target, test.name) or any(moves(target, b, test) for b in both)
