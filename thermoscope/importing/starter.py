"""A first network where nobody gives one: a node per measured part, heat as recorded, sizes from the readings.

It lets a comparison run on the first day. Its numbers are orders of magnitude with wide priors, and it says so.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence

import numpy as np

from geom.description.names import is_plain
from geom.description.roles import Role
from geom.errors import InputError
from thermoscope.escapes import toml_key, toml_value
from thermoscope.importing.guess import Guess, in_memory
from thermoscope.importing.source import Source
from thermoscope.importing.words import QUANTITY, SETPOINT, roles_of, tokens

NOISE = 0.02  # of the largest: as far below zero a power meter may read when nothing flows
ASSUMED_W = 100.0  # heat of a machine of which nobody recorded any
TIME_CONSTANT = 0.3  # of the record: most tests last three time constants
POWERS = {"power": 1.0, "current": 2.0, "share": 1.0}  # of a loss that follows it
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
        raise InputError("no column is a temperature of a machine", files,
                         "a column with degC or K, or a name such as T_winding")  # fmt: skip
    nodes = list(dict.fromkeys(place for *_, place in hot))
    boundaries = ["ambient", *(["coolant"] if any(place == "coolant" for *_, place in places) else [])]
    rises = {place: rise(source, g) for source, g, place in hot}
    heat, watts = _heat(columns, max(rises, key=lambda place: rises[place]))
    G = watts / max(*rises.values(), 1.0)
    return _toml(name, nodes, boundaries, G * TIME_CONSTANT * span_s / len(nodes), G, heat)


BOUNDARIES = {Role.AMBIENT: "ambient", Role.COOLANT: "coolant"}


def place_of(g: Guess, label: str) -> str:
    """A node called after the column, or the boundary that its name means; "" for what is no temperature."""
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
    through = {g.feeds for s, g in columns if g.feeds and not _heats(s, g)}
    by_quantity = {
        q: [(s, g) for s, g in columns if g.quantity == q and g.feeds and g.feeds not in through] for q in HEATS
    }
    kind = next((q for q in HEATS if by_quantity[q]), "")
    if not kind:
        return _loss("heat", at, ASSUMED_W, ""), ASSUMED_W
    sources = {g.feeds: (s, g) for s, g in reversed(by_quantity[kind])}
    selection = list(sources.items()) if kind == "share" else list(sources.items())[-1:]
    lines, total = [], 0.0
    for i, (feeds, (source, g)) in enumerate(selection, 1):
        mean = float(np.sqrt(np.nanmean(np.square(in_memory(source, g))))) or 1.0
        watts = mean if kind == "power" else ASSUMED_W
        of = f"of = {{ input = {toml_value(feeds)}, at = {mean:.4g}, exponent = {POWERS[kind]} }}"
        lines.append(_loss(f"heat-{i}" if len(selection) > 1 else "heat", at, watts, of))
        total += watts
    return "\n".join(lines), total


def _heats(source: Source, g: Guess) -> bool:
    """Can it be what heats? A power that changes its sign is one that passes through, as of a machine that brakes; one
    that is always below zero is a reversed clamp, which is refused."""
    values = in_memory(source, g)
    noise = NOISE * float(np.nanmax(np.abs(values)))
    return g.quantity != "power" or not (np.nanmin(values) < -noise and np.nanmax(values) > noise)


def _loss(name: str, at: str, watts: float, of: str) -> str:
    lines = [f"[losses.{name}]", 'kind = "constant"', f"at = {toml_value(at)}", f"P_W = {watts:.4g}", of]
    return "\n".join([*(line for line in lines if line), f"prior_sd = {SPREAD}", ""])


def _toml(
    name: str, nodes: Sequence[str], boundaries: Sequence[str], C: float, G: float, heat: str
) -> str:  # fmt: skip
    """One link from node to node in a row, and one to each boundary."""
    lines = [
        "# A first network made from the columns alone: every number is an order of magnitude. Put in what you know:",
        "# masses, materials, areas, what heats what (docs/network-toml.md), then thermoscope model calibrate.", "",
        "[network]", f"name = {toml_value(name)}", f"boundaries = {toml_value(list(boundaries))}", "",
    ]  # fmt: skip
    for node in nodes:
        role = [f'role = "{roles[0]}"'] if (roles := roles_of(node)) else []
        lines += [f"[nodes.{toml_key(node)}]", f"C_J_K = {max(C, 1.0):.3g}", *role, f"prior_sd = {SPREAD}", ""]
    inside = [(a, b, 5 * G) for a, b in itertools.pairwise(nodes)]
    outside = [(n, b, G / len(nodes) / len(boundaries)) for n in nodes for b in boundaries]
    for i, (a, b, size) in enumerate((*inside, *outside), 1):
        link = f"{a}-{b}" if is_plain(f"{a}-{b}") else f"link-{i}"
        lines += [f"[links.{toml_key(link)}]", f"between = {toml_value([a, b])}", f"G_W_K = {size:.3g}",
                  f"prior_sd = {SPREAD}", ""]  # fmt: skip
    return "\n".join([*lines, heat])
