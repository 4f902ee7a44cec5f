"""From a machine to a model that can run a test: mesh, field, network, films and losses; cached by content."""

import hashlib
import pickle
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from fem.matrices.assembly import FieldModel, HasTensor, assemble
from fem.matrices.bends import Bends
from fem.matrices.material import Conductivity, LoopWound
from fem.matrices.winding import homogenised
from fem.solvers.snapshots import little_parts
from fem.solvers.streams import cut
from geom import Machine, NamedMesh, build_mesh
from geom.description.materials import Material
from geom.one_thread import one_blas_thread
from geom.storage import cache_folder
from lumped.condensation.condensed import Zone
from lumped.condensation.reduction import Recipe, Reduction, reduce
from lumped.machine.motor import boundaries, fluids, motor_network, nominal_coefficients
from lumped.machine.path import path_of
from lumped.machine.shapes import wound
from lumped.model.network import Network
from lumped.model.once import once

Progress = Callable[[str], None]
ACROSS = 1  # elements over a compact face: windings are quadratic, so their hot spots are within 0.5 % with one
AXIAL = 0.75  # thickest layer over the size of a triangle: 45 mm, a stack of 140 mm in four layers
CASE = Recipe(  # hot spots within 2 % over the range of films and contacts: docs/condensation.md
    tolerance=0.16,
    random_points=6,
    film_factors=(0.3, 10.0),
    joined_contacts=(2.2, 5.0),
    opposed_contacts=5.0,
    favour=3.0,
    thin=6.0,
)
FEW = 100  # means and shapes of the network that a diagnosis runs: its effects are within 1 % (median) of the larger's


def silent(message: str) -> None:
    """No progress."""


@dataclass(frozen=True)
class Meshing:
    """How fine a mesh is, as for geom.build_mesh.  bends : where elements are quadratic besides windings"""

    size_m: float
    segments: int
    across: float
    axial_m: float
    ends: tuple[str, ...] = ()
    finer: tuple[str, ...] = ()
    bends: Bends | None = None

    @property
    def coarser(self) -> "Meshing":
        """Elements twice as large every way; arcs keep their chords, so that both meshes have the same volume."""
        return replace(self, size_m=2 * self.size_m, across=self.across / 2, axial_m=2 * self.axial_m)

    def along(self, way: str, times: float) -> "Meshing":
        """Elements so many times as large one way, "size_m", "across" or "axial_m", with the same chords; towards
        the ends of a part, which has one way of its own, a step finer."""
        if way not in ("size_m", "across", "axial_m"):
            return replace(self, ends=(*self.ends, way))
        return replace(self, **{way: getattr(self, way) * (1.0 / times if way == "across" else times)})


@dataclass(frozen=True)
class Built:
    """A machine at every stage;  meshing : how its mesh was made;  small : a network of fewer shapes, for many runs"""

    machine: Machine
    mesh: NamedMesh
    network: Network
    meshing: Meshing
    small: Network | None = None

    @property
    @once
    def field(self) -> FieldModel:
        """Conduction on the mesh, assembled anew: two thirds of all the bytes, which few commands want."""
        return field_of(self.machine, self.mesh, self.meshing.bends)


def field_of(machine: Machine, mesh: NamedMesh, bends: Bends | None = None) -> FieldModel:
    """Conduction of the machine on its mesh, with the materials of its file; windings on quadratic elements, too."""
    materials = {part.name: machine.material_of(part.name) for part in machine.parts}
    conductivity: dict[str, HasTensor] = {name: conductivity_of(m) for name, m in materials.items()}
    for name, coil in machine.features.coils.items():
        copper = conductivity_of(materials[name])
        conductivity[name] = LoopWound(
            copper.k_z, copper.k_r, coil.axes, coil.half_length, coil.half_width, coil.z_centre
        )
    windings = [name for name in materials if wound(machine, name)]
    return assemble(mesh, conductivity, {name: m.rho * m.cp for name, m in materials.items()}, windings, bends)


def conductivity_of(material: Material) -> Conductivity:
    """Of a winding from its wires and resin, of all else as the table says."""
    if material.mixture is not None:
        return homogenised(material.mixture)
    return Conductivity(material.k_plane, material.k_plane, material.k_axial)


@dataclass(frozen=True)
class Prepared:
    """A machine on its mesh, and the coefficients its network is centred on (W/m2/K)."""

    machine: Machine
    mesh: NamedMesh
    field: FieldModel
    films: Mapping[str, float]
    contacts: Mapping[str, float]
    meshing: Meshing


def prepared(
    machine: Machine,
    size_m: float,
    segments: int,
    progress: Progress = silent,
    axial_m: float | None = None,
    across: float = ACROSS,
) -> Prepared:
    """Mesh and conduction; axial_m : thickest layer along the axis (m), None for 0.75 size_m; all as for build_mesh."""
    axial = AXIAL * size_m if axial_m is None else axial_m
    return meshed(machine, Meshing(size_m, segments, across, axial), progress)


def meshed(machine: Machine, how: Meshing, progress: Progress = silent) -> Prepared:
    """Mesh and conduction on a mesh of given fineness."""
    progress("mesh")
    mesh = plain_mesh(machine, how)
    for jacket in (part.name for part in machine.fluids if part.material != "air"):  # its walls, along its coolant
        path = path_of(machine, jacket)
        mesh = cut(mesh, jacket, path.along, path.cells)
    progress(f"conduction on {len(mesh.points)} points")
    return Prepared(machine, mesh, field_of(machine, mesh, how.bends), *coefficients_on(machine, mesh), how)


def plain_mesh(machine: Machine, how: Meshing) -> NamedMesh:
    """The mesh alone, from the cache where it was made before."""
    return build_mesh(machine, how.size_m, how.segments, how.across, how.axial_m, cache_folder(), how.ends, how.finer)


def coefficients_on(machine: Machine, mesh: NamedMesh) -> tuple[dict[str, float], dict[str, float]]:
    """Nominal films and contacts (W/m2/K) of the faces and contacts of a mesh."""
    faces = {name: (patch.part, patch.fluid) for name, patch in mesh.patches.items()}
    return nominal_coefficients(machine, faces, mesh.contacts)


def reduced(ready: Prepared, recipe: Recipe, zones: Mapping[str, Zone] | None = None) -> Reduction:
    """What the parts can look like, from the cache where it has been solved before."""
    m = ready.machine
    return reduce(
        ready.field, ready.films, ready.contacts, fluids(m), boundaries(m), recipe, m.name, cache_folder(), zones
    )


@one_blas_thread
def build(
    machine: Machine,
    size_m: float = 0.06,
    segments: int = 48,
    recipe: Recipe = CASE,
    progress: Progress = silent,
    axial_m: float | None = None,
) -> Built:
    """Everything from the machine file to the network, at one mesh size; once for each machine in a process."""
    key = hashlib.sha256(pickle.dumps((machine, size_m, segments, recipe, axial_m))).digest()
    if key not in _built:
        while len(_built) >= MOST_BUILT:
            _built.pop(next(iter(_built)))
        _built[key] = _anew(machine, size_m, segments, recipe, progress, axial_m)
    return _built[key]


def networks_of(machine: Machine, reduction: Reduction, recipe: Recipe) -> tuple[Network, Network]:
    """The network of a recipe, and the small one for many runs."""
    favour = dict.fromkeys(means_network(machine, reduction).heated, recipe.favour)
    thin = dict.fromkeys(little_parts(reduction.field), recipe.thin)
    large = reduction.network(recipe.tolerance, recipe.max_states, {**favour, **thin})
    small = reduction.network(recipe.tolerance, FEW, favour)
    return motor_network(machine, large), motor_network(machine, small)


def means_network(machine: Machine, reduction: Reduction) -> Network:
    """A mean per part and no shapes: enough for losses, fluids and streams."""
    return motor_network(machine, reduction.network(max_states=len(reduction.field.blocks)))


MOST_BUILT = 2  # machines: a command works on one, `carry` on pairs
_built: dict[bytes, Built] = {}  # by content: nothing that is asked for has changed


def _anew(
    machine: Machine, size_m: float, segments: int, recipe: Recipe, progress: Progress, axial_m: float | None
) -> Built:
    ready = prepared(machine, size_m, segments, progress, axial_m)
    progress("network from the field")
    reduction = reduced(ready, recipe)
    network, small = networks_of(machine, reduction, recipe)
    fewer = len(small.states) < len(network.states)
    return Built(machine, ready.mesh, network, ready.meshing, small if fewer else None)
