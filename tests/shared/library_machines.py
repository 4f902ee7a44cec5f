"""Machines of the library that are meshed in another way each, and points inside the parts of a machine."""

import shapely

from geom import library
from geom.description.profile import ArcGrid

# what is left out has the same parts in other lengths: it is on the bases of M1, which are there
ALIKE = {"pmsm-m2-no-base", "pmsm-m2-plate", "pmsm-m3-no-base", "pmsm-m3-plate"}
DISTINCT = [name for name in library() if name not in ALIKE]


def point_in(machine, name):
    """A point (m) well inside the part: in the plane inside its largest prism, at half its length."""
    profile, z0, z1 = max(machine.part(name).prisms, key=lambda prism: prism[0].area * (prism[2] - prism[1]))
    inside = shapely.maximum_inscribed_circle(profile.to_polygon(ArcGrid([profile], 72)))
    return float(inside.coords[0][0]), float(inside.coords[0][1]), (z0 + z1) / 2
