"""Solids and mesh of the shipped machines: CPU seconds, sizes, and what the mesh loses of the exact volume.

    python benchmarks/geometry.py [--json FILE]

Single-thread CPU seconds, best of two. "volume error" is the worst part of the machine against the exact formula;
"least quality" is the smallest mean ratio of an element (1 for a regular tetrahedron), thin insulation included.
"""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from geom import COARSE, FINE, Machine, NamedMesh, build_mesh, library, load_machine
from geom.cad import solids

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


def mean_ratio(mesh: NamedMesh) -> float:
    """Smallest 12 (3 V)^(2/3) / sum of squared edges (Liu and Joe 1994)."""
    corners = mesh.points[mesh.tets]
    pairs = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
    squares = sum(((corners[:, i] - corners[:, j]) ** 2).sum(axis=1) for i, j in pairs)
    return float((12 * np.cbrt(3 * volumes(mesh)) ** 2 / squares).min())


def motor_rows() -> list[dict[str, Any]]:
    motor = load_machine("series-dc-100kw")
    build_mesh(motor, **COARSE)  # imports
    cad, _ = cpu_seconds(lambda: [solids(part) for part in motor.parts])
    rows = [row("series-dc-100kw", "solids", "s", cad)]
    for name, setting in SETTINGS.items():
        seconds, mesh = cpu_seconds(lambda setting=setting: build_mesh(motor, **setting))
        case = f"series-dc-100kw, {name}"
        rows += [row(case, "mesh", "s", seconds), row(case, "nodes", "1", len(mesh.points))]
        rows += [row(case, "tetrahedra", "1", len(mesh.tets)), row(case, "least quality", "1", mean_ratio(mesh))]
        rows += [row(case, "volume error", "1", volume_error(motor, mesh))]
    with tempfile.TemporaryDirectory() as folder:
        build_mesh(motor, **FINE, cache=folder)
        seconds, _ = cpu_seconds(lambda: build_mesh(motor, **FINE, cache=folder))
    return [*rows, row("series-dc-100kw, fine", "mesh from cache", "s", seconds)]


def library_rows() -> list[dict[str, Any]]:
    rows = []
    for name in library():
        machine = load_machine(name)
        seconds, mesh = cpu_seconds(lambda machine=machine: build_mesh(machine))
        rows += [row(name, "mesh", "s", seconds), row(name, "nodes", "1", len(mesh.points))]
        rows += [row(name, "volume error", "1", volume_error(machine, mesh))]
    return rows


def row(case: str, measure: str, unit: str, ours: float) -> dict[str, Any]:
    empty = {"peer": None, "peer_name": None, "ratio": None, "n": None, "ci95": None}
    return {"case": case, "measure": measure, "unit": unit, "ours": ours, **empty}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", metavar="FILE", help="write the rows there; - is stdout")
    target = parser.parse_args().json
    found = [*motor_rows(), *library_rows()]
    computer = f"{platform.machine()}, Python {platform.python_version()}"
    document = {
        "benchmark": "geometry",
        "computer": computer,
        "date": datetime.date.today().isoformat(),
        "rows": found,
    }
    if target == "-":
        json.dump(document, sys.stdout, indent=1)
    elif target:
        Path(target).write_text(json.dumps(document, indent=1))
    if target != "-":
        print(computer)
        for line in found:
            print(f"{line['case']:36} {line['measure']:16} {line['ours']:12.4g} {line['unit']}")


if __name__ == "__main__":
    main()
