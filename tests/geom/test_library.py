"""Every machine that comes with the tool: meshes conformally, completely named, true to its volumes."""

import math

import numpy as np
import pytest
from measures import area, facets_of_tets, keys, tet_volumes

from geom import COARSE, InputError, build_mesh, check_cad, library, load_machine
from geom.machine import machine_from

OTHERS = [name for name in library() if name != "series-dc-100kw"]  # that one has a file of its own


@pytest.fixture(scope="module", params=OTHERS)
def meshed(request):
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


def test_all_parts_hang_together(meshed):
    _, mesh = meshed
    reached = {mesh.parts[0]}
    for _ in mesh.parts:
        reached |= {name for c in mesh.contacts.values() if {c.a, c.b} & reached for name in (c.a, c.b)}
    assert reached == set(mesh.parts)


@pytest.mark.parametrize("name", ["pmsm-m1", "ipmsm-48s8p-jacket", "tefc-industrial-radial"])
def test_solids_are_watertight_and_have_the_formulas_volume(name):
    for check in check_cad(load_machine(name)):
        assert check.watertight, check.part
        assert check.solid_volume == pytest.approx(check.volume, rel=1e-9), check.part


def test_published_dimensions_of_the_leaf_class_machine():
    g = load_machine("ipmsm-48s8p-jacket").geometry
    wall = g.housing.thickness + g.housing.channel + g.housing.wall
    assert (g.stator.slots, g.rotor.poles) == (48, 8)
    assert g.stator.outer_diameter + 2 * wall == pytest.approx(0.250)
    assert g.winding.straight + g.winding.end == pytest.approx(0.030)


@pytest.mark.parametrize(
    ("name", "slots", "length", "gap"), [("m1", 18, 0.29, 1.4), ("m2", 48, 0.29, 0.7), ("m3", 48, 0.465, 1.0)]
)
def test_machines_of_the_table(name, slots, length, gap):
    for variant in ("", "-no-base", "-plate"):
        g = load_machine(f"pmsm-{name}{variant}").geometry
        assert (g.stator.slots, g.rotor.poles, g.frame.length) == (slots, 16, pytest.approx(length))
        assert g.stator.liner_gap == pytest.approx(gap * 1e-3)


def test_stack_touches_the_housing_over_its_whole_cylinder():
    machine = load_machine("tefc-industrial")
    mesh = build_mesh(machine, **COARSE)
    g = machine.geometry.stator
    exact = math.pi * g.outer_diameter * g.stack_length
    assert area(mesh, mesh.contacts["housing|stator.core"].facets) == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize(
    ("geometry", "words"),
    [
        ({"housing": {"kind": "axial-fins", "fins": 200, "fin_thickness_mm": 5.0}}, ["fin_thickness_mm", "overlap"]),
        ({"stator": {"tooth_mm": 40.0}}, ["tooth_mm", "40", "less than"]),
        ({"stator": {"liner_gap_mm": 5.0, "slots": 48, "tooth_mm": 5.0}}, ["tooth_mm"]),
        ({"rotor": {"magnet_width_mm": 60.0}}, ["magnet_width_mm", "pole pitch"]),
        ({"rotor": {"magnet_thickness_mm": 60.0}}, ["magnet_thickness_mm", "shaft"]),
        ({"frame": {"length_mm": 200.0}}, ["length_mm", "200"]),
        ({"base": {"kind": "plate", "width_mm": 50.0}}, ["width_mm", "foot"]),
    ],
)
def test_impossible_magnet_machines_are_refused(geometry, words):
    with pytest.raises(InputError) as caught:
        machine_from({"machine": {"family": "pmsm"}, "geometry": geometry})
    for word in words:
        assert word in str(caught.value)
