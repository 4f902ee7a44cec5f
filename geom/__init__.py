"""geom: what is the machine? Named prismatic parts, solids, a named mesh.

machine = load_machine("pmsm-m1")        # a name of the library, a .toml file, or a .step file (see geom.solids.step)
for row in part_table(machine): ...      # volumes, masses, film and contact areas, without solids or mesh
check_cad(machine); export_cad(machine, "out")
mesh = build_mesh(machine, **COARSE)
"""

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from geom.description.machine import Machine as Machine
    from geom.description.materials import Material as Material, material as material, material_table as material_table
    from geom.description.materials import winding_conductivity as winding_conductivity
    from geom.description.part import Part as Part
    from geom.drawings.gallery import catalogue as catalogue, thumbnail_of as thumbnail_of
    from geom.drawings.gallery import write_library as write_library
    from geom.errors import InputError as InputError, MissingDependency as MissingDependency
    from geom.errors import ThermoscopeError as ThermoscopeError
    from geom.machine_file import import_draft as import_draft, import_step as import_step, library as library
    from geom.machine_file import load_machine as load_machine
    from geom.meshing.areas import PartRow as PartRow, part_table as part_table
    from geom.meshing.mesh import Contact as Contact, NamedMesh as NamedMesh, Patch as Patch
    from geom.meshing.mesh import mesh_quality as mesh_quality
    from geom.meshing.mesher import COARSE as COARSE, FINE as FINE, build_mesh as build_mesh
    from geom.meshing.meshio_io import read_vtu as read_vtu, write_vtu as write_vtu
    from geom.solids.cad import export_cad as export_cad
    from geom.solids.surfaces import check_cad as check_cad

__getattr__, __dir__ = loaded_when_used(__name__, __file__)
