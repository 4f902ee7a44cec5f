"""Motor-CAD files (.mot, sections of key=value): machines with permanent magnets and a rotor inside the stator."""

from __future__ import annotations

import cmath
import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from geom.description.materials import LIMITS, material
from geom.description.outlines import INSET, Outline, radii
from geom.description.profile import Loop, loop_area
from geom.errors import InputError
from geom.importing import assumptions
from geom.importing.draft import Draft, in_mm, new_draft, number, one_line, read_text
from geom.importing.plane import Place, Point, Slot, arc, loop_through, mirror, unite
from geom.importing.slots import magnet_of

RIGHT = "a Motor-CAD file: [Header] with Program_Name=Motor-CAD, then sections of key=value"
METRES = 1e-3  # lengths of the file are in mm
LITRES_PER_MIN = 6e4  # in m3/s
COOLANTS = {"egw 50/50": "glycol-50", "water": "water", "pgw 50/50": "propylene-glycol-50"}
HOME = {"Shaft_Speed": "Miscellaneous"}  # of keys that several sections have, the one that counts
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
    file.choice("Motor_Type", ("BPM",))
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


def _slot(file: File, place: Place) -> Slot:
    """Corners from the bore on: opening, tooth tip, flank, and a bottom with rounded corners around the axis."""
    kind = file.choice("Slot_Type", ("Parallel_Tooth", "Parallel_Slot"))
    opening, tip, deep = (file.length(key) for key in ("Slot_Opening", "Tooth_Tip_Depth", "Slot_Depth"))
    slope = math.tan(math.radians(file.number("Tooth_Tip_Angle", 0.0, 80.0, 0.0)))
    z1 = place.on_surface(opening)
    z2, bottom = z1.real + tip + 1j * z1.imag, place.radius + deep
    radius = file.length("Slot_Corner_Radius", 0.0)
    if kind == "Parallel_Slot":
        wide = file.length("Slot_Width")
        rise = complex(max(wide - opening, 0.0) / 2 * slope, wide / 2 - z2.imag)
        flank, way = z2 + rise, 1.0 + 0j
        centre = math.sqrt((bottom - radius) ** 2 - (wide / 2 - radius) ** 2) + 1j * (wide / 2 - radius)
        end = centre + 1j * radius
    else:
        tooth, way = file.length("Tooth_Width"), cmath.exp(1j * place.half)
        # where the tip's slope, tan(angle) down for each step sideways, meets the flank of the tooth
        room = place.beside_tooth(z2.real, tooth).imag - z2.imag
        step = room / (1.0 - slope * math.tan(place.half))
        flank = z2 + complex(slope * step, step)
        low = tooth / 2 + radius
        centre = place.from_tooth(math.sqrt((bottom - radius) ** 2 - low**2) + 1j * low)
        end = centre + 1j * radius * way
    last = centre * bottom / abs(centre) if radius else end
    half: list[Point] = [(z1, 0.0), (z2, 0.0), (flank, 0.0), (end, arc(end, last, centre) if radius else 0.0)]
    half = [*half, (last, 0.0)] if radius else half
    return Slot(half, arc(last.conjugate(), last), 2)


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
    count, each, kind = file.number("ConductorsPerSlot", 1, 1e5), _section(file), "round"
    if file.text("Armature_CoilStyle") == "1":
        kind = "hairpin"
        if (turn := _layers(draft, file, round(count))) is not None:
            return each * 1e6, slots * count * (file.length("Stator_Lam_Length") + 2 * turn), 1.0
        right = "an equivalent solid winding of the same copper: so many bars are no layers of this slot"
        draft.leave("Armature_CoilStyle", "hairpin", right)
    draft.draw("slots", words, slots, [slot.path])
    draft.draw("wires", f"{words}: under the tooth tips, the liner counted in", slots, wire)
    fill = count * each / room
    if not 0.005 <= fill <= 0.95:
        raise InputError(
            f"conductors take {100 * fill:.3g} % of a slot", file.where("ConductorsPerSlot"), "0.5 to 95 %"
        )
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


def _section(file: File) -> float:
    """Of one conductor (m2): round by its diameter, a hairpin by width and height."""
    if file.text("Armature_CoilStyle") == "1":
        return file.length("Copper_Width") * file.length("Copper_Height")
    return math.pi / 4 * file.length("Copper_Diameter") ** 2


def _v_layers(file: File, place: Place) -> list[tuple[Loop, Loop]]:
    """One arm of every layer of a V: the magnet, and the air to its outer end, above the middle of the pole."""
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
        excess = ((tip - end) * way.conjugate()).real
        out.append((magnet, loop_through([end, tip, tip + across, end + across]) if excess > 1e-5 else ()))
    return out


def _rotor(draft: Draft, file: File) -> None:
    poles = file.count("Pole_Number")
    place = Place(file.length("Stator_Bore") / 2 - file.length("Airgap"), -1, math.pi / poles)
    kind = file.choice("BPM_Rotor", ROTORS)
    ROTORS[kind](draft, file, place, poles)
    draft.take("geometry.shaft", "Shaft_Dia", diameter_mm=file.number("Shaft_Dia"))
    stator, rotor = file.number("Stator_Lam_Length"), file.number("Rotor_Lam_Length", usual=0.0)
    if rotor and abs(rotor - stator) > 1e-3:
        draft.take("geometry.rotor", "Rotor_Lam_Length", stack_length_mm=rotor)
        words = f"contradicts Stator_Lam_Length = {stator:g}: each stack has its own here, change one if they are one"
        draft.leave("Rotor_Lam_Length", rotor, words)
    magnets = file.number("Magnet_Length", usual=rotor or stator)
    if abs(magnets - (rotor or stator)) > 1e-3:
        draft.leave("Magnet_Length", magnets, "contradicts the rotor's length, which magnets have here")


def _v_rotor(draft: Draft, file: File, place: Place, poles: int) -> None:
    arms = _v_layers(file, place)
    words = "PoleVAngle, PoleArc, BridgeThickness, MagnetThickness, MagnetBarWidth by layer"
    magnets = [loop for magnet, _ in arms for loop in (magnet, mirror(magnet))]
    air = [loop for _, tip in arms if tip for loop in (tip, mirror(tip))]
    draft.draw("pockets", words, poles, unite([*magnets, *air]))
    draft.draw("magnets", f"{words}: at the inner ends of their pockets", poles, magnets)


def _surface_rotor(draft: Draft, file: File, place: Place, poles: int) -> None:
    thick, arc_ = file.length("Magnet_Thickness"), math.radians(file.number("Magnet_Arc_[ED]", 1, 180)) * 2 / poles
    core = Place(place.radius - thick, -1, place.half)
    sizes = {"H0": 0.0, "Hmag": thick, "W0": arc_, "Wmag": arc_}
    draft.draw("magnets", "Magnet_Thickness, Magnet_Arc_[ED]", poles, magnet_of("SlotM11", core, sizes).filled)
    draft.take("geometry.rotor", "Stator_Bore, Airgap, Magnet_Thickness", core_diameter_mm=in_mm(2 * core.radius))


ROTORS: dict[str, Callable[[Draft, File, Place, int], None]] = {
    "Interior_VShape": _v_rotor,
    "Surface_Radial": _surface_rotor,
    "Surface_Parallel": _surface_rotor,
}


def _frame(draft: Draft, file: File, family_template: str) -> None:
    kind, lam, outside = file.text("Housing_Type"), file.length("Stator_Lam_Dia"), file.length("Housing_Dia")
    wall, stack = (outside - lam) / 2, file.number("Stator_Lam_Length")
    if "Water_Jacket" in kind:
        inner, high = file.length("WJ_Channel-Lam"), file.length("WJ_Channel_Height")
        wide, rib = file.number("WJ_Channel_Width"), file.number("WJ_Channel_Spacing")
        turns = max(round((stack - rib) / max(wide + rib, 1e-6)), 1)
        values = {"kind": "spiral", "thickness_mm": in_mm(inner), "channel_mm": in_mm(high)}
        draft.take("geometry.housing", "Housing_Type, WJ_Channel-Lam, WJ_Channel_Height", **values)
        draft.take("geometry.housing", "Housing_Dia less all below", wall_mm=in_mm(wall - inner - high))
        draft.take("geometry.housing", "WJ_Channel_Width and WJ_Channel_Spacing over the stack", turns=turns)
        even = (stack - turns * wide) / (turns + 1)
        draft.assume("geometry.housing", "ribs that leave WJ_Channel_Width to each turn", rib_mm=round(even, 6))
    elif wall > 1e-3 and not file.number("Fin_Number_[Total]", usual=0.0) > 1:
        draft.take("geometry.housing", "Housing_Dia, Stator_Lam_Dia", kind="plain", thickness_mm=in_mm(wall))
    else:
        draft.leave("Housing_Type", kind, "this housing is not read: a template stands for it")
        assumptions.template(draft, family_template)
    draft.take("geometry.frame", "Motor_Length", length_mm=file.number("Motor_Length"))
    draft.take("geometry.frame", "Endcap_Thickness_[F]", cap_mm=file.number("Endcap_Thickness_[F]", usual=10.0))
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
        "cooling", "HousingWJ_Inlet_Temperature", inlet_C=file.number("HousingWJ_Inlet_Temperature", -60, 130, 20)
    )
    draft.assume("cooling", "one way through", jacket={"inlet": "jacket.inlet", "outlet": "jacket.outlet"})


def _materials(draft: Draft, file: File) -> None:
    """What parts are made of, by the file's own values; sheets are read in their plane."""
    for part in sorted(assumptions.parts_of(draft) & _KEYS["materials"].keys()):
        end, k = _KEYS["materials"][part]
        keys = {k: f"Thermal_Conductivity_{end}", "rho": f"Density_{end}", "cp": f"Specific_Heat_{end}"}
        values = {ours: file.number(key, *LIMITS[ours]) for ours, key in keys.items() if file.text(key).strip()}
        if values:
            draft.take("materials", ", ".join(keys.values()), **{part: values})


def _losses(draft: Draft, file: File, copper: tuple[float, float, float]) -> None:
    """As the file has them at its reference speeds; where it has none but in the copper, the usual ones."""
    watts = {key: file.number(key, 0.0, 1e9, 0.0) for key in _KEYS["losses"]}
    speed = file.number("Shaft_Speed", 0.0, 1e6, assumptions.USUAL_RPM)
    if not any(watts.values()):
        draft.leave("[Losses_At_RPM_Ref]", "0", "no losses in the file")
        iron = 7600.0 * file.length("Stator_Lam_Length") * math.pi / 4 * (file.length("Stator_Lam_Dia") ** 2) * 0.5
        density = assumptions.CURRENT_DENSITY.get("jacket", assumptions.USUAL_DENSITY)
        assumptions.losses(draft, *copper, iron, density)
        return
    draft.take("ratings", "Shaft_Speed", speed_rpm=speed)
    for key, (name, other, kind, place) in _KEYS["losses"].items():
        if not watts[key]:
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
    ours = material("copper").k_plane
    k = file.number("Thermal_Conductivity_Copper_-_Active", 0.0, 1e4, ours)
    if abs(k / ours - 1) > 0.01:
        draft.leave("Thermal_Conductivity_Copper_-_Active", k, f"copper in windings has {ours:g} W/m/K here")
    for key, (first, second) in file.contradictions.items():
        if key in file.reads:
            draft.leave(key, second, f"stands there twice: {first} is taken")
    for k in range(200):
        legend = file.text(f"Temperature_Validation_Legend[{k}]")
        if legend:
            value = file.number(f"Temperature_Validation_Temperature[{k}]", -273.15, 2000)
            draft.readings[one_line(legend)[:80]] = value
            draft.leave(f"Temperature_Validation [{legend}]", value, "degC, stored: a steady state to compare with")


def _zero(text: str) -> bool:
    try:
        return float(text) == 0.0
    except ValueError:
        return False
