"""Series-wound DC traction motor: wound rotor with commutator, salient poles with field coils.

The axis is z, the commutator sits on the right (high z), the feet point to -y. The housing is finned, or has
one or two liquid jackets between the feet.
"""

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, fluid
from geom.description.roles import Role
from geom.families.family import Family
from geom.families.series_dc.checks import check
from geom.families.series_dc.commutator import brush_gear
from geom.families.series_dc.housing import coolant, enclosure, ports
from geom.families.series_dc.layout import Axial, Radii
from geom.families.series_dc.parameters import PARAMETERS, features
from geom.families.series_dc.rotor import rotor
from geom.families.series_dc.stator import stator
from geom.families.shaft_fan import shaft_fan


def build(g: Geometry) -> tuple[Part, ...]:
    """Solids and fluids of the machine. Raises InputError for parts that do not fit."""
    z = Axial(g)
    check(g, z)
    fan = shaft_fan(g.fan, g.shaft.bearing_diameter / 2, z.fan0, z.flange0)
    return (*rotor(g, z), *stator(g, z), *enclosure(g, z), *brush_gear(g, z), *fan, *_fluids(g, z))


def _fluids(g: Geometry, z: Axial) -> tuple[Part, ...]:
    r = Radii(g)
    hollow, core = shapes.disc(r.yoke1), shapes.disc(g.rotor.outer_diameter / 2)
    ducts = (fluid("air.ducts", (core, z.core0, z.core1)),) if g.rotor.ducts else ()
    cowl = (fluid("air.fan", (shapes.disc(g.fan.diameter / 2), z.fan0, z.flange0)),) if g.fan.depth else ()
    return (
        *cowl,
        fluid("air.left", (hollow, z.inner0, z.core0)),
        *ducts,
        fluid("airgap", (shapes.ring(r.rotor, r.bore), z.core0, z.core1), role=Role.AIR_GAP),
        fluid("air.interpolar", (shapes.ring(r.bore, r.yoke0), z.core0, z.core1)),
        fluid("air.right", (hollow, z.core1, z.inner1)),
        *coolant(g, z),
    )


_SIDES = ("jacket.left", "jacket.right")
_FACES = {
    ("housing", "ambient"): "housing.fins",
    **{("housing", side): f"{side}.wall" for side in _SIDES},
    **{(f"{side}.{end}.tube", side): f"{side}.{end}.bore" for side in _SIDES for end in ("inlet", "outlet")},
}
_DOC = "Series-wound DC traction motor with salient poles; housing with fins or liquid jackets"
FAMILY = Family("series-dc", _DOC, PARAMETERS, build, _FACES, ports, features)
