"""Points inside the parts of a machine."""

import shapely

from geom.description.profile import ArcGrid


def point_in(machine, name):
    """A point (m) well inside the part: in the plane inside its largest prism, at half its length."""
    profile, z0, z1 = max(machine.part(name).prisms, key=lambda prism: prism[0].area * (prism[2] - prism[1]))
    inside = shapely.maximum_inscribed_circle(profile.to_polygon(ArcGrid([profile], 72)))
    return float(inside.coords[0][0]), float(inside.coords[0][1]), (z0 + z1) / 2
