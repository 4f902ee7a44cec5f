"""geom: what is the machine? Named prismatic parts, solids, a named mesh.

machine = load_machine("pmsm-m1")        # a name of the library, a .toml file, or a .step file (see geom.step)
for row in part_table(machine): ...      # volumes, masses, film and contact areas, without solids or mesh
check_cad(machine); export_cad(machine, "out")
mesh = build_mesh(machine, **COARSE)
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "load_machine": "machine",
    "library": "machine",
    "Machine": "machine",
    "import_step": "step",
    "Part": "part",
    "Material": "materials",
    "material": "materials",
    "material_table": "materials",
    "winding_conductivity": "materials",
    "build_mesh": "mesher",
    "COARSE": "mesher",
    "FINE": "mesher",
    "mesh_quality": "quality",
    "export_cad": "cad",
    "check_cad": "surfaces",
    "part_table": "areas",
    "PartRow": "areas",
    "drawing_of": "drawing",
    "thumbnail_of": "drawing",
    "catalogue": "gallery",
    "write_library": "gallery",
    "write_pages": "family_page",
    "NamedMesh": "mesh",
    "Patch": "mesh",
    "Contact": "mesh",
    "InputError": "errors",
    "ThermoscopeError": "errors",
    "MissingDependency": "errors",
    "read_vtu": "meshio_io",
    "write_vtu": "meshio_io",
}
__all__ = [*_HOME]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'geom' has no attribute {name!r}")
    return getattr(import_module(f"geom.{_HOME[name]}"), name)
