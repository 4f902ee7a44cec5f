"""Every solid of every machine, once: watertight, and back from STEP, STL and GLB with its name and volume."""

import cadquery as cq
import pytest
import trimesh
from thinned import thinned

from geom import check_cad, export_cad, library, load_machine
from geom.solids.cad import solids

pytestmark = pytest.mark.nightly


def only_new_parts():
    """Machines with the parts that no machine before them has."""
    seen, machines = set(), {}
    for name in library():
        machine = thinned(load_machine(name))
        new = tuple(part for part in machine.parts if (part.name, part.prisms, part.cad_shape) not in seen)
        seen |= {(part.name, part.prisms, part.cad_shape) for part in new}
        if new:
            machines[name] = type(machine)(**{**vars(machine), "parts": new})
    return machines


def _volume(part, cache):
    return sum(solid.Volume() for solid in solids(part, cache)) * 1e-9


MACHINES = only_new_parts()
SURFACE = 0.02  # triangles lie within 0.05 to 0.1 mm of the solid, mica is 0.8 mm thin


@pytest.fixture(scope="module", params=MACHINES)
def written(request, tmp_path_factory, run_cache):
    machine, folder = MACHINES[request.param], tmp_path_factory.mktemp("cad")
    return machine, export_cad(machine, folder, cache=run_cache), run_cache


def test_solids_are_watertight_and_have_the_volume_of_the_formula(written):
    """A round port and its square prisms differ in what a curved wall leaves of them: 0.6 % of the port."""
    machine, _, cache = written
    for check in check_cad(machine, 0.1, cache):
        exact = 0.01 if check.part.endswith("tube") else 1e-4 if machine.part(check.part).cad_shape else 1e-9
        assert check.watertight, check.part
        assert check.solid_volume == pytest.approx(check.volume, rel=exact), check.part


def test_step_keeps_names_and_volumes(written):
    """The file keeps 7 digits, and the integral over a helix's free-form faces shows it: 5e-5."""
    machine, files, cache = written
    back = {name.split("/")[-1]: shape for shape, name, _, _ in cq.Assembly.load(str(files["step"]))}
    assert back.keys() == {part.name for part in machine.parts}
    for part in machine.parts:
        volume = sum(solid.Volume() for solid in back[part.name].Solids()) * 1e-9
        exact = 1e-4 if part.cad_shape else 1e-6
        assert volume == pytest.approx(_volume(part, cache), rel=exact), part.name


def test_stl_is_watertight_and_keeps_the_volume(written):
    machine, files, _ = written
    for part in machine.parts:
        mesh = trimesh.load(files[f"stl:{part.name}"])
        assert mesh.is_watertight, part.name
        assert mesh.volume * 1e-9 == pytest.approx(part.volume, rel=SURFACE), part.name


def test_glb_keeps_names_and_volumes(written):
    """In metres, as glTF has it; one node per part."""
    machine, files, _ = written
    scene = trimesh.load(files["glb"])
    for part in machine.parts:
        placed, mesh = scene.graph[part.name]
        whole = scene.geometry[mesh].copy().apply_transform(placed)
        assert whole.volume == pytest.approx(part.volume, rel=SURFACE), part.name
