"""thermoscope use fleet CASE RECORDINGS...: what differs between motors that should be equal, and which stands out."""

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from extras.monitor.fleet import Population, population
from extras.monitor.fleet.population import DIFFERS
from extras.monitor.rows.fleet import STEP_S, Reader, histories, recordings
from thermoscope import InputError, plugin as th

WIDE = 50.0  # spread (%) of a parameter beyond which motors of one type seldom are; films and joints drift by a third
FAR, LEAST_K = 3.0, 0.3  # times the usual error, and what that is at least: below it only noise is left


def fleet(
    case: th.CaseArgument,
    recordings: Annotated[list[Path], typer.Argument(metavar="RECORDINGS...", help="UNIT@2026-03.csv, or folders.")],
    like: Annotated[str | None, typer.Option(metavar="TEST", help="As in this test; else the first that fits.")] = None,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler.")] = None,
    json: th.JsonOption = None,
) -> int:
    """Motors that should be equal: what differs between them, what drifts over the months, which one stands out."""
    with th.progress() as tell:
        document = fleet_document(case, recordings, like, cluster, tell)
    th.give(document, json, lambda: fleet_summary(document))
    return 0


@th.one_blas_thread
def fleet_document(
    case: str, names: Sequence[Path], like: str | None, cluster: str | None, tell: th.Progress
) -> dict[str, Any]:
    """like : the test whose sheet the recordings have, else the first that fits;  cluster : of a Dask scheduler"""
    files, folder = recordings(names), th.open_case(case, tell)
    sheets = {e.name: e.sheet for e in folder.settings.tests}
    if like is not None and like not in sheets:
        raise InputError(f"no test '{like}'", "--like", th.suggestion(like, sheets))
    of = {name: th.load_sheet(sheet) for name, sheet in sheets.items() if like in (None, name)}
    reader = Reader(replace(folder.case, tests=()), folder.case.tests, of, folder.settings.sample_s or STEP_S)
    with th.dask_cluster(cluster) if cluster else nullcontext() as executor:
        units = histories(files, reader, tell, executor)
    tell("the motors together")
    fits = {u.name: float(np.sqrt(np.mean([s.rmse_K**2 for s in u.parts]))) for u in units}
    head = {"case": folder.case.name, "revision": folder.case.model.revision, "recordings": len(files)}
    return {**head, **_document(population(units), fits)}


def _document(of: Population, fits: Mapping[str, float]) -> dict[str, Any]:
    parameters = []
    for k, name in enumerate(of.names):
        row: dict[str, Any] = {
            "name": name,
            "mean": np.exp(of.mean[k]),
            "mean_ci95": _factor(of.mean[k], of.mean_sd[k]),
            "spread_percent": 100.0 * of.spread[k],
            "differs": bool(of.spread_probability[k] < DIFFERS),
            "probability_equal": of.spread_probability[k],
        }
        if of.drift is not None and of.drift_sd is not None and of.drift_spread is not None:
            low, high = of.drift[k] - th.NORMAL_95 * of.drift_sd[k], of.drift[k] + th.NORMAL_95 * of.drift_sd[k]
            row["drift_percent_year"] = 100.0 * of.drift[k]
            row["drift_ci95"] = [100.0 * low, 100.0 * high]
            row["drift_spread_percent_year"] = 100.0 * of.drift_spread[k]
            row["drifts"] = bool(low > 0.0 or high < 0.0)
        parameters.append(row)
    return {
        "units": [
            {
                "unit": name,
                "rmse_K": fits[name],
                "parameters": {n: np.exp(of.posterior[i, k]) for k, n in enumerate(of.names)},
                "ci95": {n: _factor(of.posterior[i, k], of.posterior_sd[i, k]) for k, n in enumerate(of.names)},
                **_drifts(of, i),
            }
            for i, name in enumerate(of.units)
        ],
        "parameters": parameters,
        "outliers": [
            {
                "unit": o.unit,
                "parameter": o.parameter,
                "factor": np.exp(o.change),
                "factor_ci95": _factor(o.change, o.sd),
                "z": o.z,
                "probability": o.probability,
                "instead": o.instead,
            }
            for o in of.outliers
        ],
    }


def _drifts(of: Population, i: int) -> dict[str, Any]:
    if of.unit_drift is None or of.unit_drift_sd is None:
        return {}
    pairs = zip(of.unit_drift[i], th.NORMAL_95 * of.unit_drift_sd[i], strict=True)
    rows = {n: [100.0 * (drift + s * half) for s in (-1.0, 1.0)] for n, (drift, half) in zip(of.names, pairs)}
    return {"drift_percent_year": rows}


def _factor(mean: float, sd: float) -> list[float]:
    return [float(np.exp(mean - th.NORMAL_95 * sd)), float(np.exp(mean + th.NORMAL_95 * sd))]


def unequal_words(document: Mapping[str, Any]) -> str:
    """A warning where the recordings are hardly of equal motors; "" where nothing speaks against it."""
    usual = float(np.median([u["rmse_K"] for u in document["units"]]))
    other = [u["unit"] for u in document["units"] if u["rmse_K"] > FAR * max(usual, LEAST_K)]
    wide = [p for p in document["parameters"] if p["differs"] and p["spread_percent"] > WIDE]
    why = [f"{th.value_words(p['name'])} differs by {p['spread_percent']:.0f} %" for p in wide[:2]]
    if other:
        why.append(f"the model leaves more than {FAR:g} times as much of {', '.join(other[:3])} as of the usual one")
    return f"Are these equal motors? {'; '.join(why)}. Give each type a folder of its own." if why else ""


def fleet_summary(document: Mapping[str, Any]) -> th.Summary:
    """The outliers, what differs, what drifts."""
    outliers, count = document["outliers"], len(document["units"])
    worst = "; ".join(f"{o['unit']} ({th.value_words(o['parameter'])} x {o['factor']:.2f})" for o in outliers[:3])
    names = dict.fromkeys(o["unit"] for o in outliers)
    odd = f"{len(names)} stand{'s' * (len(names) == 1)} out: {worst}" if outliers else "none stands out"
    sentence = f"{count} motors; {odd}."
    parts = [
        th.Table.of(
            "Outliers",
            outliers,
            "motor=unit | parameter=words | factor | from=low | to=high | or else=others",
            words=lambda o: th.value_words(o["parameter"]),
            low=lambda o: o["factor_ci95"][0],
            high=lambda o: o["factor_ci95"][1],
            others=lambda o: [th.value_words(n) for n in o["instead"]],
        ),
        th.Table.of(
            "Parameters over the fleet (1: as declared)",
            sorted(document["parameters"], key=lambda p: -p["spread_percent"]),
            "parameter=words | *mean | *spread (%)=spread_percent | *differs | *drift (%/year)=drift_percent_year | "
            "from=low | to=high",
            words=lambda p: th.value_words(p["name"]),
            low=lambda p: p.get("drift_ci95", [None, None])[0],
            high=lambda p: p.get("drift_ci95", [None, None])[1],
        ),
    ]
    return th.Summary(" ".join(filter(None, [unequal_words(document), sentence])), parts, "--json FILE has all numbers")
