"""CAD solids of random machines of every family: watertight, and of the exact volume within 1 %, machine by machine.

    python benchmarks/family_solids.py FILE [--machines 1000] [--family NAME]

The machines are those of families.py. Every solid of every part is built and triangulated, and its volume compared with
the part's exact one. FILE gets a line of JSON per machine and is taken up again where it ends; the counts of all lines
are printed at the end. The families take turns.
"""

import argparse
import time
from itertools import product
from pathlib import Path
from typing import Any

from families import WITHIN, machine_of

from geom import InputError, check_cad
from geom.description.machine import Machine
from geom.description.part import Helix
from geom.families.family import Family
from geom.machine_file import families
from scripts.published import add_lines, json_lines

TOLERANCE_MM = 0.2  # at 2 mm the triangles of ports of a few mm fold


def helical(machine: Machine) -> bool:
    """Whether a channel winds round the axis."""
    return any(isinstance(piece, Helix) for part in machine.parts if part.cad_shape for piece in part.cad_shape.cuts)


def checked(family: Family, seed: int) -> dict[str, Any]:
    """One machine: solids, whether all are watertight, largest relative error of a part's volume, seconds."""
    start, line = time.process_time(), {"family": family.name, "seed": seed}
    try:
        machine = machine_of(family, seed)
        checks = check_cad(machine, TOLERANCE_MM)
    except InputError as refusal:
        return {**line, "refused": str(refusal)}
    worst = max(checks, key=lambda c: abs(c.solid_volume / c.volume - 1.0))
    open_parts = [c.part for c in checks if not c.watertight]
    return {
        **line,
        "prisms": sum(len(part.prisms) for part in machine.parts),
        "helical": helical(machine),
        "solids": sum(c.pieces for c in checks),
        "watertight": not open_parts,
        "open": open_parts,
        "error": abs(worst.solid_volume / worst.volume - 1.0),
        "worst": worst.part,
        "seconds": round(time.process_time() - start, 1),
    }


def counts(lines: list[dict[str, Any]], name: str) -> str:
    own = [line for line in lines if line["family"] == name]
    built = [line for line in own if "refused" not in line]
    right = [line for line in built if line["watertight"] and line["error"] <= WITHIN]
    return (
        f"{name:10} built {len(built)} of {len(own)}, helical {sum(x['helical'] for x in built)}, "
        f"solids {sum(x['solids'] for x in built)}, watertight {sum(x['watertight'] for x in built)}, "
        f"watertight and within 1 % {len(right)}, largest error {max((x['error'] for x in built), default=0.0):.2g}, "
        f"CPU s {sum(x['seconds'] for x in built):.0f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--machines", type=int, default=1000)
    parser.add_argument("--family", choices=list(families()))
    args = parser.parse_args()
    of = [family for name, family in families().items() if args.family in (None, name)]
    lines = json_lines(args.file)
    done = {(line["family"], line["seed"]) for line in lines}
    for seed, family in product(range(args.machines), of):
        if (family.name, seed) not in done:
            lines.append(checked(family, seed))
            add_lines(args.file, lines[-1])
    for family in of:
        print(counts(lines, family.name))


if __name__ == "__main__":
    main()
