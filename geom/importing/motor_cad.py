"""Motor-CAD files (.mot, sections of key=value): machines with magnets or a cage, the rotor inside the stator."""

import cmath
import math
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from geom.description.materials import LIMITS
from geom.description.outlines import INSET, Outline, radii
from geom.description.profile import Loop, loop_area
from geom.errors import InputError
from geom.importing import assumptions
from geom.importing.draft import Draft, in_mm, new_draft, number, one_line, read_text
from geom.importing.plane import Place, Point, Slot, arc, crossing, loop_through, mirror, on_circle, unite
from geom.importing.slots import magnet_of

RIGHT = "a Motor-CAD file: [Header] with Program_Name=Motor-CAD, then sections of key=value"
METRES = 1e-3  # lengths of the file are in mm
LITRES_PER_MIN = 6e4  # in m3/s
COOLANTS = {"egw 50/50": "glycol-50", "water": "water", "pgw 50/50": "propylene-glycol-50"}
BARS = {"2": "between parallel teeth", "4": "round at both ends"}  # of the cage's upper bars, by Top_Bar_Type
HOME = {"Shaft_Speed": "Miscellaneous"}  # of keys that several sections have, the one that counts
SLICE = re.compile(r" *\(C\d+\)$")  # at the end of a node's name
COLDEST, HOTTEST = -60.0, 130.0  # degC, of a coolant
HOT_ROOM = 300.0  # degC, of what surrounds a machine: ovens too
# What keys of a file are here.
_KEYS = tomllib.loads(Path(__file__).with_name("motor_cad.toml").read_text("utf-8"))


@dataclass
class File:
    """Keys of a .mot file, each with its section; the first value of a key that stands there twice.

    contradictions : key -> the first value and another;  reads : keys that somebody asked for
    """

    path: Path
    values: dict[str, str] = field(default_factory=dict)
    sections: dict[str, str] = field(default_factory=dict)
    contradictions: dict[str, tuple[str, str]] = field(default_factory=dict)
    reads: set[str] = field(default_factory=set)

    def where(self, key: str) -> str:
        return f"{self.path} [{self.sections.get(key, 'Dimensions')}]"

    def text(self, key: str) -> str:
        """The value as it stands there; "" of a key that is not there."""
        self.reads.add(key)
        return self.values.get(key, "")

    def number(self, key: str, low: float = 0.0, high: float = 1e6, usual: float | None = None) -> float:
        """A number, or the usual one where the key is not there."""
        if not self.text(key).strip() and usual is not None:
            return usual
        return number(self.values, key, self.where(key), low, high)

    def length(self, key: str, usual: float | None = None) -> float:
        """m"""
        return METRES * self.number(key, usual=usual)

    def count(self, key: str) -> int:
        return round(self.number(key, 1, 400))

    def choice(self, key: str, words: Any) -> str:
        word = self.text(key)
        if word not in words:
            raise InputError(f"{key} = {word[:40]!r} is not read", self.where(key), f"one of: {', '.join(words)}")
        return word


def read_motor_cad(path: Path, family_template: str) -> Draft:
    """The draft of a machine file. Raises InputError for a file that is damaged or foreign, or of another kind."""
    file = _parsed(path)
    file.choice("Motor_Type", ("BPM", "IM"))
    draft = new_draft(file.text("Title"), path, f"Motor-CAD {file.values.get('Program_Version', '')}")
    draft.take("machine", "Title", name=draft.name)
    draft.assume("machine", "any cross-section", family="cross-section")
    notes = file.text("DataFile_Notes")
    if notes:
        draft.take("machine", "DataFile_Notes", description=one_line(notes))
    copper = _stator(draft, file)
    _rotor(draft, file)
    _frame(draft, file, family_template)
    _cooling(draft, file)
    parts = assumptions.parts_of(draft)
    for key, pair in _KEYS["gaps"].items():
        gap = file.number(key, 0.0, 10.0, usual=0.0)
        if gap and set(pair.split("|")) <= parts:
            draft.take("contacts", f"{key}, mm of air", **{pair: {"gap_mm": gap}})
    liner = file.number("Liner_Thickness", usual=0.0)
    k = file.number("Thermal_Conductivity_Slot_Liner", 1e-3, 500, 0.21)
    h = round(k / (METRES * liner), 2) if liner else None
    assumptions.contacts(draft, h, "Liner_Thickness, Thermal_Conductivity_Slot_Liner")
    _materials(draft, file)
    _losses(draft, file, copper)
    assumptions.copper_sensor(draft)
    _left(draft, file)
    return draft


def _parsed(path: Path) -> File:
    file, section = File(path), ""
    for line in read_text(path, RIGHT).splitlines():
        if line.startswith("[") and line.endswith("]") and "=" not in line:
            section = line[1:-1]
        elif "=" in line:
            key, _, value = line.partition("=")
            if HOME.get(key.strip()) == section != file.sections.get(key.strip()):
                file.values.pop(key.strip(), None)
                file.sections.pop(key.strip(), None)
            first = file.values.setdefault(key.strip(), value.strip())
            file.sections.setdefault(key.strip(), section)
            if first != value.strip() and not key.startswith("["):
                file.contradictions.setdefault(key.strip(), (first, value.strip()))
    if file.text("Program_Name") != "Motor-CAD":
        raise InputError("Program_Name is not Motor-CAD", f"{path} [Header]", RIGHT)
    return file


def _corner(place: Place, tooth: float, circle: float, radius: float, side: int) -> tuple[complex, complex, complex]:
    """A rounded corner between the flank of a tooth and a circle around the axis: its centre and both its ends.

    side : 1 where the circle is the bottom, -1 where it is the top;  all else in m
    """
    low = tooth / 2 + radius
    centre = place.from_tooth(math.sqrt((circle - side * place.way * radius) ** 2 - low**2) + 1j * low)
    return centre, centre + 1j * radius * cmath.exp(1j * place.half), centre * circle / abs(centre)


def _rounded(flank: complex, centre: complex, last: complex) -> list[Point]:
    return [(flank, arc(flank, last, centre)), (last, 0.0)]


def _below_tip(place: Place, start: complex, slope: float, tooth: float) -> complex:
    """Where the slope of a tooth's tip, depth for each step sideways, meets its flank."""
    room = place.beside_tooth(start.real, tooth).imag - start.imag
    step = room / (1.0 - place.way * slope * math.tan(place.half))
    return start + complex(place.way * slope * step, step)


def _slot(file: File, place: Place) -> Slot:
    """Corners from the bore on: opening, tooth tip, flank, and a bottom by its kind."""
    kind = file.choice("Slot_Type", ("Parallel_Tooth", "Parallel_Tooth_SqBase", "Parallel_Slot"))
    opening, tip, deep = (file.length(key) for key in ("Slot_Opening", "Tooth_Tip_Depth", "Slot_Depth"))
    slope = math.tan(math.radians(file.number("Tooth_Tip_Angle", 0.0, 80.0, 0.0)))
    z1 = place.on_surface(opening)
    z2, bottom = z1.real + tip + 1j * z1.imag, place.radius + deep
    radius = file.length("Slot_Corner_Radius", 0.0)
    if kind == "Parallel_Slot":
        wide = file.length("Slot_Width")
        flank = z2 + complex(max(wide - opening, 0.0) / 2 * slope, wide / 2 - z2.imag)
        centre = math.sqrt((bottom - radius) ** 2 - (wide / 2 - radius) ** 2) + 1j * (wide / 2 - radius)
        end, last = centre + 1j * radius, centre * bottom / abs(centre)
    else:
        tooth = file.length("Tooth_Width")
        flank = _below_tip(place, z2, slope, tooth)
        centre, end, last = _corner(place, tooth, bottom, radius, 1)
    if kind == "Parallel_Tooth_SqBase":  # at right angles to the teeth, so with a ridge in its middle
        ends = (place.from_tooth(bottom + 0.5j * tooth), complex(bottom / math.cos(place.half)))
        return Slot([(z, 0.0) for z in (z1, z2, flank, *ends)], 0.0, 2)
    return Slot([(z1, 0.0), (z2, 0.0), (flank, 0.0), *_rounded(end, centre, last)], arc(last.conjugate(), last), 2)


def _stator(draft: Draft, file: File) -> tuple[float, float, float]:
    """Section of a conductor (mm2), length of all (m), parallel ways; the stator goes into the draft."""
    slots = file.count("Slot_Number")
    place = Place(file.length("Stator_Bore") / 2, 1, math.pi / slots)
    try:
        slot = _slot(file, place)
        wire = slot.filled
    except (ValueError, ZeroDivisionError):
        right = "Slot_Opening, Tooth_Width, Slot_Depth and Slot_Corner_Radius that leave a slot"
        raise InputError("the slot is not a shape", f"{file.path} [Dimensions]", right) from None
    dimensions = {
        "Stator_Lam_Dia": "outer_diameter_mm",
        "Stator_Bore": "bore_diameter_mm",
        "Stator_Lam_Length": "stack_length_mm",
    }
    for key, ours in {**dimensions, "Airgap": "air_gap_mm"}.items():
        draft.take("geometry.stator", key, **{ours: file.number(key)})
    draft.take("geometry.stator", "Slot_Number", slots=slots)
    words = "Slot_Type, Slot_Opening, Tooth_Width, Slot_Depth, Tooth_Tip_Depth, Tooth_Tip_Angle, Slot_Corner_Radius"
    room = sum(abs(loop_area(loop)) for loop in wire)
    count, hairpin = file.number("ConductorsPerSlot", 1, 1e5), file.text("Armature_CoilStyle") == "1"
    if hairpin:
        each = file.length("Copper_Width") * file.length("Copper_Height")
        if (turn := _layers(draft, file, round(count))) is not None:
            return each * 1e6, slots * count * (file.length("Stator_Lam_Length") + 2 * turn), 1.0
        right = "an equivalent solid winding of the same copper: so many bars are no layers of this slot"
        draft.leave("Armature_CoilStyle", "hairpin", right)
    else:
        each = math.pi / 4 * file.length("Copper_Diameter") ** 2
    draft.draw("slots", words, slots, [slot.path])
    draft.draw("wires", f"{words}: under the tooth tips, the liner counted in", slots, wire)
    fill = count * each / room
    if not 0.005 <= fill <= 0.95:
        raise InputError(
            f"conductors take {100 * fill:.3g} % of a slot", file.where("ConductorsPerSlot"), "0.5 to 95 %"
        )
    kind = "hairpin" if hairpin else "round"
    words = f"ConductorsPerSlot, {kind}: {count:g} of {each * 1e6:.4g} mm2 in {room * 1e6:.5g} mm2"
    draft.take("geometry.winding", words, fill=float(f"{fill:.9g}"))
    _, end = _resin_and_ends(draft, file)
    reach = radii((Outline(slots, wire),))
    middle, span = (max(reach) + min(reach)) / 2, file.number("MagThrow", 1, 400, slots / file.count("Pole_Number"))
    turn = math.pi / 4 * min(span * 2 * math.pi / slots, math.pi) * middle
    loose = slots * count * each * turn / (2 * math.pi * middle * (max(reach) - min(reach)) * (1 - 2 * INSET) * end)
    why = "end turns are semicircles over MagThrow"
    draft.assume("geometry.winding", why, end_fill=float(f"{min(max(loose, 0.005), 0.95):.6g}"))
    return each * 1e6, slots * count * (file.length("Stator_Lam_Length") + 2 * turn), 1.0


def _resin_and_ends(draft: Draft, file: File) -> tuple[float, float]:
    """Straight length outside the stack and that of the end turns, along the axis (m)."""
    good = file.number("Imp_Goodness_[Active]", 0.0, 1.0, 1.0)
    draft.take("geometry.winding", "Imp_Goodness_[Active]", impregnation=good)
    draft.take(
        "geometry.winding", "Imp_Goodness_[EWdg]", end_impregnation=file.number("Imp_Goodness_[EWdg]", 0, 1, good)
    )
    straight = file.length("Wdg_Extension_[F]", 5e-3)
    end = max(file.length("EWdg_Overhang_[F]", 30e-3) - straight, 2e-3)
    draft.take("geometry.winding", "Wdg_Extension_[F]", straight_mm=in_mm(max(straight, 0.5e-3)))
    draft.take("geometry.winding", "EWdg_Overhang_[F] less Wdg_Extension_[F]", end_mm=in_mm(end))
    return straight, end


def _layers(draft: Draft, file: File, count: int) -> float | None:
    """A hairpin winding of one bar per layer. Returns wire at one end (m); None where that does not fit the slot."""
    tip, depth, bore = (file.number(key) for key in ("Tooth_Tip_Depth", "Slot_Depth", "Stator_Bore"))
    width, height = file.number("Copper_Width"), file.number("Copper_Height")
    enamel = file.number("Insulation_Thickness", usual=0.1) or 0.05
    liner, slots = file.number("Liner_Thickness", usual=0.0) or 0.05, file.count("Slot_Number")
    parallel = file.text("Slot_Type") == "Parallel_Slot"
    key, ours = ("Slot_Width", "slot_width_mm") if parallel else ("Tooth_Width", "tooth_mm")
    wall, inner = file.number(key), bore / 2 + tip + liner
    room = (wall if parallel else 2 * inner * math.sin(math.pi / slots) - wall) - 2 * liner
    if count > 20 or width + 2 * enamel > room or count * (height + 2 * enamel) > depth - tip - 2 * liner:
        return None
    draft.take("geometry.stator", "Slot_Type", slot_shape="parallel" if parallel else "tapered")
    draft.take("geometry.stator", key, **{ours: wall})
    sizes = {"Slot_Depth": "slot_depth_mm", "Tooth_Tip_Depth": "tip_mm", "Slot_Opening": "opening_mm"}
    for key, ours in sizes.items():
        draft.take("geometry.stator", key, **{ours: file.number(key)})
    draft.take("geometry.stator", "Liner_Thickness, at least 0.05", liner_mm=liner)
    draft.leave("Slot_Corner_Radius", file.number("Slot_Corner_Radius", usual=0.0), "slots of bars have sharp corners")
    draft.take("geometry.winding", "Armature_CoilStyle", kind="hairpin")
    draft.take("geometry.winding", "ConductorsPerSlot", layers=count)
    draft.take("geometry.winding", "Copper_Width", bar_width_mm=width)
    draft.take("geometry.winding", "Copper_Height", bar_height_mm=height)
    draft.take("geometry.winding", "Insulation_Thickness, at least 0.05", enamel_mm=enamel)
    span = file.number("MagThrow", 1, 400, slots / file.count("Pole_Number")) * 2 * math.pi / slots
    draft.take("geometry.winding", "MagThrow", pitch_deg=round(math.degrees(min(span, math.pi)), 6))
    straight, end = _resin_and_ends(draft, file)
    return straight + math.hypot(end, span / 2 * METRES * (bore + depth + tip) / 2)


def _v_layers(file: File, place: Place) -> list[tuple[Loop, Loop]]:
    """One arm of every layer of a V: the magnet, and the air beyond it to bridge and web, above the pole's middle."""
    out = []
    for k in range(round(file.number("VMagnet_Layers", 1, 10, 1))):
        value = lambda key, usual=None, k=k: file.length(f"{key}_Array[{k}]", usual)  # noqa: E731
        opening = math.radians(file.number(f"PoleVAngle_Array[{k}]", 10, 180)) / 2
        reach = math.radians(file.number(f"PoleArc_Array[{k}]", 1, 180)) * place.half / math.pi  # half of it, in space
        tip = (place.radius - value("BridgeThickness")) * cmath.exp(1j * reach)
        way, thick = cmath.exp(1j * opening), value("MagnetThickness")
        rib = value("VShapeMagnetPost", 0.0) / 2 + file.length(f"VShape_Magnet_ClearanceInner[{k}]", 0.0)
        start = tip - (tip.imag - rib) / way.imag * way
        end = start + value("MagnetBarWidth") * way
        across = 1j * way * thick
        magnet = loop_through([start, end, end + across, start + across])
        corner, reach = end + across, abs(tip)
        web = reach * cmath.exp(1j * (place.half - math.asin(value("WebThickness", 0.0) / 2 / reach)))
        foot = crossing(corner, corner + way, web, web + cmath.exp(1j * place.half))
        edge = [web, foot]  # of the air: along bridge and web, or along the bridge alone
        if abs(foot) > reach:
            edge = [max(on_circle(corner, corner + way, reach), key=lambda z: (z * way.conjugate()).real)]
        fits = cmath.phase(edge[0]) > cmath.phase(tip) and ((edge[-1] - corner) * way.conjugate()).real > 0
        bridge: list[Point | complex] = [(tip, arc(tip, edge[0])), *edge]
        air = [end, *(bridge if fits else [tip]), corner]
        out.append((magnet, loop_through(air) if ((tip - end) * way.conjugate()).real > 1e-5 else ()))
    return out


def _u_layers(file: File, place: Place) -> list[tuple[Loop, list[Loop]]]:
    """Half of every layer of a U: its air with the magnets', and these, above the middle of the pole."""
    out = []
    for k in range(round(file.number("Magnet_Layers", 1, 10, 1))):
        value = lambda key, usual=None, k=k: file.length(f"{key}_Array[{k}]", usual)  # noqa: E731
        reach, web = place.radius - value("UShape_BridgeThickness"), value("UShape_WebThickness") / 2
        lean = math.radians(file.number(f"UShape_OuterAngleOffset_Array[{k}]", -80, 80, 0.0))
        tip, way = (reach * cmath.exp(1j * (place.half - math.asin(web / reach))), cmath.exp(1j * (place.half - lean)))
        deep, across = value("UShape_Thickness_Inner", 0.0), -1j * way * value("UShape_Thickness_Outer", 0.0)
        low, post = value("UShape_InnerDiameter") / 2, value("UShape_CentrePost", 0.0) / 2
        foot, inner = (crossing(z, z + way, x, x + 1j) for z, x in ((tip, low), (tip + across, low + deep)))
        top = max(on_circle(tip + across, tip + across + way, reach), key=lambda z: z.real)
        arm: list[Point | complex] = [inner, (top, arc(top, tip)), tip, foot]
        start = max(post, value("UShape_Post_Inner", 0.0) / 2) + value("UMagnet_Offset_Inner", 0.0)
        side, end = value("UMagnet_Length_Inner", 0.0), value("UMagnet_Length_Outer", 0.0)
        flat = [low + 1j * start, low + deep + 1j * start, low + deep + 1j * (start + side), low + 1j * (start + side)]
        steps = [((z - tip) * way.conjugate()).real for z in (foot, inner, top)]  # along the arm, from its tip
        middle = tip + (max(steps[:2]) + min(steps[2], 0.0)) / 2 * way
        along = [middle - end / 2 * way, middle + end / 2 * way]
        beside = [along[0], along[0] + across, along[1] + across, along[1]]
        pocket = loop_through([low + 1j * post, low + deep + 1j * post, *arm] if deep and post < inner.imag else arm)
        out.append((pocket, [loop_through(z) for z, length in ((flat, side), (beside, end)) if length]))
    return out


def _rotor(draft: Draft, file: File) -> None:
    poles = file.count("Pole_Number")
    band = file.number("Banding_Thickness", 0.0, 100.0, 0.0)
    radius = file.length("Stator_Bore") / 2 - file.length("Airgap") - METRES * band
    if band and radius <= 0:
        raise InputError(f"Banding_Thickness = {band:g} leaves no rotor", f"{file.path} [Dimensions]", "less")
    place = Place(radius, -1, math.pi / poles)
    rotor_kind = _cage_rotor if file.text("Motor_Type") == "IM" else ROTORS[file.choice("BPM_Rotor", ROTORS)]
    rotor_kind(draft, file, place, poles)
    if band:
        draft.take("geometry.rotor", "Banding_Thickness, under the gap of Airgap", sleeve_mm=band)
        under = "magnets" if draft.value("geometry.rotor", "core_diameter_mm") else "rotor.core"
        gap = file.number("Banding_-_Rotor", 0.0, 10.0, 0.0)
        if gap:
            draft.take("contacts", "Banding_-_Rotor, mm of air", **{f"{under}|rotor.sleeve": {"gap_mm": gap}})
    draft.take("geometry.shaft", "Shaft_Dia", diameter_mm=file.number("Shaft_Dia"))
    stator, rotor = file.number("Stator_Lam_Length"), file.number("Rotor_Lam_Length", usual=0.0)
    if rotor and abs(rotor - stator) > 1e-3:
        draft.take("geometry.rotor", "Rotor_Lam_Length", stack_length_mm=rotor)
        words = f"contradicts Stator_Lam_Length = {stator:g}: each stack has its own here, change one if they are one"
        draft.leave("Rotor_Lam_Length", rotor, words)
    magnets = file.number("Magnet_Length", usual=rotor or stator)
    if "magnets" in assumptions.parts_of(draft) and abs(magnets - (rotor or stator)) > 1e-3:
        draft.leave("Magnet_Length", magnets, "contradicts the rotor's length, which magnets have here")


def _v_rotor(draft: Draft, file: File, place: Place, poles: int) -> None:
    arms = _v_layers(file, place)
    words = "PoleVAngle, PoleArc, BridgeThickness, MagnetThickness, MagnetBarWidth by layer"
    magnets = [loop for magnet, _ in arms for loop in (magnet, mirror(magnet))]
    air = [loop for _, tip in arms if tip for loop in (tip, mirror(tip))]
    draft.draw("pockets", words, poles, unite([*magnets, *air]))
    draft.draw("magnets", f"{words}: at the inner ends of their pockets", poles, magnets)


def _u_rotor(draft: Draft, file: File, place: Place, poles: int) -> None:
    layers = _u_layers(file, place)
    words = "UShape_InnerDiameter, UShape_WebThickness, UShape_Thickness_Inner, UShape_Thickness_Outer by layer"
    draft.draw("pockets", words, poles, unite([loop for half, _ in layers for loop in (half, mirror(half))]))
    magnets = [loop for _, some in layers for magnet in some for loop in (magnet, mirror(magnet))]
    draft.draw("magnets", "UMagnet_Length_Inner, UMagnet_Length_Outer by layer", poles, magnets)
    ribs = {f"UShape_Post_{side}_Array[{k}]" for side in ("Inner", "Outer") for k in range(len(layers))}
    for key in sorted(key for key in ribs if file.number(key, usual=0.0)):
        draft.leave(key, file.number(key), "no ribs here but UShape_CentrePost, in the middle of the pole")


def _surface_rotor(draft: Draft, file: File, place: Place, poles: int) -> None:
    """Magnets with sides along radii, or parallel to their middle and as wide as their arc is outside."""
    thick, angle = file.length("Magnet_Thickness"), math.radians(file.number("Magnet_Arc_[ED]", 1, 180)) * 2 / poles
    core, kind = Place(place.radius - thick, -1, place.half), "SlotM11"
    sizes = {"H0": 0.0, "Hmag": thick, "W0": angle, "Wmag": angle}
    if file.text("BPM_Rotor") == "Surface_Parallel":
        wide, kind = 2 * place.radius * math.sin(angle / 2), "SlotM15"
        sizes |= {"Wmag": wide, "W0": 2 * math.asin(wide / 2 / core.radius), "Rtopm": place.radius}
    draft.draw("magnets", "Magnet_Thickness, Magnet_Arc_[ED]", poles, magnet_of(kind, core, sizes).filled)
    draft.take(
        "geometry.rotor",
        "Stator_Bore, Airgap, Banding_Thickness, Magnet_Thickness",
        core_diameter_mm=in_mm(2 * core.radius),
    )


def _bar(file: File, place: Place) -> Slot:
    """Corners from the rotor's surface on: opening, what is above the flank by its kind, flank, a round bottom."""
    opening, depth, deep = (file.length(f"Bar_{key}_[T]") for key in ("Opening", "Opening_Depth", "Depth"))
    tooth, z1 = file.length("Rotor_Tooth_Width_T"), place.on_surface(opening)
    bottom = _corner(place, tooth, place.radius - deep, file.length("Bar_Corner_Radius[T]", 0.0), 1)
    top = place.radius - depth
    z2 = math.sqrt(top**2 - opening**2 / 4) + 0.5j * opening
    if BARS[file.choice("Top_Bar_Type", BARS)] == "round at both ends":
        centre, end, first = _corner(place, tooth, top, file.length("BarT_Opening_Radius", 0.0), -1)
        above = [(z2, arc(z2, first)), (first, arc(first, end, centre)), (end, 0.0)]
    else:
        slope = math.tan(math.radians(file.number("Bar_Tip_Angle_[T]", 0.0, 80.0, 0.0)))
        above = [(z2, 0.0), (_below_tip(place, z2, slope, tooth), 0.0)]
    centre, end, last = bottom
    half = [(z1, 0.0), *above, *_rounded(end, centre, last)]
    return Slot(half, arc(last.conjugate(), last), 1, round_lid=True)


def _cage_rotor(draft: Draft, file: File, place: Place, poles: int) -> None:
    """A cage of one bar in each slot: closed slots are holes, others are cut into the surface."""
    file.choice("Bottom_Bar_Type", ("", "0"))
    bars = file.count("Rotor_Bars")
    place = Place(place.radius, -1, math.pi / bars)
    try:
        slot = _bar(file, place)
        filled = slot.filled
    except (ValueError, ZeroDivisionError):
        right = "Bar_Depth_[T], Rotor_Tooth_Width_T and Bar_Corner_Radius[T] that leave a bar"
        raise InputError("the bar is not a shape", f"{file.path} [Dimensions]", right) from None
    words = f"Top_Bar_Type, {BARS[file.text('Top_Bar_Type')]}, Bar_Depth_[T], Bar_Opening_[T], Rotor_Tooth_Width_T"
    if BARS[file.text("Top_Bar_Type")] == "round at both ends":
        draft.leave(
            "Top_Bar_Type",
            "4",
            "read as a bar that is round at both ends, by the keys that belong to it: compare the drawing",
        )
    opened = file.number("Bar_Opening_[T]") > 0
    draft.draw("notches" if opened else "pockets", words, bars, [slot.path] if opened else filled)
    draft.draw("bars", f"{words}: below the opening", bars, filled)
    reach = radii((Outline(bars, filled),))
    more = sum(file.length(f"EndRing_{side}_Add_F", 0.0) for side in ("Inner", "Outer"))
    draft.take("geometry.rotor", "EndRing_Thickness_F", end_mm=file.number("EndRing_Thickness_F", 0.5, 300))
    words = "the bars' height, EndRing_Inner_Add_F and EndRing_Outer_Add_F"
    draft.take("geometry.rotor", words, ring_mm=in_mm(max(reach) - min(reach) + more))
    metal = file.text("Material_Rotor_Cage_Top").lower()
    like = {"like": assumptions.cage_metal(metal)}
    draft.take("materials", f"Material_Rotor_Cage_Top, {metal}", **{"rotor.cage": like})


ROTORS: dict[str, Callable[[Draft, File, Place, int], None]] = {
    "Interior_VShape": _v_rotor,
    "Interior_UShape": _u_rotor,
    "Surface_Radial": _surface_rotor,
    "Surface_Parallel": _surface_rotor,
}


def _frame(draft: Draft, file: File, family_template: str) -> None:
    kind, lam, outside = file.text("Housing_Type"), file.length("Stator_Lam_Dia"), file.length("Housing_Dia")
    wall, stack = (outside - lam) / 2, file.number("Stator_Lam_Length")
    if kind == "Water_Jacket":
        inner, high = file.length("WJ_Channel-Lam"), file.length("WJ_Channel_Height")
        wide, rib = file.number("WJ_Channel_Width"), file.number("WJ_Channel_Spacing")
        turns = max(round((stack - rib) / max(wide + rib, 1e-6)), 1)
        values = {"kind": "spiral", "thickness_mm": in_mm(inner), "channel_mm": in_mm(high)}
        draft.take("geometry.housing", "Housing_Type, WJ_Channel-Lam, WJ_Channel_Height", **values)
        draft.take("geometry.housing", "Housing_Dia less all below", wall_mm=in_mm(wall - inner - high))
        draft.take("geometry.housing", "WJ_Channel_Width and WJ_Channel_Spacing over the stack", turns=turns)
        even = (stack - turns * wide) / (turns + 1)
        draft.assume("geometry.housing", "ribs that leave WJ_Channel_Width to each turn", rib_mm=round(even, 6))
    elif "Water_Jacket" not in kind and wall > 1e-3 and not file.number("Fin_Number_[Total]", usual=0.0) > 1:
        draft.take("geometry.housing", "Housing_Dia, Stator_Lam_Dia", kind="plain", thickness_mm=in_mm(wall))
    else:
        draft.leave("Housing_Type", kind, "this housing is not read: a template stands for it")
        assumptions.template(draft, "jacket" if "Water_Jacket" in kind else family_template)
    cap, length = file.number("Endcap_Thickness_[F]", usual=10.0), file.number("Motor_Length")
    draft.take("geometry.frame", "Endcap_Thickness_[F]", cap_mm=cap)
    ends = sum(draft.value("geometry.winding", key) for key in ("straight_mm", "end_mm"))
    least = stack + 2 * (ends + cap + 1.0)  # mm; 1 between end turns and end-cap
    if length >= least:
        draft.take("geometry.frame", "Motor_Length", length_mm=length)
    else:
        words = f"contradicts Stator_Lam_Length, EWdg_Overhang_[F], Endcap_Thickness_[F]: together {least:.5g} mm"
        draft.leave("Motor_Length", length, words)
        draft.assume("geometry.frame", "as long as all it holds", length_mm=in_mm(METRES * least))
    shaft, seat = file.number("Shaft_Dia"), file.number("Bearing_Dia_[F]", usual=0.0)
    if seat < 1.2 * shaft:
        draft.leave(
            "Bearing_Dia_[F]", seat, "the shaft has one diameter here, Shaft_Dia, and the bearing does not fit it"
        )
        draft.assume("geometry.bearing", "in proportion to the shaft", outer_diameter_mm=1.8 * shaft)
    else:
        draft.take("geometry.bearing", "Bearing_Dia_[F]", outer_diameter_mm=seat)


def _cooling(draft: Draft, file: File) -> None:
    if draft.value("geometry.housing", "kind") != "spiral" or draft.value("cooling", "jacket"):
        return
    fluid = file.text("Housing_Water_Jacket_Fluid_Name")
    if fluid.lower() in COOLANTS:
        draft.take("cooling", "Housing_Water_Jacket_Fluid_Name", coolant=COOLANTS[fluid.lower()])
    else:
        draft.leave("Housing_Water_Jacket_Fluid_Name", fluid, f"not one of: {', '.join(COOLANTS)}")
        draft.assume("cooling", "in place of the file's fluid", coolant=assumptions.GLYCOL["coolant"])
    flow = round(LITRES_PER_MIN * file.number("WJ_Fluid_Volume_Flow_Rate", 0.0, 1.0), 6)
    draft.take("cooling", "WJ_Fluid_Volume_Flow_Rate in m3/s", flow_L_per_min=flow)
    draft.take(
        "cooling",
        "HousingWJ_Inlet_Temperature",
        inlet_C=file.number("HousingWJ_Inlet_Temperature", COLDEST, HOTTEST, 20),
    )
    draft.assume("cooling", "one way through", jacket={"inlet": "jacket.inlet", "outlet": "jacket.outlet"})


def _materials(draft: Draft, file: File) -> None:
    """What parts are made of, by the file's own values; sheets are read in their plane."""
    windings = assumptions.windings(draft)
    kinds = {**_KEYS["materials"], **{part: ["Copper_-_Active", "k"] for part in windings}}
    for part in sorted(assumptions.parts_of(draft) & kinds.keys()):
        end, k = kinds[part]
        keys = {k: f"Thermal_Conductivity_{end}", "rho": f"Density_{end}", "cp": f"Specific_Heat_{end}"}
        if part == "rotor.cage":
            keys = {k: f"Conductivity_{end}", "rho": f"Density_{end}", "cp": f"Cp_{end}"}
        values = {ours: file.number(key, *LIMITS[ours]) for ours, key in keys.items() if file.text(key).strip()}
        if part in windings:
            values = {f"{ours}_conductor": value for ours, value in values.items()}
        if values:
            before = draft.value("materials", part) or {}
            draft.take("materials", ", ".join(keys.values()), **{part: {**before, **values}})


def _losses(draft: Draft, file: File, copper: tuple[float, float, float]) -> None:
    """As the file has them at its reference speeds; where it has none but in the copper, the usual ones."""
    parts = {*assumptions.parts_of(draft), "winding.copper", "stator.core.back", "stator.core.teeth", "airgap"}
    watts = {key: file.number(key, 0.0, 1e9, 0.0) for key, loss in _KEYS["losses"].items() if loss[-1] in parts}
    speed = file.number("Shaft_Speed", 0.0, 1e6, assumptions.USUAL_RPM)
    if not any(watts.values()):
        draft.leave("[Losses_At_RPM_Ref]", "0", "no losses in the file")
        iron = 7600.0 * file.length("Stator_Lam_Length") * math.pi / 4 * (file.length("Stator_Lam_Dia") ** 2) * 0.5
        density = assumptions.CURRENT_DENSITY.get("jacket", assumptions.USUAL_DENSITY)
        assumptions.losses(draft, *copper, iron, density)
        return
    draft.take("ratings", "Shaft_Speed", speed_rpm=speed)
    for key, (name, other, kind, place) in _KEYS["losses"].items():
        if not watts.get(key):
            continue
        reference = file.number(f"Ref_Speed_-_{name}", 1.0, 1e6, assumptions.USUAL_RPM)
        exponent = file.number(f"Speed_Coeff_-_{other or name}", 0.0, 10.0, 0.0)
        values: dict[str, Any] = {"kind": kind, "at": place, "P_W": watts[key]}
        if exponent:
            values["of"] = {"input": "speed_rpm", "at": reference, "exponent": exponent}
        draft.take(
            f"losses.{name.split('_@')[0].lower().replace('_', '-').replace('[', '').replace(']', '')}", key, **values
        )
    none = [key for key, loss in watts.items() if not loss]
    if none:
        draft.leave("[Losses_At_RPM_Ref]", "0", f"no loss in the file: {', '.join(key.split('_@')[0] for key in none)}")


def _left(draft: Draft, file: File) -> None:
    """What matters and goes nowhere; values that differ from our table's; stored temperatures."""
    for key, (neutral, why) in _KEYS["ignored"].items():
        text = file.text(key)
        if text and text != str(neutral) and not (isinstance(neutral, float) and _zero(text)):
            draft.leave(key, text, why)
    for key, (first, second) in file.contradictions.items():
        if key in file.reads:
            draft.leave(key, second, f"stands there twice: {first} is taken")
    for k in range(200):
        legend = file.text(f"Temperature_Validation_Legend[{k}]")
        if legend:
            value = file.number(f"Temperature_Validation_Temperature[{k}]", -273.15, 2000)
            name = one_line(legend)[:80]
            draft.readings[name] = value
            if place := _KEYS["temperatures"].get(SLICE.sub("", name)):
                draft.places[name] = place
            draft.leave(f"Temperature_Validation [{legend}]", value, "degC, stored: a steady state to compare with")
    for key, boundary in _KEYS["surroundings"].items():
        if file.text(key):
            draft.surroundings[boundary] = file.number(key, COLDEST, HOT_ROOM)


def _zero(text: str) -> bool:
    try:
        return float(text) == 0.0
    except ValueError:
        return False
