"""thermoscope build MACHINE"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.errors import InputError
from thermoscope.commands import crosscheck
from thermoscope.folder import load_machine_file
from thermoscope.terminal import give, progress, say, table

if TYPE_CHECKING:
    from geom.mesh import NamedMesh
    from geom.surfaces import CadCheck
    from thermoscope.pipeline import Built
    from thermoscope.sized import Sized

ERRORS = ("mean", "hot", "point")


def build(machine: str, out: Path | None, target: str | None, accuracy: float | None = None) -> int:
    """Solids, mesh and network of a machine to a folder, and the network against the field.

    accuracy : percent of a part's own rise; the smallest network that meets it is kept. None: the size a case runs.
    """
    from geom import check_cad, export_cad, write_vtu

    described = load_machine_file(Path(machine))
    folder = out or Path("out") / described.name
    if Path(machine).is_file() and folder.resolve() == Path(machine).resolve().parent:
        raise InputError("the machine file lies there: a result could take its name", f"--out {folder}", "out/NAME")
    with progress() as tell:
        built, found = _built(described, accuracy, tell)
        checked = crosscheck.checked(built, found, tell)
        tell("solids")
        solids = check_cad(described)
        tell(f"writing {folder}")
        export_cad(described, folder)
        write_vtu(built.mesh, folder / f"{described.name}.vtu")
        document = {**described_as(built, solids), **checked, **({} if found is None else {"sizes": found.document()})}
        crosscheck.save(document, folder)
    give(document, target, lambda: show(document, folder))
    return 0 if found is None or found.met else 1


def _built(described: Any, accuracy: float | None, tell: Any) -> tuple[Built, Sized | None]:
    from lumped.motor_bases import on_all
    from thermoscope.pipeline import build as built_from
    from thermoscope.sized import sized

    if accuracy is None:
        return built_from(on_all(described), progress=tell), None
    found = sized(described, accuracy, progress=tell)
    return found.built, found


def described_as(built: Built, solids: list[CadCheck]) -> dict[str, Any]:
    """The document of the command; surfaces, mesh and formula volumes in m3, areas in m2."""
    from geom.areas import part_table

    meshed = mesh_volumes(built.mesh)
    rows = {row.name: row for row in part_table(built.machine)}
    parts = [
        {
            "name": s.part, "material": built.machine.part(s.part).material, "volume_m3": s.volume,
            "mesh_volume_m3": meshed[s.part], "solid_volume_m3": s.solid_volume, "watertight": s.watertight,
            "mass_kg": rows[s.part].mass, "faces_m2": dict(rows[s.part].faces),
            "contacts_m2": dict(rows[s.part].contacts),
        }
        for s in solids
    ]  # fmt: skip
    return {
        "machine": built.machine.name,
        "parts": parts,
        "mesh": {"nodes": len(built.mesh.points), "tets": len(built.mesh.tets)},
        "network": {"nodes": len(built.network.states), "links": len(built.network.links)},
    }


def mesh_volumes(mesh: NamedMesh) -> dict[str, float]:
    """Volume of every part in the mesh (m3): its tetrahedra summed."""
    corners = mesh.points[mesh.tets]
    sizes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    return dict(zip(mesh.parts, np.bincount(mesh.region, sizes, len(mesh.parts)).tolist(), strict=True))


def show(document: Mapping[str, Any], folder: Path) -> None:
    """Parts, error against size, the field against the network, and where the files are."""
    headers = ["part", "material", "volume (l)", "in the mesh (l)", "mass (kg)", "to fluids (m2)", "to parts (m2)",
               "watertight"]  # fmt: skip
    table("Parts", headers, [_row(part) for part in document["parts"]], marked=["NO"])
    if "sizes" in document:
        show_sizes(document["sizes"])
    crosscheck.show(document, folder)
    mesh, network = document["mesh"], document["network"]
    say(f"mesh: {mesh['nodes']} points, {mesh['tets']} tetrahedra")
    say(f"network: {network['nodes']} states, {network['links']} links; files in {folder}")


def _row(part: Mapping[str, Any]) -> list[Any]:
    litres = [1e3 * part["volume_m3"], 1e3 * part["mesh_volume_m3"]]
    areas = [sum(part["faces_m2"].values()), sum(part["contacts_m2"].values())]
    return [part["name"], part["material"], *litres, part["mass_kg"], *areas, "yes" if part["watertight"] else "NO"]


def show_sizes(sizes: Mapping[str, Any]) -> None:
    """Error against number of states, and what the guard saw at points nothing was fitted to."""
    wish = sizes["wish_percent"]
    rows = [["means only" if not s["asked"] else f"up to {s['asked']}", *_errors(s)] for s in sizes["sizes"]]
    rows += [
        ["learned", g["states"], "-", "-", "-", *(g["random"][k] for k in ERRORS), _word(g)] for g in sizes["guard"]
    ]
    title = f"Error in % of a part's rise (wish: means {wish['mean']:g}, hot spots and points {wish['hot']:g})"
    headers = ["network", "states", "mean", "hot spot", "point", "mean, random", "hot, random", "point, random", "met"]
    table(title, headers, rows)
    if not sizes["met"]:
        worst = sizes["guard"][-1]["random"]
        say(f"the wish is missed: mean {worst['mean_part']}, hot spot {worst['hot_part']}, point {worst['point_part']}")


def _errors(size: Mapping[str, Any]) -> Sequence[Any]:
    values = [size[at][kind] for at in ("nominal", "random") for kind in ERRORS]
    return [size["states"], *values, _word(size)]


def _word(row: Mapping[str, Any]) -> str:
    return "yes" if row["met"] else "no"
