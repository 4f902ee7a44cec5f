"""What the first lines say of a recording: all that was left out though it may matter, and all that is doubted."""

import re
from collections.abc import Sequence
from shlex import quote

import numpy as np

from geom.arrays import Array
from geom.description.roles import Role
from measured.headers.words import INLET, is_setpoint, is_spoken, quantities_of, roles_of
from measured.importing.aligned import Recording
from measured.importing.draft import ASSUMED_ROOM, Draft
from measured.importing.guess import (
    AS_SPEED,
    AS_WINDING,
    BY_LETTERS,
    BY_READINGS,
    CANNOT_BE,
    CERTAIN,
    CODES_ALONE,
    ELSE,
    FLUID_ALONE,
    HARDLY,
    NO_UNIT,
    NUMBERED,
    OF_DEVICE,
    OF_INSTRUMENT,
    OF_SENSOR,
    OF_TESTED,
    OF_USER,
    ONE_SIDE,
    UNKNOWN,
    UNTOLD,
    WHOLE,
    Guess,
    in_memory,
    is_whole,
    may_wind,
    of_edge,
)
from measured.importing.relations import COARSE, NOISE_K, misfit, names_of
from measured.importing.source import Source
from measured.importing.starter import HEATS, MAIN, POWERS, STILL, rise

Columns = Sequence[tuple[Recording, Guess]]
LEAST_K = 1.0  # that a part has to warm by before what heats it can be told
BETTER = 0.5  # of the misfit: another column explains the readings better
EXPLAINS = 0.3  # of the rise: what is left beside a column that heats
FEEDS = (*HEATS, "torque", "voltage")  # that may say what heats it
SOON = ("", *FEEDS)  # quantities of columns left out that may
NO_PART = "its name says no part of a machine"
UNIT = re.compile(rf"{NO_UNIT}: (\S+) is assumed")
NO_INLET = "taken as the coolant that flows in, though its name says no inlet"
OUTLET = "it warms with the machine: an outlet?"
SHEETS = "tests/*.toml"  # where each column has its doubt
PLACES = (NO_PART, NUMBERED, BY_READINGS, AS_WINDING, FLUID_ALONE)
WEAK = (
    *(NO_PART, NUMBERED, BY_READINGS, AS_WINDING, HARDLY, WHOLE, BY_LETTERS, OF_INSTRUMENT, OF_DEVICE, OF_TESTED),
    *(AS_SPEED, "gives coolant already"),
)
STAY = ("stays in the file as a check, and feeds nothing", "stay in the file as checks, and feed nothing")
BROKEN = (CANNOT_BE, CODES_ALONE, OF_INSTRUMENT)  # of temperatures, which were expected to be read


def first_lines(drafts: Sequence[Draft]) -> list[str]:
    """A sentence for each kind of doubt, of the first test that has it, the gravest first."""
    return list(dict.fromkeys(_doubts_of(drafts).values()))


def short_lines(drafts: Sequence[Draft], learnt: bool) -> list[str]:
    """Those of them that may change a verdict, and one line of the rest.

    learnt : the network was made from the readings, so that a unit scales its numbers alone
    """
    doubts = _doubts_of(drafts)
    weak = [kind for kind in doubts if any(words in kind for words in (*WEAK, *[NO_UNIT] * learnt))]
    grave = list(dict.fromkeys(words for kind, words in doubts.items() if kind not in weak))
    if not weak:
        return grave
    if grave:
        return [*grave, f"weaker guesses stand in {SHEETS}"]
    others = f"; {len(weak) - 1} more in {SHEETS}" if weak[1:] else ""
    return [f"{doubts[weak[0]].partition('; --place')[0]}{others}"]


def _doubts_of(drafts: Sequence[Draft]) -> dict[str, str]:
    """Kind of doubt -> its sentence."""
    out: dict[str, str] = {}
    for draft in drafts:
        columns = [(r, g) for r in draft.records for g in r.guesses]
        left = [
            (r, g)
            for r, g in columns
            if not g.used and r.source.is_filled(g.column) and not g.doubt.startswith(CERTAIN)
        ]
        for kind, words in (
            *((doubt, words) for doubt, words in _lost(left).items() if doubt.endswith(BROKEN)),
            *_winding(columns, left).items(),
            *_heat(draft, columns, left).items(),
            *_room(draft, left).items(),
            *_lost(left).items(),
            *_doubted(columns).items(),
            *{f"clock of {r.name}": r.clock.doubt for r in draft.records if r.clock.doubt}.items(),
        ):
            out.setdefault(kind, words)
    alike = sum(any(ASSUMED_ROOM in note for note in draft.notes) for draft in drafts)
    if alike > 1 and "ambient" in out:
        out["ambient"] += f"; {alike} tests alike"
    return out


def may_be_temperature(source: Source, g: Guess) -> bool:
    """By its unit, or by a name without any."""
    candidates = quantities_of(source.labels[g.column])
    return g.quantity == "temperature" or (
        not g.quantity and bool(roles_of(source.labels[g.column])) and not candidates[1:]
    )


def _winding(columns: Columns, left: Columns) -> dict[str, str]:
    hot = [(roles_of(f"{r.source.labels[g.column]} {g.place}"), g) for r, g in columns if g.place]
    if any(Role.WINDING in roles or is_whole(g.column) or AS_WINDING in g.doubt for roles, g in hot):
        return {}
    if not may_wind((r.source.labels[g.column], g) for r, g in columns):
        return {}
    wound = [(r, g) for r, g in left if Role.WINDING in roles_of(r.source.labels[g.column])[:1]]
    lost = [g.column for r, g in wound if may_be_temperature(r.source, g)]
    ohms = [g.column for _, g in left if g.quantity == "resistance"]
    if lost:
        words = f"'{lost[0]}' looks like winding; --place {quote(f'{lost[0]}=PLACE')}"
    elif ohms:
        words = f"'{ohms[0]}' is a resistance; say whose and when cold: docs/how-to/thermal-test.md"
    elif any(not roles for roles, _ in hot):
        return {"winding": "no column's name says winding"}
    else:
        return {"winding": "no winding is measured"}
    return {"winding": f"the winding was not placed: {words}"}


def _heat(draft: Draft, columns: Columns, left: Columns) -> dict[str, str]:
    """What heats is lacking, is a torque or a voltage alone, or explains the readings less well than another column."""
    heats = [(r, g) for r, g in columns if g.feeds and g.quantity in FEEDS]
    others = [(r, g) for r, g in left if g.quantity in SOON and r.source.is_numeric(g.column)]
    others = [(r, g) for r, g in others if g.quantity or g.doubt == UNTOLD or OF_SENSOR in g.doubt]  # it may heat
    main = [(r, g) for r, g in heats if g.feeds in MAIN.values()] or heats
    best, error = _best(draft, columns, [*others, *(one for one in heats if one not in main)])
    if draft.constants:
        return {}
    if not heats:
        numeric = [(quantities_of(r.source.labels[c]), c) for r, g in left if r.source.is_numeric(c := g.column)]
        candidates = [column for quantities, column in numeric if {*quantities} & {*HEATS}]
        if candidates := candidates or ([best] if best and error < EXPLAINS else []):
            to = quote(f"{candidates[0]}=QUANTITY")
            return {"heat": f"the only heat was left out: '{candidates[0]}'; --place {to}"}
        return {"heat": "no column says what heats it"}
    column, ours = _best(draft, columns, main)
    if not any(g.quantity in HEATS for _, g in heats):
        return {"heat": f"no current and no loss is recorded: '{heats[0][1].column}' alone tells of the heat"}
    lost = any(g.quantity == "power" for _, g in main)  # as was recorded
    if best and not lost and error < BETTER * ours and error < EXPLAINS:
        to = "share" if any(r.source.is_switch(g.column) for r, g in left if g.column == best) else "QUANTITY"
        return {"heat": f"'{best}' explains the readings better than '{column}'; --place {quote(f'{best}={to}')}"}
    return {}


def _best(draft: Draft, columns: Columns, of: Columns) -> tuple[str, float]:
    """The column that explains the hottest part best, and what it leaves of the rise; "" where none can be told."""
    hot = [(r, g) for r, g in columns if g.place and not of_edge(roles_of(r.source.labels[g.column]))]
    if not hot or not of:
        return "", np.inf
    record, hottest = max(hot, key=lambda one: rise(one[0].source, one[1]))
    size = rise(record.source, hottest)
    room = next((in_memory(r.source, g) for r, g in columns if g.place == "ambient" and r is record), None)
    if size < LEAST_K:
        return "", np.inf
    above = in_memory(record.source, hottest) - (draft.boundaries.get("ambient", 0.0) if room is None else room)
    left = {g.column: _unexplained(record, above, r, g) for r, g in of}
    best = min(left, key=lambda c: left[c])
    return best, max(left[best] - NOISE_K, 0.0) / size


def _unexplained(record: Recording, above: Array, other: Recording, g: Guess) -> float:
    """Misfit (K) of the response to a column."""
    heat = other.source.numbers(g.column)
    steps = np.diff(heat[np.isfinite(heat)])
    if other is not record:
        good = np.isfinite(heat) & np.isfinite(other.clock.seconds)
        if good.sum() < COARSE:
            return np.inf
        heat = np.interp(record.clock.seconds, other.clock.seconds[good] + other.shift_s, heat[good])
    if steps.size < COARSE or not (steps < 0).any():  # a counter follows everything that warms
        return np.inf
    return min(misfit(record.clock.seconds, above, heat, p) for p in {*POWERS.values()})


def _room(draft: Draft, left: Columns) -> dict[str, str]:
    """A room that was assumed, though a column may be it."""
    notes = [note for note in draft.notes if ASSUMED_ROOM in note]
    rooms = [g.column for r, g in left if g.quantity and roles_of(r.source.labels[g.column])[:1] == [Role.AMBIENT]]
    if notes and rooms:
        how = f"'{rooms[0]}' looks like the room; --place {quote(f'{rooms[0]}=ambient')}"
        return {"ambient": f"the room was not placed: {how}"}
    return {"ambient": notes[0]} if notes else {}


def _lost(left: Columns) -> dict[str, str]:
    """Columns that may be temperatures, and those of which nothing is known."""
    out: dict[str, list[str]] = {}
    for r, g in left:
        if is_setpoint(r.source.labels[g.column]):
            continue
        moves = r.source.is_numeric(g.column) and float(np.nanstd(r.source.numbers(g.column))) > 0.0
        if (
            g.doubt.endswith(BROKEN)
            or (g.quantity and may_be_temperature(r.source, g))
            or (moves and (g.doubt == UNTOLD or g.doubt.endswith(UNKNOWN)))
        ):
            out.setdefault(g.doubt, []).append(g.column)
    checks = [doubt for doubt in out if doubt.endswith("gives coolant already")]
    lost = {d: f"{names_of(of)} {('is', 'are')[len(of) > 1]} left out: {d}" for d, of in out.items() if d not in checks}
    return lost | {d: f"{names_of(out[d])} {STAY[len(out[d]) > 1]}" for d in checks}


def _doubted(columns: Columns) -> dict[str, str]:
    """Columns that are used with a doubt."""
    out: dict[str, list[str]] = {}
    most = max((rise(r.source, g) for r, g in columns if g.place), default=0.0)
    for r, g in columns:
        label = r.source.labels[g.column]
        unknown = g.place and g.why != OF_USER and not roles_of(f"{label} {g.place}") and not is_whole(label)
        fluid = g.place == "coolant" and not is_spoken(label, INLET)
        flows = (OUTLET if rise(r.source, g) > STILL * most else NO_INLET) if fluid else ""
        first = next((words for words in (ELSE, ONE_SIDE) if words in g.doubt), g.doubt)
        doubt = first or (NO_PART if unknown else flows)
        if g.used and doubt:
            out.setdefault(doubt, []).append(g.column)
    units_of = {doubt: match[1] for doubt in out if (match := UNIT.search(doubt))}
    units = [f"'{c}' is taken in {unit}" for doubt, unit in units_of.items() for c in out[doubt]]
    where = {
        doubt: f"; --place {quote(f'{of[0]}=PLACE')}" if any(words in doubt for words in PLACES) else ""
        for doubt, of in out.items()
    }
    words = {d: f"{names_of(of)}: {d}{where[d]}" for d, of in out.items() if d not in units_of}
    return {**words, NO_UNIT: f"{NO_UNIT}: {', '.join(units)}"} if units else words
