"""thermoscope demo: the whole loop on the shipped case with a hidden effect."""

from __future__ import annotations

import io
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.errors import InputError, MissingDependency
from thermoscope.case_folder.folder import find_case
from thermoscope.case_folder.runs import by_interest, fields, held
from thermoscope.commands.explain.diagnose import diagnose
from thermoscope.commands.model.build import build
from thermoscope.commands.model.calibrate import calibrate
from thermoscope.commands.model.revise import add
from thermoscope.commands.open_case import open_case
from thermoscope.commands.show.pages import render, report
from thermoscope.commands.stored_diagnosis import saved_diagnosis
from thermoscope.commands.test.compare import compare
from thermoscope.console.answer import Answer, Grid, within
from thermoscope.console.terminal import give, notes, notes_once, progress, say

if TYPE_CHECKING:
    from thermoscope.pipeline import Built
    from validation.calibration.one_factor_fit import OneFactorFit
    from validation.comparison.compare import Comparison

CASE, KNOB = "road-test", "fan.flow"
SHORT, LONGER = 7, 10  # lines of a chapter after its first sentence: the whole story is at most 80
MARKER = ".made-by-thermoscope-demo"


@dataclass(frozen=True)
class Stage:
    """The model at one point of the story, held against every test."""

    name: str
    comparison: Comparison


@notes_once()
def demo(out: Path, target: str | None) -> int:
    """Exit code 0 when an effect was named, accepted, and the error on the held-out test fell."""
    begun = time.monotonic()
    case = fresh(out)
    stages = []
    headline("1  The machine: solids, mesh, field, network")
    with within(SHORT):
        build(str(machine_of(case)), out / "machine", None)
        picture(machine_picture(case, out), "the parts and their names")
        headline("2  Calibrated on the brake stand")
        calibrate(str(case), True, None)
    stages.append(Stage("calibrated on the stand", held_against(case)))
    headline("3  Held against the road")
    with within(SHORT):
        compare(str(case), None)
        picture(misses(case, out), "the motor after an hour on the road, labelled by what the model misses")
    headline("4  The old way: turn up the fan's air flow until the right flange agrees")
    turned = old_way(case)
    stages.append(Stage(f"{KNOB} x {turned.factor:.2f} instead", turned.comparison))
    headline("5  What is missing?")
    with within(LONGER):
        diagnose(str(case), str(out / "diagnose.json"))
    found = saved_diagnosis(open_case(str(case), lambda _: None)) or {}
    named = found.get("named", [])
    picture(odds(found, out), "what the readings say")
    done = False
    if named:
        headline(f"6  Add {named[0]}")
        with within(SHORT):
            done = add(str(case), named[0], False, str(out / "add.json")) == 0
        stages.append(Stage(f"with {named[0]}", held_against(case)))
    headline("7  What is left, and where to look")
    with within(0), redirect_stdout(io.StringIO()):
        render(str(case), out, None)
        report(str(case), out, None)
    picture(out / "error.png", "the error, step by step")
    picture(out / "field-before-after.png", "the field before and after")
    return closing(stages, done, out, target, time.monotonic() - begun)


def picture(file: Path | None, words: str) -> None:
    """Name a picture where the story has come to it; nothing where this computer cannot draw it."""
    if file is not None and file.exists():
        say(f"Picture: {file}: {words}")


def machine_picture(case: Path, out: Path) -> Path | None:
    """The parts, each with its name."""
    from viz import regions, split

    mesh = _built(case).mesh
    return _drawn(out / "1-machine.png", lambda png: regions(split(mesh), png=png).close())


def _built(case: Path) -> Built:
    found = open_case(str(case), silent).built
    assert found is not None, "the demo's case is built from geometry"
    return found


def misses(case: Path, out: Path) -> Path | None:
    """The machine at the end of the held-out test, its sensors labelled by what the calibrated model misses."""
    from viz import cutaway, sensors, split

    folder = open_case(str(case), silent)
    test = by_interest(folder)[0]

    def draw(png: Path) -> None:
        nodes = split(_built(case).mesh)
        now = fields(folder.case, test, nodes, 1)[1][-1]
        cutaway(nodes, now, sensors=sensors(held(folder, test), folder.positions), title=test.name, png=png)

    return _drawn(out / "2-misses.png", draw)


def _drawn(png: Path, draw: Callable[[Path], Any]) -> Path | None:
    """The picture, None where graphics are missing (`thermoscope check` says how to get them)."""
    from viz import require_gl

    try:
        require_gl()
        draw(png)
    except MissingDependency as fault:
        notes([str(fault)])
        return None
    return png


def odds(found: Mapping[str, Any], out: Path) -> Path | None:
    """The probability of every hypothesis."""
    from viz import posterior

    if not found:
        return None
    posterior(found["odds"], png=out / "3-odds.png")
    return out / "3-odds.png"


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
    from thermoscope.case_folder.settings import read_settings

    machine = read_settings(case).machine
    assert machine is not None, "the demo's case is built from geometry"
    return machine


def silent(message: str) -> None:
    """No progress."""


def headline(words: str) -> None:
    say(f"=== {words} ===")


def held_against(case: Path) -> Comparison:
    from validation.comparison.compare import compare as compared

    with progress() as tell:
        return compared(open_case(str(case), tell).case)


def old_way(case: Path) -> OneFactorFit:
    """One knob, turned until the right flange agrees on the first road test."""
    from validation.calibration.one_factor_fit import one_factor_fit

    with progress() as tell:
        folder = open_case(str(case), tell)
        tell("turning the fan's air flow")
        turned = one_factor_fit(folder.case, KNOB, flange(folder.case.tests))
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
    give(document, target, lambda: answer(stages, out, seconds))
    return 0 if fell else 1


def answer(stages: Sequence[Stage], out: Path, seconds: float) -> Answer:
    """The errors, model by model."""
    tests = stages[0].comparison.tests
    headers = ["model", *(f"{t.name}{'*' if t.role == 'hold-out' else ''}" for t in tests)]
    rows = [[s.name, *(t.rmse_K for t in s.comparison.tests)] for s in stages]
    flange = [[s.name, *(right_flange(t) for t in s.comparison.tests)] for s in stages]
    sentence = f"{out / 'report.html'} tells it all. {seconds:.0f} s; * was never used."
    return Answer(sentence, [Grid("Error of all sensors, rms (K)", headers, rows, keep=headers),
                             Grid("Error on the right flange alone, rms (K)", headers, flange, keep=headers)],
                  f"recording {out}/*.rrd; solids {out}/machine; thermoscope show serve {out / CASE}")  # fmt: skip


def right_flange(test: Any) -> float:
    return next((c.rmse_K for c in test.channels if c.place == "flange.right"), float("nan"))
