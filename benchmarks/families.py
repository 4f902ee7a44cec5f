"""Random machines of every family, drawn within the documented bounds: how many build, closed, of the right volume.

    python benchmarks/families.py [--machines 1000] [--prisms 1000] [--partitions 60] [--solids 20] [--family NAME]
        [--json FILE]

Every machine passes the family's rules or not. Of the first `--prisms`, every prism's section is a valid polygon, so
that the prism is closed, and every part's volume as it is meshed, 144 chords per turn, is its exact one within 1 %. Of
the first `--partitions` the whole plane partition is made: no two solids overlap, faces tile the plane, and no void is
left that no fluid fills. Of the first `--solids` machines CAD solids are built and tessellated: watertight, and of the
exact volume.
"""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from geom import InputError, Machine, check_cad
from geom.description.profile import ArcGrid
from geom.description.random_geometry import random_geometry
from geom.families import families
from geom.families.family import Family
from geom.machine_file import machine_from
from geom.meshing.partition import partition
from geom.meshing.voids import filled

WITHIN = 0.01  # of the exact volume
SEGMENTS = 144


@dataclass(frozen=True)
class Drawn:
    """One draw: what is wrong with it if anything, and the worst relative volume error of a part."""

    fault: str = ""
    error: float = 0.0

    @property
    def right(self) -> bool:
        return not self.fault and self.error <= WITHIN


def machine_of(family: Family, seed: int) -> Machine:
    table = {"machine": {"family": family.name}, "geometry": random_geometry(family, np.random.default_rng(seed))}
    return machine_from(table, f"{family.name} {seed}")


def prisms(family: Family, seed: int) -> Drawn:
    """The machine of a seed, prism by prism."""
    try:
        machine = machine_of(family, seed)
    except InputError as refusal:
        return Drawn(str(refusal))
    own = [(k, prism) for k, part in enumerate(machine.parts) for prism in part.prisms]
    grid = ArcGrid([prism[0] for _, prism in own], SEGMENTS)
    shapes = np.array([prism[0].to_polygon(grid) for _, prism in own], dtype=object)
    if not shapely.is_valid(shapes).all():
        return Drawn("a section that is no valid polygon")
    long = np.array([z1 - z0 for _, (_, z0, z1) in own])
    if np.any(long <= 0.0):
        return Drawn("a prism without length")
    meshed = np.bincount([k for k, _ in own], shapely.area(shapes) * long)
    return Drawn("", max(abs(v / part.volume - 1.0) for v, part in zip(meshed, machine.parts, strict=True)))


def tiled(family: Family, seed: int) -> bool:
    """Whether the machine's plane partition has no gap, and no closed void that no fluid fills."""
    machine = machine_of(family, seed)
    try:
        cut = filled(partition((*machine.parts, *machine.fluids), SEGMENTS))
    except InputError as refusal:
        print(f"    {machine.name}: {refusal}", file=sys.stderr)
        return False
    box = shapely.box(*shapely.total_bounds(cut.faces)).area
    return bool(abs(cut.area().sum() / box - 1.0) < 1e-9)


def solid(family: Family, seed: int) -> tuple[bool, float]:
    """Whether all solids are watertight, and the largest relative error of a part's volume."""
    checks = check_cad(machine_of(family, seed), 0.2)
    return all(c.watertight for c in checks), max(abs(c.solid_volume / c.volume - 1.0) for c in checks)


def rows(family: Family, machines: int, sections: int, partitions: int, solids: int) -> list[dict[str, Any]]:
    refused = [r for r in (refusal(family, seed) for seed in range(machines)) if r]
    drawn = [prisms(family, seed) for seed in range(sections)]
    for what, times in Counter([*refused, *(d.fault for d in drawn if d.fault)]).most_common(9):
        print(f"    {times} x {what}", file=sys.stderr)
    made = [solid(family, seed) for seed in range(solids)]
    found = {
        "machines drawn": machines, "built": machines - len(refused),
        "looked at prism by prism": len(drawn), "closed": sum(not d.fault for d in drawn),
        "within 1 % of the exact volume": sum(d.right for d in drawn), "largest error": max(d.error for d in drawn),
        "partitions made": partitions, "without gap or overlap": sum(tiled(family, seed) for seed in range(partitions)),
        "solids built": len(made), "watertight": sum(tight for tight, _ in made),
        "largest error of a solid": max((error for _, error in made), default=0.0),
    }  # fmt: skip
    return [{"case": family.name, "measure": measure, "unit": "1", "ours": value} for measure, value in found.items()]


def refusal(family: Family, seed: int) -> str:
    try:
        machine_of(family, seed)
    except InputError as refused:
        return str(refused)
    return ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--machines", type=int, default=1000)
    parser.add_argument("--prisms", type=int, default=1000)
    parser.add_argument("--partitions", type=int, default=60)
    parser.add_argument("--solids", type=int, default=20)
    parser.add_argument("--family", choices=list(families()))
    parser.add_argument("--json", metavar="FILE")
    args = parser.parse_args()
    found = []
    for name, family in families().items():
        if args.family in (None, name):
            found += rows(family, args.machines, args.prisms, args.partitions, args.solids)
            for line in found[-11:]:
                print(f"{line['case']:12} {line['measure']:32} {line['ours']:10.4g}", flush=True)
    if args.json:
        computer = f"{platform.machine()}, Python {platform.python_version()}"
        head = {"benchmark": "families", "computer": computer, "date": datetime.date.today().isoformat()}
        Path(args.json).write_text(json.dumps({**head, "rows": found}, indent=1))


if __name__ == "__main__":
    main()
