"""Solids and mesh of the shipped machines: CPU seconds, sizes, and what the mesh loses of the exact volume.

    python benchmarks/geometry.py [--json FILE]

Single-thread CPU seconds, best of two. "volume error" is the worst part of the machine against the exact formula;
"least quality" is the smallest mean ratio of an element (1 for a regular tetrahedron), thin insulation included.
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from geom import (
    COARSE,
    FINE,
    Machine,
    NamedMesh,
    build_mesh,
    export_cad,
    import_step,
    library,
    load_machine,
    mesh_quality,
    part_table,
)
from geom.machine_file import machine_from
from geom.meshing.mesher import _planned
from geom.solids.cad import solids
from scripts.published import measured_row as row, print_rows, write_rows

SETTINGS: dict[str, dict[str, Any]] = {
    "coarse": COARSE,
    "default": {},
    "150k": {"size_m": 0.015, "segments": 60, "across": 3},
    "fine": FINE,
}


def cpu_seconds(run: Callable[[], object], repeats: int = 2) -> tuple[float, Any]:
    """Least CPU time (s) over the repeats, and the last result."""
    times, result = [], None
    for _ in range(repeats):
        start = time.process_time()
        result = run()
        times.append(time.process_time() - start)
    return min(times), result


def volumes(mesh: NamedMesh) -> np.ndarray:
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def volume_error(machine: Machine, mesh: NamedMesh) -> float:
    """Largest relative difference of a part's mesh volume to its exact volume."""
    found = np.bincount(mesh.region, volumes(mesh), minlength=len(mesh.parts))
    exact = np.array([machine.part(name).volume for name in mesh.parts])
    return float(np.abs(found / exact - 1).max())


def anew(machine: Machine, **setting: Any) -> NamedMesh:
    """A mesh without what earlier meshes of the machine have left behind."""
    _planned.cache_clear()
    return build_mesh(machine, **setting)


def motor_rows() -> list[dict[str, Any]]:
    motor = load_machine("series-dc-100kw")
    build_mesh(motor, **COARSE)  # imports
    cad, _ = cpu_seconds(lambda: [solids(part) for part in motor.parts])
    rows = [row("series-dc-100kw", "solids", "s", cad)]
    for name, setting in SETTINGS.items():
        seconds, mesh = cpu_seconds(lambda setting=setting: anew(motor, **setting))
        case = f"series-dc-100kw, {name}"
        rows += [row(case, "mesh", "s", seconds), row(case, "nodes", "1", len(mesh.points))]
        rows += [
            row(case, "tetrahedra", "1", len(mesh.tets)),
            row(case, "least quality", "1", min(mesh_quality(mesh).values())),
        ]
        rows += [row(case, "volume error", "1", volume_error(motor, mesh))]
    seconds, _ = cpu_seconds(lambda: build_mesh(motor, **SETTINGS["150k"]))
    rows += [row("series-dc-100kw, 150k", "mesh, refined", "s", seconds)]
    with tempfile.TemporaryDirectory() as folder:
        build_mesh(motor, **FINE, cache=folder)
        seconds, _ = cpu_seconds(lambda: build_mesh(motor, **FINE, cache=folder))
    return [*rows, row("series-dc-100kw, fine", "mesh from cache", "s", seconds), *rebuild_rows(motor)]


def rebuild_rows(motor: Machine) -> list[dict[str, Any]]:
    """Solids after a change of the fins, parts built for it, and the way out to STEP and back."""
    table = {"machine": {"family": "series-dc"}, "geometry": {"housing": {"fin_height_mm": 17.0}}}
    changed = machine_from(table, motor.name)
    with tempfile.TemporaryDirectory() as folder:
        for part in motor.parts:
            solids(part, folder)
        before = set(os.listdir(folder))
        again, _ = cpu_seconds(lambda: [solids(part, folder) for part in changed.parts], repeats=1)
        built = len(set(os.listdir(folder)) - before)
        out, files = cpu_seconds(lambda: export_cad(motor, folder, ("step",), cache=folder), repeats=1)
        back, _ = cpu_seconds(lambda: import_step(files["step"]), repeats=1)
    areas, _ = cpu_seconds(lambda: part_table(motor))
    rows = [
        row(motor.name, "solids after a change of fins", "s", again),
        row(motor.name, "solids built for it", "1", built),
    ]
    rows += [row(motor.name, "STEP written", "s", out), row(motor.name, "STEP read and sliced", "s", back)]
    return [*rows, row(motor.name, "table of parts and areas", "s", areas)]


def library_rows() -> list[dict[str, Any]]:
    rows = []
    for name in library():
        machine = load_machine(name)
        seconds, mesh = cpu_seconds(lambda machine=machine: anew(machine))
        rows += [row(name, "mesh", "s", seconds), row(name, "nodes", "1", len(mesh.points))]
        rows += [row(name, "volume error", "1", volume_error(machine, mesh))]
        rows += [row(name, "least quality", "1", min(mesh_quality(mesh).values()))]
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the rows there; - is stdout")
    target = parser.parse_args().json
    found = [*motor_rows(), *library_rows()]
    write_rows(target, "geometry", found)
    if target != "-":
        print_rows(found)


if __name__ == "__main__":
    main()
