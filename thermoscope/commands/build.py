"""thermoscope build MACHINE"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermoscope.folder import load_machine_file
from thermoscope.terminal import cell, give, progress, say, table

if TYPE_CHECKING:
    from geom.cad import CadCheck
    from geom.mesh import NamedMesh
    from thermoscope.crosscheck import CrossCheck
    from thermoscope.pipeline import Built

HOT = 200.0  # degC, what insulation bears


def build(machine: str, out: Path | None, target: str | None) -> int:
    """Solids, mesh and network of a machine to a folder, and the network against the field at one steady point."""
    from geom import check_cad, export_cad, write_vtu
    from thermoscope.crosscheck import crosscheck
    from thermoscope.pipeline import build as built_from

    described = load_machine_file(Path(machine))
    folder = out or Path("out") / described.name
    with progress() as tell:
        built = built_from(described, progress=tell)
        tell("field against network")
        point = bearable(built)
        checked = crosscheck(built.field, built.network, point)
        tell("solids")
        solids = check_cad(described)
        tell(f"writing {folder}")
        export_cad(described, folder)
        write_vtu(built.mesh, folder / f"{described.name}.vtu")
    document = {**described_as(built, solids, checked), "operating_point": point}
    give(document, target, lambda: show(document, folder))
    return 0


def bearable(built: Built) -> dict[str, float]:
    """The rated point with its current lowered until the machine settles: a short-time rating has no steady state."""
    from lumped.motor import operating_point
    from thermoscope.crosscheck import steady_state

    point = {name: float(value[0]) for name, value in operating_point(built.machine).items()}
    named = [i for i, state in enumerate(built.network.states) if "#" not in state]
    while True:
        T = steady_state(built.network, point, 20.0)[named]
        if T.min() > 0.0 and T.max() < HOT:
            return point
        point = {**point, "current_A": 0.8 * point["current_A"]}


def described_as(built: Built, solids: list[CadCheck], checked: CrossCheck) -> dict[str, Any]:
    """The document of the command; surfaces, mesh and formula volumes in m3."""
    meshed = mesh_volumes(built.mesh)
    parts = [
        {
            "name": s.part, "material": built.machine.part(s.part).material, "volume_m3": s.volume,
            "mesh_volume_m3": meshed[s.part], "solid_volume_m3": s.solid_volume, "watertight": s.watertight,
        }
        for s in solids
    ]  # fmt: skip
    return {
        "machine": built.machine.name,
        "parts": parts,
        "mesh": {"nodes": len(built.mesh.points), "tets": len(built.mesh.tets)},
        "network": {"nodes": len(built.network.states), "links": len(built.network.links)},
        "crosscheck": [vars(part) for part in checked.parts],
        "energy_balance": checked.energy_balance,
    }


def mesh_volumes(mesh: NamedMesh) -> dict[str, float]:
    """Volume of every part in the mesh (m3): its tetrahedra summed."""
    corners = mesh.points[mesh.tets]
    sizes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    return dict(zip(mesh.parts, np.bincount(mesh.region, sizes, len(mesh.parts)).tolist(), strict=True))


def show(document: Mapping[str, Any], folder: Path) -> None:
    """Parts, the field against the network, and where the files are."""
    litres = [
        [p["name"], p["material"], 1e3 * p["volume_m3"], 1e3 * p["mesh_volume_m3"], "yes" if p["watertight"] else "NO"]
        for p in document["parts"]
    ]
    table("Parts", ["part", "material", "volume (l)", "in the mesh (l)", "watertight"], litres, marked=["NO"])
    headers = ["part", "field mean", "network mean", "field max", "network max", "off (% of rise)"]
    point = ", ".join(f"{name} {cell(value)}" for name, value in document["operating_point"].items())
    title = f"Steady at {point}, 20 degC around: temperatures (degC)"
    table(title, headers, [list(part.values()) for part in document["crosscheck"]])
    mesh, network = document["mesh"], document["network"]
    say(f"mesh: {mesh['nodes']} points, {mesh['tets']} tetrahedra")
    say(f"network: {network['nodes']} states, {network['links']} links")
    say(f"energy balance of the field: {document['energy_balance']:.1e}; files in {folder}")
