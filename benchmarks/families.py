"""Random machines of every family: within the documented bounds all build, beyond them all are built or told how.

    python benchmarks/families.py [--machines 1000] [--prisms 1000] [--partitions 60] [--beyond 2000] [--family NAME]
        [--winding hairpin] [--json FILE]

Every machine passes the family's rules or not. Of the first `--prisms`, every prism's section is a valid polygon, so
that the prism is closed, and every part's volume as it is meshed, 144 chords per turn, is its exact one within 1 %. Of
the first `--partitions` the whole plane partition is made: no two solids overlap, faces tile the plane, and no void is
left that no fluid fills. (family_solids.py builds their CAD solids.)

For `--beyond` machines the bounds of all ratios are made half as wide again. One length is beyond its bounds and all
else random within them; in as many machines all lengths are random within the wider bounds. Lengths are given in mm,
each within its own range. What a refusal asks for is done and the machine built again, until it is built.
"""

import re
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from geom import InputError, Machine
from geom.description.parameters import UNITS, Parameter
from geom.description.profile import ArcGrid
from geom.description.reading import read_geometry
from geom.families.family import Family
from geom.families.random_geometry import random_geometry
from geom.machine_file import families, machine_from
from geom.meshing.partition import filled, partition
from scripts.published import benchmark_parser, write_rows

WITHIN = 0.01  # of the exact volume
WIDER = 1.5  # bounds of ratios, beyond which machines are drawn
MOST = 60  # changes: more than any family has lengths
Table = dict[str, dict[str, Any]]
SEGMENTS = 144


@dataclass(frozen=True)
class Drawn:
    """One draw: what is wrong with it if anything, and the worst relative volume error of a part."""

    fault: str = ""
    error: float = 0.0

    @property
    def right(self) -> bool:
        return not self.fault and bool(self.error <= WITHIN)


def wound(family: Family, kind: str) -> Family | None:
    """The family with windings of one kind."""
    one = [p for p in family.parameters if p.key == "winding.kind" and kind in p.choices]
    others = tuple(replace(p, choices=(kind,)) if p in one else p for p in family.parameters)
    return replace(family, parameters=others) if one else None


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


def widened(p: Parameter) -> Parameter:
    """Its ratio with bounds WIDER times as far apart; a lower bound is at most halved, so that it stays a length."""
    if p.of is None:
        return p
    more = (WIDER - 1) / 2 * (p.of.high - p.of.low)
    return replace(p, of=replace(p.of, low=max(p.of.low - more, p.of.low / 2), high=p.of.high + more))


def one_beyond(family: Family, rng: np.random.Generator) -> Table | None:
    """A machine within the bounds, one of whose lengths leaves them; None if it leaves its own range too."""
    lengths = [p for p in family.parameters if p.of is not None]
    table, p = random_geometry(family, rng), lengths[rng.integers(len(lengths))]
    far = widened(p).of
    assert p.of is not None
    assert far is not None
    ratio = rng.uniform(far.low, p.of.low) if rng.random() < 0.5 else rng.uniform(p.of.high, far.high)
    values = read_geometry(family.parameters, table, "")
    length = (p.of.start(values) + ratio * p.of.span(values)) / UNITS[p.unit]
    table[p.group].pop(p.ratio_name, None)
    table[p.group][p.name] = float(length)
    return table if p.low <= length <= p.high else None


def all_beyond(family: Family, rng: np.random.Generator) -> Table | None:
    """All lengths in mm, within the wider bounds; None if one leaves its own range."""
    wide = replace(family, parameters=tuple(map(widened, family.parameters)))
    table = random_geometry(wide, rng)
    values = read_geometry(wide.parameters, table, "")
    for p in family.parameters:
        if p.ratio_name in table[p.group]:
            table[p.group][p.name] = float(getattr(getattr(values, p.group), p.attribute) / UNITS[p.unit])
            del table[p.group][p.ratio_name]
            if not p.low <= table[p.group][p.name] <= p.high and table[p.group][p.name] != 0.0:
                return None
    return table


def changes(family: Family, table: Table) -> int | None:
    """How many lengths are changed, as refusals ask, until the machine is built; None if one asks for nothing."""
    lengths = {(p.group, key): p for p in family.parameters for key in (p.name, p.ratio_name)}
    for n in range(MOST):
        try:
            machine_from({"machine": {"family": family.name}, "geometry": table})
            return n
        except InputError as refusal:
            asked = re.search(r"\[geometry\.(\w+)\] (\w+) = (\S+) (fits|is a beginning)$", refusal.right)
        if asked is None:
            return None
        group, name, value, _ = asked.groups()
        p = lengths[group, name]
        rest = {key: entry for key, entry in table[group].items() if key not in (p.name, p.ratio_name)}
        table = {**table, group: {**rest, name: float(value)}}
    return None


def beyond(family: Family, draw: Callable[[Family, np.random.Generator], Table | None], machines: int) -> Counter[Any]:
    """How many machines need how many changes."""
    rng, times = np.random.default_rng(24), Counter[Any]()
    while times.total() < machines:
        table = draw(family, rng)
        if table is not None:
            times[changes(family, table)] += 1
    return times


def refusals(family: Family, machines: int) -> dict[str, int]:
    out = {}
    for what, draw in (("one length beyond", one_beyond), ("all lengths wide", all_beyond)):
        times = beyond(family, draw, machines)
        several = [n for n in times if n is not None and n > 1]
        values = {
            "machines": machines,
            "built": times[0],
            "one change cures": times[1],
            "several changes cure": sum(times[n] for n in several),
            "most changes": max(several, default=0),
            "refused without advice": times[None],
        }
        out |= {f"{what}: {name}": n for name, n in values.items()}
    return out


def rows(family: Family, machines: int, sections: int, partitions: int, wide: int) -> list[dict[str, Any]]:
    refused = [r for r in (refusal(family, seed) for seed in range(machines)) if r]
    drawn = [prisms(family, seed) for seed in range(sections)]
    for what, times in Counter([*refused, *(d.fault for d in drawn if d.fault)]).most_common(9):
        print(f"    {times} x {what}", file=sys.stderr)
    found = {
        "machines drawn": machines,
        "built": machines - len(refused),
        "looked at prism by prism": len(drawn),
        "closed": sum(not d.fault for d in drawn),
        "within 1 % of the exact volume": sum(d.right for d in drawn),
        "largest error": max(d.error for d in drawn),
        "partitions made": partitions,
        "without gap or overlap": sum(tiled(family, seed) for seed in range(partitions)),
        **refusals(family, wide),
    }
    return [{"case": family.name, "measure": measure, "unit": "1", "ours": value} for measure, value in found.items()]


def refusal(family: Family, seed: int) -> str:
    try:
        machine_of(family, seed)
    except InputError as refused:
        return str(refused)
    return ""


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--machines", type=int, default=1000)
    parser.add_argument("--prisms", type=int, default=1000)
    parser.add_argument("--partitions", type=int, default=60)
    parser.add_argument("--beyond", type=int, default=2000)
    parser.add_argument("--family", choices=list(families()))
    parser.add_argument("--winding", help="of all machines; families without such a winding are left out")
    args = parser.parse_args()
    found = []
    drawn = {
        name: family if args.winding is None else wound(family, args.winding) for name, family in families().items()
    }
    for name, family in drawn.items():
        if args.family in (None, name) and family is not None:
            found += rows(family, args.machines, args.prisms, args.partitions, args.beyond)
            for line in found[-20:]:
                print(f"{line['case']:12} {line['measure']:44} {line['ours']:10.4g}", flush=True)
    write_rows(args.json, "families", found)


if __name__ == "__main__":
    main()
