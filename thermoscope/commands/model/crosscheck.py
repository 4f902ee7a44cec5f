"""thermoscope model crosscheck MACHINE"""

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.arrays import Array
from geom.errors import ThermoscopeError
from geom.escapes import csv_lines
from geom.storage import write_whole
from geom.table import Table
from lumped.transfer.ranges import within_silence
from thermoscope.case_folder.folder import load_machine_file
from thermoscope.console.options import ACCURACY, Accuracy, Json, Machine, Out
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, notes, plain, progress

if TYPE_CHECKING:
    from lumped.build.network_size import NetworkSize
    from lumped.build.pipeline import Built
    from lumped.model.network import Network
    from thermoscope.console.terminal import Progress

HOT = 200.0  # degC, what insulation bears
LOADS = {"torque_Nm": "N m", "iq_A": "A", "id_A": "A", "current_A": "A"}  # of a machine: the first it has
MOST_ROWS = 12  # rows of a long table on the screen; the files hold all


def crosscheck(machine: Machine, out: Out = None, accuracy: Accuracy = ACCURACY, target: Json = None) -> int:
    """Where network and field disagree, which link is responsible, and the hand formula beside the field's value."""
    from lumped.build.network_size import accurate_network

    source = load_machine_file(Path(machine))
    folder = out or Path("out") / source.name
    with progress() as tell:
        size = accurate_network(source, accuracy, progress=tell, say=lambda message: notes([message]))
        document = {"machine": source.name, **checked(size.built, size, tell)}
        save(document, folder)
    give(document, target, lambda: crosscheck_summary(document, folder))
    return 0 if size.met else 1


def checked(built: "Built", size: "NetworkSize | None", tell: "Progress") -> dict[str, Any]:
    """Part by part and link by link at a point where the machine settles, and the hand formulas there."""
    from lumped.build.analytical_checks import analytical_checks
    from lumped.build.crosscheck import crosscheck as compare, with_local_laws
    from lumped.machine.loss_sources import loss_shares

    tell("field against network")
    point, z = bearable(built)
    field, solver = (built.field, None) if size is None else (size.reduction.field, size.reduction.solver)
    loads = None if size is None else size.reduction.loads
    shares = loss_shares(built.machine, built.network)
    check = compare(field, built.network, point, solver=solver, loads=loads, shares=shares, z=z)
    tell("laws point by point")
    local = with_local_laws(field, built.network, point, check, shares, loads, solver).T
    tell("hand formulas")
    formulas = analytical_checks(built.machine, field, check)
    responsible = {part.place: check.responsible(part.place) for part in check.parts}
    return {
        "operating_point": point,
        "crosscheck": [
            {
                **vars(part),
                "local_max_C": float(local[field.blocks[part.place].dofs].max()),
                "responsible": None if link is None else link.link,
            }
            for part, link in zip(check.parts, responsible.values(), strict=True)
        ],
        "links": [vars(link) for link in check.links],
        "hand": [row.document() for row in formulas],
        "energy_balance": check.energy_balance,
    }


def bearable(built: "Built") -> tuple[dict[str, float], Array]:
    """The rated point with its load lowered until the machine settles, and where its network does (degC): a
    short-time rating has no steady state. The small network looks first, in a hundredth of the time.

    That it does not settle is one note; what its films leave on the way there says nothing more.

    Raises ThermoscopeError where it settles at no current: its other losses alone overheat it, or nothing cools it.
    """
    from lumped.machine.motor import rated_inputs

    rated = point = rated_inputs(built.machine)
    load, unit = next((name, unit) for name, unit in LOADS.items() if name in rated)
    small, share = built.small or built.network, 1.0
    while (z := _rest(small, point)) is None or (z := _rest(built.network, point)) is None:
        share *= 0.8
        point = {name: share * value if name in LOADS else value for name, value in rated.items()}
        if share <= 0.01:
            never = f"'{built.machine.name}' does not settle below {HOT:g} degC, even with next to no current"
            raise ThermoscopeError(never)
    if share < 1.0:
        fault = f"at {rated[load]:g} {unit} it does not settle below {HOT:g} degC"
        notes([f"{fault}: checked at {point[load]:.4g} {unit}"])
    return point, z


def _rest(network: "Network", point: Mapping[str, float]) -> Array | None:
    """Where a network comes to rest (degC), None where that is too hot for insulation, or nowhere."""
    from lumped.build.crosscheck import steady_state

    means = [i for i, state in enumerate(network.states) if "#" not in state]
    with suppress(ThermoscopeError), within_silence():  # thermal runaway: copper's losses grow faster than its cooling
        z = steady_state(network, point, 20.0)
        if z[means].min() > 0.0 and z[means].max() < HOT:
            return z
    return None


def save(document: Mapping[str, Any], folder: Path) -> None:
    """crosscheck.json, and its tables as CSV."""
    write_whole(folder / "crosscheck.json", json.dumps(plain(document), indent=2, ensure_ascii=False) + "\n")
    for name in ("crosscheck", "links", "hand"):
        file = folder / ("crosscheck.csv" if name == "crosscheck" else f"crosscheck-{name}.csv")
        rows = document[name]
        write_whole(file, csv_lines([list(rows[0]), *(list(plain(row).values()) for row in rows)] if rows else []))


def crosscheck_summary(document: Mapping[str, Any], folder: Path) -> Summary:
    """Parts, the links that differ most, and the hand formulas furthest off."""
    sentence = (
        f"Steady at the rated point the network has {agreement(document)}; the field's energy balance "
        f"{document['energy_balance']:.1e}."
    )
    point = ", ".join(f"{name} {value:.4g}" for name, value in document["operating_point"].items())
    tables = [parts(document), links(document), analytical_table(document)]
    return Summary(
        sentence, tables, f"all rows in {folder}/crosscheck*.csv; --json FILE", [f"Operating point: {point}"]
    )


def agreement(document: Mapping[str, Any]) -> str:
    """How far means, and hottest points of heated and of other parts, are off; and the part that is furthest."""
    rows: Sequence[Mapping[str, Any]] = document["crosscheck"]
    hot = {heats: [row for row in rows if row["heated"] is heats] for heats in (True, False)}
    kinds = [
        ("means", "mean_percent", rows),
        ("hottest points of heated parts", "hot_percent", hot[True]),
        ("of others", "hot_percent", hot[False]),
    ]
    return ", ".join(f"{kind} within {_furthest(some, key)}" for kind, key, some in kinds if some)


def _furthest(rows: Sequence[Mapping[str, Any]], key: str) -> str:
    worst = max(rows, key=lambda row: float(row[key]))
    return f"{worst[key]:.2g} % ({worst['place']})"


def parts(document: Mapping[str, Any]) -> Table:
    """Temperatures by field and network, the largest difference first."""
    return Table.of(
        "Temperatures (degC), 20 degC around; % of the rise",
        sorted(document["crosscheck"], key=lambda part: -max(part["mean_percent"], part["hot_percent"])),
        "part=place | field mean=fem_mean_C | network mean=network_mean_C | *field max=fem_max_C | "
        "network max=network_max_C | *mean off (%)=mean_percent | *max off (%)=hot_percent | heated | "
        "field max, laws local=local_max_C | link that differs most=responsible",
    )


def links(document: Mapping[str, Any]) -> Table:
    """Heat through links, the largest difference first."""
    columns = "link | field=fem_W | network=network_W | off (% of all heat)=percent_of_heat"
    return Table.of("Heat through links (W)", document["links"][:MOST_ROWS], columns)


def analytical_table(document: Mapping[str, Any]) -> Table:
    """Hand formulas, the furthest off first."""
    rows = sorted(document["hand"], key=lambda row: -abs(row["ratio"] - 1.0))
    columns = "link | formula | textbook=textbook_K_W | *field=field_K_W | *ratio"
    return Table.of("Hand formulas (K/W)", rows[:MOST_ROWS], columns)
