"""The network that a case runs against its field, at hot spots of heated parts and of others, far from its own point.

    python benchmarks/condensed/case_network.py [MACHINE ...] [--json FILE [--page]]

Points: nominal; all films x0.3 and x10; all contacts x0.2 and x5; every film and contact drawn between x0.2 and x5.
Steady, errors are in percent of the part's own rise, at least a tenth of the machine's largest. After a step of loss,
from 30 s to two hours, in percent of the machine's largest rise at that time. Rated losses, fluids and streams.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from lumped.build.crosscheck import FLOOR
from lumped.build.fixed_coefficients import FixedCoefficients, rated
from lumped.build.pipeline import ACROSS, AXIAL, CASE, Meshing, Prepared, meshed, networks_of, reduced
from lumped.machine.bases import on_all, on_every_base
from lumped.model.network import Array, Network
from scripts.published import kept_rows, machine_arguments, publish, table, write_rows
from thermoscope.case_folder.folder import load_machine_file

PAGE = Path("docs/condensation.md")
KINDS = ("heated", "other")  # parts
EARLY = 2  # steps of 10 s that are left out


def points(nominal: FixedCoefficients) -> dict[str, FixedCoefficients]:
    """What is compared, by name."""
    out = {"nominal": nominal}
    for f in (0.3, 10.0):
        out[f"films x{f:g}"] = replace(nominal, films={k: f * v for k, v in nominal.films.items()})
    for f in (0.2, 5.0):
        out[f"contacts x{f:g}"] = replace(nominal, contacts={k: f * v for k, v in nominal.contacts.items()})
    return {**out, "drawn x0.2 to x5": nominal.moved(5.0, seed=7)}


def fields(ready: Prepared, asked: dict[str, FixedCoefficients]) -> dict[str, list[Array]]:
    """The field at every point, and after the steps of loss at two of them."""
    out = {name: [point.of_field(ready.field)] for name, point in asked.items()}
    for name in [name for name in ("nominal", "contacts x5") if name in asked]:
        out[f"step of loss, {name}"] = list(asked[name].steps_of_field(ready.field))[EARLY:]
    return out


def errors(
    ready: Prepared, network: Network, asked: dict[str, FixedCoefficients], exact: dict[str, list[Array]]
) -> Iterator[tuple[str, str, str, float]]:
    """(point, kind of part, the part that is furthest off, percent)"""
    for name, curve in exact.items():
        step = name.startswith("step of loss, ")
        point = asked[name.removeprefix("step of loss, ")]
        own = (
            list(point.steps_of_network(network, ready.field))[EARLY:]
            if step
            else [point.of_network(network, ready.field)]
        )
        off = dict.fromkeys(ready.field.blocks, 0.0)
        for T, x in zip(curve, own, strict=True):
            largest = float(T[: ready.field.n].max())
            for part in off:
                dofs = ready.field.blocks[part].dofs
                rise = largest if step else max(float(T[dofs].max()), FLOOR * largest)
                off[part] = max(off[part], 100.0 * abs(float(T[dofs].max() - x[dofs].max())) / rise)
        for kind in KINDS:
            those = [part for part in off if (part in point.watts) == (kind == "heated")]
            worst = max(those, key=lambda part: off[part])
            yield name, kind, worst, off[worst]


def networks_on(machine: str) -> tuple[Prepared, list[Network], FixedCoefficients]:
    """The mesh of a case, its network and the small one that its diagnosis runs, and the rated point."""
    described = on_all(load_machine_file(Path(machine)))
    ready = meshed(described, Meshing(0.06, 48, ACROSS, 0.06 * AXIAL))
    networks = [on_every_base(x) for x in networks_of(described, reduced(ready, CASE), CASE)]
    return ready, networks, rated(described, networks[0], ready.films, ready.contacts)


def rows(machine: str) -> Iterator[dict[str, Any]]:
    """Of both networks at every point."""
    ready, networks, nominal = networks_on(machine)
    asked = points(nominal)
    exact = fields(ready, asked)
    for network in networks:
        for point, kind, part, percent in errors(ready, network, asked, exact):
            yield {
                "machine": machine,
                "states": len(network.states),
                "case": point,
                "kind": kind,
                "measure": f"hot spot of {part}",
                "unit": "%",
                "ours": round(percent, 3),
            }


def main() -> None:
    given = machine_arguments(__doc__)
    found = kept_rows(given)
    for machine in given.machines:
        for row in rows(machine):
            found.append(row)
            case = f"{machine}, {row['states']} states, {row['case']}, {row['kind']}"
            print(f"{case:70} {row['ours']:6.2f} {row['unit']}  {row['measure']}", flush=True)
        write_rows(given.json, "case_network", found)
    if given.page:
        publish(PAGE, "case-network", errors_table(found, max))
        publish(PAGE, "small-network", errors_table(found, min))


def errors_table(found: Sequence[Mapping[str, Any]], which: Callable[[set[int]], int]) -> str:
    """Percent at the part that is furthest off, heated and other: a row per point, a column per machine.

    which : of the numbers of states of a machine's networks
    """
    machines = list(dict.fromkeys(row["machine"] for row in found))
    states = {m: which({row["states"] for row in found if row["machine"] == m}) for m in machines}
    cells = {
        (row["case"], row["machine"], row["kind"]): f"{row['ours']:.1f}"
        for row in found
        if row["states"] == states[row["machine"]]
    }
    rows: list[list[object]] = [["states", *(states[m] for m in machines)]]
    for case in dict.fromkeys(row["case"] for row in found):
        rows.append([case, *(" / ".join(cells[case, m, kind] for kind in KINDS) for m in machines)])
    return table(["heated / other", *machines], rows)


if __name__ == "__main__":
    main()
