"""Exact solids: the same volumes as the formulas, watertight surfaces, exports that come back."""

import math

import pytest

from geom import check_cad, export_cad
from geom.description import shapes
from geom.description.machine import Machine
from geom.description.part import Part
from geom.solids.cad import solids


@pytest.fixture(scope="module")
def checks(motor):
    return check_cad(motor)


def test_every_surface_is_watertight(checks):
    assert [check.part for check in checks if not check.watertight] == []


def test_solids_have_the_volume_of_the_formula(checks):
    for check in checks:
        assert check.solid_volume == pytest.approx(check.volume, rel=1e-9), check.part


def test_stacked_prisms_become_one_solid():
    part = Part("bolt", "steel", ((shapes.disc(0.01), 0.0, 0.02), (shapes.disc(0.005), 0.02, 0.05)))
    (bolt,) = solids(part)
    assert bolt.Volume() == pytest.approx(math.pi * (0.01**2 * 0.02 + 0.005**2 * 0.03) * 1e9)


@pytest.fixture(scope="module")
def small():
    parts = (
        Part("rod", "steel", ((shapes.disc(0.01), 0.0, 0.1),)),
        Part("sleeve.left", "copper", ((shapes.ring(0.01, 0.02), 0.0, 0.04),)),
    )
    return Machine("small", "none", "", parts, (), {}, None, {})


def test_step_comes_back_with_names_and_volumes(small, tmp_path):
    import cadquery as cq

    path = export_cad(small, tmp_path, ("step",))["step"]
    back = cq.Assembly.load(str(path))
    found = {name.split("/")[-1]: node for name, node in back.objects.items() if node.obj is not None}
    for part in small.parts:
        volume = sum(shape.Volume() for shape in found[part.name].shapes)
        assert volume * 1e-9 == pytest.approx(part.volume, rel=1e-6)


def test_stl_comes_back_watertight(small, tmp_path):
    import trimesh

    written = export_cad(small, tmp_path, ("stl",))
    for part in small.parts:
        mesh = trimesh.load(written[f"stl:{part.name}"])
        assert mesh.is_watertight
        assert mesh.volume * 1e-9 == pytest.approx(part.volume, rel=0.01)


def test_glb_comes_back_with_names_in_metres_and_upright(small, tmp_path):
    """glTF: metres, y upwards; a rod of 100 mm along z, in a sleeve of 20 mm radius."""
    import trimesh

    scene = trimesh.load(export_cad(small, tmp_path, ("glb",))["glb"])
    assert {part.name for part in small.parts} < set(scene.graph.nodes)
    assert sorted(scene.extents) == pytest.approx([0.04, 0.04, 0.1], rel=0.01)
    assert scene.bounds[1] == pytest.approx([0.02, 0.1, 0.02], rel=0.01)
