"""thermoscope bench curves CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from thermoscope import InputError, plugin as th


def curves(
    case: th.CaseArgument,
    resolution: Annotated[float, typer.Option(min=1e-3, max=100.0, help="K, of the thermocouples.")] = 0.5,
    against: Annotated[str | None, typer.Option(metavar="TEST|CASE", help="An earlier test, or its case.")] = None,
    test: Annotated[str | None, typer.Option(help="The later test, with --against; by default the last one.")] = None,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Warming curves: equilibrium, tau_95, the 3 to 4 % rule, equal tests pooled; --against finds what changed since.

    Exit code 1 if the rule fails, equal tests differ, or the later test is not equal to the earlier one.
    """
    from extras.bench.commands.drift import show_drift
    from extras.bench.measuring.curves import curves as found_in

    if against is not None:
        return show_drift(case, test, against, out, json)
    if test or out:
        raise InputError("is for two tests", "--test" if test else "--out", "--against TEST beside it")
    with th.progress() as tell:
        folder = th.open_case(case, tell)
        tell("fitting the warming curves")
        result = found_in(folder.case, resolution)
    document = result.document()
    th.give(document, json, lambda: curves_summary(document))
    return 0 if result.agrees else 1


def curves_summary(document: Mapping[str, Any]) -> th.Summary:
    """The rule assembly by assembly, the repeats, then eq. 8 and eq. 9 sensor by sensor."""
    assemblies = [{**a, "test": t["name"]} for t in document["tests"] for a in t["assemblies"]]
    fine = sum(a["verdict"] in ("calibrated", "allowed") for a in assemblies)
    columns = "assembly=place | *test | measured (degC)=measured | calculated (degC)=calculated | *%=percent"
    columns += " | % of rise=percent_of_rise | reading's 95 % (%)=U95_percent | *verdict"
    title = "Within 3 to 4 % of the measured temperature, never above 7 %"
    rule = th.Table.of(title, assemblies, columns, ["beyond 7 %"])
    sentence = f"{fine} of {len(assemblies)} assemblies are within the 3 to 4 % rule."
    parts: list[th.Table | str] = [rule, _repeats(document), _warming(document), *_doubts(document)]
    return th.Summary(sentence, parts, "--json FILE has all numbers")


def _warming(document: Mapping[str, Any]) -> th.Table:
    headers = ["sensor", "test", "a (degC)", "b", "c (1/min)", "rms (K)", "T(0)", "tau_95 (min)", "steady", "K/h"]
    rows = [[c["channel"], t["name"], *_row(c)] for t in document["tests"] for c in t["curves"]]
    keep = ["test", "tau_95 (min)", "steady", "rms (K)"]
    return th.Table("Warming: T = a exp(b exp(c t)), 95 % intervals; steady by eq. 9", headers, rows, ["no"], keep)


def _repeats(document: Mapping[str, Any]) -> th.Table:
    columns = "place | *equal tests=tests | *mean rise (K)=mean | 1 sigma (K)=sd_mean | largest difference=spread"
    return th.Table.of("Equal tests pooled", document["repeats"], f"{columns} | 95 % limit=limit | *repeat", ["no"])


def _doubts(document: Mapping[str, Any]) -> list[str]:
    return [
        f"{t['name']}, {c['channel']}: {words}"
        for t in document["tests"]
        for c in t["curves"]
        for words in [*((c["eq8"] or {}).get("warnings", [])), *([c["why"]] if c["why"] else [])]
    ]


def _row(c: Mapping[str, Any]) -> list[Any]:
    e, q = c["eq8"], c["equilibrium"]
    fit: list[Any] = ["-"] * 6
    if e is not None:
        sizes = (_with(e[key], e["ci95"][name]) for key, name in (("a_degC", "a"), ("b", "b"), ("c_1_min", "c")))
        fit = [*sizes, e["rmse_K"], e["start_degC"], e["tau95_min"]]
    return [*fit, *(["-", "-"] if q is None else [_since(q), q["drift_K_h"]])]


def _with(value: float, ci: list[float]) -> str:
    return f"{th.cell(value)} ({th.cell(ci[0])} ... {th.cell(ci[1])})"


def _since(q: Mapping[str, Any]) -> str:
    return f"since {q['from_min']:.0f} min" if q["reached"] else "no"
