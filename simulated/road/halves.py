"""The truth's mesh: the stator whole, the rotor as one slot pitch.

The rotor turns, so each of its slots meets the same air and the same mean bearing: one pitch between two planes that
no heat crosses stands for all. It leaves unknowns enough to mesh both finely.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from geom import build_mesh
from geom.description import shapes
from geom.description.machine import Machine
from geom.description.part import Part, Prism, fluid
from geom.description.profile import Loop, Profile, Vertex
from geom.meshing.mesh import Contact, NamedMesh, Patch

ROTOR: tuple[str, ...] = ("shaft", "rotor.core", "slot.liner", "winding.armature")
ROTOR += ("winding.armature.left", "winding.armature.right", "commutator")
JOINTS = (("bearing.left", "shaft"), ("bearing.right", "shaft"))


@dataclass(frozen=True)
class TwoHalves:
    """One mesh of both, not joined; copies : how often each part's piece counts; joints : pairs of touching patches."""

    mesh: NamedMesh
    copies: Mapping[str, int]
    joints: Mapping[str, tuple[Patch, Patch]]


def build(machine: Machine, stator_m: float, rotor_m: float, segments: int = 60) -> TwoHalves:
    """Mesh the stator with triangles of `stator_m` and the rotor's slot pitch with triangles of `rotor_m` (m)."""
    slots = machine.geometry.rotor.slots
    still = build_mesh(stator(machine), stator_m, segments)
    turning = without_cuts(build_mesh(one_slot(machine), rotor_m, 3 * segments, 2 * rotor_m), math.pi / slots)
    both = _together(still, turning)
    joints = {f"{a}|{b}": (both.patches[f"{a}.{b}"], both.patches[f"{b}.{a}"]) for a, b in JOINTS}
    inner = {f"{a}.{b}" for pair in JOINTS for a, b in (pair, pair[::-1])}
    patches = {name: patch for name, patch in both.patches.items() if name not in inner}
    return TwoHalves(
        replace(both, patches=patches), {part: slots if part in ROTOR else 1 for part in both.parts}, joints
    )


def stator(machine: Machine) -> Machine:
    """All that stands still; the shaft leaves a space of its name."""
    parts = tuple(part for part in machine.parts if part.name not in ROTOR)
    g = machine.geometry
    shaft = fluid("shaft", (shapes.disc(g.shaft.bearing_diameter / 2), 0.0, g.shaft.length))
    core = machine.part("rotor.core").span
    return replace(machine, parts=parts, fluids=(shaft, *machine.fluids, _hollow(machine, core)))


def one_slot(machine: Machine) -> Machine:
    """One slot pitch of all that turns, around the slot at angle 0; the bearings leave spaces of their names."""
    whole = [part for part in machine.parts if part.name in ROTOR]
    radii = _radii(whole)
    parts = tuple(replace(part, prisms=_pitch(machine, part, radii)) for part in whole)
    bearings = tuple(replace(part, solid=False) for part in machine.parts if part.name.startswith("bearing"))
    core = machine.part("rotor.core").span
    return replace(machine, parts=parts, fluids=(*bearings, *machine.fluids, _hollow(machine, core)))


def _hollow(machine: Machine, span: tuple[float, float]) -> Part:
    return fluid("rest", (shapes.disc(machine.geometry.rotor.outer_diameter / 2), *span))


def _pitch(machine: Machine, part: Part, radii: list[float]) -> tuple[Prism, ...]:
    half = math.pi / machine.geometry.rotor.slots
    pieces = ((_piece(profile, half, radii), z0, z1) for profile, z0, z1 in part.prisms)
    return tuple((piece, z0, z1) for piece, z0, z1 in pieces if piece is not None)


def _piece(profile: Profile, half: float, radii: list[float]) -> Profile | None:
    """The part of a disc, of a ring, of a slotted ring or of a bundle of slots that lies within the pitch."""
    if len(profile.outer) == 2:
        return Profile(_pie(_inner(profile), profile.outer[0][0], half, radii))
    if _is_round(profile):
        return Profile(_slotted(profile, half, radii))
    x, y = np.mean([vertex[:2] for vertex in profile.outer], axis=0)
    return profile if abs(math.atan2(y, x)) < half else None


def _inner(profile: Profile) -> float:
    return profile.holes[0][0][0] if profile.holes else 0.0


def _radii(parts: Iterable[Part]) -> list[float]:
    """All radii at which a ring begins or ends: the sides of every sector pass through the same points."""
    profiles = [profile for part in parts for profile, _, _ in part.prisms]
    outer = {p.outer[0][0] for p in profiles if len(p.outer) == 2}
    return sorted(outer | {_inner(p) for p in profiles if _is_round(p)})


def _is_round(profile: Profile) -> bool:
    return bool(profile.holes) and len(profile.holes[0]) == 2


def _sides(inner: float, outer: float, half: float, radii: list[float]) -> tuple[list[Vertex], list[Vertex]]:
    """Both sides of a sector: outwards at -half, inwards at +half, ends included."""
    along = [inner, *(r for r in radii if inner + 1e-6 < r < outer - 1e-6), outer]
    return [shapes.polar(r, -half) for r in along], [shapes.polar(r, half) for r in reversed(along)]


def _with_bulge(vertices: list[Vertex], bulge: float) -> list[Vertex]:
    """The same vertices, an arc leaving the last."""
    x, y, _ = vertices[-1]
    return [*vertices[:-1], (x, y, bulge)]


def _pie(inner: float, outer: float, half: float, radii: list[float]) -> Loop:
    low, high = _sides(inner, outer, half, radii)
    bulge = shapes.bulge_of(2 * half)
    if not inner:
        return (*_with_bulge(low, bulge), *high[:-1])
    return (*_with_bulge(low, bulge), *_with_bulge(high, -bulge))


def _slotted(lamination: Profile, half: float, radii: list[float]) -> Loop:
    """The lamination around the slot at angle 0: the slot's corners, and the arcs and sides that close the pitch."""
    inside = [abs(math.atan2(y, x)) < half for x, y, _ in lamination.outer]
    first = next(i for i, within in enumerate(inside) if within and not inside[i - 1])
    slot = [(lamination.outer * 2)[first + i] for i in range(sum(inside))]
    (x0, y0, _), (x1, y1, _) = slot[0], slot[-1]
    low, high = _sides(_inner(lamination), math.hypot(x0, y0), half, radii)
    tooth = shapes.bulge_of(half + math.atan2(y0, x0)), shapes.bulge_of(half - math.atan2(y1, x1))
    closing = _with_bulge(high, -shapes.bulge_of(2 * half))
    return (*_with_bulge(low, tooth[0]), *_with_bulge(slot, tooth[1]), *closing)


def without_cuts(mesh: NamedMesh, half: float) -> NamedMesh:
    """The mesh without the outer facets that lie in the two planes of the cut."""
    x, y, _ = mesh.points.T
    in_cut = np.abs(np.abs(np.arctan2(y, x)) - half) * np.hypot(x, y) < 1e-6
    in_cut |= np.hypot(x, y) < 1e-9
    kept = {name: replace(p, facets=p.facets[~in_cut[p.facets].all(axis=1)]) for name, p in mesh.patches.items()}
    return replace(mesh, patches={name: patch for name, patch in kept.items() if len(patch.facets)})


def _together(a: NamedMesh, b: NamedMesh) -> NamedMesh:
    move, more = len(a.points), len(a.parts)
    patches = {name: Patch(p.part, p.fluid, p.facets + move) for name, p in b.patches.items()}
    contacts = {name: Contact(c.a, c.b, c.facets + move) for name, c in b.contacts.items()}
    points, tets = np.concatenate([a.points, b.points]), np.concatenate([a.tets, b.tets + move])
    region, parts = np.concatenate([a.region, b.region + more]), (*a.parts, *b.parts)
    return NamedMesh(points, tets, region, parts, {**a.patches, **patches}, {**a.contacts, **contacts})
