"""Solids and mesh of the shipped machines: CPU seconds, sizes, and what the mesh loses of the exact volume.

    python benchmarks/geometry.py [--json FILE]

Single-thread CPU seconds, best of two. "volume error" is the worst part of the machine against the exact formula;
"least quality" is the smallest mean ratio of an element (1 for a regular tetrahedron), thin insulation included.
"""

import os
import tempfile
from typing import Any

import numpy as np

import geom
from geom.machine_file import machine_from
from geom.meshing.mesher import _planned
from geom.solids.cad import solids
from scripts.published import benchmark_parser, measured_row as row, print_rows, timed, write_rows

SETTINGS: dict[str, dict[str, Any]] = {
    "coarse": geom.COARSE,
    "default": {},
    "150k": {"size_m": 0.015, "segments": 60, "across": 3},
    "fine": geom.FINE,
}


def volumes(mesh: geom.NamedMesh) -> np.ndarray:
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def volume_error(machine: geom.Machine, mesh: geom.NamedMesh) -> float:
    """Largest relative difference of a part's mesh volume to its exact volume."""
    found = np.bincount(mesh.region, volumes(mesh), minlength=len(mesh.parts))
    exact = np.array([machine.part(name).volume for name in mesh.parts])
    return float(np.abs(found / exact - 1).max())


def anew(machine: geom.Machine, **setting: Any) -> geom.NamedMesh:
    """A mesh without what earlier meshes of the machine have left behind."""
    _planned.cache_clear()
    return geom.build_mesh(machine, **setting)


def motor_rows() -> list[dict[str, Any]]:
    motor = geom.load_machine("series-dc-100kw")
    geom.build_mesh(motor, **geom.COARSE)  # imports
    _, cad, _ = timed(lambda: [solids(part) for part in motor.parts], 2)
    rows = [row("series-dc-100kw", "solids", "s", cad)]
    for name, setting in SETTINGS.items():
        _, seconds, mesh = timed(lambda setting=setting: anew(motor, **setting), 2)
        case = f"series-dc-100kw, {name}"
        rows += [row(case, "mesh", "s", seconds), row(case, "nodes", "1", len(mesh.points))]
        rows += [
            row(case, "tetrahedra", "1", len(mesh.tets)),
            row(case, "least quality", "1", min(geom.mesh_quality(mesh).values())),
        ]
        rows += [row(case, "volume error", "1", volume_error(motor, mesh))]
    _, seconds, _ = timed(lambda: geom.build_mesh(motor, **SETTINGS["150k"]), 2)
    rows += [row("series-dc-100kw, 150k", "mesh, refined", "s", seconds)]
    with tempfile.TemporaryDirectory() as folder:
        geom.build_mesh(motor, **geom.FINE, cache=folder)
        _, seconds, _ = timed(lambda: geom.build_mesh(motor, **geom.FINE, cache=folder), 2)
    return [*rows, row("series-dc-100kw, fine", "mesh from cache", "s", seconds), *rebuild_rows(motor)]


def rebuild_rows(motor: geom.Machine) -> list[dict[str, Any]]:
    """Solids after a change of the fins, parts built for it, and the way out to STEP and back."""
    table = {"machine": {"family": "series-dc"}, "geometry": {"housing": {"fin_height_mm": 17.0}}}
    changed = machine_from(table, motor.name)
    with tempfile.TemporaryDirectory() as folder:
        for part in motor.parts:
            solids(part, folder)
        before = set(os.listdir(folder))
        _, again, _ = timed(lambda: [solids(part, folder) for part in changed.parts])
        built = len(set(os.listdir(folder)) - before)
        _, out, files = timed(lambda: geom.export_cad(motor, folder, ("step",), cache=folder))
        _, back, _ = timed(lambda: geom.import_step(files["step"]))
    _, areas, _ = timed(lambda: geom.part_table(motor), 2)
    rows = [
        row(motor.name, "solids after a change of fins", "s", again),
        row(motor.name, "solids built for it", "1", built),
    ]
    rows += [row(motor.name, "STEP written", "s", out), row(motor.name, "STEP read and sliced", "s", back)]
    return [*rows, row(motor.name, "table of parts and areas", "s", areas)]


def library_rows() -> list[dict[str, Any]]:
    rows = []
    for name in geom.library():
        machine = geom.load_machine(name)
        _, seconds, mesh = timed(lambda machine=machine: anew(machine), 2)
        rows += [row(name, "mesh", "s", seconds), row(name, "nodes", "1", len(mesh.points))]
        rows += [row(name, "volume error", "1", volume_error(machine, mesh))]
        rows += [row(name, "least quality", "1", min(geom.mesh_quality(mesh).values()))]
    return rows


def main() -> None:
    parser = benchmark_parser(__doc__)
    target = parser.parse_args().json
    found = [*motor_rows(), *library_rows()]
    write_rows(target, "geometry", found)
    if str(target) != "-":
        print_rows(found)


if __name__ == "__main__":
    main()
