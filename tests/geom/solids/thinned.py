"""A machine with one of each kind of prism: the 48th slot liner adds work to a CAD kernel, but nothing to a test."""

import math
from dataclasses import replace


def thinned(machine):
    return replace(machine, parts=tuple(_thin(part) for part in machine.parts))


def _thin(part):
    return part if part.cad_shape else replace(part, prisms=_distinct(part.prisms))


def _distinct(prisms):
    found = {}
    for profile, z0, z1 in prisms:
        x, y, _ = profile.outer[0]
        facing = profile.rotated(-math.atan2(y, x))
        shape = tuple(tuple(tuple(round(v, 7) + 0.0 for v in vertex) for vertex in loop) for loop in facing.loops)
        found.setdefault((shape, round(z1 - z0, 7)), (profile, z0, z1))
    return tuple(found.values())
