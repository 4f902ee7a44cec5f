"""thermoscope rate CASE|MACHINE: what it may carry, for how long, and how sure that is."""

from __future__ import annotations

import json
import tempfile
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from geom.errors import InputError
from lumped.correlations import RangeWarning
from lumped.integration.simulate import Record
from lumped.model.quantities import USUAL
from lumped.schemas.reader import known
from thermoscope.bands import along, posterior_of, wanted
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.runs import before_last, named_rows
from thermoscope.commands.open_case import open_case
from thermoscope.commands.use.export import read_limits
from thermoscope.console.answer import Answer, Grid
from thermoscope.console.terminal import Progress, give, notes, progress
from thermoscope.recordings.csv_file import read_csv
from thermoscope.verification.error_budget import model_of
from validation.bands import ParameterPosterior
from validation.rating.derating import deratings
from validation.rating.envelope import FORMS, TIMES, Rating, rated, until
from validation.rating.loss_grid import SPEED, TORQUE, loss_grid, with_losses
from validation.rating.operation import Operation, operation
from validation.rating.points import Model

NORMAL_95 = 1.96
POINTS = 6  # speeds of the envelope
WARM = 0.75  # load at rest from which an overload begins warm
SETTLED = 20.0  # time constants


@dataclass(frozen=True)
class Asked:
    """limits : place -> degC;  at : input or boundary -> value;  losses : a map, at a voltage;  overload : of S1"""

    limits: Mapping[str, float]
    at: Mapping[str, float]
    losses: Path | None = None
    voltage: float | None = None
    overload: float = 1.5
    top_rpm: float | None = None


def rate(
    name: str, limits: Sequence[str], at: Sequence[str], losses: Path | None, voltage: float | None, overload: float,
    top_rpm: float | None, sure: bool | None, target: str | None,
) -> int:  # fmt: skip
    """Ratings of a case, or of a machine with nothing measured."""
    asked = Asked(read_limits(limits), read_at(at), losses, voltage, overload / 100.0, top_rpm)
    if not asked.limits:
        raise InputError("no limit is given", "--limit", "PLACE=DEGC, for example winding=155")
    with progress() as tell, once() as said:
        folder = case_or_machine(name, tell)
        document = {"case": folder.case.name, "revision": folder.case.model.revision,
                    **document_of(folder, asked, sure, tell)}  # fmt: skip
    notes(said)
    give(document, target, lambda: answer(document))
    return 0


def read_at(said: Sequence[str]) -> dict[str, float]:
    """NAME=VALUE, ..."""
    out = {}
    for one in said:
        name, _, value = one.rpartition("=")
        try:
            out[name] = float(value)
        except ValueError:
            name = ""
        if not name or not np.isfinite(out[name]):
            raise InputError(f"'{one}' is no operating point", "--at", "NAME=VALUE, for example speed_rpm=2000")
    return out


def case_or_machine(name: str, tell: Progress) -> Folder:
    """A case, or a machine on its own as a case without tests."""
    from geom import library

    path = Path(name)
    if not (path.is_file() or (not path.exists() and name in library())):
        return open_case(name, tell, untested=True)
    with tempfile.TemporaryDirectory() as folder:
        machine = str(path.resolve()) if path.is_file() else name
        text = f"[case]\nname = {json.dumps(path.stem)}\nmachine = {json.dumps(machine)}\n"
        Path(folder, "case.toml").write_text(text, encoding="utf-8")
        return open_case(folder, tell, untested=True)


def columns_of(file: Path) -> dict[str, np.ndarray]:
    """The columns of a loss map as numbers."""
    import pandas as pd

    if not file.is_file():
        raise InputError("no such file", f"--losses {file}", "a CSV file with a row per torque and speed")
    table = read_csv(file)
    out = {}
    for name in table.columns:
        numbers = pd.to_numeric(table[name], errors="coerce").to_numpy(float)
        if not np.all(np.isfinite(numbers)):
            row = int(np.argmin(np.isfinite(numbers)))
            raise InputError(f"column '{name}' has no number in row {row + 2}", str(file), "numbers in every row")
        out[str(name)] = numbers
    return out


@contextmanager
def once() -> Iterator[list[str]]:
    """What correlations and maps say of their ranges: the last word of each instead of hundreds."""
    said: list[str] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", RangeWarning)
        yield said
    last = {str(w.message).split("=")[0]: str(w.message) for w in caught}
    said.extend(f"{what} (a rating looks beyond what it ends at)" for what in last.values())


def document_of(folder: Folder, asked: Asked, sure: bool | None, tell: Progress) -> dict[str, Any]:
    model, op = _model(folder, asked)
    tell("ratings")
    here = {form: rated(model, op, asked.limits, form, None) for form in FORMS}
    earlier = before_last(folder)
    before = {}
    if earlier is not None:
        tell("ratings of the model before its last step")
        old, _ = _model(replace(folder, case=earlier), asked)
        before = {form: rated(old, op, asked.limits, form, None).load for form in FORMS}
    belief = posterior_of(folder, tell) if asked.losses is None and wanted(model.network, sure) else None
    tell("envelope over the speed")
    speeds = _speeds(folder, op, asked)
    envelope = [rated(model, op, asked.limits, form, n) for form in ("S1", "S2 60 s", "S2 10 s") for n in speeds]
    tell("derating")
    load, main = here["S1"].load, op.inputs[op.main]
    return {
        "limits": [{"place": p, "degC": T} for p, T in asked.limits.items()],
        "reference": {"input": op.main, "value": main, "inputs": dict(op.inputs), "boundaries": dict(op.boundaries)},
        "ratings": [_row(folder, asked, op, r, before.get(f), belief) for f, r in here.items()],
        "envelope": [{"form": r.form, "speed_rpm": r.speed, "value": r.load * main, "at": r.at} for r in envelope],
        "derating": [{"of": d.of, "value": d.value, "unit": d.unit, "share": d.load / load}
                     for d in deratings(model, op, asked.limits)],
        "overload": _overload(model, op, asked, load),
    }  # fmt: skip


def _model(folder: Folder, asked: Asked) -> tuple[Model, Operation]:
    network, values = model_of(folder)
    rows = named_rows(network, folder)
    for place in asked.limits:
        if place not in rows:
            raise InputError(f"no temperature '{place}' to limit", "--limit", known(place, rows))
    tests = folder.case.tests
    if asked.losses is not None:
        grid = loss_grid(columns_of(asked.losses), str(asked.losses), asked.voltage)
        network = with_losses(network, grid, str(asked.losses))
        network = replace(network, quantities={TORQUE: USUAL[TORQUE], SPEED: USUAL[SPEED], **network.quantities})
        asked = replace(asked, at={TORQUE: float(grid.torque.max()), SPEED: float(np.median(grid.speed)), **asked.at})
        tests = ()
    around = {b: u for b, u in _air(folder).items() if b in network.boundaries}
    op = operation(network, tests, {**(around if asked.losses else {}), **asked.at})
    mine = {p.name for p in network.parameters}
    return Model(network, {k: v for k, v in values.items() if k in mine}, [rows[p] for p in asked.limits]), op


def _air(folder: Folder) -> dict[str, float]:
    """Boundaries at the mean of the tests."""
    names = {b for t in folder.case.tests for b in t.boundaries}
    tests = folder.case.tests
    return {b: float(np.mean([np.mean(t.boundaries[b]) for t in tests if b in t.boundaries])) for b in names}


def _speeds(folder: Folder, op: Operation, asked: Asked) -> list[float]:
    """From rest to the largest speed that was recorded or asked for."""
    if op.speed is None:
        return []
    seen = [float(np.max(np.abs(t.inputs[op.speed]))) for t in folder.case.tests if op.speed in t.inputs]
    top = asked.top_rpm or max([abs(op.inputs[op.speed]), *seen])
    return [float(n) for n in np.linspace(0.0, top, POINTS)] if top > 0.0 else []


def _row(
    folder: Folder, asked: Asked, op: Operation, r: Rating, before: float | None, of: ParameterPosterior | None
) -> dict[str, Any]:
    main = op.inputs[op.main]
    half = _half95(folder, op, r, of) if of is not None and np.isfinite(r.load) and r.slope > 0.0 else None
    ci95 = None if half is None else [(r.load - half) * main, (r.load + half) * main]
    change = None if not before or not np.isfinite(before) else 100.0 * (r.load / before - 1.0)
    return {
        "form": r.form, "value": r.load * main, "ci95": ci95, "at": r.at,
        "before": None if before is None else before * main, "change_percent": change,
    }  # fmt: skip


def _half95(folder: Folder, op: Operation, r: Rating, of: ParameterPosterior) -> float:
    """Half the 95 % band of a load. Duties take that of rest: their mean heat is what counts."""
    network = of.network
    span = TIMES.get(r.form, SETTLED * network.settles_s)
    time = np.concatenate([[0.0], span * np.geomspace(1e-3, 1.0, 40)])
    load = r.load if r.form == "S1" or r.form in TIMES else r.load * 0.4**0.5
    inputs = {n: np.full(time.size, u) for n, u in op.at(load).items()}
    air = {b: np.full(time.size, T) for b, T in op.boundaries.items()}
    found = along(of, "rating", Record(time, inputs, air, float(np.mean(list(op.boundaries.values())))),
                  {r.at: named_rows(network, folder)[r.at]})  # fmt: skip
    return float(found.half95[-1, 0] / r.slope)


def _overload(model: Model, op: Operation, asked: Asked, load: float) -> dict[str, Any]:
    """How long at a multiple of the continuous rating, from cold and from rest at three quarters of it."""
    if not np.isfinite(load):
        return {}
    most = list(asked.limits.values())
    cold, warm = (until(model, op, most, asked.overload * load, None, w) for w in (None, WARM * load))
    return {"percent": 100.0 * asked.overload, "from_cold_s": cold, "from_warm_s": warm, "warm_percent": 100.0 * WARM}


def answer(document: Mapping[str, Any]) -> Answer:
    """The continuous rating with its band; the other forms; envelope and derating."""
    first, main = document["ratings"][0], document["reference"]["input"]
    band = "" if first["ci95"] is None else f" ({first['ci95'][0]:.4g} to {first['ci95'][1]:.4g})"
    sentence = f"Continuous: {main} = {first['value']:.4g}{band}, limited by {first['at'] or 'nothing'}."
    rows = [[r["form"], r["value"], *(r["ci95"] or (None, None)), r["at"], r["before"], r["change_percent"]]
            for r in document["ratings"]]  # fmt: skip
    headers = ["form", main, "95 % from", "to", "limited by", "before", "change (%)"]
    parts: list[Grid | str] = [Grid("", headers, rows, keep=[main, "95 % from", "to", "change (%)"])]
    if over := document["overload"]:
        parts.append(f"{over['percent']:g} % of it: {over['from_cold_s']:.4g} s from cold, {over['from_warm_s']:.4g} s "
                     f"from rest at {over['warm_percent']:g} %.")  # fmt: skip
    derated = [[d["of"], d["value"], d["unit"], 100.0 * d["share"]] for d in document["derating"]]
    parts.append(Grid("Continuous rating elsewhere", ["over", "value", "unit", "% of it"], derated))
    envelope = [[e["form"], e["speed_rpm"], e["value"], e["at"]] for e in document["envelope"]]
    parts.append(Grid("Over the speed", ["form", "speed (1/min)", main, "limited by"], envelope))
    return Answer(sentence, parts, "--json FILE; --limit, --at, --losses")
