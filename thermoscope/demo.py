"""thermoscope demo: the whole loop on the shipped case with a hidden effect."""

from __future__ import annotations

import shutil
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.errors import InputError
from thermoscope.commands.build import build
from thermoscope.commands.calibrate import calibrate
from thermoscope.commands.compare import compare
from thermoscope.commands.diagnose import diagnose
from thermoscope.commands.opened import opened
from thermoscope.commands.revise import add
from thermoscope.commands.saved import saved_diagnosis
from thermoscope.commands.show import render, report
from thermoscope.folder import find_case
from thermoscope.terminal import give, progress, say, table

if TYPE_CHECKING:
    from validation.compare import Comparison
    from validation.tuned import Tuned

CASE, KNOB = "road-test", "fan.flow"
MARKER = ".made-by-thermoscope-demo"


@dataclass(frozen=True)
class Stage:
    """The model at one point of the story, held against every test."""

    name: str
    comparison: Comparison


def demo(out: Path, target: str | None) -> int:
    """Exit code 0 when an effect was named, accepted, and the error on the held-out test fell."""
    begun = time.monotonic()
    case = fresh(out)
    stages = []
    headline("1  The machine: solids, mesh, field, network")
    build(str(machine_of(case)), out / "machine", None)
    headline("2  Calibrated on the brake stand")
    calibrate(str(case), True, None)
    stages.append(Stage("calibrated on the stand", held_against(case)))
    headline("3  Held against the road")
    compare(str(case), None)
    headline("4  The old way: turn up the fan's air flow until the right flange agrees")
    turned = old_way(case)
    stages.append(Stage(f"{KNOB} x {turned.factor:.2f} instead", turned.comparison))
    headline("5  What is missing?")
    diagnose(str(case), str(out / "diagnose.json"))
    named = (saved_diagnosis(opened(str(case), lambda _: None)) or {}).get("named", [])
    done = False
    if named:
        headline(f"6  Add {named[0]}")
        done = add(str(case), named[0], False, str(out / "add.json")) == 0
        stages.append(Stage(f"with {named[0]}", held_against(case)))
    headline("7  Pictures, recording, report")
    render(str(case), out, None)
    report(str(case), out, None, again=False)
    return closing(stages, done, out, target, time.monotonic() - begun)


def fresh(out: Path) -> Path:
    """A copy of the shipped case under `out`; a folder the demo did not make is left alone."""
    copy = out / CASE
    if copy.exists() and not (copy / MARKER).exists():
        raise InputError("is in the way", str(copy), "another --out folder")
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(find_case(CASE), copy, ignore=shutil.ignore_patterns("out", "model.toml"))
    (copy / MARKER).touch()
    return copy


def machine_of(case: Path) -> Path:
    from thermoscope.settings import read_settings

    machine = read_settings(case).machine
    assert machine is not None, "the demo's case is built from geometry"
    return machine


def headline(words: str) -> None:
    say(f"\n=== {words} ===")


def held_against(case: Path) -> Comparison:
    from validation.compare import compare as compared

    with progress() as tell:
        return compared(opened(str(case), tell).case)


def old_way(case: Path) -> Tuned:
    """One knob, turned until the right flange agrees on the first road test."""
    from validation.tuned import tuned

    with progress() as tell:
        folder = opened(str(case), tell)
        tell("turning the fan's air flow")
        turned = tuned(folder.case, KNOB, flange(folder.case.tests))
    flow = 138 * turned.factor
    say(f"{flow:.0f} m3/h instead of 138 bring the right flange closest on road-1; see below what else they do")
    return turned


def flange(tests: Sequence[Any]) -> str:
    """The channel on the right flange."""
    return next(c.name for t in tests for c in t.channels if c.place == "flange.right")


def closing(stages: Sequence[Stage], done: bool, out: Path, target: str | None, seconds: float) -> int:
    """The table the story ends with: rms error per test, all sensors, and on the right flange."""
    first, last = stages[0].comparison, stages[-1].comparison
    held = [(a, b) for a, b in zip(first.tests, last.tests, strict=True) if a.role == "hold-out"]
    fell = done and all(b.rmse_K < a.rmse_K for a, b in held)
    document = {"case": CASE, "stages": [{"stage": s.name, **s.comparison.document()} for s in stages], "fell": fell}
    give(document, target, lambda: show(stages, out, seconds))
    return 0 if fell else 1


def show(stages: Sequence[Stage], out: Path, seconds: float) -> None:
    tests = stages[0].comparison.tests
    headers = ["model", *(f"{t.name} ({t.role})" for t in tests)]
    rows = [[s.name, *(t.rmse_K for t in s.comparison.tests)] for s in stages]
    say("")
    table("Error of all sensors, rms (K)", headers, rows)
    rows = [[s.name, *(right_flange(t) for t in s.comparison.tests)] for s in stages]
    table("Error on the right flange alone, rms (K)", headers, rows)
    say(f"Look at {out}: report.html, pictures (*.png), a recording (*.rrd), the machine (STEP, STL).  {seconds:.0f} s")


def right_flange(test: Any) -> float:
    return next((c.rmse_K for c in test.channels if c.place == "flange.right"), float("nan"))
