"""The network that a case runs where one film or one contact alone is another, and where all are drawn at once.

    python benchmarks/condensed/one_by_one.py [MACHINE ...] [--json FILE [--page]]

Every film x0.3 and x10 and every contact x0.2 and x5, each alone; then twelve draws of all of them between x0.2 and
x5, and twelve where each stands as it is or at an end. Steady, at rated losses: the hottest point of the part that is
furthest off, as in case_network.py.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from case_network import KINDS, PAGE, errors, fields, networks_on

from lumped.build.fixed_coefficients import FixedCoefficients
from scripts.published import kept_rows, machine_arguments, publish, table, write_rows

HEAD = ("machine", "states", "changed", "points", "heated (%)", "that is", "where", "other (%)", "that is", "where")
DRAWS = range(100, 112)  # seeds
ENDS = {"films": (0.3, 1.0, 10.0), "contacts": (0.2, 1.0, 5.0)}


def groups(nominal: FixedCoefficients) -> dict[str, dict[str, FixedCoefficients]]:
    """What is changed -> its points, by name."""
    h, g = nominal.films, nominal.contacts
    alone = {f"{k} x{f:g}": replace(nominal, films={**h, k: f * h[k]}) for k in h for f in (0.3, 10.0)}
    alone |= {f"{k} x{f:g}": replace(nominal, contacts={**g, k: f * g[k]}) for k in g for f in (0.2, 5.0)}
    return {
        "one film or contact": alone,
        "all, drawn": {f"draw {k - 99}": nominal.moved(5.0, k) for k in DRAWS},
        "all, ends drawn": {f"draw {k - 99}": at_ends(nominal, k) for k in DRAWS},
    }


def at_ends(nominal: FixedCoefficients, seed: int) -> FixedCoefficients:
    """Every film and contact as it is or at an end of its range."""
    rng = np.random.default_rng(seed)
    h, g = ({k: v * float(rng.choice(ENDS[of])) for k, v in getattr(nominal, of).items()} for of in ENDS)
    return replace(nominal, films=h, contacts=g)


def rows(machine: str) -> Iterator[dict[str, Any]]:
    """The worst point of each group, for heated parts and for others."""
    ready, (network, _), nominal = networks_on(machine)
    for group, asked in groups(nominal).items():
        each = ({name: point} for name, point in asked.items())
        off = [row for one in each for row in errors(ready, network, one, fields(ready, one))]
        for kind in KINDS:
            at, _, part, percent = max((row for row in off if row[1] == kind), key=lambda row: row[3])
            head = {"machine": machine, "states": len(network.states), "case": group, "points": len(asked)}
            yield {**head, "kind": kind, "part": part, "at": at, "unit": "%", "ours": round(percent, 3)}


def points_table(found: Sequence[Mapping[str, Any]]) -> str:
    rows = []
    for heated, other in zip(found[::2], found[1::2], strict=True):
        each = [(f"{r['ours']:.1f}", r["part"], str(r["at"]).replace("|", " on ")) for r in (heated, other)]
        rows.append([*(other[key] for key in ("machine", "states", "case", "points")), *each[0], *each[1]])
    return table(HEAD, rows)


def main() -> None:
    given = machine_arguments(__doc__)
    found = kept_rows(given)
    for machine in given.machines:
        found += rows(machine)
        print(points_table(found), flush=True)
        write_rows(given.json, "one_by_one", found)
    if given.page:
        publish(PAGE, "one-by-one", points_table(found))


if __name__ == "__main__":
    main()
