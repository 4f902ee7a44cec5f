"""What drawings do not know: frame and cooling by the name of a template, contacts, losses to begin with."""

import math
from typing import Any

from geom.description.outlines import INSET
from geom.errors import InputError
from geom.importing.draft import Draft

GLYCOL: dict[str, Any] = {"coolant": "glycol-50", "flow_L_per_min": 5.0}
TEMPLATES: dict[str, dict[str, dict[str, Any]]] = {
    "closed": {"geometry.housing": {"kind": "plain"}},
    "open": {"geometry.housing": {"kind": "none"}},
    "fins": {
        "geometry.housing": {"kind": "axial-fins", "fins": 40},
        "fans.cowl": {"air_speed_m_s": 8.0, "at_rpm": 3000},
    },
    "jacket": {
        "geometry.housing": {"kind": "spiral", "turns": 6},
        "cooling": {**GLYCOL, "jacket": {"inlet": "jacket.inlet", "outlet": "jacket.outlet"}},
    },
}
USUAL_TEMPLATE = "closed"
CURRENT_DENSITY = {"jacket": 10.0}  # A/mm2 at rest of the machine with a jacket; textbooks have 10-20, 3-7 in still air
USUAL_DENSITY = 4.0
COPPER_OHM_M = 1.724e-8  # annealed copper at 20 degC, IEC 60028
HYSTERESIS_W_KG, EDDY_W_KG = 2.0, 2.0  # of iron at 3000 rpm: half of M400-50A at 1.5 T and 50 Hz each, scaled to 100 Hz
ROTOR_SHARE = 0.1  # of the iron's losses in rotor and magnets, order of magnitude
USUAL_RPM = 3000.0
LINER_H = 500.0  # W/m2/K: 0.3 mm of slot liner at 0.16 W/m/K
PHASES = 3
CAGE_METALS = (("alum", "aluminium-cast"), ("copper", "copper"), ("cu", "copper"))  # by a word of their name


def cage_metal(text: str) -> str:
    """The material of a cage by the words that a file has for it; cast aluminium where they say nothing."""
    return next((name for word, name in CAGE_METALS if word in text.lower()), "aluminium-cast")


def template(draft: Draft, name: str) -> None:
    """Frame and cooling of a template. InputError for a name that is none."""
    if name not in TEMPLATES:
        raise InputError(f"{name!r} is not a template", "--family-template", f"one of: {', '.join(TEMPLATES)}")
    for section, values in TEMPLATES[name].items():
        draft.assume(section, f"template {name!r}: another one by --family-template", **values)


def contacts(draft: Draft, slots_h: float | None = None, source: str = "") -> None:
    """Between all parts.  slots_h : of the slot's lining (W/m2/K) and where it is from, None where the file has none"""
    if "winding" not in parts_of(draft):
        pass  # layers of bars have contacts of their own insulation
    elif slots_h is not None:
        draft.take("contacts", source, **{"stator.core|winding": {"h_W_m2K": slots_h}})
    else:
        draft.assume("contacts", "a slot liner of 0.3 mm", **{"stator.core|winding": {"h_W_m2K": LINER_H}})
    usual: dict[str, dict[str, float]] = {
        "default": {"gap_mm": 0.01},
        "magnets|rotor.core": {"gap_mm": 0.05},
        "winding|winding.left": {"h_W_m2K": 50000.0},
        "winding|winding.right": {"h_W_m2K": 50000.0},
        "rotor.core|winding.field": {"h_W_m2K": LINER_H},
        "rotor.cage|rotor.core": {"gap_mm": 0.01},
        "rotor.core|shaft": {"h_W_m2K": 4000.0},
        **{f"bearing.{end}|shaft": {"h_W_m2K": 150.0} for end in ("left", "right")},
        **{f"bearing.{end}|endcap.{end}": {"h_W_m2K": 1500.0} for end in ("left", "right")},
        "housing|stator.core": {"gap_mm": 0.02},
    }
    parts = parts_of(draft)
    joints = {pair: value for pair, value in usual.items() if pair == "default" or set(pair.split("|")) <= parts}
    entered = {e.key for e in draft.entries if e.section == "contacts"}
    draft.assume("contacts", "as usual for this joint", **{k: v for k, v in joints.items() if k not in entered})


def parts_of(draft: Draft) -> set[str]:
    """Names of the solids that the machine file will have, as far as contacts and losses name them."""
    sections = {e.section for e in draft.entries}
    always = {"stator.core", "rotor.core", "shaft", *windings(draft)}
    ends = {f"{part}.{end}" for part in ("bearing", "endcap") for end in ("left", "right")}
    some = {"magnets": "magnets", "bars": "rotor.cage", "coils": "winding.field"}
    sleeve = {"rotor.sleeve"} if draft.value("geometry.rotor", "sleeve_mm") else set()
    housing = {"housing"} if draft.value("geometry.housing", "kind") != "none" else set()
    return always | ends | housing | sleeve | {part for name, part in some.items() if f"[outlines.{name}]" in sections}


def heated_places(draft: Draft) -> tuple[str, ...]:
    """Where a machine of another program may have losses: all of its copper, and its other solids that have some."""
    solids = ("stator.core", "rotor.core", "magnets", "rotor.cage", "bearing.left", "bearing.right")
    return ("winding.copper", *(part for part in solids if part in parts_of(draft)))


def losses(draft: Draft, copper_mm2: float, length_m: float, parallel: float, iron_kg: float, density: float) -> None:
    """Losses to begin with, at 3000 rpm.

    copper_mm2 : section of one conductor;  length_m : of all conductors of the machine, end turns too
    parallel : ways of a phase's current;  density : of the current (A/mm2)
    """
    current = density * copper_mm2 * parallel
    heat = COPPER_OHM_M * (density * 1e6) ** 2 * length_m * copper_mm2 * 1e-6
    why = f"a current density of {density:g} A/mm2 in the copper of the file"
    draft.assume("ratings", why, current_A=round(current, 3))
    draft.assume("ratings", "order of magnitude", speed_rpm=USUAL_RPM)
    ohms = float(f"{heat / PHASES / current**2:.4g}")
    copper = {"kind": "copper", "at": "winding.copper", "currents": ["current_A"], "factor": PHASES, "R20_ohm": ohms}
    draft.assume("losses.copper", f"length and section of the file's conductors; {why}", **copper)
    at, speed = "as usual for laminations", {"input": "speed_rpm", "at": USUAL_RPM}
    iron = {"hysteresis_W": round(HYSTERESIS_W_KG * iron_kg, 1), "eddy_W": round(EDDY_W_KG * iron_kg, 1)}
    draft.assume("losses.iron", at, kind="iron", at="stator.core", **iron, speed_at=USUAL_RPM)
    parts = parts_of(draft)
    rotor = {"magnets": 0.5, "rotor.core": 0.5} if "magnets" in parts else "rotor.core"
    stray = max(round(ROTOR_SHARE * (HYSTERESIS_W_KG + EDDY_W_KG) * iron_kg, 2), 0.01)
    kind = "magnet" if "magnets" in parts else "stray"
    draft.assume("losses.rotor", "a tenth of the iron's", kind=kind, at=rotor, P_W=stray, of={**speed, "exponent": 2})
    share, of = max(round(0.5 * heat, 2), 0.01), {"input": "current_A", "at": round(current, 3), "exponent": 2}
    for name, part in (("cage", "rotor.cage"), ("field", "winding.field")):
        if part in parts:
            draft.assume(f"losses.{name}", "half of the stator's", kind="stray", at=part, P_W=share, of=of)
    for end in ("left", "right"):
        name = f"losses.bearing-{end}"
        draft.assume(name, "order of magnitude", kind="bearing", at=f"bearing.{end}", P_W=5, of=speed)


def windings(draft: Draft) -> list[str]:
    """Parts of the stator's winding: what lies in the slots, as a whole or by layers, and both ends."""
    layers = draft.value("geometry.winding", "layers")
    slots = [f"winding.layer-{k + 1}" for k in range(layers)] if layers else ["winding"]
    return [*slots, "winding.left", "winding.right"]


def copper_sensor(draft: Draft) -> None:
    mean = {"mean_of": windings(draft), "by": "copper"}
    draft.assume("sensors", "what a resistance measurement sees", **{"winding.copper": mean})


def end_windings(
    draft: Draft, bore_m: float, depth_m: float, slots: int, span: float, copper_m2: float, fill: float
) -> float:
    """Rings of the end turns, semicircles over the coil's span. Returns the length of one conductor at one end (m).

    depth_m : of the winding;  span : of a coil in slots
    copper_m2 : section of the conductors of a slot;  fill : of their room
    """
    bore_m, depth_m = max(bore_m, 1e-2), max(depth_m, 1e-4)
    middle = bore_m / 2 + depth_m / 2
    turn = math.pi / 4 * min(span * 2 * math.pi / slots, math.pi) * middle  # half of a semicircle's arc
    ring = 2 * math.pi * middle * depth_m * (1 - 2 * INSET)
    loose = min(max(0.8 * fill, 0.02), 0.9)
    length = min(max(slots * copper_m2 * turn / (ring * loose), 0.05 * bore_m, 2.1e-3), 0.5 * bore_m)
    loose = min(max(slots * copper_m2 * turn / (ring * length), 0.005), 0.95)
    why = "end turns are semicircles over the coil's span"
    draft.assume("geometry.winding", why, end_mm=round(1e3 * length, 4), end_fill=float(f"{loose:.6g}"))
    return turn


def frame(draft: Draft) -> None:
    """End-caps and bearings, in proportion to what was entered."""

    def size(group: str, key: str) -> float:
        return 1e-3 * (draft.value(f"geometry.{group}", f"{key}_mm") or 0.0)

    stack = max(size("stator", "stack_length"), size("rotor", "stack_length"))
    ends = max(size("winding", "straight") + size("winding", "end"), size("rotor", "end"))
    outer_m, shaft_m = size("stator", "outer_diameter"), size("shaft", "diameter")
    cap = max(0.06 * outer_m, 2e-3)
    length = max(stack + 2 * (1.15 * ends + cap + 1e-3), 0.05)
    seat = min(1.8 * shaft_m, (shaft_m + outer_m) / 2)
    draft.assume(
        "geometry.frame", "room for the end turns", length_mm=round(1e3 * length, 4), cap_mm=round(1e3 * cap, 4)
    )
    if draft.value("geometry.housing", "kind") == "none":
        points = [point for loop in draft.value("[outlines.wires]", "loops_mm") for point in loop]
        yoke = 1e3 * outer_m / 2 - max(math.hypot(x, y) for x, y, *_ in points)
        draft.assume("geometry.frame", "less than half of the yoke", skirt_mm=max(round(0.4 * yoke, 4), 1.0))
    draft.assume("geometry.bearing", "in proportion to the shaft", outer_diameter_mm=round(max(1e3 * seat, 10.0), 4))
