"""Meshes of the motor and of every other machine: conformal, completely named, and true to the exact geometry."""

import math

import numpy as np
import pytest
from library_machines import DISTINCT
from measures import area, facets_of_tets, keys, tet_volumes

from geom import COARSE, build_mesh, load_machine, part_table
from geom.description.profile import ArcGrid, Profile
from geom.description.shapes import circle_loop

MOTOR = "series-dc-100kw"
MACHINES = [MOTOR, *(pytest.param(name, marks=pytest.mark.nightly) for name in DISTINCT if name != MOTOR)]


@pytest.fixture(scope="module", params=MACHINES)
def meshed(request, motor, motor_mesh):
    """A machine and its coarse mesh: the motor's every time, the other machines' at night."""
    if request.param == MOTOR:
        return motor, motor_mesh
    machine = load_machine(request.param)
    return machine, build_mesh(machine, **COARSE)


def test_facets_are_shared_by_two_or_named_once(meshed):
    _, mesh = meshed
    facets, counts = np.unique(facets_of_tets(mesh)[0], return_counts=True)
    named = np.concatenate([keys(mesh, patch.facets) for patch in mesh.patches.values()])
    assert counts.max() == 2
    assert np.array_equal(np.sort(named), facets[counts == 1])


def test_volumes_are_within_one_per_cent(meshed):
    machine, mesh = meshed
    volumes = tet_volumes(mesh)
    assert volumes.min() > 0
    for index, name in enumerate(mesh.parts):
        assert volumes[mesh.region == index].sum() == pytest.approx(machine.part(name).volume, rel=0.01), name


def test_areas_are_within_two_per_cent_of_the_description(meshed):
    machine, mesh = meshed
    rows = part_table(machine, segments=96)
    contacts = {"|".join(sorted((row.name, other))): a for row in rows for other, a in row.contacts.items()}
    faces = {name: a for row in rows for name, a in row.faces.items()}
    for found, exact in ((mesh.contacts, contacts), (mesh.patches, faces)):
        assert found.keys() == exact.keys()
        for name in found:
            assert area(mesh, found[name].facets) == pytest.approx(exact[name], rel=0.02), name


def test_all_parts_hang_together(meshed):
    _, mesh = meshed
    reached = {mesh.parts[0]}
    for _ in mesh.parts:
        reached |= {name for c in mesh.contacts.values() if {c.a, c.b} & reached for name in (c.a, c.b)}
    assert reached == set(mesh.parts)


def test_every_facet_between_two_parts_has_exactly_one_contact(motor_mesh):
    key, region = facets_of_tets(motor_mesh)
    order = np.argsort(key, kind="stable")
    key, region = key[order], region[order]
    between = (key[1:] == key[:-1]) & (region[1:] != region[:-1])
    named = np.concatenate([keys(motor_mesh, contact.facets) for contact in motor_mesh.contacts.values()])
    assert np.array_equal(np.sort(named), key[1:][between])


def test_patch_facets_belong_to_the_part_they_name(motor_mesh):
    key, region = facets_of_tets(motor_mesh)
    owner = dict(zip(key.tolist(), region.tolist()))
    for patch in motor_mesh.patches.values():
        assert {owner[k] for k in keys(motor_mesh, patch.facets).tolist()} == {motor_mesh.parts.index(patch.part)}


def test_contact_areas_follow_from_radii_and_lengths(motor, motor_mesh):
    g = motor.geometry
    expected = {
        "rotor.core|shaft": math.pi * g.shaft.core_diameter * g.rotor.stack_length,
        "housing|yoke": math.pi
        * (g.stator.yoke_inner_diameter + 2 * g.stator.yoke_thickness)
        * (g.rotor.stack_length + 2 * g.stator.yoke_overhang),
        "bearing.left|flange.left": math.pi * g.bearing.outer_diameter * g.flange.thickness,
        "bearing.right|shaft": math.pi * g.shaft.bearing_diameter * g.flange.thickness,
        "base|feet": 4 * g.feet.width * g.feet.length,
        # two sides and two end caps on each of four poles
        "field.insulation|poles": 8 * g.field.coil_height * (g.rotor.stack_length + g.stator.body_width),
    }
    for name, exact in expected.items():
        assert area(motor_mesh, motor_mesh.contacts[name].facets) == pytest.approx(exact, rel=0.02), name


def test_volume_error_falls_with_the_square_of_the_chord(motor):
    """An inscribed n-gon loses (2 pi / n)^2 / 6 of the circle."""
    shaft = motor.part("shaft").volume
    errors = []
    for segments in (36, 72):
        mesh = build_mesh(motor, size_m=0.06, segments=segments, across=1)
        inside = mesh.region == mesh.parts.index("shaft")
        errors.append(1 - tet_volumes(mesh)[inside].sum() / shaft)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.02)


def test_cached_mesh_is_the_same_and_follows_the_content(motor, tmp_path, monkeypatch):
    first = build_mesh(motor, size_m=0.08, segments=36, across=1, cache=tmp_path)
    monkeypatch.setattr("geom.meshing.mesher.partition", None)
    again = build_mesh(motor, size_m=0.08, segments=36, across=1, cache=tmp_path)
    assert np.array_equal(first.points, again.points)
    assert np.array_equal(first.tets, again.tets)
    assert first.patches.keys() == again.patches.keys()
    with pytest.raises(TypeError):
        build_mesh(motor, size_m=0.08, segments=37, across=1, cache=tmp_path)


def test_machine_without_fins_or_with_ducts_meshes_too():
    from geom.machine_file import machine_from

    geometry = {"housing": {"fins": 0}, "rotor": {"ducts": 8, "duct_diameter_mm": 16.0}}
    table = {"machine": {"family": "series-dc"}, "geometry": geometry}
    mesh = build_mesh(machine_from(table), size_m=0.08, segments=36, across=1)
    ducts = area(mesh, mesh.patches["rotor.core.air.ducts"].facets)
    assert ducts == pytest.approx(8 * math.pi * 0.016 * 0.2, rel=0.01)


@pytest.mark.parametrize("segments", [12, 36, 48])
def test_chords_leave_the_bridge_over_a_magnet_in_the_iron(segments):
    """A chord of 36 a turn lies 0.4 mm under a circle of 100 mm: deeper than a bridge of 0.2 mm."""
    x = math.sqrt(99.8e-3**2 - 20e-3**2)
    magnet = ((x - 2e-3, -20e-3, 0.0), (x, -20e-3, 0.0), (x, 20e-3, 0.0), (x - 2e-3, 20e-3, 0.0))
    core = Profile(circle_loop(100e-3), (magnet,))
    polygon = core.to_polygon(ArcGrid([core, Profile(magnet)], segments))
    corners = np.array(magnet)[1:3, :2]
    assert polygon.is_valid
    outer = np.array(polygon.exterior.coords)
    for corner in corners:
        a, b = outer[:-1], outer[1:]
        n = np.column_stack([(b - a)[:, 1], (a - b)[:, 0]])
        distance = np.abs(((corner - a) * n).sum(axis=1) / np.linalg.norm(n, axis=1)).min()
        assert distance > 0.1e-3


def test_layers_become_thinner_towards_the_ends_of_a_part_that_is_named_alone():
    """By four for each time it is named; levels beside another part stay as they are."""
    machine = load_machine("pmsm-m1-no-base")
    usual, thin = (build_mesh(machine, 0.2, 24, 0.25, 0.24, ends=ends) for ends in ((), ("stator.core",) * 2))
    z0, z1 = machine.part("stator.core").span

    def levels(mesh, part):
        return np.unique(mesh.points[np.unique(mesh.tets[mesh.region == mesh.parts.index(part)]), 2])

    height = np.diff(levels(usual, "stator.core"))[0]
    inner = [z0 + height / 16, z0 + height / 4, z1 - height / 4, z1 - height / 16]
    assert set(np.round(inner, 6)) <= set(np.round(levels(thin, "stator.core"), 6))
    assert levels(thin, "rotor.core") == pytest.approx(levels(usual, "rotor.core"))
    assert tet_volumes(thin).min() > 0
    assert tet_volumes(thin).sum() == pytest.approx(tet_volumes(usual).sum(), rel=1e-9)
