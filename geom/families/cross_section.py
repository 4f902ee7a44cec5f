"""Radial-flux machines with a cross-section that the file draws: slots, magnets, pockets, bars and coils as outlines.

Frame, housing, bearings and base are those of the other machines with a round housing. Without [outlines] the stator
has tapered slots and the rotor is plain iron.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.outlines import INSET, Outline, Outlines, notched_loop, radii, refuse_cuts
from geom.description.parameters import Measure, Parameter, choice, length as mm
from geom.description.part import Part, extrude, fluid
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.errors import InputError
from geom.families.family import Family
from geom.families.fit import Fit
from geom.families.radial_flux import parameters
from geom.families.radial_flux.checks import check
from geom.families.radial_flux.housing import FACES, coolant, enclosure, ports
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.stator import stator
from geom.families.shaft_fan import shaft_fan

FILLS = ("winding.fill", "winding.end_fill")  # of any conductor, single turns too
NAMES = {
    "slots": "cut into the bore, from the bore to the bore",
    "wires": "what the winding fills",
    "vents": "holes through the stator",
    "notches": "cut into the rotor's surface, from the surface to the surface",
    "pockets": "holes through the rotor, those of magnets too",
    "magnets": "in their pockets or on the rotor",
    "bars": "of the cage",
    "coils": "of a wound rotor",
}
gap = Measure("shaft to air gap", lambda g: g.stator.bore_diameter / 2 - g.stator.air_gap - g.shaft.diameter / 2)
rotor = Measure(
    "the bore less gap and sleeve on either side",
    lambda g: g.stator.bore_diameter - 2 * (g.stator.air_gap + g.rotor.sleeve),
)
inside = Measure("shaft to rotor surface", lambda g: rotor.span(g) / 2 - g.shaft.diameter / 2)
PARAMETERS = (
    *(replace(p, low=0.005, high=0.95) if p.key in FILLS else p for p in parameters.COMMON),
    mm("rotor.sleeve", 0, 0.1, 100, gap(0.02, 0.2), "around magnets and iron, under the air gap; 0: none", off=True),
    mm("rotor.core_diameter", 0, 5, 3000, rotor(0.8, 1.0), "iron of the rotor; 0: up to gap or sleeve", off=True),
    mm("rotor.stack_length", 0, 5, 3000, parameters.stack(0.8, 1.0), "of the rotor; 0: as the stator's", off=True),
    choice("rotor.inside", ("bored", "solid"), "laminations around the shaft, or to the axis between two stubs of it"),
    mm("rotor.end", 5, 0.5, 300, parameters.end_space(0.1, 0.6), "rings of the cage, or end turns of a wound rotor"),
    mm("rotor.ring", 10, 0.5, 600, inside(0.1, 0.8), "radial height of the cage's rings"),
    Parameter("rotor.fill", 0.45, 0.005, 0.95, "share of conductor in a coil of a wound rotor"),
    *parameters.FAN,
)


class _Places(Layout):
    """Radii and positions of a drawn machine (m), and what is drawn."""

    def __init__(self, g: Geometry) -> None:
        super().__init__(g)
        outlines: Outlines = getattr(g, "outlines", None) or {name: () for name in NAMES}
        self.outlines = outlines
        self.shell = self.rotor - g.rotor.sleeve
        self.surface = g.rotor.core_diameter / 2 or self.shell
        stack = g.rotor.stack_length or g.stator.stack_length
        self.iron0, self.iron1 = self.middle - stack / 2, self.middle + stack / 2
        if outlines["wires"]:
            self.wire0, self.wire1 = min(radii(outlines["wires"])), max(radii(outlines["wires"]))
        self.mouth = max([self.slot0 if not outlines["wires"] else self.bore, *radii(outlines["slots"])])
        self.valley = min([self.surface, *radii(outlines["notches"])])


def build_section(g: Geometry) -> tuple[Part, ...]:
    """Solids and fluids of a machine with a drawn cross-section. Raises InputError for parts that do not fit."""
    at = _Places(g)
    _check(g, at)
    fan = shaft_fan(g.fan, g.shaft.diameter / 2, at.cowl0, 0.0)
    return (*_shaft(g, at), *_rotor(g, at), *_stator(g, at), *enclosure(g, at), *fan, *_fluids(g, at))


def _check(g: Geometry, at: _Places) -> None:
    fit, outlines = Fit(g), at.outlines
    check(g, at, outlined=bool(outlines["slots"] or outlines["wires"]))
    right = f"at most {2e3 * at.shell:.5g}, to leave gap and sleeve"
    fit.need(at.surface <= at.shell + 1e-9, "rotor.core_diameter", right)
    fit.need(g.shaft.diameter / 2 < at.valley, "shaft.diameter", f"less than {2e3 * at.valley:.5g} mm, the rotor")
    room = min(at.iron0 - at.cap0, at.cap1 - at.iron1)
    fit.need(room > 0.0, "rotor.stack_length", "less, to clear the end-caps")
    if outlines["bars"] or outlines["coils"]:
        fit.below(0.98 * room, "rotor.end", ", the end space")
    if outlines["bars"]:
        fit.below(max(radii(outlines["bars"])) - 0.51 * g.shaft.diameter, "rotor.ring", ", to clear the shaft")
    if outlines["wires"] and g.winding.kind == "hairpin":
        right = "slots by [geometry.stator], without [[outlines.slots]] and [[outlines.wires]]"
        raise InputError("bars of a hairpin winding are not drawn", "[[outlines.wires]]", right)
    refuse_cuts(outlines, ("slots", "notches"))
    _inside(outlines, ("slots", "wires", "vents"), (0.999 * at.bore, at.core), "the laminations")
    shaft = g.shaft.diameter / 2 if g.rotor.inside == "bored" else 0.0
    _inside(outlines, ("pockets", "bars", "coils", "notches"), (shaft, at.surface + 1e-7), "the rotor")
    most, what = (at.shell + 1e-7, "the sleeve") if g.rotor.sleeve else (at.bore, "the bore")
    _inside(outlines, ("magnets",), (shaft, most), what)


def _inside(outlines: Outlines, names: tuple[str, ...], span: tuple[float, float], what: str) -> None:
    for name in names:
        for radius in radii(outlines[name]):
            if not span[0] <= radius <= span[1]:
                right = f"points from {span[0] * 1e3:.5g} to {span[1] * 1e3:.5g} mm from the axis, {what}"
                raise InputError(f"a point lies {radius * 1e3:.5g} mm from the axis", f"[[outlines.{name}]]", right)


def _shaft(g: Geometry, at: _Places) -> tuple[Part, ...]:
    disc, start, end = shapes.disc(g.shaft.diameter / 2), 0.8 * at.cowl0, at.length + g.shaft.extension
    spans = ((start, end),) if g.rotor.inside == "bored" else ((start, at.iron0), (at.iron1, end))
    return (Part("shaft", "steel", tuple((disc, *span) for span in spans), role=Role.SHAFT),)


def _around(groups: tuple[Outline, ...]) -> list[Profile]:
    return [profile for group in groups for profile in group.around()]


def _end_turns(inner: float, outer: float) -> Profile:
    """A ring for the end turns of conductors between two radii (m)."""
    inset = INSET * (outer - inner)
    return shapes.ring(inner + inset, outer - inset)


def _rotor(g: Geometry, at: _Places) -> Iterator[Part]:
    outlines = at.outlines
    bore = (shapes.circle_loop(g.shaft.diameter / 2),) if g.rotor.inside == "bored" else ()
    holes = tuple(profile.outer for profile in _around(outlines["pockets"]))
    core = Profile(notched_loop(at.surface, outlines["notches"]), (*bore, *holes))
    yield Part("rotor.core", "electrical-steel", ((core, at.iron0, at.iron1),), role=Role.ROTOR)
    left, right = (at.iron0 - g.rotor.end, at.iron0), (at.iron1, at.iron1 + g.rotor.end)
    if outlines["magnets"]:
        prisms = extrude(_around(outlines["magnets"]), at.iron0, at.iron1)
        yield Part("magnets", "magnet-ndfeb", prisms, role=Role.MAGNET)
    if g.rotor.sleeve:
        prism = shapes.ring(at.shell, at.rotor), at.iron0, at.iron1
        # It holds the magnets and carries no field: for losses of iron it is insulation that turns.
        yield Part("rotor.sleeve", "carbon-fibre", (prism,), role=Role.INSULATION, turns=True)
    if bars := extrude(_around(outlines["bars"]), at.iron0, at.iron1):
        top = max(radii(outlines["bars"]))
        ring = shapes.ring(top - g.rotor.ring, top)
        yield Part("rotor.cage", "aluminium-cast", (*bars, (ring, *left), (ring, *right)), role=Role.CAGE)
    if outlines["coils"]:
        reach = radii(outlines["coils"])
        ring, filling = _end_turns(min(reach), max(reach)), (g.rotor.fill, g.winding.impregnation)
        coils = extrude(_around(outlines["coils"]), at.iron0, at.iron1)
        yield Part("winding.field", "winding", coils, filling, role=Role.WINDING, turns=True)
        for end, span in (("left", left), ("right", right)):
            name = f"winding.field.{end}"
            yield Part(name, "end-winding", ((ring, *span),), filling, role=Role.WINDING, turns=True)


def _stator(g: Geometry, at: _Places) -> tuple[Part, ...]:
    outlines = at.outlines
    if not outlines["wires"]:
        return stator(g, at)
    vents = tuple(profile.outer for profile in _around(outlines["vents"]))
    core = Profile(shapes.circle_loop(at.core), (notched_loop(at.bore, outlines["slots"]), *vents))
    wires, w, ring = _around(outlines["wires"]), g.winding, _end_turns(at.wire0, at.wire1)
    loose = (w.end_fill, w.end_impregnation)
    left = (*extrude(wires, at.coil0, at.core0), (ring, at.ring0, at.coil0))
    right = (*extrude(wires, at.core1, at.coil1), (ring, at.coil1, at.ring1))
    filling = (w.fill, w.impregnation)
    return (
        Part("stator.core", "electrical-steel", ((core, at.core0, at.core1),), role=Role.IRON),
        Part("winding", "winding", extrude(wires, at.core0, at.core1), filling, role=Role.WINDING),
        Part("winding.left", "end-winding", left, loose, role=Role.WINDING),
        Part("winding.right", "end-winding", right, loose, role=Role.WINDING),
    )


def _fluids(g: Geometry, at: _Places) -> tuple[Part, ...]:
    """Holes through the iron and room under a sleeve have air of their own; the gap takes what slots and the rotor's
    surface leave."""
    whole, low, high = shapes.disc(at.core), min(at.core0, at.iron0), max(at.core1, at.iron1)
    gap = [(shapes.ring(at.rotor, at.mouth), low, high)]
    if at.valley < at.rotor and not g.rotor.sleeve:
        gap.append((shapes.ring(at.valley, at.rotor), at.iron0, at.iron1))
    # Is there a hole through the iron, or room under a sleeve, that no magnet fills?
    outlines = at.outlines
    holes, magnets, *others = (
        sum(p.area for p in _around(outlines[name])) for name in ("pockets", "magnets", "bars", "coils")
    )
    buried = max(radii(outlines["magnets"]), default=0.0) < at.surface
    iron = Profile(notched_loop(at.surface, outlines["notches"])).area - holes
    under = math.pi * at.shell**2 - iron - magnets - sum(others)
    covered = bool(g.rotor.sleeve) and under > 1e-7
    return (
        fluid("airgap", *gap, role=Role.AIR_GAP),
        fluid("air.left", (whole, at.cap0, max(at.core0, at.iron0))),
        fluid("air.right", (whole, min(at.core1, at.iron1), at.cap1)),
        *coolant(g, at),
        *([fluid("air.inside")] if (bool(outlines["vents"]) or covered or holes > magnets * buried + 1e-7) else []),
    )


_DOC = "Radial-flux machine with a drawn cross-section: any slots, magnets, barriers, cage or wound rotor, as outlines"
CROSS_SECTION = Family("cross-section", _DOC, PARAMETERS, build_section, FACES, ports, parameters.features, NAMES)
