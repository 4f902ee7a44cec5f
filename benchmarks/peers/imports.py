"""Machine files of other programs, each from the file to its steady field: seconds, sizes and what the mesh loses.

    python benchmarks/peers/imports.py FILE... [--json FILE] [--page]

Each file goes through a process of its own: read, meshed, condensed, and solved at the rated point that the import
assumes. "volume off" is the largest difference of a part's mesh to its exact volume, which follows from the file's own
numbers; "balance" is heat in less heat out, over heat in. With --page the table goes into docs/benchmarks.md.
"""

import os
import resource
import tempfile
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

import thermoscope as ts
from fem.matrices.kernels import volumes
from geom import import_draft
from scripts.published import ROOT, benchmark_parser, publish, table, timed, write_rows

PAGE = ROOT / "docs" / "benchmarks.md"
HEAD = "file | import (s) | build (s) | field (s) | states | volume off | balance | memory (GB)"


def measured(file: Path) -> dict[str, Any]:
    """One file from the text to the field: CPU seconds of each step, and what came out."""
    ts.build("tefc-industrial", size_m=0.2).field()  # imports and compiled kernels
    _, read, _ = timed(lambda: import_draft(file))
    _, build, machine = timed(lambda: ts.build(file))
    _, solve, field = timed(machine.field)
    mesh, exact = machine.mesh, [machine.built.machine.part(name).volume for name in machine.mesh.parts]
    meshed = np.bincount(mesh.region, np.abs(volumes(mesh.points, mesh.tets)), minlength=len(exact))
    return {
        "file": file.name,
        "import_s": read,
        "build_s": build,
        "field_s": solve,
        "states": len(machine.network.states),
        "volume_off": float(np.abs(meshed / exact - 1.0).max()),
        "balance": field.energy_balance,
        "memory_GB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20,
    }


def page(rows: list[dict[str, Any]]) -> str:
    """Markdown, a row per file."""
    formats = ("", ".3f", ".1f", ".1f", "", ".1%", ".0e", ".1f")
    cells = [[format(x, f) for x, f in zip(row.values(), formats, strict=True)] for row in rows]
    return table(HEAD.split(" | "), cells)


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE")
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    rows = []
    for file in given.files:
        with tempfile.TemporaryDirectory() as store, ProcessPoolExecutor(1, get_context("spawn")) as process:
            os.environ["THERMOSCOPE_CACHE"] = store  # nothing of an earlier run
            rows.append(process.submit(measured, file).result())
        print(rows[-1], flush=True)
    write_rows(given.json, "imports", rows)
    if given.page:
        publish(PAGE, "imports", page(rows))


if __name__ == "__main__":
    main()
