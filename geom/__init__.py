"""geom: what is the machine? Named prismatic parts, solids, a named mesh.

machine = load_machine("pmsm-m1")        # a name of the library, a .toml file, or a .step file (see geom.solids.step)
for row in part_table(machine): ...      # volumes, masses, film and contact areas, without solids or mesh
check_cad(machine); export_cad(machine, "out")
mesh = build_mesh(machine, **COARSE)
"""

from __future__ import annotations

from geom.lazy import loaded_when_used

_HOME = {
    "load_machine": "machine_file",
    "library": "machine_file",
    "Machine": "description.machine",
    "import_step": "machine_file",
    "import_draft": "machine_file",
    "Part": "description.part",
    "Material": "description.materials",
    "material": "description.materials",
    "material_table": "description.materials",
    "winding_conductivity": "description.materials",
    "build_mesh": "meshing.mesher",
    "COARSE": "meshing.mesher",
    "FINE": "meshing.mesher",
    "mesh_quality": "meshing.quality",
    "export_cad": "solids.cad",
    "check_cad": "solids.surfaces",
    "part_table": "meshing.areas",
    "PartRow": "meshing.areas",
    "thumbnail_of": "drawings.gallery",
    "catalogue": "drawings.gallery",
    "write_library": "drawings.gallery",
    "NamedMesh": "meshing.mesh",
    "Patch": "meshing.mesh",
    "Contact": "meshing.mesh",
    "InputError": "errors",
    "ThermoscopeError": "errors",
    "MissingDependency": "errors",
    "read_vtu": "meshing.meshio_io",
    "write_vtu": "meshing.meshio_io",
}
__all__ = [*_HOME]
__getattr__, __dir__ = loaded_when_used(__name__, _HOME, within="geom.")
