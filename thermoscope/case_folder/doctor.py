"""What is probably wrong with recordings, sheets and network before anything is fitted, each with its cure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from lumped.model.network import Link, Network, Source
from lumped.transfer.laws import InputPower
from thermoscope.recordings.sheet import Sheet
from thermoscope.recordings.tables import Samples

Array = NDArray[np.float64]
FIRST = 5  # readings that say where a column starts
KELVIN, OFF_K = 273.15, 15.0  # how near a start has to be to that of the others in another unit
APART_K = 12.0  # how far it has to be as it stands
SPIKE_K, SPIKE_TIMES = 8.0, 20.0  # a reading that leaps and comes back, in K and in usual steps of its column
UNEVEN = 0.5  # of a long step of a clock, between nine in ten and one in ten of all
RATES = 10.0  # times the rows of another test
STORED = 20.0  # times the heat that came in; capacities are known within a factor of 2 or 3
WARM_K = 3.0
LEAST_READINGS = 3  # of a sensor in a test, as of rows
WIDE_K = 10.0  # 1-sigma that no sensor of a machine has
ONE = np.ones(2)  # of every input
SWITCHES = ((0.0, 1.0), (0.0, 100.0))  # levels of an input that is switched: as a number, in percent


@dataclass(frozen=True)
class Finding:
    """test : "" for the case as a whole;  where : column, input or node;  cure : what to do about it

    remark : may well be as meant
    """

    test: str
    where: str
    what: str
    cure: str
    remark: bool = False

    def document(self) -> dict[str, str | bool]:
        return dict(vars(self))


@dataclass(frozen=True)
class Patient:
    """One test as it was read."""

    name: str
    sheet: Sheet
    samples: Samples

    @property
    def temperatures(self) -> dict[str, Array]:
        return {c.name: self.samples.values[c.name] for c in self.sheet.columns if c.is_temperature}

    @property
    def inputs(self) -> dict[str, Array]:
        """Input -> its readings, of all columns that feed one."""
        return {c.feeds: self.samples.values[c.name] for c in self.sheet.columns if c.feeds}

    def found(self, where: str, what: str, cure: str) -> Finding:
        return Finding(self.name, where, what, cure)


def examined(patients: list[Patient], network: Network) -> tuple[Finding, ...]:
    """Everything that looks wrong in the tests, in the case as a whole and in the network."""
    each = [finding for p in patients for check in CHECKS for finding in check(p)]
    power = [finding for p in patients for finding in _power(p, network)]
    inputs = [*_unused(patients, network), *_switched(patients, network)]
    return (*each, *power, *_rates(patients), *_copies(patients), *_cold(network), *inputs, *_stores(network))


def _units(p: Patient) -> Iterator[Finding]:
    """A column that starts where the others would in kelvin or Fahrenheit."""
    starts = _starts(p)
    for name, start in starts.items():
        others = [s for n, s in starts.items() if n != name]
        usual = float(np.median(others)) if others else 20.0
        if abs(start - usual) < APART_K:
            continue
        if abs(start - KELVIN - usual) < OFF_K:
            yield p.found(name, f"starts at {start:.0f} degC, the others at {usual:.0f}: kelvin?", 'unit = "K"')
        elif abs((start - 32.0) / 1.8 - usual) < OFF_K / 3:
            yield p.found(name, f"starts at {start:.0f} degC, the others at {usual:.0f}: Fahrenheit?", 'unit = "degF"')


def _scale(p: Patient) -> Iterator[Finding]:
    """A column that starts at ten times, or a tenth, of where the others do: a logger's tenths of a degree."""
    starts = _starts(p)
    for name, start in starts.items():
        usual = float(np.median([s for n, s in starts.items() if n != name] or [start]))
        for factor, cure in ((10.0, "divide the column by 10"), (0.1, "multiply the column by 10")):
            if abs(start - factor * usual) < 0.1 * abs(factor * usual) and abs(start - usual) > APART_K:
                yield p.found(name, f"starts at {start:.4g} degC, the others at {usual:.4g}: tenths of a degree?", cure)


def _reversed(p: Patient) -> Iterator[Finding]:
    """A sensor that falls as the others rise: a thermocouple with its wires swapped."""
    moves = {n: float(v[seen[-1]] - v[seen[0]]) for n, v in p.temperatures.items()
             if (seen := np.flatnonzero(np.isfinite(v))).size}  # fmt: skip
    for name, move in moves.items():
        others = [m for n, m in moves.items() if n != name]
        if move < -WARM_K and others and min(others) > -WARM_K / 3 and float(np.median(others)) > WARM_K:
            yield p.found(name, f"falls by {-move:.0f} K while the others rise: are its wires swapped?",
                          "use = false, or the wires the right way round")  # fmt: skip


def _sparse(p: Patient) -> Iterator[Finding]:
    """Sensors that were hardly read."""
    after = {c.name for c in p.sheet.columns if c.electrical is not None}  # one reading says the end, and is meant so
    for name, values in p.temperatures.items():
        count = int(np.isfinite(values).sum())
        if count < LEAST_READINGS and name not in after:
            yield p.found(name, f"was read {count} {'time' if count == 1 else 'times'} in the whole test: that "
                          "says next to nothing of the model", "readings over the test, or use = false")  # fmt: skip


def _declared(p: Patient) -> Iterator[Finding]:
    """What the sheet says of a test or a sensor, against what was read."""
    starts, span = _starts(p), float(p.samples.time[-1])
    given = p.sheet.initial
    for c in (c for c in p.sheet.columns if c.name in starts):
        first = given if isinstance(given, float) else given.get(c.place) if not isinstance(given, str) else None
        if first is not None and abs(first - starts[c.name]) > APART_K:
            yield p.found(c.name, f"starts at {starts[c.name]:.0f} degC, the sheet says initial = {first:g}",
                          'initial = "first-readings"')  # fmt: skip
        values, lag = p.samples.values[c.name], c.lag_s
        move = float(np.nanmax(values) - np.nanmin(values))
        if c.sigma_K > max(move, WIDE_K):
            yield p.found(c.name, f"its sigma_K = {c.sigma_K:g} is more than it moves ({move:.3g} K): no error of the "
                          "model could show", "the 1-sigma of the sensor's data sheet")  # fmt: skip
        if lag > span:
            yield p.found(c.name, f"its lag of {lag:g} s is longer than the test ({span:g} s)",
                          "lag_s and filter_s in seconds")  # fmt: skip
    for name, events in p.sheet.events.items():
        if events.at_s[-1] > p.samples.start_s + span:
            yield p.found(name, f"switches at {events.at_s[-1]:g} s, after the test has ended",
                          "at_s in seconds from the first row")  # fmt: skip


def _starts(p: Patient) -> dict[str, float]:
    """Column -> what its first readings say (degC)."""
    seen = {n: v[np.isfinite(v)] for n, v in p.temperatures.items()}
    return {n: float(np.median(v[:FIRST])) for n, v in seen.items() if v.size}


def _clock(p: Patient) -> Iterator[Finding]:
    low, high = np.percentile(np.diff(p.samples.time), [10.0, 90.0])
    if high - low > UNEVEN * high:
        yield p.found("clock", f"rows come unevenly, {low:g} to {high:g} s apart",
                      "check the recorder's clock; readings are averaged onto the grid as they stand")  # fmt: skip
    for a, b in p.samples.gaps:
        yield p.found("clock", f"no rows from {a:g} to {b:g} s", "split the test there if the machine ran on")


def _spikes(p: Patient) -> Iterator[Finding]:
    """Single readings that leap and come back at once."""
    for name, values in p.temperatures.items():
        seen = np.flatnonzero(np.isfinite(values))
        if seen.size < 10:
            continue
        y = values[seen]
        leap = np.minimum(np.abs(y[1:-1] - y[:-2]), np.abs(y[1:-1] - y[2:]))
        back = np.abs(y[2:] - y[:-2]) < 0.5 * leap
        out = np.flatnonzero(back & (leap > max(SPIKE_K, SPIKE_TIMES * float(np.median(np.abs(np.diff(y)))))))
        if out.size:
            at = p.samples.time[seen[out[0] + 1]]
            yield p.found(name, f"{out.size} readings leap by {leap[out].max():.0f} K and come back, first at {at:g} s",
                          "empty those cells; look for a loose contact")  # fmt: skip


def _frozen(p: Patient) -> Iterator[Finding]:
    """Sensors that never move while others do; what stands still for a while is noted where the file is read."""
    moves = {n: float(np.nanmax(v) - np.nanmin(v)) for n, v in p.temperatures.items() if np.isfinite(v).any()}
    if max(moves.values(), default=0.0) > WARM_K:
        for name, move in moves.items():
            if move == 0.0 and np.isfinite(p.temperatures[name]).sum() >= LEAST_READINGS:
                yield p.found(name, "never moves while others do: frozen?", "use = false, or another sensor")


def _twins(p: Patient) -> Iterator[Finding]:
    """Columns with the very same readings."""
    values = {c.name: p.samples.values[c.name] for c in p.sheet.columns}
    for a, b in combinations(values, 2):
        x, y = values[a], values[b]
        if np.array_equal(x, y, equal_nan=True) and np.unique(x[np.isfinite(x)]).size > 2:
            yield p.found(f"{a}, {b}", "are the same readings throughout", "one of them; check the logger's channels")


def _noted(p: Patient) -> Iterator[Finding]:
    """Doubts of the reader that are no gaps."""
    for note in p.samples.notes:
        if "no rows from" not in note:
            yield p.found("", note, "look at it; use = false leaves a column out")


CHECKS = (_noted, _units, _scale, _reversed, _sparse, _declared, _clock, _spikes, _frozen, _twins)


def _power(p: Patient, network: Network) -> Iterator[Finding]:
    """A measured power that cannot have warmed the machine as it did, even if nothing had leaked."""
    rises = [float(np.nanmax(v) - v[np.isfinite(v)][0]) for v in p.temperatures.values() if np.isfinite(v).any()]
    rise, span = float(np.median(rises)) if rises else 0.0, float(p.samples.time[-1])
    stored = float(network.C.sum()) * rise
    columns = [c for c in p.sheet.columns if c.quantity == "power" and c.feeds in network.inputs]
    came = sum(float(np.nanmean(np.abs(p.samples.values[c.name]))) for c in columns) * span
    if columns and rise > WARM_K and 0.0 < STORED * came < stored:
        names = ", ".join(c.name for c in columns)
        yield p.found(names, f"{came:.3g} J came in, {stored:.3g} J would be needed for the rise of {rise:.0f} K: kW?",
                      'unit = "kW", or check [nodes] C_J_K')  # fmt: skip


def _rates(patients: list[Patient]) -> Iterator[Finding]:
    """Tests whose rows are far further apart than those of the others: mostly a time unit."""
    steps = {p.name: float(np.median(np.diff(p.samples.time))) for p in patients}
    usual = float(np.median(list(steps.values()))) if steps else 0.0
    for name, step in steps.items():
        if not usual / RATES <= step <= usual * RATES:
            yield Finding(name, "clock", f"rows are {step:g} s apart, {usual:g} s in the other tests: ms, min or h?",
                          'time_unit = "ms" (or min, h)')  # fmt: skip


def _copies(patients: list[Patient]) -> Iterator[Finding]:
    """Tests with the same readings under two names: what is fitted would also be held out."""
    for a, b in combinations(patients, 2):
        shared = set(a.samples.values) & set(b.samples.values)
        if shared and all(np.array_equal(a.samples.values[n], b.samples.values[n], equal_nan=True) for n in shared):
            yield Finding(f"{a.name}, {b.name}", "", "are the same recording under two names", "keep one of them")


def _unused(patients: list[Patient], network: Network) -> Iterator[Finding]:
    """Inputs that no law reads, and inputs that no test moves."""
    read = network.inputs
    fed = {name: c.name for p in patients for c in p.sheet.columns for name in [c.feeds] if name}
    fed |= {name: "" for p in patients for name in p.sheet.events}
    squared = {column for p in patients for of in p.sheet.squares.values() for column in of}
    for name, column in sorted(fed.items()):
        if name not in read and column not in squared:
            yield Finding("", name, "no law of the network reads this input; an effect may",
                          "input = the name that a law reads, or leave it for effects", True)  # fmt: skip
    for name in sorted(n for n in read & set(fed) if fed[n]):
        values = np.concatenate([p.inputs[name] for p in patients if name in p.inputs])
        if np.unique(values[np.isfinite(values)]).size < 2:
            yield Finding("", name, "no test moves this input: what depends on it cannot be told",
                          "a test in which it changes")  # fmt: skip


def _switched(patients: list[Patient], network: Network) -> Iterator[Finding]:
    """Inputs that are only ever on or off in a law that raises them to a power: 0 and 1 are the same to any power."""
    for name in sorted(network.inputs):
        seen = [p.inputs[name] for p in patients if name in p.inputs]
        seen += [p.sheet.events[name].value for p in patients if name in p.sheet.events]
        levels = np.unique(np.concatenate(seen)) if seen else np.zeros(0)
        levels = levels[np.isfinite(levels)]
        if not any(np.array_equal(levels, pair) for pair in SWITCHES):
            continue
        items: list[Link | Source] = [*network.links, *network.sources]
        for item in items:
            terms = item.law.terms if isinstance(item.law, InputPower) else ()
            for _, _, exponent in (t for t in terms if t[0] == name and t[2] != 1.0):
                yield Finding("", name, f"is only on or off: the exponent {exponent:g} in '{item.name}' says nothing",
                              "exponent = 1.0, or a column that says how much")  # fmt: skip


def _cold(network: Network) -> Iterator[Finding]:
    """A network that nothing can heat."""
    laws = [source.law for source in network.sources]
    if not any(np.any(np.asarray(law.factor({n: ONE for n in law.reads})) != 0.0) for law in laws):
        what = "no loss of the network gives any heat" if laws else "the network has no loss: nothing heats it"
        yield Finding("", "losses", what, "[losses.NAME] with kind, at and its numbers")


def _stores(network: Network) -> Iterator[Finding]:
    """Nodes that nothing heats and that are joined to one other node only."""
    heated = {int(i) for source in network.sources for i in source.index}
    partners: Mapping[int, set[int]] = {i: set() for i in range(len(network.states))}
    for link in network.links:
        ends = {int(i) for i in (*link.rows, *link.cols)}
        for i in ends & set(partners):
            partners[i] |= ends - {i}
    for i, name in enumerate(network.states):
        if "#" not in name and i not in heated and len(partners[i]) == 1 and min(partners[i]) < len(network.states):
            yield Finding("", name, "nothing heats or cools this node but one other node: it only stores heat",
                          "a loss at it, or a second link", True)  # fmt: skip
