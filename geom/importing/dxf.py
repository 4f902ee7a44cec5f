"""Cross-sections as drawings (.dxf), layers named by part: one slot or pole pitch, several, or the whole machine."""

import cmath
import math
import re
import tomllib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geom.description.outlines import MOST_COPIES, NOTHING, Outline, radii
from geom.description.profile import ArcGrid, Loop, Profile, loop_area, loop_length
from geom.description.roles import ROLE_WORDS, SHORTEST, Role, plain, words_of
from geom.errors import InputError
from geom.importing import assumptions
from geom.importing.draft import Draft, in_mm, new_draft
from geom.importing.drawing import (
    WELD,
    Edge,
    along,
    axis_of,
    edges_of,
    loops_and_paths,
    middle,
    piece,
    read_drawing,
    sector_of,
    whole_turn,
)
from geom.importing.plane import arc, loop_through, rotate, unite

USUAL_FILL = 0.4  # of round wire in what the winding fills: textbooks have 0.35 to 0.45
MOST_SIDES = 4  # shapes of a winding in a slot: coil sides, two beside or above each other; more are conductors
LINER_W_M_K = 0.16  # of aramid paper
OVERLAP = 0.01  # share of a shape's area that lies in the iron, from which on it has a hole there
SLIVER = 0.005  # of a slot's depth: a room that begins so near to a corner of the slot begins at it
LEAST_SHARE = 0.5  # of a slot's room: a winding drawn smaller is no filling with a liner around it
# Words of a layer's name; the first of these kinds that one names is meant: "stator slot" is the slot.
_WORDS = tomllib.loads(Path(__file__).with_name("layers.toml").read_text("utf-8"))
_ROLES = {"winding": Role.WINDING, "magnet": Role.MAGNET, "bar": Role.CAGE, "shaft": Role.SHAFT} | {
    "housing": Role.HOUSING,
    "rotor": Role.ROTOR,
    "stator": Role.IRON,
}
_ROLE_WORDS = {kind: ROLE_WORDS[role] - words_of(_WORDS["slot"]) for kind, role in _ROLES.items()}
KINDS = {kind: words_of(text) | _ROLE_WORDS.get(kind, frozenset()) for kind, text in _WORDS.items()}
LAYERS = "layers named by part, such as stator, slot, winding, magnet, rotor, shaft, housing"
_WORD = re.compile(r"[^\W\d_]+")


def kind_of(layer: str) -> str:
    """The part that a layer's name says, "" for none; long words count inside others, too."""
    words = [plain(word).lower() for word in _WORD.findall(layer)]
    for kind, terms in KINDS.items():
        if any(w in terms or w.removesuffix("s") in terms for w in words):
            return kind
    for kind, terms in KINDS.items():
        if any(len(term) >= SHORTEST and term in w for w in words for term in terms):
            return kind
    return ""


@dataclass(frozen=True)
class Section:
    """Edges (m, around the axis) of every kind of layer, with the layers' names and the file."""

    path: Path
    edges: dict[str, list[Edge]]
    names: dict[str, str]

    def where(self, kind: str) -> str:
        return f"{self.path} layer {self.names.get(kind, kind)}"

    def sector(self, kind: str) -> tuple[int, float]:
        return sector_of(self.edges[kind], self.where(kind))

    def iron(self, kind: str) -> list[Loop]:
        """Outlines of the whole turn: what a sector's sides cut is one again."""
        around = whole_turn(self.edges[kind], *self.sector(kind), cut=True)
        return loops_and_paths(around, self.where(kind), seams=True)[0]

    def slots(self) -> list[Loop]:
        """Loops, and paths that the bore closes, of the whole turn."""
        if "slot" not in self.edges:
            return []
        around = whole_turn(self.edges["slot"], *self.sector("stator"), cut=True)
        closed, unclosed = loops_and_paths(around, self.where("slot"), paths=True)
        return closed + unclosed

    def shapes(self, kind: str, iron: str) -> list[Loop]:
        """Loops of the whole turn, as often as their iron stands there; those that a sector cuts are one again."""
        if kind not in self.edges:
            return []
        copies, start = self.sector(iron)
        try:
            loops, _ = loops_and_paths(self.edges[kind], self.where(kind))
        except InputError:
            if copies == 1:
                raise
            loops = loops_and_paths(whole_turn(self.edges[kind], copies, start, cut=True), self.where(kind))[0]
            copies = 1
        rings = sorted((loop for loop in loops if _encloses(loop)), key=_area)
        parts = [part for ring in zip(rings[::2], rings[1::2]) for part in _ring(*ring)]
        loops = [loop for loop in loops if loop not in rings] + parts
        return [rotate(loop, 2 * math.pi * k / copies) for k in range(copies) for loop in loops]


def read_section(path: Path, family_template: str, stack_mm: float | None = None, units: str = "") -> Draft:
    """The draft of a machine file.

    stack_mm, units : what a drawing does not know, None and "" where it has a text such as "stack_mm = 120"
    Raises InputError for a damaged file, layers that name no part, and outlines that are open.
    """
    drawing = read_drawing(path, units)
    try:
        stack_mm = float(drawing.notes.get("stack_mm", "")) if stack_mm is None else stack_mm
    except ValueError:
        right = "--stack-mm 120 of model import; or a text stack_mm = 120 in the drawing"
        raise InputError("a drawing does not say how long the stack is", str(path), right) from None
    draft = new_draft(None, path, "DXF")
    draft.take("machine", "the file's name", name=draft.name)
    draft.assume("machine", "any cross-section", family="cross-section")
    kinds: dict[str, list[Edge]] = {}
    names: dict[str, str] = {}
    for layer, lines in drawing.layers.items():
        if kind := kind_of(layer):
            kinds[kind] = kinds.get(kind, []) + lines
            names[kind] = ", ".join(filter(None, [names.get(kind, ""), layer]))
        else:
            draft.leave(f"layer {layer}", f"{len(lines)} lines", "names no part")
    for kind in ("wedge", "gap"):
        if kinds.pop(kind, None):
            draft.leave(f"layer {names[kind]}", "lines", "slot openings and gaps are air here")
    if drawing.others:
        listed = ", ".join(f"{count} {kind}" for kind, count in drawing.others.items())
        draft.leave("entities", listed, "no lines, arcs or curves")
    for kind in ("stator", "winding", "rotor"):
        if kind not in kinds:
            listed = ", ".join(f"{layer!r}" for layer in [*drawing.layers][:9]) or "none with lines"
            raise InputError(f"no layer is of the {kind}", f"{path} layers {listed}", LAYERS)
    axis = axis_of(kinds["stator"])
    if axis:
        at = f"x = {1e3 * axis.real:.6g}, y = {1e3 * axis.imag:.6g} mm"
        draft.leave("axis", at, "taken as the axis: the stator's longest arc goes around it")
    around = {kind: [(a - axis, b - axis, bulge) for a, b, bulge in lines] for kind, lines in kinds.items()}
    section = Section(path, around, names)
    unit = f"$INSUNITS, {1e3 * drawing.unit:g} mm" if not units else "--units"
    stator = _stator(draft, section, unit)
    draft.take("geometry.stator", "--stack-mm, or a text in the drawing", stack_length_mm=stack_mm)
    copper, turn = _winding(draft, section, stator, _rotor(draft, section, stator))
    _frame(draft, section, family_template)
    _losses(draft, stator, copper, turn, family_template)
    return draft


@dataclass(frozen=True)
class Stator:
    """bore : radius (m);  paths : slots from the bore to the bore, or rooms : closed ones;  wires : as drawn

    iron : section of the laminations (m2)
    """

    bore: float
    paths: list[Loop]
    rooms: list[Loop]
    wires: list[Loop]
    iron: float


def _stator(draft: Draft, section: Section, unit: str) -> Stator:
    layer = section.names["stator"]
    loops = section.iron("stator")
    rings = [loop for loop in loops if _encloses(loop)]
    if len(rings) < 2:
        right = "two: the laminations outside, and the bore with or without slots"
        raise InputError(f"{len(rings)} outlines go around the axis", section.where("stator"), right)
    inner, outer = min(rings, key=_area), max(rings, key=_area)
    bore, size = min(_reach([inner])), math.sqrt(_area(outer) / math.pi)
    if max(_reach([outer])) > size + WELD:
        draft.leave(f"layer {layer}", "not round outside", "a circle of the same area here")
    paths, holes = _slot_paths(inner, bore), []
    for shape in [*(section.slots() if not paths else []), *(loop for loop in loops if not _encloses(loop))]:
        pieces = _slot_paths(shape, bore)
        paths += pieces
        holes += [] if pieces else [shape]
    every, section.names["coil"] = section.edges["winding"], section.names["winding"]
    section.edges["coil"] = [edge for edge in every if min(map(abs, edge[:2])) < bore - WELD]  # of a wound rotor
    section.edges["winding"] = [edge for edge in every if min(map(abs, edge[:2])) >= bore - WELD]
    wires = section.shapes("winding", "stator")
    rooms = [] if paths else [hole for hole in holes if any(_share(wire, hole) > OVERLAP for wire in wires)]
    for key, radius in {"outer_diameter_mm": size, "bore_diameter_mm": bore}.items():
        draft.take("geometry.stator", f"layer {layer}, {unit}", **{key: in_mm(2 * radius)})
    if not paths and not rooms:
        right = "slots in the outline of the bore, or on a layer 'slot'"
        raise InputError("no slots are drawn", section.where("stator"), right)
    draft.take("geometry.stator", "outlines counted around the axis", slots=len(paths) or len(rooms))
    _draw(draft, "slots", section.names.get("slot", layer), paths)
    _draw(draft, "vents", layer, holes)
    iron = _area(outer) - _area(inner) - sum(_area(hole) for hole in holes)
    return Stator(bore, paths, rooms, wires, iron)


def _winding(draft: Draft, section: Section, stator: Stator, poles: int) -> tuple[float, float]:
    """What winds up a slot (m2 of conductor), and the length of an end turn (m); the slot's room is filled."""
    layer, where = section.names["winding"], section.where("winding")
    if not stator.wires:
        raise InputError("no winding lies in the stator", where, "closed outlines in the slots, beyond the bore")
    low, slots = min(_reach(stator.wires)), len(stator.paths) or len(stator.rooms)
    rooms = stator.rooms or [_room(path, low, where) for path in stator.paths]
    room, wires = sum(map(_area, rooms)), sum(map(_area, stator.wires))
    count, share = len(stator.wires) / slots, min(wires / room, 1.0)
    if wires > 1.01 * room:
        raise InputError(f"windings take {100 * wires / room:.4g} % of the slots", where, "outlines inside the slots")
    _draw(draft, "wires", layer, rooms)
    words = f"{100 * share:.4g} % of the slots' room is drawn as winding"
    if count > MOST_SIDES:
        draft.take("geometry.winding", f"{count:g} conductors in a slot: {words}", fill=float(f"{share:.6g}"))
    else:
        why = f"{100 * USUAL_FILL:g} % copper in the winding; {words}"
        draft.assume("geometry.winding", why, fill=float(f"{USUAL_FILL * share:.6g}"))
    fill = draft.value("geometry.winding", "fill")
    reach = _reach(rooms)
    span, depth = slots / poles, max(reach) - min(reach)
    copper = fill * room / slots
    turn = assumptions.end_windings(draft, 2 * min(reach), depth, slots, span, copper, fill)
    straight = max(in_mm(0.06 * stator.bore), 0.5)
    draft.assume("geometry.winding", "in proportion to the bore", straight_mm=round(straight, 4))
    walls = sum(loop_length(loop) for loop in rooms)
    if count <= MOST_SIDES and LEAST_SHARE < share < 1 - 1e-3:
        liner = (room - wires) / walls
        h = round(LINER_W_M_K / liner, 1)
        words = f"{1e3 * liner:.3g} mm between winding and slot as drawn, at {LINER_W_M_K:g} W/m/K"
        assumptions.contacts(draft, h, words)
    else:
        assumptions.contacts(draft)
    return copper, turn


def _rotor(draft: Draft, section: Section, stator: Stator) -> int:
    """Enters the rotor. Returns: how many poles it has, by what repeats around the axis."""
    layer, where = section.names["rotor"], section.where("rotor")
    loops = section.iron("rotor")
    rings = [loop for loop in loops if _encloses(loop)]
    if not rings:
        raise InputError("no outline goes around the axis", where, "the laminations' surface, closed around the axis")
    outline = max(rings, key=_area)
    surface = max(_reach([outline]))
    holes = [loop for loop in loops if not _encloses(loop)]
    magnets, bars, pockets = (section.shapes(k, "rotor") for k in ("magnet", "bar", "pocket"))
    coils = section.shapes("coil", "rotor")
    _draw(draft, "notches", layer, _slot_paths(outline, surface))
    iron = Profile(outline, tuple(holes))
    cut = [loop for loop in [*pockets, *magnets, *bars, *coils] if _share(loop, iron) > OVERLAP]
    _draw(draft, "pockets", section.names.get("pocket", layer), unite([*holes, *cut]) if cut else holes)
    _draw(draft, "magnets", section.names.get("magnet", ""), magnets)
    _draw(draft, "bars", section.names.get("bar", ""), bars)
    _draw(draft, "coils", section.names["coil"], coils)
    if coils:
        draft.assume("geometry.rotor", "as usual", fill=USUAL_FILL, end_mm=round(in_mm(0.2 * surface), 4))
    gap = stator.bore - max([surface, *_reach(magnets)])
    if not 0.2e-3 <= gap <= 20e-3:
        right = "a rotor inside the bore, with an air gap from 0.2 to 20 mm"
        raise InputError(f"the air gap is {1e3 * gap:.5g} mm", where, right)
    draft.take("geometry.stator", "bore less the rotor's outermost point", air_gap_mm=in_mm(gap))
    if max(_reach(magnets), default=0.0) > surface + WELD:
        draft.take("geometry.rotor", f"layer {layer}", core_diameter_mm=in_mm(2 * surface))
    inner = [min(_reach([ring])) for ring in rings if ring is not outline]
    shaft = [abs(z) for a, b, _ in section.edges.get("shaft", ()) for z in (a, b)]
    if inner or shaft:
        source = f"layer {layer if inner else section.names['shaft']}"
        draft.take("geometry.shaft", source, diameter_mm=in_mm(2 * (min(inner) if inner else max(shaft))))
        if inner and shaft and abs(max(shaft) - min(inner)) > WELD:
            words = f"contradicts the bore of {2e3 * min(inner):.6g} mm in layer {layer}, which the shaft fills here"
            draft.leave(f"layer {section.names['shaft']}", f"{2e3 * max(shaft):.6g} mm", words)
    else:
        draft.take("geometry.rotor", f"layer {layer} has no bore", inside="solid")
        size = round(in_mm(0.6 * surface), 4)
        draft.assume("geometry.shaft", "no shaft is drawn: 0.3 of the rotor", diameter_mm=size)
    if bars:
        reach = _reach(bars)
        ring = min(max(reach) - min(reach), 0.9 * (max(reach) - max([*inner, 0.3 * surface])))
        draft.assume("geometry.rotor", "rings as high as the bars, half as long", ring_mm=round(in_mm(ring), 4))
        draft.assume("geometry.rotor", "half of the rings' height", end_mm=max(round(in_mm(0.5 * ring), 4), 0.5))
    poles = next((_repeated(shapes)[0] for shapes in (magnets, holes) if shapes), 0)
    poles = poles if poles > 1 and not bars else 2 * max(round(len(stator.paths or stator.rooms) / 12), 1)
    draft.leave("poles", poles, "as the rotor repeats, or six slots for each: end turns span slots over poles")
    return poles


def _frame(draft: Draft, section: Section, family_template: str) -> None:
    assumptions.template(draft, family_template)
    edges, outer = section.edges.get("housing"), draft.value("geometry.stator", "outer_diameter_mm")
    if edges:
        wall = 1e3 * max(abs(z) for edge in edges for z in (edge[0], middle(edge))) - outer / 2
        layer = f"layer {section.names['housing']}"
        if family_template == "open" or wall < 1.0:
            draft.leave(layer, f"{wall:.4g} mm beyond the stator", f"no housing of template {family_template!r}")
        else:
            draft.take("geometry.housing", f"{layer}, its outermost point", thickness_mm=round(wall, 6))
    assumptions.frame(draft)


def _losses(draft: Draft, stator: Stator, copper: float, turn: float, family_template: str) -> None:
    """To begin with; the current is that of all conductors of a slot, whose number nobody draws."""
    length = 1e-3 * draft.value("geometry.stator", "stack_length_mm")
    density = assumptions.CURRENT_DENSITY.get(family_template, assumptions.USUAL_DENSITY)
    wire = len(stator.paths or stator.rooms) * (length + 2 * turn)
    assumptions.losses(draft, 1e6 * copper, wire, 1.0, 7600.0 * length * stator.iron, density)
    words = "current_A is that of a slot: with n conductors in series it is n times less, R20_ohm n n times more"
    draft.leave("conductors", "not drawn", words)
    assumptions.copper_sensor(draft)


def _draw(draft: Draft, name: str, layer: str, shapes: Sequence[Loop]) -> None:
    """Shapes of the whole turn, those that repeat once."""
    if shapes:
        copies, loops = _repeated(shapes)
        draft.draw(name, f"layer {layer}", copies, loops)


def _repeated(shapes: Sequence[Loop]) -> tuple[int, list[Loop]]:
    """How often a pattern stands around the axis, and its shapes around +x."""
    centres = np.array([np.mean([z for edge in edges_of(loop) for z in (edge[0], middle(edge))]) for loop in shapes])
    areas = np.array([_area(loop) for loop in shapes])
    for copies in range(min(len(shapes), MOST_COPIES), 0, -1):
        if len(shapes) % copies:
            continue
        away = abs(centres[:, None] * cmath.exp(2j * math.pi / copies) - centres[None, :])
        near = away.argmin(axis=1)
        alike = abs(areas[near] - areas) < 1e-3 * areas + NOTHING
        if (away.min(axis=1) < 10 * WELD).all() and alike.all():
            break
    pitch = 2 * math.pi / copies
    first = np.floor((np.angle(centres) + pitch / 2 + 1e-6) / pitch) == 0
    return copies, [loop for loop, here in zip(shapes, first) if here]


def _slot_paths(loop: Loop, radius: float) -> list[Loop]:
    """What of a loop, or of an open path, lies off a circle around the axis: paths from it to it, anticlockwise."""
    sides = [part for edge in edges_of(loop) for part in _split(edge, radius)]
    starts = [k for k, edge in enumerate(sides) if abs(abs(edge[0]) - radius) < WELD]
    paths = []
    for k, start in enumerate(starts):
        end = starts[(k + 1) % len(starts)]
        run = [sides[(start + i) % len(sides)] for i in range((end - start - 1) % len(sides) + 1)]
        if len(run) == 1 and _on_circle(run[0], radius):
            continue
        path = tuple([(a.real, a.imag, bulge) for a, _, bulge in run] + [(run[-1][1].real, run[-1][1].imag, 0.0)])
        rising = cmath.phase(run[-1][1] / run[0][0]) > 0
        paths.append(path if rising else tuple((*p[:2], -q[2]) for p, q in zip(path[::-1], [*path[-2::-1], path[-1]])))
    return paths


def _split(edge: Edge, radius: float) -> list[Edge]:
    """At its outermost point, where that lies on a circle: a pole's arc around a centre of its own."""
    if not edge[2] or min(abs(abs(z) - radius) for z in edge[:2]) < WELD:
        return [edge]
    far = max(np.linspace(0.02, 0.98, 193), key=lambda share: abs(along(edge, float(share))))
    tip = along(edge, float(far))
    if abs(abs(tip) - radius) > WELD or max(map(abs, edge[:2])) > radius - WELD:
        return [edge]
    return [piece(edge, 0.0, float(far)), piece(edge, float(far), 1.0)]


def _on_circle(edge: Edge, radius: float) -> bool:
    """Along a circle around the axis, or a chord of it?"""
    a, b, _ = edge
    depth = radius * math.cos(cmath.phase(b / a) / 2) if abs(a) * abs(b) else 0.0
    return max(abs(abs(z) - radius) for z in (a, b)) < WELD and depth - WELD < abs(middle(edge)) < radius + WELD


def _room(path: Loop, low: float, where: str) -> Loop:
    """What of a slot lies beyond a radius (m): closed by a circle around the axis, with the slot's own sides."""
    corners = [math.hypot(x, y) for x, y, _ in path]
    low = max((r for r in corners if abs(r - low) < SLIVER * (max(corners) - corners[0])), default=low)
    sides = [part for edge in edges_of(path)[:-1] for part in _halves(edge, low)]
    up = next((k for k, edge in enumerate(sides) if abs(edge[1]) > low + WELD), None)
    down = next((k for k in reversed(range(len(sides))) if abs(sides[k][0]) > low + WELD), None)
    if up is None or down is None:
        raise InputError(f"the winding begins {1e3 * low:.5g} mm from the axis, beyond the slots", where, LAYERS)
    first, last = piece(sides[up], _crossing(sides[up], low), 1.0), piece(sides[down], 0.0, _crossing(sides[down], low))
    run = [first, *sides[up + 1 : down], last]
    a, b = (z * low / abs(z) if abs(abs(z) - low) < WELD else z for z in (last[1], first[0]))
    return loop_through([(b, first[2]), *((e[0], e[2]) for e in run[1:]), (a, arc(a, b))])


def _halves(edge: Edge, radius: float) -> list[Edge]:
    """An arc that leaves a circle around the axis and comes back to it: as two, which do one of both."""
    if edge[2] and max(map(abs, edge[:2])) < radius < abs(middle(edge)):
        return [piece(edge, 0.0, 0.5), piece(edge, 0.5, 1.0)]
    return [edge]


def _crossing(edge: Edge, radius: float) -> float:
    """The share of an edge's way at which it crosses a circle around the axis; an end that is on it already."""
    from scipy.optimize import brentq

    ends = [abs(z) - radius for z in edge[:2]]
    if min(map(abs, ends)) < WELD or ends[0] * ends[1] > 0:
        return float(abs(ends[1]) < abs(ends[0]))
    return float(brentq(lambda share: abs(along(edge, share)) - radius, 0.0, 1.0))


def _encloses(loop: Loop) -> bool:
    """Does it go around the axis?"""
    turn = 0.0
    for edge in edges_of(loop):
        a, half, b = edge[0], middle(edge), edge[1]
        if min(abs(a), abs(half), abs(b)) < WELD:
            return False
        turn += cmath.phase(half / a) + cmath.phase(b / half)
    return abs(turn) > math.pi


def _ring(inner: Loop, outer: Loop) -> list[Loop]:
    """Between two circles around the axis: its halves."""
    r, R = (math.sqrt(_area(loop) / math.pi) for loop in (inner, outer))
    return [((s * R, 0.0, 1.0), (-s * R, 0.0, 0.0), (-s * r, 0.0, -1.0), (s * r, 0.0, 0.0)) for s in (1, -1)]


def _area(loop: Loop) -> float:
    return abs(loop_area(loop))


def _reach(loops: Iterable[Loop]) -> list[float]:
    """Distances from the axis (m) of corners, of arcs, and of straight edges where they are nearest."""
    return radii((Outline(1, tuple((*loop, loop[0]) for loop in loops)),))


def _share(loop: Loop, region: Loop | Profile) -> float:
    """Of a loop's area, what lies in another or in a region."""
    profiles = [Profile(loop), region if isinstance(region, Profile) else Profile(region)]
    grid = ArcGrid(profiles)
    one, other = (profile.to_polygon(grid).buffer(0) for profile in profiles)
    return float(one.intersection(other).area / max(one.area, NOTHING))
