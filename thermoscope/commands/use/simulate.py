"""thermoscope use simulate CASE: inputs in, temperatures out."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from geom.arrays import Array
from geom.description.names import file_stem
from geom.errors import InputError, ThermoscopeError
from geom.escapes import csv_lines
from geom.storage import write_whole
from geom.table import Table
from geom.text import counted
from lumped.drives.coupled import coupled
from lumped.integration.balance import Audit, audit
from lumped.integration.runaway import checked_run
from lumped.integration.simulate import Record, simulate as integrated
from lumped.model.network import Network, Row
from measured.sensors.operators import observe, setting
from thermoscope.bands import bands_requested, documents, full_columns, posterior_of, predicted_bands
from thermoscope.case_folder.cycle import Cycle, find_cycle, load_cycle
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.runs import HOT, hot_spots, named_rows, sensors
from thermoscope.commands.model.error_budget import budget, in_short
from thermoscope.commands.open_case import PACKAGE, open_case
from thermoscope.console.options import Case, Json, Out, Sure
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import Progress, give, notes, progress
from validation.bands import Bands, ParameterPosterior
from validation.comparison.error_budget import error_budgets
from validation.comparison.predict import record, thermal
from validation.parameters.unknowns import standing

MISMATCH = 0.01  # of all losses: parabolas miss a hundredth of that; more means that heat went astray


def readings(network: Network, folder: Folder, name: str, record: Record, T: Array) -> Array:
    """From the temperatures T (n_time, n_sensor) at the sensors, in the order of `sensors`."""
    if not folder.case.tests:
        return T
    channels = tuple(replace(c, y=np.full(record.time.size, np.nan)) for c in sensors(folder).values())
    air = {n: np.broadcast_to(u, record.time.shape) for n, u in record.boundaries.items()}
    run = replace(folder.case.tests[0], name=name, time=record.time, inputs={}, boundaries=air, channels=channels)
    return observe(network, run, T, setting(network.parameters, folder.case.model.values))


def short_of(record: Record, share: float = 0.01) -> dict[str, float]:
    """What the drive could not deliver: quantity -> seconds for which it missed what was wanted by more than `share`.

    Of the torque or speed wanted, against the largest wanted: too little, and, where it has no brake for it, too much.
    """
    out, step = {}, np.diff(record.time, prepend=record.time[0])
    for name, demand in record.inputs.items():
        if (actual := record.inputs.get(name.replace("_wanted", ""))) is not None and "_wanted" in name:
            missed = np.abs(demand - actual) > share * np.abs(demand).max(initial=1e-12)
            out[name.replace("_wanted", "")] = float(step @ missed)
    return {name: seconds for name, seconds in out.items() if seconds > 0.0}


def simulate(
    case: Case,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A drive cycle; else all tests.")] = None,
    out: Out = None,
    target: Json = None,
    sure: Sure = None,
) -> int:
    """Drive cycle in, temperatures out: a CSV per run, and how well its heat balance closed."""
    with progress() as tell:
        folder = open_case(case, tell, untested=True)
        network, values = _model(folder)
        path = folder.settings.path
        into = out or (Path("out") / path.name if PACKAGE in path.resolve().parents else folder.settings.out)
        posterior = posterior_of(folder, tell) if bands_requested(network, sure) else None
        runs = [_ran(network, values, one, folder, into, tell, posterior) for one in _cycles(folder, network, cycle)]
        circuits = _circuits(folder)
    document = {"case": folder.case.name, "revision": folder.case.model.revision, "runs": runs, "circuits": circuits}
    give(document, target, lambda: simulation_summary(document))
    return 0


def _model(folder: Folder) -> tuple[Network, dict[str, float]]:
    """The network with the effects added, and the values of the parameters that act on heat."""
    network = standing(folder.case)
    mine = {p.name for p in thermal(network).parameters}
    return network, {k: v for k, v in folder.case.model.values.items() if k in mine}


def _cycles(folder: Folder, network: Network, cycle: str | None) -> Iterable[Cycle]:
    if cycle is None and not folder.case.tests:
        raise InputError("nothing to run", str(folder.settings.path), "--cycle NAME, or [tests.NAME] in case.toml")
    if cycle is None:
        return [Cycle(test.name, record(test, {})) for test in folder.case.tests]
    ratings = folder.built.machine.sections.get("ratings", {}) if folder.built is not None else {}
    loaded = load_cycle(find_cycle(folder.settings.path, cycle), network, ratings)
    notes(loaded.notes)
    return [loaded]


def _ran(
    network: Network,
    values: Mapping[str, float],
    cycle: Cycle,
    folder: Folder,
    into: Path,
    tell: Progress,
    posterior: ParameterPosterior | None,
) -> dict[str, Any]:
    tell(f"running {cycle.name}")
    network = cycle.on(network)
    rows, record, whole = named_rows(network, folder), cycle.record, network
    network = thermal(network)
    posterior = posterior and replace(posterior, network=cycle.on(posterior.network))
    residuals: tuple[float, ...] = ()
    if cycle.drive is None:
        run = integrated(network, record, values, list(rows.values()), keep_states=True)
    else:
        drive = coupled(network, record, cycle.drive, cycle.watched, values, list(rows.values()))
        run, record, residuals = drive.run, replace(record, inputs=drive.inputs), drive.residuals
    z = np.asarray(run.z)
    inside, hot = len(rows) - len(sensors(folder)), hot_spots(network, z)
    hottest = [z[:, r.index] @ r.weights for r in hot.values()]
    read = readings(whole, folder, cycle.name, record, run.y[:, inside:])
    y, items = np.column_stack([run.y[:, :inside], *hottest, read]), list(rows.items())
    rows = dict([*items[:inside], *hot.items(), *items[inside:]])
    checked_run(y, record.time, tuple(rows), network)
    heat = audit(network, record, values)
    if heat.mismatch > MISMATCH:
        raise ThermoscopeError(f"{cycle.name}: injected and declared losses differ by {100 * heat.mismatch:.3g} %")
    band = None if posterior is None else predicted_bands(posterior, cycle.name, record, rows)
    file = write_whole(into / f"simulate-{file_stem(cycle.name)}.csv", _csv(cycle.name, record, rows, y, band))
    budget = error_budgets(folder, {cycle.name: record}, tell)[cycle.name]
    document = _document(cycle, record, rows, y, heat, residuals, file)
    if band is not None:
        fields = documents(band)
        document["places"] = [{**p, **fields[p["place"]]} for p in document["places"]]
    return {**document, "error_budget": budget.document()}


def _csv(name: str, record: Record, rows: Mapping[str, Row], y: Array, band: Bands | None) -> str:
    inputs = full_columns(name, {**record.inputs, **record.boundaries}, record)
    head = ["time_s", *inputs, *(f"T {place} (degC)" for place in rows)]
    body = np.column_stack([record.time, *inputs.values(), y])
    if band is not None:
        head += [f"95 % T {place} (+- K)" for place in rows]
        body = np.column_stack([body, band.half95])
    return csv_lines([head]) + "\n".join(",".join(f"{x:.7g}" for x in line) for line in body) + "\n"


def _document(
    cycle: Cycle,
    record: Record,
    rows: Mapping[str, Row],
    y: Array,
    heat: Audit,
    residuals: tuple[float, ...],
    file: Path,
) -> dict[str, Any]:
    span, short = float(record.time[-1] - record.time[0]) or 1.0, short_of(record)
    hottest = np.argmax(y, axis=0)
    return {
        "name": cycle.name,
        "file": str(file),
        "duration_s": span,
        "places": [
            {
                "place": name,
                "start_C": y[0, k],
                "max_C": y[hottest[k], k],
                "max_at_s": record.time[hottest[k]],
                "end_C": y[-1, k],
            }
            for k, name in enumerate(rows)
        ],
        "losses": [
            {"loss": n, "declared_J": J, "injected_J": heat.injected_J[n], "mean_W": J / span}
            for n, J in heat.declared_J.items()
        ],
        "energy_balance": heat.residual,
        "loss_mismatch": heat.mismatch,
        "short_of": {name: seconds / span for name, seconds in short.items()},
        "short_of_s": short,
        "coupling": {"rounds": len(residuals), "residuals_K": list(residuals)},
    }


def _circuits(folder: Folder) -> list[dict[str, Any]]:
    """Pressure drop and pump power of declared coolant circuits at their usual flow."""
    if folder.settings.network is None:
        return []
    from lumped.declarations.network import load_circuits

    circuits = load_circuits(folder.settings.network)
    return [
        {"circuit": n, "flow_m3_s": c.flow, "pressure_drop_Pa": c.pressure_drop(), "pump_W": c.pump_power()}
        for n, c in circuits.items()
    ]


def simulation_summary(document: Mapping[str, Any]) -> Summary:
    """The hottest place of each run; per run temperatures, losses, and how well it closed."""
    runs = document["runs"]
    hottest = [(p["max_C"], p["place"], r["name"]) for r in runs for p in r["places"]]
    top = max(hottest)
    where, many = top[1].removeprefix(HOT), "run" if len(runs) == 1 else "runs"
    sentence = f"Hottest: {where}, {top[0]:.1f} degC in {top[2]}; {len(runs)} {many}."
    budgets, closing = {run["name"]: run["error_budget"] for run in runs}, [x for run in runs for x in _closing(run)]
    parts: list[Table | str] = [_places(runs), *closing, in_short(budgets, {}), *map(_circuit, document["circuits"])]
    rest = [*(_losses(run) for run in runs), *budget(budgets, {})]
    return Summary(sentence, parts, f"temperatures in {runs[0]['file']}{' ...' if len(runs) > 1 else ''}", rest)


def _places(runs: Sequence[Mapping[str, Any]]) -> Table:
    """Temperatures, the hottest first."""
    rows = [{"run": r["name"], **p} for r in runs for p in sorted(r["places"], key=lambda p: -p["max_C"])]
    band = " | *95 % band (K)=widest_ci95_K" if all("widest_ci95_K" in row for row in rows) else ""
    return Table.of(
        "",
        rows,
        "place | *run | start (degC)=start_C | *largest (degC)=max_C | at (s)=max_at_s | *end (degC)=end_C" + band,
        max_at_s=lambda p: round(p["max_at_s"]),
    )


def _losses(run: Mapping[str, Any]) -> Table:
    losses = sorted((x for x in run["losses"] if x["mean_W"]), key=lambda x: -x["mean_W"])
    return Table.of(f"Losses in {run['name']}", losses, "loss | mean (W)=mean_W")


def _closing(run: Mapping[str, Any]) -> list[str]:
    """What the drive could not do, whether it agrees with the temperatures, and the balance of heat."""
    lines = [
        f"{name}: for {100 * share:.3g} % of the time short of what was wanted by more than 1 %, at the limits: "
        f"{run['short_of_s'][name]:.4g} s."
        for name, share in run["short_of"].items()
    ]
    if rounds := run["coupling"]["residuals_K"]:
        again = counted(len(rounds), "round")
        lines.append(f"Drive and temperatures agree after {again} (last change {rounds[-1]:.2g} K).")
    return [
        *lines,
        f"{run['name']}: heat in - out - stored {run['energy_balance']:.1e} of the heat, losses injected "
        f"against declared {run['loss_mismatch']:.1e}.",
    ]


def _circuit(c: Mapping[str, Any]) -> str:
    return (
        f"Circuit {c['circuit']}: {c['flow_m3_s'] * 6e4:.3g} l/min, {c['pressure_drop_Pa'] / 1e3:.3g} kPa, "
        f"pump {c['pump_W']:.3g} W."
    )
