"""A first network where nobody gives one: a node per measured part, heat as recorded, sizes from the readings.

It lets a comparison run on the first day. Its numbers are orders of magnitude with wide priors, and it says so.
"""

import itertools
import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from shlex import quote

import numpy as np

from geom.arrays import Array
from geom.description.names import is_plain
from geom.description.roles import Role
from geom.errors import InputError
from geom.escapes import toml_key, toml_value
from lumped.model.quantities import FLOWS
from measured.headers.words import (
    CHANNELS,
    COMES_OUT,
    EXHAUST,
    INLET,
    LOSS,
    OIL,
    OUTER,
    QUANTITY,
    ROOMS,
    is_setpoint,
    is_spoken,
    is_within,
    quantities_of,
    roles_of,
    tokens,
)
from measured.importing.guess import (
    AS_WINDING,
    AXES,
    CANNOT_BE,
    DEAD,
    OF_INSTRUMENT,
    ON_OFF,
    UNTOLD,
    Guess,
    in_memory,
    is_whole,
    readings_in_memory,
)
from measured.importing.relations import names_of
from measured.importing.source import Source
from measured.recordings.consistency import NOISE

ASSUMED_W = 100.0  # heat of a machine of which nobody recorded any
TIME_CONSTANT = 0.3  # of the record: most tests last three time constants
POWERS = {"power": 1.0, "current": 2.0, "share": 1.0}  # of a loss that follows it
MAIN = {"power": "power_W", "current": "current_A"}  # what the surest column of that quantity feeds
STIRS = {"speed", *FLOWS}  # what a share of does not heat
HEATS = tuple(POWERS)  # in the order in which a record tells the heat
PLATINUM = re.compile(r"(?i)pt[ -]?10{2,3}(?!\d)")  # the number is part of the sensor's name
EXHAUSTED = "the air that leaves the machine, beside a room"
STILL = 0.1  # of the largest rise: what warms by less is hardly a part of the machine
MOST = (2.0, 98.0)  # per cent of the readings between which they are not outliers
COLD_K = 3.0  # by which a room may be warmer than the parts at the start
SPREAD = 1.0  # prior of everything here, in powers of e


Columns = Sequence[tuple[Source, Guess]]


@dataclass(frozen=True)
class FirstTerm:
    """A link between two nodes, or a node and a boundary; or a loss at one node.

    ends : two names, or one;  value : W/K or W;  of : (input, its value there, exponent) of all that it follows
    sd : prior of its logarithm
    """

    ends: tuple[str, ...]
    value: float
    of: tuple[tuple[str, float, float], ...] = ()
    sd: float = SPREAD


@dataclass(frozen=True)
class FirstNetwork:
    """A network of measured parts.

    capacities : node -> (J/K, prior of its logarithm);  terms : links and losses;  watts : mean of all losses
    learnt : tests that its numbers were learnt from, none where they are orders of magnitude
    wound : nodes of the winding by their readings
    """

    name: str
    boundaries: Sequence[str]
    capacities: Mapping[str, tuple[float, float]]
    terms: Sequence[FirstTerm]
    watts: float
    learnt: Sequence[str] = ()
    wound: frozenset[str] = frozenset()

    def text(self) -> str:
        """As network.toml."""
        lines = [*self._remark(), "", "[network]", f"name = {toml_value(self.name)}"]
        lines += [f"boundaries = {toml_value(list(self.boundaries))}", ""]
        role_of = {node: next((r for r in roles_of(node) if r not in BOUNDARIES), "") for node in self.capacities}
        role_of |= dict.fromkeys(self.wound, Role.WINDING)
        whole = [node for node in role_of if is_whole(node)]
        if len(whole) == 1 and Role.WINDING not in role_of.values():  # "motor temperature" of drives
            role_of[whole[0]] = Role.WINDING
        for node, (C, sd) in self.capacities.items():
            role = [f'role = "{role_of[node]}"'] * bool(role_of[node])
            size = [f"C_J_K = {max(C, 1.0):.3g}", f"prior_sd = {sd:.2g}", "reading = true"]
            lines += [f"[nodes.{toml_key(node)}]", *role, *size, ""]
        names: set[str] = set()
        links = [term for term in self.terms if len(term.ends) == 2]
        losses = [term for term in self.terms if len(term.ends) == 1]
        for i, term in enumerate(links, 1):
            name = "-".join([*term.ends, *(of[0] for of in term.of)])
            name = name if is_plain(name) and name not in names else f"link-{i}"
            names.add(name)
            lines += [f"[links.{toml_key(name)}]", f"between = {toml_value(list(term.ends))}"]
            lines += [f"G_W_K = {term.value:.3g}", *_follows(term), f"prior_sd = {term.sd:.2g}", ""]
        for i, term in enumerate(losses, 1):
            lines += [f"[losses.{f'heat-{i}' if len(losses) > 1 else 'heat'}]", 'kind = "constant"']
            lines += [f"at = {toml_value(term.ends[0])}", f"P_W = {term.value:.4g}", *_follows(term)]
            lines += [f"prior_sd = {term.sd:.2g}", ""]
        return "\n".join(lines)

    def _remark(self) -> list[str]:
        advice = (
            "# Put in what you know (masses, materials, areas, what heats what: docs/network-toml.md), then calibrate."
        )
        if not self.learnt:
            return ["# A first network made from the columns alone: every number is an order of magnitude.", advice]
        return [
            f"# A first network learnt from {', '.join(self.learnt)}: the fewest links and losses that predict what",
            "# was left out. Readings tell how its numbers compare, not how large they are together:",
            f"# the heat is taken to be {self.watts:.4g} W on average.",
            advice,
        ]


def _follows(term: FirstTerm) -> list[str]:
    of = [f"{{ input = {toml_value(i)}, at = {at:.4g}, exponent = {p} }}" for i, at, p in term.of]
    return [f"of = {of[0] if len(of) == 1 else '[' + ', '.join(of) + ']'}"] if of else []


def of_machine(columns: Columns) -> Columns:
    """Without other devices, and with the coldest column as the room where it hardly warms and no other is the room."""
    every = [(s, g, place_of(g, s.labels[g.column])) for s, g in columns]
    parts = [(s, g) for s, g, place in every if g.doubt != OF_INSTRUMENT and place not in ("", *BOUNDARIES.values())]
    if parts:
        columns = [(s, Guess(g.column, "", doubt=g.doubt) if g.doubt == OF_INSTRUMENT else g) for s, g in columns]
    rooms = {s.labels[g.column] for s, g, place in every if place == "ambient" and not g.place}
    inside = {label for label in rooms if not is_within(label, OUTER)}
    several = sum(is_spoken(s.labels[g.column], ROOMS) for s, g, place in every if place) > 1
    if (inside < rooms or several) and not any(
        roles_of(label := s.labels[g.column]) or is_whole(label) for s, g in parts
    ):
        columns = _as_parts(columns, inside)
    if not rooms and any(is_spoken(s.labels[g.column], ROOMS) for s, g in parts):
        out = {g.column for s, g in parts if {*tokens(s.labels[g.column])} - QUANTITY["temperature"] == {"out"}}
        columns = [(s, replace(g, place=g.place or "ambient") if g.column in out else g) for s, g in columns]
    columns = _as_parts(columns, _warmed_oil(every))
    if all(place in ("", *BOUNDARIES.values()) for *_, place in every):
        fluids = {s.labels[g.column] for s, g, place in every if place == "coolant" and not g.place}
        columns = _as_parts(columns, {label for label in fluids if not is_spoken(label, INLET)})
    if any(place == "ambient" and not _leaves(s, g) for s, g, place in every):
        return _without_exhaust(columns)
    if len({g.column for _, g in parts}) < 2 or any(g.why == "values" for _, g, place in every):
        return columns
    starts = [float(v[0]) for v in (readings_in_memory(*part) for part in parts) if v.size]
    coldest, most = float(np.median(starts)) + COLD_K, STILL * max(rise(*part) for part in parts)
    shares = [tokens(s.labels[g.column]) for s, g in columns if g.feeds and g.quantity == "share"]
    of_heaters = {word for words in shares for word in words if word.isdigit()}
    means = dict[float, str]()
    for s, g in parts:
        values = in_memory(s, g)
        mean = float(np.nanmean(values))  # of what hardly changes and is as cold as the others were when they began
        if {*filter(str.isdigit, tokens(s.labels[g.column]))} & of_heaters:
            continue  # T2 beside Q2, its heater
        if not roles_of(s.labels[g.column]) and mean <= coldest and np.ptp(np.nanpercentile(values, MOST)) <= most:
            means.setdefault(mean, g.column)
    room = means[min(means)] if means else ""
    columns = [(s, replace(g, place="ambient") if g.column == room else g) for s, g in columns]
    return _without_exhaust(columns) if room else columns


def _as_parts(columns: Columns, labels: Collection[str]) -> Columns:
    """With these columns as parts called after them."""
    return [(s, replace(g, place=_name(n)) if (n := s.labels[g.column]) in labels else g) for s, g in columns]


def _warmed_oil(every: Sequence[tuple[Source, Guess, str]]) -> set[str]:
    """What would be the coolant where that is oil that the machine warms, as of a transformer, a gearbox or a hydraulic
    unit."""
    fluids = [(s, g) for s, g, place in every if place == "coolant" and not g.place]
    labels = {s.labels[g.column] for s, g in fluids}
    flows = [s.labels[g.column] for s, g, _ in every if g.quantity == "water_flow"]
    comes_in = any(is_spoken(label, INLET) for label in labels) or any(Role.COOLANT in roles_of(n) for n in flows)
    if comes_in or not any(is_spoken(label, OIL) for label in labels):
        return set()
    most = max(rise(s, g) for s, g, place in every if place and place != "ambient")
    return labels if all(rise(s, g) > STILL * most for s, g in fluids) else set()


def _without_exhaust(columns: Columns) -> Columns:
    """Without air that leaves the machine, which beside a room is not a boundary: the machine heats it."""
    return [(s, Guess(g.column, "", doubt=EXHAUSTED) if _leaves(s, g) else g) for s, g in columns]


def _leaves(source: Source, g: Guess) -> bool:
    """Is it the air that leaves the machine, and not put by hand?"""
    return g.quantity == "temperature" and not g.place and is_spoken(source.labels[g.column], EXHAUST)


def starter(columns: Columns, name: str, span_s: float) -> FirstNetwork:
    """The network of some columns. InputError where none is a temperature of a machine."""
    places = [(source, g, place_of(g, source.labels[g.column])) for source, g in columns]
    hot = [(source, g, place) for source, g, place in places if place and place not in BOUNDARIES.values()]
    if not hot:
        files = ", ".join(dict.fromkeys(str(source.file) for source, _ in columns))
        doubted = [(g, s.labels[g.column]) for s, g in columns if g.doubt]
        broken = (OF_INSTRUMENT, f"as temperature {CANNOT_BE}")
        lost = [g for g, n in doubted if g.doubt.endswith(broken) or roles_of(n) or "temperature" in quantities_of(n)]
        lost.sort(key=lambda g: g.doubt != OF_INSTRUMENT)
        doubts = (f"; '{g.column}' is left out: {g.doubt}" for g in lost if not g.feeds)
        what = "no column is a temperature of a machine" + next(doubts, "")
        right = "a column with degC or K, or a name such as T_winding"
        if untold := [g.column for _, g in columns if g.doubt == UNTOLD]:
            what, right = f"{what}; {names_of(untold, 3)}: {UNTOLD}", f"{right}; --place {quote(f'{untold[0]}=PLACE')}"
        raise InputError(what, files, right)
    nodes = list(dict.fromkeys(place for *_, place in hot))
    boundaries = ["ambient", *(["coolant"] if any(place == "coolant" for *_, place in places) else [])]
    rises = {place: rise(source, g) for source, g, place in hot}
    losses, watts = _heat(columns, max(rises, key=lambda place: rises[place]))
    G = watts / max(*rises.values(), 1.0)
    inside = [FirstTerm(pair, 5 * G) for pair in itertools.pairwise(nodes)]
    outside = [FirstTerm((n, b), G / len(nodes) / len(boundaries)) for n in nodes for b in boundaries]
    by_name = {place for s, g, place in hot if roles_of(s.labels[g.column])[:1] == [Role.WINDING]}
    wound = frozenset({place for _, g, place in hot if AS_WINDING in g.doubt} | by_name)
    capacities = dict.fromkeys(nodes, (G * TIME_CONSTANT * span_s / len(nodes), SPREAD))
    return FirstNetwork(name, boundaries, capacities, [*inside, *outside, *losses], watts, wound=wound)


BOUNDARIES = {Role.AMBIENT: "ambient", Role.COOLANT: "coolant"}


def place_of(g: Guess, label: str) -> str:
    """A node called after the column, or the boundary that its name means; "" for what is not a temperature."""
    if g.place and g.quantity == "temperature":
        return g.place  # as the user said
    if g.quantity != "temperature" or is_setpoint(label) or g.doubt == DEAD:
        return ""
    return next((BOUNDARIES.get(role, "") for role in roles_of(label)), "") or _name(label)


def _name(label: str) -> str:
    """A node called after its column."""
    words = [w for w in tokens(PLATINUM.sub(" ", label)) if w not in QUANTITY["temperature"]]
    numbers = [w for w in words if w.isdigit()]
    return "-".join(words if {*words} - {*numbers} - CHANNELS else ["part", *numbers])


def rise(source: Source, g: Guess) -> float:
    """Largest reading less the first (K)."""
    finite = readings_in_memory(source, g)
    return float(np.max(finite) - finite[0])


def _heat(columns: Columns, at: str) -> tuple[list[FirstTerm], float]:
    """The losses, and their mean (W)."""
    by_quantity = {q: {g.feeds: in_memory(s, g) for s, g in reversed(of)} for q in HEATS if (of := heating(columns, q))}
    kind = next((q for q in HEATS if q in by_quantity), "")
    if not kind:
        return [FirstTerm((at,), ASSUMED_W)], ASSUMED_W
    sources = by_quantity[kind]
    for axes in AXES:
        parts = [f"{axis}_A" for axis in axes]
        if "current_A" not in sources and all(name in sources for name in parts):
            sources["current_A"] = np.sqrt(sum(np.square(sources[name]) for name in parts))
    first = MAIN[kind] if MAIN.get(kind) in sources else list(sources)[-1]
    selection = list(sources.items()) if kind == "share" else [(first, sources[first])]
    losses = []
    for feeds, values in selection:
        mean = float(np.sqrt(np.nanmean(np.square(values)))) or 1.0
        losses.append(FirstTerm((at,), mean if kind == "power" else ASSUMED_W, ((feeds, mean, POWERS[kind]),)))
    return losses, sum(loss.value for loss in losses)


def heating(columns: Columns, quantity: str) -> list[tuple[Source, Guess]]:
    """Columns of a quantity that can be what heats, losses first.

    A power that is below zero passes through, as of a machine that brakes or a cell that is discharged; so does that of
    a machine whose torque or power out is recorded beside its current, unless it says that it is a loss.
    """
    candidates = [(s, g) for s, g in columns if g.quantity == quantity and g.feeds]
    if quantity != "power":
        candidates = [(s, g) for s, g in candidates if g.doubt != ON_OFF] or candidates
        return [(s, g) for s, g in candidates if not STIRS & {*quantities_of(s.labels[g.column])}]
    kinds = {g.quantity for _, g in columns if g.feeds}
    lost = [(s, g) for s, g in candidates if LOSS & {*tokens(s.labels[g.column])}]
    comes_out = "torque" in kinds or any(COMES_OUT & {*tokens(s.labels[g.column])} for s, g in candidates)
    candidates = lost or ([] if "current" in kinds and comes_out else candidates)
    return [(s, g) for s, g in candidates if not _passes(in_memory(s, g), "current" in kinds)]


def _passes(values: Array, beside_current: bool) -> bool:
    """Does a power pass through?  One that is always below zero, with no current beside it, is a reversed clamp."""
    noise = NOISE * float(np.nanmax(np.abs(values)))
    return bool(np.nanmin(values) < -noise and (np.nanmax(values) > noise or beside_current))
