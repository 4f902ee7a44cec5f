"""STEP assemblies from elsewhere: sliced into the prisms they were made of, or refused by name."""

import math
import time

import cadquery as cq
import pytest
from measures import tet_volumes

from geom import COARSE, InputError, build_mesh, export_cad, import_step, load_machine, part_table
from geom.description import shapes
from geom.description.machine import Machine
from geom.description.part import Part
from geom.solids.slicing import sliced
from geom.solids.stack import stacked

R, L = 0.02, 0.1


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """A shipped machine as a STEP file with its materials beside it."""
    return export_cad(load_machine("pmsm-m1"), tmp_path_factory.mktemp("step"), ("step",))["step"]


@pytest.fixture(scope="module")
def imported(exported):
    return load_machine(exported)


def test_shipped_machine_comes_back_with_names_materials_and_volumes(imported):
    shipped = load_machine("pmsm-m1")
    assert imported.name == shipped.name
    assert [part.name for part in imported.parts] == [part.name for part in shipped.parts]
    for part in imported.parts:
        assert part.material == shipped.part(part.name).material
        assert part.identity == shipped.part(part.name).identity
        assert part.volume == pytest.approx(shipped.part(part.name).volume, rel=1e-9), part.name


def test_shipped_machine_comes_back_with_its_contacts(imported):
    back = {row.name: row for row in part_table(imported)}
    for row in part_table(load_machine("pmsm-m1")):
        assert back[row.name].contacts == pytest.approx(row.contacts, rel=1e-3), row.name
        assert back[row.name].film_area == pytest.approx(row.film_area, rel=1e-3), row.name


def test_imported_machine_meshes_and_its_closed_voids_are_air(imported):
    mesh = build_mesh(imported, **COARSE)
    volumes = tet_volumes(mesh)
    for index, name in enumerate(mesh.parts):
        assert volumes[mesh.region == index].sum() == pytest.approx(imported.part(name).volume, rel=0.01), name
    assert {patch.fluid for patch in mesh.patches.values()} == {"ambient", "air.inside"}


def test_bodies_cut_by_booleans_are_sliced():
    """A stepped shaft with a keyway and a cross made of two boxes: areas by hand."""
    shaft = cq.Workplane().circle(20).extrude(60).faces(">Z").workplane().circle(12).extrude(40)
    keyed = shaft.cut(cq.Workplane().box(6, 100, 30, centered=(True, False, False)).translate((0, 8, 70)))
    prisms = sliced(keyed.val(), "shaft")
    half = math.asin(3 / 12)
    slot = 2 * (12**2 * (half + math.sin(half) * math.cos(half)) / 2 - 3 * 8)  # between y = 8 and the circle
    assert [(round(z0, 9), round(z1, 9)) for _, z0, z1 in prisms] == [(0.0, 0.06), (0.06, 0.07), (0.07, 0.1)]
    assert prisms[0][0].area == pytest.approx(math.pi * 0.02**2)
    assert prisms[2][0].area == pytest.approx((math.pi * 12**2 - slot) * 1e-6)


def test_concentric_arcs_come_back_as_they_were():
    wire = shapes.sector(0.1, 0.14, 0.2, 0.5)
    ((profile, z0, z1),) = sliced(stacked([(wire, 0.0, 0.05)])[0], "wire")
    assert (z0, z1) == (0.0, 0.05)
    corners = {tuple(round(v, 9) for v in vertex) for vertex in profile.outer}
    assert corners == {tuple(round(v, 9) for v in vertex) for vertex in wire.outer}


def test_free_form_walls_are_faceted():
    ellipse = cq.Workplane().ellipse(30, 20).extrude(10).val()
    (prism,) = sliced(ellipse, "pad")
    assert prism[0].area == pytest.approx(math.pi * 0.03 * 0.02, rel=0.02)


NOT_PRISMATIC = {
    "cone": lambda: cq.Solid.makeCone(20, 10, 50),
    "plane": lambda: cq.Workplane().box(10, 10, 10).rotate((0, 0, 0), (1, 0, 0), 2).val(),
    "cylinder": lambda: cq.Workplane("YZ").circle(5).extrude(20).val(),
}


@pytest.mark.parametrize("kind", NOT_PRISMATIC)
def test_what_is_not_prismatic_is_refused_by_name_face_and_place(kind):
    with pytest.raises(InputError, match=rf"^thing: a {kind} face from z = .* mm is not prismatic along the axis"):
        sliced(NOT_PRISMATIC[kind](), "thing")


def write(path, **solids):
    whole = cq.Assembly(name="thing")
    for name, solid in solids.items():
        whole.add(solid, name=name.replace("_", "."))
    whole.export(str(path))
    return path


def rod():
    return cq.Solid.makeCylinder(20, 100)


def sleeve():
    return cq.Workplane().circle(30).circle(20).extrude(40).val()


def test_file_beside_gives_materials_fluids_axis_and_sections(tmp_path):
    solids = {
        "rod": rod(),
        "winding_a": sleeve(),
        "oil": sleeve().moved(cq.Location(cq.Vector(0, 0, 40))),
        "bolt": rod(),
    }
    turned = {name: solid.rotate((0, 0, 0), (0, 1, 0), 90) for name, solid in solids.items()}
    path = write(tmp_path / "turned.step", **turned)
    (tmp_path / "turned.step.toml").write_text(
        '[machine]\nname = "mine"\n[import]\naxis = "x"\nleave_out = ["bolt*"]\n'
        '[materials]\nrod = { like = "steel", k = 43.0 }\n"winding*" = "copper"\n'
        '[fluids]\noil = "glycol-50"\n[ratings]\ncurrent_A = 3.0\n'
    )
    machine = import_step(path)
    assert machine.name == "mine"
    assert {part.name: part.material for part in machine.parts} == {"rod": "steel", "winding.a": "copper"}
    assert machine.material_of("rod").k_plane == 43.0
    assert machine.part("rod").span == (0.0, pytest.approx(0.1))
    assert machine.part("oil").material == "glycol-50"
    assert machine.sections["ratings"] == {"current_A": 3.0}
    assert "rod.oil" in build_mesh(machine, **COARSE).patches


WRONG = {
    "a solid without material": ("", ["rod", "[materials]"]),
    "a solid that is not there": ('[materials]\nrod = "steel"\nrood = "steel"', ["rood", "rod"]),
    "a key nobody knows": ("[import]\naxes = 1", ["axes", "axis"]),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_file_beside_is_one_message(case, tmp_path):
    text, words = WRONG[case]
    path = write(tmp_path / "a.step", rod=rod())
    (tmp_path / "a.step.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        import_step(path)
    for word in words:
        assert word in str(caught.value)


def test_files_that_are_no_assemblies_are_refused(tmp_path, capfd):
    (tmp_path / "a.step").write_text("hello")
    cq.exporters.export(cq.Workplane().box(1, 1, 1), str(tmp_path / "b.step"))
    for name in ("a.step", "b.step", "c.step"):
        with pytest.raises(InputError, match=name):
            import_step(tmp_path / name)
    assert capfd.readouterr().out == ""


def test_a_file_that_takes_too_long_is_left(exported, monkeypatch):
    """Its reader takes longer than a second on any computer, and is ended."""
    monkeypatch.setenv("THERMOSCOPE_MOST_SECONDS", "1")
    began = time.monotonic()
    with pytest.raises(InputError, match=r"was read for .* the limit 'seconds', raised by THERMOSCOPE_MOST_SECONDS=10"):
        import_step(exported)
    assert time.monotonic() - began < 2.0


@pytest.mark.parametrize("breaks", [r"raise SystemExit(3)", r"import os; os.kill(os.getpid(), 11)"])
def test_a_reader_that_dies_is_one_message(exported, monkeypatch, tmp_path, breaks):
    (tmp_path / "cadquery.py").write_text(breaks)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match="not readable: its reader ended"):
        import_step(exported)


def test_same_name_twice_is_one_part(tmp_path):
    inner = cq.Assembly(name="left").add(rod(), name="pin")
    outer = cq.Assembly(name="right").add(rod().moved(cq.Location(cq.Vector(100, 0, 0))), name="pin")
    cq.Assembly(name="all").add(inner).add(outer).export(str(tmp_path / "a.step"))
    (tmp_path / "a.step.toml").write_text('[materials]\npin = "steel"')
    (pin,) = import_step(tmp_path / "a.step").parts
    assert pin.volume == pytest.approx(2 * math.pi * R**2 * L)


def test_a_role_that_is_none_is_one_message(tmp_path):
    small = Machine("small", "none", "", (Part("shaft", "steel", ((shapes.disc(R), 0.0, L),)),), (), {}, None, {})
    path = export_cad(small, tmp_path, ("step",))["step"]
    beside = path.with_name(f"{path.name}.toml")
    beside.write_text(beside.read_text() + '[roles]\nshaft = "axle"\n')
    with pytest.raises(InputError, match="one of winding"):
        import_step(path)
