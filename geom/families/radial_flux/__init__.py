"""Machines with a slotted stator around a round rotor: interior magnets, or a cage.

The axis is z, the shaft extension is on the right (high z), the base lies at -y.
"""

from collections.abc import Callable
from functools import partial

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, fluid
from geom.description.roles import Role
from geom.families.family import Family
from geom.families.radial_flux import parameters
from geom.families.radial_flux.checks import check, check_cage, check_magnets
from geom.families.radial_flux.housing import FACES, coolant, enclosure, ports
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.rotors import cage_rotor, magnet_rotor, shaft
from geom.families.radial_flux.stator import stator
from geom.families.shaft_fan import shaft_fan

Rotor = Callable[[Geometry, Layout], tuple[Part, ...]]


def _build(check_rotor: Callable[[Geometry, Layout], None], rotor: Rotor, g: Geometry) -> tuple[Part, ...]:
    """Solids and fluids of a machine with such a rotor. Raises InputError for parts that do not fit."""
    at = Layout(g)
    check(g, at)
    check_rotor(g, at)
    fan = shaft_fan(g.fan, g.shaft.diameter / 2, at.cowl0, 0.0)
    return (shaft(g, at), *rotor(g, at), *stator(g, at), *enclosure(g, at), *fan, *_fluids(g, at))


def _fluids(g: Geometry, at: Layout) -> tuple[Part, ...]:
    inside = shapes.disc(at.core)
    return (
        fluid("air.left", (inside, at.cap0, at.core0)),
        fluid("airgap", (shapes.ring(at.rotor, at.slot0), at.core0, at.core1), role=Role.AIR_GAP),
        fluid("air.right", (inside, at.core1, at.cap1)),
        *coolant(g, at),
    )


_PMSM = "Permanent-magnet machine with interior magnets; open laminations, housing or spiral jacket"
_TEFC = "Totally enclosed cage machine with axial or radial fins"
_WITH_MAGNETS = (*parameters.COMMON, *parameters.MAGNETS, *parameters.FAN)
PMSM = Family(
    "pmsm", _PMSM, _WITH_MAGNETS, partial(_build, check_magnets, magnet_rotor), FACES, ports, parameters.features
)
TEFC = Family(
    "tefc", _TEFC, parameters.TEFC, partial(_build, check_cage, cage_rotor), FACES, ports, parameters.features
)
