"""thermoscope bench curves CASE [--against TEST]"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from extras.bench.measuring.curves import curves as found_in
from extras.bench.measuring.drift import drift
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
    columns = "place | *equal tests=tests | *mean rise (K)=mean | 1 sigma (K)=sd_mean | largest difference=spread"
    equal = th.Table.of("Equal tests pooled", document["repeats"], f"{columns} | 95 % limit=limit | *repeat", ["no"])
    parts: list[th.Table | str] = [rule, equal, _warming(document), *_doubts(document)]
    return th.Summary(sentence, parts, "--json FILE has all numbers")


def _warming(document: Mapping[str, Any]) -> th.Table:
    headers = ["sensor", "test", "a (degC)", "b", "c (1/min)", "rms (K)", "T(0)", "tau_95 (min)", "steady", "K/h"]
    rows = [[c["channel"], t["name"], *_row(c)] for t in document["tests"] for c in t["curves"]]
    keep = ["test", "tau_95 (min)", "steady", "rms (K)"]
    return th.Table("Warming: T = a exp(b exp(c t)), 95 % intervals; steady by eq. 9", headers, rows, ["no"], keep)


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
        values = ((e[key], *e["ci95"][name]) for key, name in (("a_degC", "a"), ("b", "b"), ("c_1_min", "c")))
        sizes = (f"{value} ({low} ... {high})" for value, low, high in (map(th.cell, row) for row in values))
        fit = [*sizes, e["rmse_K"], e["start_degC"], e["tau95_min"]]
    if q is None:
        return [*fit, "-", "-"]
    return [*fit, f"since {q['from_min']:.0f} min" if q["reached"] else "no", q["drift_K_h"]]


def show_drift(case: str, test: str | None, against: str, out: Path | None, json: str | None) -> int:
    """What changed from one test to another; exit code 1 unless they are equal.

    against : a test of the case, or a second case, of which it is the test of the same name, else the last one
    """
    with th.progress() as tell:
        here = th.open_case(case, tell).case
        tests = {t.name: t for t in here.tests}
        if against not in tests and Path(against).is_dir():
            other = th.open_case(against, tell).case
            earlier = _named(other, test) if test in {t.name for t in other.tests} else other.tests[-1]
            earlier = replace(earlier, name=f"{other.name}/{earlier.name}")
        else:
            earlier = _named(here, against, "--against")
        later = _named(here, test) if test else next((t for t in reversed(here.tests) if t is not earlier), earlier)
        if later is earlier:
            right = "two tests of the case, or the folder of a second one"
            raise InputError(f"there is no other test than {earlier.name}", here.name, right)
        tell("comparing two tests")
        difference = drift(here, later, earlier)
    th.give(difference.document(), json, lambda: drift_summary(difference.document()))
    if out is not None:
        from extras.bench.figure import two_tests

        path = out / f"{th.file_stem(f'{difference.later}-{difference.earlier}')}.png"
        two_tests(difference, png=path)
        th.notes([f"written: {path}"])
    return 0 if difference.verdict == "equal" else 1


def _named(case: th.MeasuredCase, name: str | None, option: str = "--test") -> th.Test:
    tests = {t.name: t for t in case.tests}
    if name not in tests:
        raise InputError(f"unknown test {name!r} of {case.name}", option, th.suggestion(str(name), tests))
    return tests[name]


def drift_summary(document: Mapping[str, Any]) -> th.Summary:
    """What changed; then both quantities of every sensor."""
    columns = "sensor=place | *quantity | before | after | *difference (%)=percent | *+- 95 %=U95_percent"
    columns += " | uncertainties | channel | *verdict"
    table = th.Table.of("At the earlier test's conditions", document["changes"], columns, ["changed"])
    names = ", ".join(document["left_out"])
    rest = [f"too few readings, or no rise: {names}"] if names else []
    return th.Summary(document["sentence"], [table, *rest], "--out DIR")
