"""glTF as its users expect it: metres, y upwards, one named node per part."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import cadquery as cq

_MILLIMETRE = 1e-3


def write_glb(whole: cq.Assembly, path: Path, tolerance_mm: float = 0.1, angle: float = 0.1) -> None:
    """The assembly (mm, z along the machine's axis) as a binary glTF file.

    tolerance_mm, angle (rad) : how far triangles may lie from the surface
    """
    from cadquery.occ_impl.assembly import toCAF
    from OCP.Message import Message_ProgressRange
    from OCP.RWGltf import RWGltf_CafWriter
    from OCP.RWMesh import RWMesh_CoordinateSystem
    from OCP.TCollection import TCollection_AsciiString
    from OCP.TColStd import TColStd_IndexedDataMapOfStringString

    _, document = toCAF(whole, False, True, tolerance_mm, angle)
    writer = RWGltf_CafWriter(TCollection_AsciiString(str(path)), True)
    writer.SetMergeFaces(True)
    system = writer.ChangeCoordinateSystemConverter()
    system.SetInputLengthUnit(_MILLIMETRE)
    system.SetInputCoordinateSystem(RWMesh_CoordinateSystem.RWMesh_CoordinateSystem_Zup)
    writer.Perform(document, TColStd_IndexedDataMapOfStringString(), Message_ProgressRange())
