"""The field against other codes: the same mesh and problem, single-thread CPU seconds, fresh processes.

    python benchmarks/field.py [--large] [--stack] [--json FILE]

A laminated hollow cylinder with films (`peers/field.py`): 50,000 and 300,000 unknowns, with --large a million too.
"total" is assembly, boundary terms and solve; ngsolve's Cholesky runs at 50,000 only, where it is already the slowest.
A peer that has not finished after 150 CPU seconds is stopped: its row then holds that time, and says so.
Before, the series-wound motor on 150,000 nodes (188,000 unknowns, nodes split at contacts): 15 loads, and an hour in
60 s steps. --stack leaves the motor out. ngsolve is compared where it is installed (`uv pip install ngsolve`).
"""

import importlib.util
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from fem.matrices.assembly import FieldModel
from fem.matrices.grids import ring
from fem.solvers.newton import transient
from fem.solvers.solve import Fluids, Solver
from fem.solvers.streams import Stream, cut, flowing
from geom import build_mesh, load_machine
from lumped.build.pipeline import field_of
from lumped.machine.motor import nominal_coefficients
from scripts.published import benchmark_parser, measured_row as row, print_rows, write_rows

SIZES = {"50k": 36, "300k": 66}
LARGE = {"1M": 99}
OURS = "thermoscope"
STOPPED = 150  # CPU seconds
MOTOR: dict[str, Any] = {"size_m": 0.015, "segments": 60, "across": 3}


def save_stack(n: int, file: Path) -> int:
    """A hollow cylinder of n cells along, 2 n around and n / 2 across; its points."""
    r, z = np.linspace(0.08, 0.16, n // 2 + 1), np.linspace(0.0, 0.2, n + 1)

    def fluid(c: np.ndarray) -> np.ndarray:
        return np.select([c[:, 2] < 1e-9, c[:, 2] > 0.2 - 1e-9, c[:, 0] < 0.081], ["left", "right", "bore"], "ambient")

    mesh = ring(r, 2 * n, z, lambda c: np.full(len(c), "stack"), fluid)
    facets = {f"facets/{p.fluid}": p.facets for p in mesh.patches.values()}
    np.savez(file, points=mesh.points, tets=mesh.tets, **facets)  # type: ignore[arg-type]
    return len(mesh.points)


def raced(name: str, file: Path, times: int) -> dict[str, Any] | None:
    """What one contender printed in its quickest of some runs; None: it was stopped."""
    print(f"{name} ...", file=sys.stderr)
    tiny = file.with_name("tiny.npz")
    command = [sys.executable, Path(__file__).with_name("peers") / "field.py", name, file, tiny]
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (STOPPED, STOPPED))  # noqa: E731
    runs = [subprocess.run(command, stdout=subprocess.PIPE, text=True, preexec_fn=limit) for _ in range(times)]
    if any(run.returncode < 0 for run in runs):
        return None
    found = [json.loads(run.stdout.splitlines()[-1]) for run in runs]
    return min(({**f, "total": sum(f["laps"].values())} for f in found), key=lambda f: f["total"])


def stack_rows(case: str, n: int) -> list[dict[str, Any]]:
    names = ["scikit-fem + pyamg"]
    if importlib.util.find_spec("ngsolve"):
        names += ["ngsolve h1amg", *(["ngsolve Cholesky"] if case == "50k" else [])]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "stack.npz"
        points = save_stack(n, file)
        save_stack(4, file.with_name("tiny.npz"))
        ours, *others = (raced(name, file, 3 if case == "50k" else 1) for name in (OURS, *names))
    assert ours is not None, f"not done after {STOPPED} s"
    rows = [row(case, "unknowns", "1", points), row(case, "peak memory", "GiB", ours["peak_GiB"])]
    rows += [row(case, lap, "s", seconds) for lap, seconds in ours["laps"].items() if lap != "solve"]
    for name, found in zip(names, others, strict=True):
        rows += peer_rows(case, ours, name, found)
    return rows


def peer_rows(case: str, ours: dict[str, Any], name: str, found: dict[str, Any] | None) -> list[dict[str, Any]]:
    """Beside one peer; of one that was stopped, the time it had."""
    if found is None:
        return [row(case, "total", "s", ours["total"], float(STOPPED), f"{name}, stopped")]
    return [
        row(case, "total", "s", ours["total"], found["total"], name),
        row(case, "solve", "s", ours["laps"]["solve"], found["laps"]["solve"], name),
        row(case, "peak memory", "GiB", ours["peak_GiB"], found["peak_GiB"], name),
        row(case, "hottest point", "degC", ours["hottest_C"], found["hottest_C"], name),
    ]


def motor() -> tuple[FieldModel, dict[str, float], dict[str, float], Fluids]:
    """The motor's field, films, contacts and air, at the rated point."""
    machine = load_machine("series-dc-100kw")
    mesh = build_mesh(machine, **MOTOR)
    inner = sorted({p.fluid for p in mesh.patches.values()} - {"ambient"})
    h, g = nominal_coefficients(machine, {n: (p.part, p.fluid) for n, p in mesh.patches.items()}, mesh.contacts)
    for fluid in inner:
        mesh = cut(mesh, fluid, lambda x: x[:, 2], 1)
    field = field_of(machine, mesh)
    films, fluids = flowing(field, h, [Stream(fluid, 15.0, 25.0) for fluid in inner], {"ambient": 20.0})
    return field, films, g, fluids


def motor_rows() -> list[dict[str, Any]]:
    field, films, contacts, fluids = motor()
    Solver(field).factor(field.stiffness(films, contacts))(np.zeros((field.n, 1)))  # loads what is compiled
    loads = np.column_stack([field.load(part) for part in list(field.blocks)[:15]])
    case = f"motor, {field.n} unknowns"
    start = time.process_time()
    solver = Solver(field)
    X = solver.factor(field.stiffness(films, contacts))(loads)
    rows = [row(case, "15 loads", "s", time.process_time() - start)]
    left = field.stiffness(films, contacts) @ X - loads
    rows.append(row(case, "largest heat left in a node, 1 W in", "W", float(np.abs(left).max())))
    start = time.process_time()
    T = transient(
        Solver(field), films, contacts, 300.0 * loads.sum(1), fluids, np.full(field.n, 20.0), step=60.0, steps=60
    )
    rows.append(row(case, "an hour in 60 s steps", "s", time.process_time() - start))
    return [*rows, row(case, "hottest after the hour", "degC", float(T[-1].max()))]


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--large", action="store_true", help="a million unknowns as well; scikit-fem takes 8 GiB there")
    parser.add_argument("--stack", action="store_true", help="only the hollow cylinder")
    given = parser.parse_args()
    rows = [] if given.stack else motor_rows()
    print_rows(rows, sys.stderr)
    for case, n in {**SIZES, **(LARGE if given.large else {})}.items():
        rows += (found := stack_rows(case, n))
        print_rows(found, sys.stderr)
    write_rows(given.json, "field", rows)


if __name__ == "__main__":
    main()
