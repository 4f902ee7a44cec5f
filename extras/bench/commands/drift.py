"""thermoscope bench curves CASE --against TEST"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from extras.bench.measuring.drift import drift
from thermoscope import InputError, plugin as th


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
    table = th.Table.of(
        "At the earlier test's conditions",
        document["changes"],
        f"{columns} | uncertainties | channel | *verdict",
        ["changed"],
    )
    names = ", ".join(document["left_out"])
    return th.Summary(
        document["sentence"], [table, *([f"too few readings, or no rise: {names}"] if names else [])], "--out DIR"
    )
