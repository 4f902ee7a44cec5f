"""What is probably wrong with recordings, sheets and network before anything is fitted, each with its cure."""

import warnings
from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from measured.headers.words import COLD, is_spoken
from measured.recordings.sheet import Column
from measured.recordings.tables import standing_still
from measured.recordings.units import ROOM_F, ROOM_K
from thermoscope.case_folder.recording_checks import (
    LEAST_READINGS,
    OFFSET_K,
    RECORDING_CHECKS,
    WARM_K,
    Finding,
    Patient,
    first_readings,
)

RATES = 10.0  # times the rows of another test
STORED = 20.0  # times the heat that came in; capacities are known within a factor of 2 or 3
SWAPPED = 0.25  # of the rise of the others, as far as wires that are swapped make a reading fall at least
SCALED_C = 60.0  # warmer at rest is neither a room nor a machine in it
NEAR_F = 18.0  # degF between the sensors of such a machine
WIDE_K = 10.0  # 1-sigma that no sensor of a machine has
SOME = np.array([1.0, 1e3, 1e6])  # of every input: small, usual, large
CURE_OF_COPIES = "keep one of them; a hold-out that is fitted under another name judges nothing"
SWITCHES = ((0.0, 1.0), (0.0, 100.0))  # levels of an input that is switched: as a number, in percent


def examined(patients: list[Patient], network: Network) -> tuple[Finding, ...]:
    """Everything that looks wrong in the tests, in the case as a whole and in the network."""
    each = [finding for p in patients for check in RECORDING_CHECKS for finding in check(p)]
    inside = [finding for p in patients for check in INSIDE for finding in check(p, network)]
    inputs = [*_unused(patients, network), *_switched(patients, network)]
    together = [f for check in (_rates, _copies, _alone) for f in check(patients)]
    return (*each, *inside, *together, *_cold(network), *inputs, *_stores(network))


def _reversed(p: Patient, network: Network) -> Iterator[Finding]:
    """A sensor of the machine that falls as the others rise: a thermocouple with its wires swapped.

    A place that is cold by its name may fall, and any place as far as the coldest of what surrounds the machine.
    """
    columns = {c.name: p.samples.values[c.name] for c in _within(p, network)}
    edges = [np.nanmin(p.samples.values[c.name]) for c in p.sheet.columns if c.place in network.boundaries]
    least = min([*edges, *p.sheet.boundaries.values()], default=np.inf) - WARM_K
    cold = {c.name for c in _within(p, network) if is_spoken(f"{c.header} {c.place}", COLD)}
    moves = {
        n: float(v[finite[-1]] - v[finite[0]])
        for n, v in columns.items()
        if (finite := np.flatnonzero(np.isfinite(v))).size
    }
    for name, move in moves.items():
        rise = float(np.median([m for n, m in moves.items() if n != name] or [0.0]))
        below = name not in cold and np.nanmin(columns[name]) < least
        if below and rise > WARM_K and move < -max(WARM_K, SWAPPED * rise):
            what = (
                f"falls by {-move:.0f} K while the others rise: are its wires swapped, or is it cooled below the room?"
            )
            cure = "use = false, or the wires the right way round; leave it where something cools it"
            yield p.finding(name, what, cure)


def _all_units(p: Patient, network: Network) -> Iterator[Finding]:
    """Temperatures that all start where rooms do in kelvin, or a room in Fahrenheit beside machines at rest in it."""
    starts = first_readings(p)
    if not starts:
        return
    low, high = min(starts.values()), max(starts.values())
    outside = any(c.is_temperature and c.place in network.boundaries for c in p.sheet.columns)
    for (cold, hot), unit, word in ((ROOM_K, "K", "kelvin"), (ROOM_F, "degF", "Fahrenheit")):
        if cold < low and high < hot and (unit == "K" or (outside and high - low < NEAR_F)):
            what = f"start at {low:.0f} to {high:.0f} degC: {word}?"
            yield p.finding("all temperatures", what, f'unit = "{unit}" for each')


def _within(p: Patient, network: Network) -> list[Column]:
    """Columns of temperatures of the machine, not of what surrounds it."""
    return [c for c in p.sheet.columns if c.is_temperature and c.place not in network.boundaries]


def _declared(p: Patient, network: Network) -> Iterator[Finding]:
    """What the sheet says of a test or a sensor, against what was read."""
    starts, span = first_readings(p), float(p.samples.time[-1])
    initial = p.sheet.initial
    for c in (c for c in _within(p, network) if c.name in starts):
        first = initial.get(c.place) if isinstance(initial, Mapping) else initial
        if first is not None and not isinstance(first, str) and abs(first - starts[c.name]) > OFFSET_K:
            what = f"starts at {starts[c.name]:.0f} degC, the sheet says initial = {first:g}"
            yield p.finding(c.name, what, 'initial = "first-readings"')
        values, lag = p.samples.values[c.name], c.lag_s
        move = float(np.nanmax(values) - np.nanmin(values))
        if c.sigma_K > max(move, WIDE_K):
            what = f"its sigma_K = {c.sigma_K:g} is more than it moves ({move:.3g} K): no error of the model could show"
            yield p.finding(c.name, what, "the 1-sigma of the sensor's data sheet")
        if lag > span:
            what = f"its lag of {lag:g} s is longer than the test ({span:g} s)"
            yield p.finding(c.name, what, "lag_s and filter_s in seconds")
    for name, events in p.sheet.events.items():
        if events.at_s[-1] > p.samples.start_s + span:
            what = f"switches at {events.at_s[-1]:g} s, after the test has ended"
            yield p.finding(name, what, "at_s in seconds from the first row")


def _power(p: Patient, network: Network) -> Iterator[Finding]:
    """A measured power that cannot have warmed the machine as it did, even if nothing had leaked."""
    rises = [float(np.nanmax(v) - v[np.isfinite(v)][0]) for v in p.temperatures.values() if np.isfinite(v).any()]
    rise, span = float(np.median(rises)) if rises else 0.0, float(p.samples.time[-1])
    heat_J = float(network.C.sum()) * rise
    columns = [c for c in p.sheet.columns if c.quantity == "power" and c.feeds in network.inputs]
    came = sum(float(np.nanmean(np.abs(p.samples.values[c.name]))) for c in columns) * span
    if columns and rise > WARM_K and 0.0 < STORED * came < heat_J:
        names = ", ".join(c.name for c in columns)
        what = f"{came:.3g} J came in, {heat_J:.3g} J would be needed for the rise of {rise:.0f} K: kW?"
        yield p.finding(names, what, 'unit = "kW", or check [nodes] C_J_K')


def _frozen(p: Patient, network: Network) -> Iterator[Finding]:
    """Sensors of the machine that never move while others do; a room may stand still for hours."""
    moves = {n: float(np.nanmax(v) - np.nanmin(v)) for n, v in p.temperatures.items() if np.isfinite(v).any()}
    if max(moves.values(), default=0.0) > WARM_K:
        for name in (c.name for c in _within(p, network) if moves.get(c.name) == 0.0):
            if np.isfinite(p.temperatures[name]).sum() >= LEAST_READINGS:
                yield p.finding(name, "never moves while others do: frozen?", "use = false, or another sensor")


def _noted(p: Patient, network: Network) -> Iterator[Finding]:
    """Doubts of the reader that are not gaps, and of sensors that stand still for a part of the test."""
    still = {f.where for f in _frozen(p, network)}
    doubts = standing_still(_within(p, network), p.samples)
    for note in [*p.samples.notes, *(doubt for name, doubt in doubts.items() if name not in still)]:
        if "no rows from" not in note:
            yield p.finding("", note, "look at it; use = false leaves a column out")


def _scale(p: Patient, network: Network) -> Iterator[Finding]:
    """A column at ten times, or a sensor of the machine at a tenth, of where the others start: tenths of a degree.

    It may be cold outside, and no room is as hot as ten times a room.
    """
    starts, within = first_readings(p), {c.name for c in _within(p, network)}
    for name, start in starts.items():
        others = [n for n in starts if n != name and (start > SCALED_C or within >= {n, name})]
        usual = float(np.median([starts[n] for n in others] or [start]))
        for factor, cure in ((10.0, "divide the column by 10"), (0.1, "multiply the column by 10")):
            if abs(start - factor * usual) < 0.1 * abs(factor * usual) and abs(start - usual) > OFFSET_K:
                what = f"starts at {start:.4g} degC, the others at {usual:.4g}: tenths of a degree?"
                yield p.finding(name, what, cure)


INSIDE = (_all_units, _scale, _noted, _frozen, _power, _reversed, _declared)


def _rates(patients: list[Patient]) -> Iterator[Finding]:
    """Tests whose rows are far further apart than those of the others: mostly a time unit."""
    steps = {p.name: float(np.median(np.diff(p.samples.time))) for p in patients}
    usual = float(np.median(list(steps.values()))) if steps else 0.0
    for name, step in steps.items():
        if not usual / RATES <= step <= usual * RATES:
            what = f"rows are {step:g} s apart, {usual:g} s in the other tests: ms, min or h?"
            yield Finding(name, "clock", what, 'time_unit = "ms" (or min, h)')


def _copies(patients: list[Patient]) -> Iterator[Finding]:
    """Tests with the same readings under two names: what is fitted would also be held out."""
    for a, b in combinations(patients, 2):
        common = set(a.samples.values) & set(b.samples.values)
        if common and all(np.array_equal(a.samples.values[n], b.samples.values[n], equal_nan=True) for n in common):
            yield Finding(f"{a.name}, {b.name}", "", "are the same recording under two names", CURE_OF_COPIES)


def _alone(patients: list[Patient]) -> Iterator[Finding]:
    """One test: what it can still be used for."""
    if len(patients) == 1:
        steady = all(np.unique(x[np.isfinite(x)]).size < 2 for x in patients[0].samples.values.values())
        half = "an effect is judged on its second half"
        judged = "no effect is judged, for it is one steady state" if steady else half
        what = f"is the only test: nothing unseen judges the model, and {judged}"
        yield Finding(patients[0].name, "", what, 'a further recording with role = "hold-out"', True)


def _unused(patients: list[Patient], network: Network) -> Iterator[Finding]:
    """Inputs that no law reads, and inputs that no test moves."""
    read = network.inputs
    column_of = {name: c.name for p in patients for c in p.sheet.columns for name in [c.feeds] if name}
    column_of |= {name: "" for p in patients for name in p.sheet.events}
    squared = {column for p in patients for of in p.sheet.squares.values() for column in of}
    what = "no law of the network reads this input yet"
    cure = "leave it, an effect may; or input = the name of one that a law reads"
    for name, column in sorted(column_of.items()):
        if name not in read and column not in squared:
            yield Finding("", name, what, cure, True)
    for name in sorted(n for n in read & set(column_of) if column_of[n]):
        values = np.concatenate([p.inputs[name] for p in patients if name in p.inputs])
        if np.unique(values[np.isfinite(values)]).size < 2:
            what = "no test moves this input: what depends on it cannot be told"
            yield Finding("", name, what, "a test in which it changes")


def _switched(patients: list[Patient], network: Network) -> Iterator[Finding]:
    """Inputs that are only ever on or off in a law that raises them to a power: 0 and 1 are the same to any power."""
    for name in sorted(network.inputs):
        samples = [p.inputs[name] for p in patients if name in p.inputs]
        samples += [p.sheet.events[name].value for p in patients if name in p.sheet.events]
        levels = np.unique(np.concatenate(samples)) if samples else np.zeros(0)
        levels = levels[np.isfinite(levels)]
        if not any(np.array_equal(levels, pair) for pair in SWITCHES):
            continue
        for item in network.elements:
            terms = item.law.terms if isinstance(item.law, InputPower) else ()
            for _, _, exponent in (t for t in terms if t[0] == name and t[2] != 1.0):
                what = f"is only on or off: the exponent {exponent:g} in '{item.name}' says nothing"
                yield Finding("", name, what, "exponent = 1.0, or a column that says how much")


def _cold(network: Network) -> Iterator[Finding]:
    """A network that nothing can heat."""
    laws = [source.law for source in network.sources]
    with warnings.catch_warnings(), np.errstate(all="ignore"):  # maps end somewhere between these
        warnings.simplefilter("ignore")
        heats = any(np.any(np.asarray(law.factor({n: SOME for n in law.reads})) != 0.0) for law in laws)
    if not heats:
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
            what = "nothing heats or cools this node but one other node: it only stores heat"
            yield Finding("", name, what, "a loss at it, or a second link", True)
