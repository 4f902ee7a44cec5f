"""Meshes on disk: .npz for ourselves, .vtu with a JSON sidecar of names for others."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from geom.errors import InputError
from geom.meshing.mesh import Contact, NamedMesh, Patch
from geom.storage import atomic_write


def write_npz(mesh: NamedMesh, path: Path | str) -> None:
    """Everything, exactly; written whole or not at all."""
    arrays = {f"patch:{name}": patch.facets for name, patch in mesh.patches.items()}
    arrays |= {f"contact:{name}": contact.facets for name, contact in mesh.contacts.items()}
    arrays |= {"tets": mesh.tets, "region": mesh.region}
    names = np.array(json.dumps(_names(mesh)))
    with atomic_write(Path(path)) as partial:
        np.savez(partial, points=mesh.points, names=names, **arrays)  # type: ignore[arg-type]


def read_npz(path: Path | str) -> NamedMesh:
    with np.load(path) as data:
        facets = {key.split(":", 1)[1]: data[key] for key in data.files if ":" in key}
        return _named_mesh(data["points"], data["tets"], data["region"], json.loads(str(data["names"])), facets)


def write_vtu(mesh: NamedMesh, path: Path | str) -> None:
    """Tetrahedra and named triangles as .vtu (cell data `region` and `face`), names in `<path>.json`.

    region : index into `parts`, -1 on triangles; face : index into `faces`, -1 on tetrahedra.
    """
    import meshio

    faces = [p.facets for p in mesh.patches.values()] + [c.facets for c in mesh.contacts.values()]
    triangles = np.concatenate(faces)
    owner = np.repeat(np.arange(len(faces)), [len(facets) for facets in faces])
    none = [np.full(len(mesh.tets), -1), np.full(len(triangles), -1)]
    data = {"region": [mesh.region, none[1]], "face": [none[0], owner]}
    meshio.Mesh(mesh.points, [("tetra", mesh.tets), ("triangle", triangles)], cell_data=data).write(path)
    sidecar(path).write_text(json.dumps(_names(mesh), indent=1))


def read_vtu(path: Path | str) -> NamedMesh:
    """The mesh written by `write_vtu`; InputError if a file is missing."""
    import meshio

    for needed in (Path(path), sidecar(path)):
        if not needed.exists():
            raise InputError("no such file", str(needed), "a mesh is a .vtu and its .vtu.json")
    mesh = meshio.read(path)
    names = json.loads(sidecar(path).read_text())
    face, triangles = mesh.cell_data["face"][1], mesh.cells[1].data.astype(np.int64)
    order = [name for kind in ("patches", "contacts") for name in names[kind]]
    facets = {name: triangles[face == i] for i, name in enumerate(order)}
    return _named_mesh(mesh.points, mesh.cells[0].data, mesh.cell_data["region"][0], names, facets)


def sidecar(path: Path | str) -> Path:
    return Path(f"{path}.json")


def _names(mesh: NamedMesh) -> dict[str, Any]:
    patches = {name: [patch.part, patch.fluid] for name, patch in mesh.patches.items()}
    contacts = {name: [contact.a, contact.b] for name, contact in mesh.contacts.items()}
    return {"parts": list(mesh.parts), "patches": patches, "contacts": contacts}


def _named_mesh(points: Any, tets: Any, region: Any, names: dict[str, Any], facets: dict[str, Any]) -> NamedMesh:
    patches = {name: Patch(a, b, facets[name]) for name, (a, b) in names["patches"].items()}
    contacts = {name: Contact(a, b, facets[name]) for name, (a, b) in names["contacts"].items()}
    return NamedMesh(points, tets.astype(np.int64), region.astype(np.int64), tuple(names["parts"]), patches, contacts)
