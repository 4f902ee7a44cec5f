"""Machines with a slotted stator around a round rotor: interior magnets, or a cage.

The axis is z, the shaft extension is on the right (high z), the base lies at -y.
"""

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


def build_pmsm(g: Geometry) -> tuple[Part, ...]:
    """Solids and fluids of a machine with interior magnets. Raises InputError for parts that do not fit."""
    at = Layout(g)
    check(g, at)
    check_magnets(g, at)
    return (shaft(g, at), *magnet_rotor(g, at), *stator(g, at), *enclosure(g, at), *_fan(g, at), *_fluids(g, at))


def build_tefc(g: Geometry) -> tuple[Part, ...]:
    """Solids and fluids of a totally enclosed cage machine. Raises InputError for parts that do not fit."""
    at = Layout(g)
    check(g, at)
    check_cage(g, at)
    return (shaft(g, at), *cage_rotor(g, at), *stator(g, at), *enclosure(g, at), *_fan(g, at), *_fluids(g, at))


def _fan(g: Geometry, at: Layout) -> tuple[Part, ...]:
    return shaft_fan(g.fan, g.shaft.diameter / 2, at.cowl0, 0.0)


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
PMSM = Family("pmsm", _PMSM, _WITH_MAGNETS, build_pmsm, FACES, ports, parameters.features)
TEFC = Family("tefc", _TEFC, parameters.TEFC, build_tefc, FACES, ports, parameters.features)
