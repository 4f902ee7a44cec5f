"""thermoscope bench curves CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.plugin import Summary, Table, cell, give, open_case, progress


def curves(case: str, resolution: float, target: str | None) -> int:
    """Exit code 1 when an assembly is further off than 4 %, or equal tests do not repeat."""
    from extras.bench.measuring.curves import curves as found_in

    with progress() as tell:
        folder = open_case(case, tell)
        tell("fitting the warming curves")
        result = found_in(folder.case, resolution)
    document = result.document()
    give(document, target, lambda: curves_summary(document))
    return 0 if result.agrees else 1


def curves_summary(document: Mapping[str, Any]) -> Summary:
    """The rule assembly by assembly, the repeats, then eq. 8 and eq. 9 sensor by sensor."""
    rows_of_tests = [(t["name"], a) for t in document["tests"] for a in t["assemblies"]]
    over = sum(a["verdict"] != "within" for _, a in rows_of_tests)
    rows = [
        [
            a["place"],
            name,
            a["measured"],
            a["calculated"],
            a["percent"],
            a["percent_of_rise"],
            a["U95_percent"],
            a["verdict"],
        ]
        for name, a in rows_of_tests
    ]
    headers = [
        "assembly",
        "test",
        "measured (degC)",
        "calculated (degC)",
        "%",
        "% of rise",
        "reading's 95 % (%)",
        "verdict",
    ]
    rule = Table(
        "Within 3 to 4 % of the measured temperature, never above 7 %",
        headers,
        rows,
        ["beyond 7 %"],
        ["test", "%", "verdict"],
    )
    sentence = f"{len(rows_of_tests) - over} of {len(rows_of_tests)} assemblies are within the 3 to 4 % rule."
    parts: list[Table | str] = [rule, _repeats(document), _warming(document), *_doubts(document)]
    return Summary(sentence, parts, "--json FILE")


def _warming(document: Mapping[str, Any]) -> Table:
    headers = ["sensor", "test", "a (degC)", "b", "c (1/min)", "rms (K)", "T(0)", "tau_95 (min)", "steady", "K/h"]
    rows = [[c["channel"], t["name"], *_row(c)] for t in document["tests"] for c in t["curves"]]
    keep = ["test", "tau_95 (min)", "steady", "rms (K)"]
    return Table("Warming: T = a exp(b exp(c t)), 95 % intervals; steady by eq. 9", headers, rows, ["no"], keep)


def _repeats(document: Mapping[str, Any]) -> Table:
    rows = [
        [
            r["place"],
            ", ".join(r["tests"]),
            r["mean"],
            r["sd_mean"],
            r["spread"],
            r["limit"],
            "yes" if r["repeat"] else "no",
        ]
        for r in document["repeats"]
    ]
    headers = ["place", "equal tests", "mean rise (K)", "1 sigma (K)", "largest difference", "95 % limit", "repeat"]
    return Table("Equal tests pooled", headers, rows, ["no"], ["repeat", "mean rise (K)", "equal tests"])


def _doubts(document: Mapping[str, Any]) -> list[str]:
    return [
        f"{t['name']}, {c['channel']}: {words}"
        for t in document["tests"]
        for c in t["curves"]
        for words in [*((c["eq8"] or {}).get("warnings", [])), *([c["why"]] if c["why"] else [])]
    ]


def _row(c: Mapping[str, Any]) -> list[Any]:
    e, q = c["eq8"], c["equilibrium"]
    fit = (
        ["-"] * 6
        if e is None
        else [
            *(_with(e[key], e["ci95"][name]) for key, name in (("a_degC", "a"), ("b", "b"), ("c_1_min", "c"))),
            e["rmse_K"],
            e["start_degC"],
            e["tau95_min"],
        ]
    )
    return [*fit, *(["-", "-"] if q is None else [_since(q), q["drift_K_h"]])]


def _with(value: float, ci: list[float]) -> str:
    return f"{cell(value)} ({cell(ci[0])} ... {cell(ci[1])})"


def _since(q: Mapping[str, Any]) -> str:
    return f"since {q['from_min']:.0f} min" if q["reached"] else "no"
