"""A first network where nobody gives one: a node per measured part, heat as recorded, sizes from the readings.

It lets a comparison run on the first day. Its numbers are orders of magnitude with wide priors, and it says so.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from shlex import quote

import numpy as np

from geom.description.names import is_plain
from geom.description.roles import Role
from geom.errors import InputError
from geom.escapes import toml_key, toml_value
from measured.importing.draft import Draft
from measured.importing.guess import AXES, Array, Guess, in_memory
from measured.importing.source import Source
from measured.importing.words import LOSS, QUANTITY, SETPOINT, quantities_of, roles_of, tokens

NOISE = 0.02  # of the largest: as far below zero a power meter may read when nothing flows
ASSUMED_W = 100.0  # heat of a machine of which nobody recorded any
TIME_CONSTANT = 0.3  # of the record: most tests last three time constants
POWERS = {"power": 1.0, "current": 2.0, "share": 1.0}  # of a loss that follows it
MAIN = {"power": "power_W", "current": "current_A"}  # what the surest column of that quantity feeds
HEATS = tuple(POWERS)  # in the order in which a record tells the heat
PLATINUM = re.compile(r"(?i)pt[ -]?10{2,3}(?!\d)")  # the number is part of the sensor's name
SPREAD = 1.0  # prior of everything here, in powers of e


Columns = Sequence[tuple[Source, Guess]]


def starter(columns: Columns, name: str, span_s: float) -> str:
    """The text of network.toml. InputError where no column is a temperature of a machine."""
    places = [(source, g, place_of(g, source.labels[g.column])) for source, g in columns]
    hot = [(source, g, place) for source, g, place in places if place and place not in BOUNDARIES.values()]
    if not hot:
        files = ", ".join(dict.fromkeys(str(source.file) for source, _ in columns))
        raise InputError(
            "no column is a temperature of a machine", files, "a column with degC or K, or a name such as T_winding"
        )
    nodes = list(dict.fromkeys(place for *_, place in hot))
    boundaries = ["ambient", *(["coolant"] if any(place == "coolant" for *_, place in places) else [])]
    rises = {place: rise(source, g) for source, g, place in hot}
    heat, watts = _heat(columns, max(rises, key=lambda place: rises[place]))
    G = watts / max(*rises.values(), 1.0)
    return _toml(name, nodes, boundaries, G * TIME_CONSTANT * span_s / len(nodes), G, heat)


def unplaced(drafts: Sequence[Draft]) -> list[str]:
    """What matters and was left out: a temperature of the winding, the only heat, a clock; of the first such test."""
    out: dict[str, str] = {}
    for draft in drafts:
        columns = [(r.source, g) for r in draft.records for g in r.guesses]
        left = [(s, g) for s, g in columns if not g.used and s.is_filled(g.column) and g.doubt not in ALONE]
        wound = [g.column for s, g in left if Role.WINDING in roles_of(s.labels[g.column])[:1] and _warms(s, g)]
        if wound and not any(
            Role.WINDING in roles_of(f"{s.labels[g.column]} {g.place}") for s, g in columns if g.place
        ):
            out.setdefault(
                "winding",
                f"the winding was not placed: '{wound[0]}' looks like winding; --place {quote(f'{wound[0]}=PLACE')}",
            )
        hot = [roles_of(s.labels[g.column])[:1] for s, g in columns if g.place]
        if [Role.BEARING] in hot and all(role in ([Role.BEARING], [Role.AMBIENT], [Role.COOLANT]) for role in hot):
            out.setdefault("bearing", "no winding is measured, a bearing alone")
        heats = [g for s, g in columns if g.feeds and g.quantity in (*HEATS, "torque", "voltage")]
        warm = [g.column for s, g in left if set(quantities_of(s.labels[g.column])) & set(HEATS)]
        if not heats and not draft.constants and warm:
            out.setdefault("heat", f"the only heat was left out: '{warm[0]}'; --place {quote(f'{warm[0]}=INPUT')}")
        elif not heats and not draft.constants:
            out.setdefault("heat", "no column says what heats it")
        doubts = [r.clock.doubt for r in draft.records if r.clock.invented]
        if doubts:
            out.setdefault("clock", doubts[0])
    return list(out.values())


def _warms(source: Source, g: Guess) -> bool:
    """Is it a temperature by its name or its unit?"""
    return g.quantity in ("", "temperature") and quantities_of(source.labels[g.column]) in ([], ["temperature"])


ALONE = ("a set point, not a reading", "left out by hand", "--set gives it")
BOUNDARIES = {Role.AMBIENT: "ambient", Role.COOLANT: "coolant"}


def place_of(g: Guess, label: str) -> str:
    """A node called after the column, or the boundary that its name means; "" for what is no temperature."""
    if g.place and g.quantity == "temperature":
        return g.place  # as the user said
    if g.quantity != "temperature" or SETPOINT & set(tokens(label)):
        return ""
    words = [w for w in tokens(PLATINUM.sub(" ", label)) if w not in QUANTITY["temperature"]]
    role = next(iter(roles_of(label)), None)
    name = "-".join(words) if any(not w.isdigit() for w in words) else "-".join(["part", *words])
    return BOUNDARIES.get(role, name) if role is not None else name


def rise(source: Source, g: Guess) -> float:
    """Largest reading less the first (K)."""
    values = in_memory(source, g)
    finite = values[np.isfinite(values)]
    return float(np.max(finite) - finite[0])


def _heat(columns: Columns, at: str) -> tuple[str, float]:
    """The losses as lines of TOML, and their mean (W)."""
    by_quantity = {q: {g.feeds: in_memory(s, g) for s, g in reversed(of)} for q in HEATS if (of := heating(columns, q))}
    kind = next((q for q in HEATS if q in by_quantity), "")
    if not kind:
        return _loss("heat", at, ASSUMED_W, ""), ASSUMED_W
    sources = by_quantity[kind]
    for axes in AXES:
        parts = [f"{axis}_A" for axis in axes]
        if "current_A" not in sources and all(name in sources for name in parts):
            sources["current_A"] = np.sqrt(sum(np.square(sources[name]) for name in parts))
    first = MAIN[kind] if MAIN.get(kind) in sources else list(sources)[-1]
    selection = list(sources.items()) if kind == "share" else [(first, sources[first])]
    lines, total = [], 0.0
    for i, (feeds, values) in enumerate(selection, 1):
        mean = float(np.sqrt(np.nanmean(np.square(values)))) or 1.0
        watts = mean if kind == "power" else ASSUMED_W
        law = f"of = {{ input = {toml_value(feeds)}, at = {mean:.4g}, exponent = {POWERS[kind]} }}"
        lines.append(_loss(f"heat-{i}" if len(selection) > 1 else "heat", at, watts, law))
        total += watts
    return "\n".join(lines), total


def heating(columns: Columns, quantity: str) -> list[tuple[Source, Guess]]:
    """Columns of a quantity that can be what heats, losses first.

    A power that is below zero passes through, as of a machine that brakes or a cell that is discharged; so does that of
    a machine whose torque is recorded beside its current, unless it says that it is a loss.
    """
    candidates = [(s, g) for s, g in columns if g.quantity == quantity and g.feeds]
    if quantity != "power":
        return candidates
    kinds = {g.quantity for _, g in columns if g.feeds}
    lost = [(s, g) for s, g in candidates if LOSS & set(tokens(g.column))]
    candidates = lost or ([] if {"torque", "current"} <= kinds else candidates)
    return [(s, g) for s, g in candidates if not _passes(in_memory(s, g), "current" in kinds)]


def _passes(values: Array, beside_current: bool) -> bool:
    """Does a power pass through?  One that is always below zero, with no current beside it, is a reversed clamp."""
    noise = NOISE * float(np.nanmax(np.abs(values)))
    return bool(np.nanmin(values) < -noise and (np.nanmax(values) > noise or beside_current))


def _loss(name: str, at: str, watts: float, of: str) -> str:
    lines = [f"[losses.{name}]", 'kind = "constant"', f"at = {toml_value(at)}", f"P_W = {watts:.4g}", of]
    return "\n".join([*(line for line in lines if line), f"prior_sd = {SPREAD}", ""])


def _toml(name: str, nodes: Sequence[str], boundaries: Sequence[str], C: float, G: float, heat: str) -> str:
    """One link from node to node in a row, and one to each boundary."""
    lines = [
        "# A first network made from the columns alone: every number is an order of magnitude. Put in what you know:",
        "# masses, materials, areas, what heats what (docs/network-toml.md), then thermoscope model calibrate.",
        "",
        "[network]",
        f"name = {toml_value(name)}",
        f"boundaries = {toml_value(list(boundaries))}",
        "",
    ]
    for node in nodes:
        role = [f'role = "{roles[0]}"'] if (roles := roles_of(node)) else []
        lines += [f"[nodes.{toml_key(node)}]", f"C_J_K = {max(C, 1.0):.3g}", *role, f"prior_sd = {SPREAD}", ""]
    inside = [(a, b, 5 * G) for a, b in itertools.pairwise(nodes)]
    outside = [(n, b, G / len(nodes) / len(boundaries)) for n in nodes for b in boundaries]
    for i, (a, b, size) in enumerate((*inside, *outside), 1):
        link = f"{a}-{b}" if is_plain(f"{a}-{b}") else f"link-{i}"
        lines += [
            f"[links.{toml_key(link)}]",
            f"between = {toml_value([a, b])}",
            f"G_W_K = {size:.3g}",
            f"prior_sd = {SPREAD}",
            "",
        ]
    return "\n".join([*lines, heat])
