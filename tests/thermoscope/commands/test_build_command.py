"""`thermoscope model build` on a small machine of every family, and on the STEP file that it wrote."""

import json
from dataclasses import replace

import pytest
from PIL import Image

from geom import Machine, export_cad, load_machine, read_vtu
from geom.machine_file import machine_from
from lumped.build.pipeline import build as pipeline
from lumped.condensation.reduction import Recipe
from thermoscope.commands.model import build as command

pytestmark = pytest.mark.heavy

# Of any accuracy: what `build` writes and that it closes its balance is the point.
TINY = Recipe(tolerance=0.3, shifts=(), random_points=1, local_points=1, local_states=1, max_states=40)
FEW = {
    "series-dc-100kw": {"rotor": {"slots": 12}, "housing": {"fins": 8}},
    "pmsm-m1": {"stator": {"slots": 9, "liner_gap_mm": 0.5}, "rotor": {"poles": 6}},
    "tefc-industrial": {"stator": {"slots": 9, "tooth_mm": 20.0}, "rotor": {"bars": 9}, "housing": {"fins": 6}},
}


def small(name: str) -> Machine:
    """A machine of the library with few slots, and everything its file says besides geometry."""
    machine = load_machine(name)
    few = machine_from({"machine": {"family": machine.family}, "geometry": FEW[name]}, name)
    contacts = {"default": {"gap_mm": 0.02}}
    return replace(
        few,
        name="small",
        sections={
            **machine.sections,
            "contacts": contacts,
            "ratings": {**machine.sections["ratings"], "current_A": 5.0},
        },
    )


@pytest.fixture(scope="module")
def coarse(tmp_path_factory):
    """The command on a mesh for a quick test; "NAME" is a small machine of the library's family, files stay files."""
    usual = command.load_machine_file
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(tmp_path_factory.mktemp("cache")))
        patch.setattr("lumped.build.pipeline.wound", lambda machine, part: False)  # linear windings: a smaller field
        patch.setattr(command, "load_machine_file", lambda path: small(path.name) if path.name in FEW else usual(path))
        patch.setattr(command, "built_from", lambda m, accuracy, tell: (pipeline(m, 0.1, 36, TINY), None))
        pictures = command.pictures  # one family is enough
        drawn = lambda built, *rest: pictures(built, *rest) if built.machine.family != "series-dc" else []  # noqa: E731
        patch.setattr(command, "pictures", drawn)
        yield lambda machine, out, target: command.build_machine(machine, out, target, None)


@pytest.fixture(scope="module")
def solids_before(tmp_path_factory):
    """The threads of the CAD kernel run in this process, as after an earlier build: to fork it there would hang."""
    export_cad(small("pmsm-m1"), tmp_path_factory.mktemp("solids"))


@pytest.fixture(scope="module", params=FEW)
def built(request, coarse, tmp_path_factory, solids_before):
    """Machine, folder and document of the command."""
    folder = tmp_path_factory.mktemp("out")
    target = folder / "document.json"
    assert coarse(request.param, folder / "small", str(target)) == 0
    return small(request.param), folder / "small", json.loads(target.read_text())


def test_build_writes_solids_mesh_and_a_table_of_every_part(built):
    machine, folder, document = built
    assert [row["name"] for row in document["parts"]] == [part.name for part in machine.parts]
    for row in document["parts"]:
        part = machine.part(row["name"])
        assert row["watertight"], part.name
        assert row["mass_kg"] == pytest.approx(part.volume * machine.material_of(part.name).rho)
        assert row["mesh_volume_m3"] == pytest.approx(row["volume_m3"], rel=0.015), part.name
        assert row["solid_volume_m3"] == pytest.approx(row["volume_m3"], rel=0.01), part.name
        assert sum(row["faces_m2"].values()) + sum(row["contacts_m2"].values()) > 0
        assert (folder / f"{part.name}.stl").stat().st_size > 0
    for path in document["pictures"]:
        with Image.open(path) as picture:
            assert picture.size == (1280, 800)
    assert len(document["pictures"]) == (0 if machine.family == "series-dc" else 2)
    assert {"small.step", "small.step.toml", "small.glb", "small.vtu"} < {path.name for path in folder.iterdir()}
    assert read_vtu(folder / "small.vtu").parts == tuple(part.name for part in machine.parts)
    assert document["energy_balance"] < 1e-9


@pytest.mark.parametrize("built", ["pmsm-m1"], indirect=True)
def test_the_step_file_it_wrote_builds_too(built, coarse, tmp_path):
    """Same solids, masses and materials; the air inside is one space that the rotor stirs."""
    _, folder, document = built
    target = tmp_path / "again.json"
    assert coarse(str(folder / "small.step"), tmp_path / "again", str(target)) == 0
    again = json.loads(target.read_text())
    known = {row["name"]: row for row in document["parts"]}
    assert {row["name"] for row in again["parts"]} == set(known)
    for row in again["parts"]:
        assert row["material"] == known[row["name"]]["material"]
        assert row["mass_kg"] == pytest.approx(known[row["name"]]["mass_kg"], rel=1e-4)
        assert row["watertight"], row["name"]
    assert again["energy_balance"] < 1e-9
    assert any(name.endswith("air.inside") for row in again["parts"] for name in row["faces_m2"])
    rises = [part["fem_mean_C"] - 20.0 for part in again["crosscheck"]]
    assert 0.0 < min(rises) < max(rises) < 100.0, "100 W in the windings of a small machine"
