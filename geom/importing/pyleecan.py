"""Machines of pyleecan (JSON): laminations, slots, holes, magnets, cage, windings; a class is a name in a table."""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from geom.description.materials import in_limits
from geom.description.names import checked_document
from geom.description.outlines import NOTHING, Outline, radii
from geom.description.profile import Loop, loop_area
from geom.errors import InputError
from geom.importing import assumptions
from geom.importing.draft import Draft, in_mm, new_draft, number, one_line, read_text
from geom.importing.holes import HOLES, Hole
from geom.importing.plane import Place, Slot, arc, loop_through, rotate, unite, vertices
from geom.importing.slots import CURVED, MAGNETS, STEPS, magnet_of, slot_of

RIGHT = "a machine as pyleecan saves it: JSON with __class__, stator and rotor"
ROTORS = (
    *("LamHole", "LamHoleNS", "LamSlot", "LamSlotMag", "LamSlotMagNS", "LamSlotM", "LamSlotWind"),
    *("LamSquirrelCage", "LamSquirrelCageMag"),
)
STATORS = ("LamSlotWind", "LamSlot")
HOLE_KEYS = ("hole", "hole_north", "hole_south")
LARGEST_M = 10.0  # of a coordinate
USUAL_FILL = 0.4  # of round wire in a slot, by hand or machine: textbooks have 0.35 to 0.45
MOST_PARTS = 100  # holes of a pole, or surfaces of one
SLOTS = (*STEPS, *CURVED, "SlotUD")
# Section of one conductor (m2) by the letters of its class; the first whose letters are all there.
SECTIONS = {
    "Sbar": lambda c: c["Sbar"],
    "Hbar Wbar": lambda c: c["Hbar"] * c["Wbar"],
    "Hwire Wwire": lambda c: (
        c["Hwire"] * c["Wwire"] * c.get("Nwppc_rad", 1) * c.get("Nwppc_tan", 1) * c.get("Nwppc", 1)
    ),
    "Wwire": lambda c: math.pi / 4 * c["Wwire"] ** 2 * c.get("Nwppc", 1),
}
# Lengths (m) that pyleecan writes where nobody gave one, and why a shorter one than the stacks goes nowhere here.
UNSAID_M = {"Lmag": 0.95, "Lshaft": 0.442, "Lfra": 0.35}
HOLDS = {"Lshaft": "the shaft goes through all of it here", "Lfra": "the frame is longer than all it holds here"}
PLACEHOLDER = 1  # what pyleecan writes for a property of a material that nobody gave
LOST = {
    "skew": "the iron is straight here",
    "yoke_notch": "the laminations are round outside",
    "notch": "left out of the air gap's surface",
    "bore": "the air gap is round",
}
Node = Mapping[str, Any]


@dataclass(frozen=True)
class Lamination:
    """A stator or rotor.  where : its place in the file;  sizes in m"""

    node: Node
    where: str
    inner: float
    outer: float
    length: float
    way: int

    @property
    def surface(self) -> float:
        """Radius at the air gap (m)."""
        return self.inner if self.way > 0 else self.outer

    def place(self, copies: int) -> Place:
        return Place(self.surface, self.way, math.pi / copies)


@dataclass(frozen=True)
class PathSlot:
    """A slot whose path and filling the file draws line by line."""

    path: Loop
    filled: tuple[Loop, ...]


def read_pyleecan(path: Path, family_template: str) -> Draft:
    """The draft of a machine file. Raises InputError for what is not a machine with a rotor inside its stator."""
    document = _document(path)
    kind = str(document.get("__class__", ""))
    version = str(document.get("__version__", "")).removeprefix("pyleecan_")
    draft = new_draft(document.get("name"), path, f"pyleecan {version}")
    pair = [_lamination(document, key, path) for key in ("stator", "rotor")]
    draft.take("machine", "name", name=draft.name)
    draft.assume("machine", f"{kind}: any cross-section", family="cross-section")
    if document.get("desc"):
        draft.take("machine", "desc", description=one_line(document["desc"]))
    count, section = _stator(draft, pair[0])
    _rotor(draft, pair[1], pair[0])
    _shaft(draft, document, pair)
    _lengths(draft, document, pair)
    for part, key in (("stator.core", "stator"), ("rotor.core", "rotor"), ("shaft", "shaft")):
        _material(draft, part, _part(_part(document, key), "mat_type"), f"{key}.mat_type")
    conductor = _part(_part(pair[0].node, "winding"), "conductor")
    for part in assumptions.windings(draft):
        _material(draft, part, _part(conductor, "cond_mat"), "stator.winding.conductor.cond_mat")
    _frame(draft, document, pair[0], family_template)
    assumptions.contacts(draft)
    stator = pair[0]
    winding, slots = stator.node["winding"], draft.value("geometry.stator", "slots")
    ring = math.pi * (stator.outer**2 - stator.inner**2)
    iron = 7600.0 * stator.length * ring * 0.7  # kg; slots leave some 0.7 of the ring
    length = slots * count * (stator.length + 2 * 1e-3 * draft.value("geometry.winding", "end_mm"))
    density = assumptions.CURRENT_DENSITY.get(family_template, assumptions.USUAL_DENSITY)
    parallel = winding.get("Npcp")
    parallel = float(parallel) if isinstance(parallel, int) and 0 < parallel < 1000 else 1.0
    assumptions.losses(draft, section * 1e6, length, parallel, iron, density)
    assumptions.copper_sensor(draft)
    for name, lamination in zip(("stator", "rotor"), pair):
        for key, why in LOST.items():
            if lamination.node.get(key):
                draft.leave(f"{name}.{key}", "given", why)
        if lamination.node.get("Nrvd"):
            draft.leave(f"{name}.Nrvd", lamination.node["Nrvd"], "radial ducts: the stack is whole here")
    return draft


def _document(path: Path) -> Node:
    def refuse(word: str) -> None:
        raise ValueError(f"{word} is not a number of JSON")

    def table(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        out = dict[str, Any]()
        for key, value in pairs:
            if key in out:
                raise ValueError(f"{key[:40]!r} is given twice")
            out[key] = value
        return out

    try:
        document = json.loads(read_text(path, RIGHT), parse_constant=refuse, object_pairs_hook=table)
    except (ValueError, RecursionError) as fault:
        raise InputError(f"not readable as JSON: {str(fault)[:80]}", str(path), RIGHT) from None
    if not isinstance(document, dict):
        raise InputError("is not a table", str(path), RIGHT)
    kind = document.get("__class__")
    if not isinstance(kind, str) or not kind.startswith("Machine"):
        raise InputError(f"__class__ = {str(kind)[:40]!r} is not a machine", str(path), RIGHT)
    checked_document({k: v for k, v in document.items() if k in ("name", "__version__")}, str(path))
    return document


def _table(node: Node, key: str, where: str) -> Node:
    value = node.get(key)
    if not isinstance(value, Mapping):
        raise InputError(f"{key} is not there", where, RIGHT)
    return value


def _part(node: Node, key: str) -> Node:
    """A table that may be missing; then, and where it is something else, an empty one."""
    value = node.get(key)
    return value if isinstance(value, Mapping) else {}


def _parts(node: Node, key: str, where: str) -> list[Node]:
    """A list of tables that may be missing."""
    value = node.get(key) or []
    if not isinstance(value, list) or len(value) > MOST_PARTS or not all(isinstance(part, Mapping) for part in value):
        raise InputError(f"{key} is not a list of up to {MOST_PARTS} tables", where, RIGHT)
    return value


def _lamination(document: Node, key: str, path: Path) -> Lamination:
    where = f"{path} {key}"
    node = _table(document, key, str(path))
    inner, outer = (number(node, name, where, 0.0, 3.0) for name in ("Rint", "Rext"))
    if not outer > inner:
        raise InputError(f"Rext = {outer:g} is not above Rint = {inner:g}", where, "radii of the lamination in m")
    if bool(node.get("is_internal")) != (key == "rotor"):
        right = "a machine whose rotor turns inside its stator (is_internal)"
        raise InputError(f"the {key} is {'inside' if key == 'stator' else 'outside'}", f"{where} is_internal", right)
    return Lamination(node, where, inner, outer, number(node, "L1", where, 1e-3, 5.0), 1 if key == "stator" else -1)


def _sizes(node: Node, where: str) -> dict[str, float]:
    """All numbers of a slot, hole or conductor; what older files call otherwise by today's names."""
    sizes = {
        key: number(node, key, where, -1e5, 1e5) if not isinstance(value, bool) else float(value)
        for key, value in node.items()
        if isinstance(value, int | float)
    }
    if sizes.get("H1_is_rad") and {"W0", "W1", "H1"} <= set(sizes):
        sizes["H1"] = (sizes["W1"] - sizes["W0"]) / 2 * math.tan(sizes["H1"])
    kind = str(node.get("__class__"))
    if kind in MAGNETS:
        sizes.setdefault("Hmag", sizes.get("H0" if kind == "SlotM18" else "H1", 0.0))
        sizes.setdefault("Wmag", sizes.get("W1", sizes.get("W0", 0.0)))
    return sizes | ({"2R2": 2 * sizes["R2"]} if "R2" in sizes else {})


def _copies(node: Node, key: str, where: str) -> int:
    return round(number(node, key, where, 1, 400))


def _shape(kind: str, classes: Any, where: str, draw: Any) -> Any:
    """What a class draws; one message where it is unknown, or its numbers make no shape."""
    if kind not in classes:
        raise InputError(f"__class__ = {kind[:40]!r} is not known", where, f"one of: {', '.join(classes)}")
    try:
        return draw()
    except KeyError as missing:
        raise InputError(f"{kind} lacks {missing}", where, "a number in m or rad") from None
    except (ValueError, ZeroDivisionError, OverflowError, IndexError):
        right = "sides that meet the circles they end on"
        raise InputError(f"the numbers of this {kind} make no shape", where, right) from None


def _slot(lamination: Lamination) -> tuple[Slot | PathSlot, int, str]:
    where = f"{lamination.where}.slot"
    node = _table(lamination.node, "slot", lamination.where)
    kind, copies = str(node.get("__class__")), _copies(node, "Zs", where)
    place = lamination.place(copies)
    if kind == "SlotUD":
        return _shape(kind, (kind,), where, lambda: _line_slot(node, where)), copies, kind
    sizes = _sizes(node, where)
    if kind in MAGNETS:
        return _shape(kind, MAGNETS, where, lambda: magnet_of(kind, place, sizes)), copies, kind
    return _shape(kind, SLOTS, where, lambda: slot_of(kind, place, sizes)), copies, kind


def _lines(node: Node, key: str, where: str) -> list[tuple[complex, float, complex]]:
    """Begin, bulge and end of each line; arcs by their class."""
    lines = node.get(key)
    if not isinstance(lines, list) or not 1 <= len(lines) <= 1000:
        raise InputError(f"{key} is not a list of lines", where, "Segment and Arc1 to Arc3 with begin and end")
    return [_piece(line, f"{where}.{key}[{k}]") for k, line in enumerate(lines)]


def _piece(line: Any, where: str) -> tuple[complex, float, complex]:
    try:
        a, b = (complex(str(line[end]).replace(" ", "")) for end in ("begin", "end"))
        kind, left = line["__class__"], line.get("is_trigo_direction", True)
        if max(abs(a), abs(b)) > LARGEST_M:
            raise ValueError
    except (KeyError, TypeError, ValueError, AttributeError):
        raise InputError("is not a line", where, "__class__, begin and end, each a complex number in m") from None
    if kind == "Segment":
        return a, 0.0, b
    if kind == "Arc3":
        return a, 1.0 if left else -1.0, b
    if kind != "Arc1":
        raise InputError(f"__class__ = {str(kind)[:40]!r} is not known", where, "one of: Segment, Arc1, Arc3")
    radius = abs(number(line, "radius", where))
    bulge = math.tan(math.asin(min(abs(b - a) / 2 / radius, 1.0)) / 2)
    return a, bulge if left else -bulge, b


def _line_slot(node: Node, where: str) -> PathSlot:
    """A slot drawn line by line, begun at either side."""
    lines = _lines(node, "line_list", where)
    first, last = node.get("wind_begin_index"), node.get("wind_end_index")
    part = lines[first:last] if isinstance(first, int) and isinstance(last, int) else lines
    begin, end = part[0][0], part[-1][2]
    lid = arc(end, begin) if node.get("type_line_wind") or part is lines else 0.0
    wire = loop_through([*((a, bulge) for a, bulge, _ in part), (end, lid)])
    path = vertices([*((a, bulge) for a, bulge, _ in lines), (lines[-1][2], 0.0)])
    if math.atan2(path[0][1], path[0][0]) > math.atan2(path[-1][1], path[-1][0]):
        back = path[::-1]
        path = [(x, y, -following[2]) for (x, y, _), following in zip(back, [*back[1:], (0.0, 0.0, 0.0)])]
    return PathSlot(tuple(path), (wire,))


def _conductors(winding: Node, slots: int, where: str) -> float:
    """Conductors in a slot: of the matrix where there is one, else turns of a coil times layers."""
    matrix = winding.get("wind_mat")
    if isinstance(matrix, list) and (total := sum(_entries(matrix))):
        return total / slots
    kind = str(winding.get("__class__", ""))
    layers = winding.get("Nlayer") or (2 if "2L" in kind else 1)
    return number(winding, "Ntcoil", where, 1, 1e5) * (layers if isinstance(layers, int) else 1)


def _entries(matrix: Any, depth: int = 0) -> Iterator[float]:
    if isinstance(matrix, list) and depth < 6:
        for inner in matrix:
            yield from _entries(inner, depth + 1)
    elif isinstance(matrix, int | float):
        yield abs(float(matrix))


def _section(conductor: Node, where: str) -> float:
    sizes = _sizes(conductor, where)
    for letters, section in SECTIONS.items():
        if all(sizes.get(letter) for letter in letters.split()) and (area := float(section(sizes))) > 0:
            return area
    kind = str(conductor.get("__class__"))[:40]
    raise InputError(f"{kind} has no section", where, f"one of: {'; '.join(SECTIONS)}")


def _fill(draft: Draft, lamination: Lamination, name: str, group: str, copies: int, room: float) -> tuple[float, ...]:
    """Enters the share of conductor in a slot's room (m2) into a group of the geometry.

    Returns: that share, the conductors of a slot, and the section of each (m2).
    """
    where = f"{lamination.where}.winding"
    winding = _table(lamination.node, "winding", lamination.where)
    count, conductor = _conductors(winding, copies, where), _part(winding, "conductor")
    if room < NOTHING:
        raise InputError("its winding has no room", f"{lamination.where}.slot", "sizes that leave an area for it")
    if conductor.get("__class__") in (None, "Conductor"):
        draft.assume(f"geometry.{group}", f"{name}.winding.conductor has no sizes: as usual", fill=USUAL_FILL)
        return USUAL_FILL, count, USUAL_FILL * room / count
    section = _section(conductor, f"{where}.conductor")
    fill = count * section / room
    if not 0.005 <= fill <= 0.95:
        right = "other conductors than the file's: between 0.5 % and 95 %"
        draft.leave(f"{name}.winding.conductor", f"{100 * fill:.3g} % of its room", right)
    fill = min(max(fill, 0.005), 0.95)
    words = f"{name}.winding: {count:g} conductors of {section * 1e6:.4g} mm2 in {room * 1e6:.5g} mm2"
    draft.take(f"geometry.{group}", words, fill=float(f"{fill:.9g}"))
    return fill, count, section


def _stator(draft: Draft, stator: Lamination) -> tuple[float, float]:
    """Conductors of a slot, and the section of each (m2)."""
    _checked_class(stator, STATORS)
    slot, copies, kind = _slot(stator)
    draft.take("geometry.stator", "stator.Rext", outer_diameter_mm=in_mm(2 * stator.outer))
    draft.take("geometry.stator", "stator.Rint", bore_diameter_mm=in_mm(2 * stator.inner))
    draft.take("geometry.stator", "stator.L1", stack_length_mm=in_mm(stator.length))
    draft.take("geometry.stator", "stator.slot.Zs", slots=copies)
    draft.draw("slots", f"stator.slot, {kind}", copies, [slot.path])
    draft.draw("wires", f"stator.slot, {kind}: what the winding fills", copies, slot.filled)
    for vent in _vents(stator, "stator"):
        draft.draw("vents", vent.source, vent.copies, vent.loops)
    room = sum(abs(loop_area(loop)) for loop in slot.filled)
    fill, count, section = _fill(draft, stator, "stator", "winding", copies, room)
    winding = stator.node["winding"]
    reach = radii((Outline(copies, slot.filled),))
    pairs = number(winding, "p", f"{stator.where}.winding", 1, 200)
    pitch = winding.get("coil_pitch") or copies / (2 * pairs)
    span = float(pitch) if isinstance(pitch, int | float) else 1.0
    assumptions.end_windings(draft, 2 * min(reach), max(reach) - min(reach), copies, span, fill * room, fill)
    straight = winding.get("Lewout")
    if isinstance(straight, int | float) and 0.5e-3 <= straight <= 0.1:
        draft.take("geometry.winding", "stator.winding.Lewout", straight_mm=in_mm(straight))
    else:
        straight = max(in_mm(0.06 * stator.inner), 0.5)
        draft.assume("geometry.winding", "in proportion to the bore", straight_mm=straight)
    _stacking(draft, stator, "stator")
    return count, section


def _checked_class(lamination: Lamination, classes: tuple[str, ...]) -> None:
    kind = str(lamination.node.get("__class__"))
    if kind not in classes:
        raise InputError(f"__class__ = {kind[:40]!r} is not read", lamination.where, f"one of: {', '.join(classes)}")


def _stacking(draft: Draft, lamination: Lamination, name: str) -> None:
    factor = lamination.node.get("Kf1")
    if isinstance(factor, int | float) and factor != 1:
        draft.leave(f"{name}.Kf1", factor, "iron as drawn; the stacking factor lies in the material's density")


@dataclass(frozen=True)
class Cut:
    """Holes through a lamination, so often around it."""

    source: str
    copies: int
    loops: tuple[Loop, ...]


def _vents(lamination: Lamination, name: str) -> Iterator[Cut]:
    for k, vent in enumerate(_parts(lamination.node, "axial_vent", lamination.where)):
        where = f"{lamination.where}.axial_vent[{k}]"
        sizes, kind = _sizes(vent, where), str(vent.get("__class__"))
        if kind == "HoleUD":
            loops = _surface_hole(vent, where).air
        else:
            loops = (_shape(kind, (*VENTS, "HoleUD"), where, partial(VENTS.get(kind, rotate), sizes)),)
        copies, turn = _copies(vent, "Zh", where), sizes.get("Alpha0", 0.0)
        yield Cut(f"{name}.axial_vent[{k}], {kind}", copies, tuple(rotate(loop, turn) for loop in loops))


def _vent_circle(d: Mapping[str, float]) -> Loop:
    return ((d["H0"] + d["D0"] / 2, 0.0, 1.0), (d["H0"] - d["D0"] / 2, 0.0, 1.0))


def _vent_polar(d: Mapping[str, float]) -> Loop:
    a, b = (r * complex(math.cos(d["W1"] / 2), math.sin(d["W1"] / 2)) for r in (d["H0"], d["H0"] + d["D0"]))
    return loop_through([a.conjugate(), (b.conjugate(), arc(b.conjugate(), b)), b, (a, arc(a, a.conjugate()))])


def _vent_trapeze(d: Mapping[str, float]) -> Loop:
    a, b = d["H0"] + 0.5j * d["W1"], d["H0"] + d["D0"] + 0.5j * d["W2"]
    return loop_through([a.conjugate(), b.conjugate(), b, a])


VENTS = {"VentilationCirc": _vent_circle, "VentilationPolar": _vent_polar, "VentilationTrap": _vent_trapeze}


def _rotor(draft: Draft, rotor: Lamination, stator: Lamination) -> None:
    node, top = rotor.node, rotor.outer
    _checked_class(rotor, ROTORS)
    holes = [(key, k, hole) for key in HOLE_KEYS for k, hole in enumerate(_parts(node, key, rotor.where))]
    cuts = [_hole(draft, rotor, hole, key, k) for key, k, hole in holes] + [*_vents(rotor, "rotor")]
    for copies in dict.fromkeys(cut.copies for cut in cuts):
        some = [cut for cut in cuts if cut.copies == copies]  # as one: ducts may be drawn across holes
        loops = unite([loop for cut in some for loop in cut.loops])
        draft.draw("pockets", "; ".join(cut.source for cut in some), copies, loops)
    magnet = next((node[key] for key in ("magnet", "magnet_north") if isinstance(node.get(key), Mapping)), None)
    if isinstance(node.get("slot"), Mapping):
        slot, copies, kind = _slot(rotor)
        if kind != "SlotM18":
            draft.draw("notches", f"rotor.slot, {kind}", copies, [slot.path])
        if magnet is not None:
            draft.draw("magnets", f"rotor.slot, {kind}", copies, slot.filled)
            _magnet(draft, magnet, rotor, "rotor.magnet")
            top = max([top, *radii((Outline(copies, slot.filled),))])
        elif node.get("__class__") == "LamSquirrelCage" or "ring_mat" in node:
            _cage(draft, rotor, slot, copies, kind)
        elif isinstance(node.get("winding"), Mapping):
            draft.draw("coils", f"rotor.slot, {kind}: what the field winding fills", copies, slot.filled)
            _fill(draft, rotor, "rotor", "rotor", copies, sum(abs(loop_area(loop)) for loop in slot.filled))
            draft.assume("geometry.rotor", "a tenth of the rotor's diameter", end_mm=in_mm(0.1 * 2 * rotor.outer))
    gap = stator.inner - top
    if not 0.2e-3 <= gap <= 20e-3:
        right = f"stator.Rint = {stator.inner:g} m at least 0.2 mm and at most 20 mm beyond it"
        raise InputError(f"the rotor ends at {top:.6g} m", rotor.where, right)
    draft.take("geometry.stator", "stator.Rint less the rotor's outermost point", air_gap_mm=in_mm(gap))
    if top > rotor.outer + 1e-9:
        draft.take("geometry.rotor", "rotor.Rext", core_diameter_mm=in_mm(2 * rotor.outer))
    if abs(rotor.length - stator.length) > 1e-6:
        draft.take("geometry.rotor", "rotor.L1", stack_length_mm=in_mm(rotor.length))
        words = f"contradicts stator.L1 = {stator.length:g} m: each stack has its own here, change one if they are one"
        draft.leave("rotor.L1", rotor.length, words)
    _stacking(draft, rotor, "rotor")


def _hole(draft: Draft, rotor: Lamination, node: Node, key: str, k: int) -> Cut:
    """Draws its magnets. Every pole has it, or with `hole_north` and `hole_south` every other one."""
    name, where, kind = f"rotor.{key}[{k}]", f"{rotor.where}.{key}[{k}]", str(node.get("__class__"))
    copies = _copies(node, "Zh", where)
    if kind == "HoleUD":
        hole, present = _surface_hole(node, where), _part(node, "magnet_dict")
    else:
        hole = _shape(kind, (*HOLES, "HoleUD"), where, lambda: HOLES[kind](rotor.place(copies), _sizes(node, where)))
        present = node
    magnets = [m for k, m in enumerate(hole.magnets) if present.get(f"magnet_{k}", present is not node)]
    turn = 2 * math.pi / copies if key == "hole_south" else 0.0
    around = copies if key == "hole" else max(copies // 2, 1)
    draft.draw("magnets", f"{name}, {kind}", around, [rotate(loop, turn) for loop in magnets])
    _magnet(draft, _part(present, "magnet_0"), rotor, f"{name}.magnet_0")
    return Cut(f"{name}, {kind}", around, tuple(rotate(loop, turn) for loop in (*hole.magnets, *hole.air)))


def _surface_hole(node: Node, where: str) -> Hole:
    """A hole drawn surface by surface, its magnets by their labels."""
    magnets: list[Loop] = []
    air: list[Loop] = []
    for k, surface in enumerate(_parts(node, "surf_list", where)):
        lines = _lines(surface, "line_list", f"{where}.surf_list[{k}]")
        loop = loop_through([(a, bulge) for a, bulge, _ in lines])
        (magnets if "Mag" in str(surface.get("label")) else air).append(loop)
    return Hole(tuple(magnets), tuple(air))


def _material(draft: Draft, part: str, material: Node, source: str, **like: str) -> None:
    """What of a part's material the file knows; PLACEHOLDER stands where it does not."""
    heat = _part(material, "HT")
    values = {"k_plane": heat.get("lambda_x"), "k_axial": heat.get("lambda_z"), "cp": heat.get("Cp")}
    values["rho"] = _part(material, "struct").get("rho")
    fine = {k: v for k, v in values.items() if v != PLACEHOLDER and isinstance(v, int | float) and in_limits(k, v)}
    if part in assumptions.windings(draft):
        fine = {f"{k.removesuffix('_axial')}_conductor": v for k, v in fine.items() if k != "k_plane"}
    if fine or like:
        draft.take("materials", source, **{part: {**like, **fine} if fine else like["like"]})


def _magnet(draft: Draft, magnet: Node, rotor: Lamination, name: str) -> None:
    if draft.value("materials", "magnets") is None:
        _material(draft, "magnets", _part(magnet, "mat_type"), f"{name}.mat_type")
    length = _length(magnet, "Lmag")
    if length is not None and abs(length - rotor.length) > 0.005 * rotor.length:
        words = f"contradicts rotor.L1 = {rotor.length:g} m: magnets are as long as the rotor here"
        draft.leave(f"{name}.Lmag", length, words)


def _cage(draft: Draft, rotor: Lamination, slot: Slot | PathSlot, copies: int, kind: str) -> None:
    where = rotor.where
    draft.draw("bars", f"rotor.slot, {kind}: what a bar fills", copies, slot.filled)
    area = sum(abs(loop_area(loop)) for loop in slot.filled)
    section = _section(_table(_table(rotor.node, "winding", where), "conductor", where), f"{where}.winding.conductor")
    if abs(section / area - 1) > 0.02:
        words = f"contradicts the slot's {area * 1e6:.4g} mm2: bars fill their slots here"
        draft.leave("rotor.winding.conductor", f"{section * 1e6:.4g} mm2", words)
    reach = radii((Outline(copies, slot.filled),))
    ring, high = number(rotor.node, "Lscr", where, 1e-4, 1.0), number(rotor.node, "Hscr", where, 1e-4, 1.0)
    most = 0.95 * (max(reach) - max(rotor.inner, 0.3 * rotor.outer))
    draft.take("geometry.rotor", "rotor.Lscr", end_mm=in_mm(min(ring, 0.3)))
    if high < most:
        draft.take("geometry.rotor", "rotor.Hscr", ring_mm=in_mm(high))
    else:
        draft.leave("rotor.Hscr", high, "higher than bars to shaft")
        draft.assume("geometry.rotor", "rings as high as the bars", ring_mm=in_mm(min(max(reach) - min(reach), most)))
    metal = str(_part(rotor.node, "ring_mat").get("name", "")).lower()
    like = assumptions.cage_metal(metal)
    _material(draft, "rotor.cage", _part(rotor.node, "ring_mat"), f"rotor.ring_mat, {metal}", like=like)


def _shaft(draft: Draft, document: Node, pair: list[Lamination]) -> None:
    rotor, shaft = pair[1], _part(document, "shaft")
    diameter = shaft.get("Drsh")
    diameter = diameter if isinstance(diameter, int | float) and diameter > 0 else None
    if rotor.inner > 0:
        draft.take("geometry.shaft", "rotor.Rint", diameter_mm=in_mm(2 * rotor.inner))
        if diameter and abs(diameter - 2 * rotor.inner) > 1e-6:
            words = f"contradicts rotor.Rint = {rotor.inner:g} m, which the shaft fills here"
            draft.leave("shaft.Drsh", diameter, words)
        return
    draft.take("geometry.rotor", "rotor.Rint = 0", inside="solid")
    if diameter:
        draft.take("geometry.shaft", "shaft.Drsh", diameter_mm=in_mm(diameter))
    else:
        diameter = max(in_mm(0.6 * rotor.outer), 5.0)
        draft.assume("geometry.shaft", "no shaft in the file: 0.3 of the rotor", diameter_mm=diameter)


def _length(node: Node, key: str) -> float | None:
    """m; None of what nobody gave."""
    length = node.get(key)
    if isinstance(length, bool) or not isinstance(length, int | float) or length == UNSAID_M[key]:
        return None
    return length


def _lengths(draft: Draft, document: Node, pair: list[Lamination]) -> None:
    """Shaft and frame that are shorter than what they hold."""
    longest = max(pair, key=lambda lamination: lamination.length)
    name = "stator.L1" if longest is pair[0] else "rotor.L1"
    for part, key in (("shaft", "Lshaft"), ("frame", "Lfra")):
        length = _length(_part(document, part), key)
        if length is not None and length < longest.length - 1e-6:
            draft.leave(f"{part}.{key}", length, f"contradicts {name} = {longest.length:g} m: {HOLDS[key]}")


def _frame(draft: Draft, document: Node, stator: Lamination, family_template: str) -> None:
    assumptions.template(draft, family_template)
    node = _part(document, "frame")
    inner, outer = node.get("Rint"), node.get("Rext")
    if family_template == "open" or not isinstance(inner, int | float) or not isinstance(outer, int | float):
        pass  # no frame here, or none in the file
    elif outer < inner:
        words = f"contradicts frame.Rint = {inner:g} m, which lies inside it: the wall is the template's"
        draft.leave("frame.Rext", outer, words)
    elif outer > inner:
        draft.take("geometry.housing", "frame.Rext - frame.Rint", thickness_mm=in_mm(outer - inner))
        if abs(inner - stator.outer) > 1e-5:
            words = f"contradicts stator.Rext = {stator.outer:g} m, which the housing encloses here"
            draft.leave("frame.Rint", inner, words)
    assumptions.frame(draft)
