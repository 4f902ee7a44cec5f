"""thermoscope demo: the whole loop on the shipped case with a hidden effect."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.errors import InputError, MissingDependency
from thermoscope.case_folder.folder import find_case
from thermoscope.case_folder.runs import by_interest, comparison_of, end_of, fields, temperature_range
from thermoscope.commands.explain.diagnose import answer as diagnosis_answer
from thermoscope.commands.explain.diagnose import diagnosed
from thermoscope.commands.model.build import build
from thermoscope.commands.model.calibrate import calibrate
from thermoscope.commands.model.revise import add
from thermoscope.commands.open_case import open_case
from thermoscope.commands.show.pages import rendered, write_page
from thermoscope.commands.test.compare import answer as comparison_answer
from thermoscope.commands.test.compare import compared
from thermoscope.console.answer import Answer, Grid, within
from thermoscope.console.progress_bar import one_bar
from thermoscope.console.terminal import give, notes, notes_once, progress, say

if TYPE_CHECKING:
    from thermoscope.case_folder.folder import Folder
    from validation.calibration.one_factor_fit import OneFactorFit

CASE, KNOB = "road-test", "fan.flow"
SHORT, LONGER = 7, 13  # lines of a chapter after its first sentence: the whole story is at most 80
MARKER = ".made-by-thermoscope-demo"


@dataclass(frozen=True)
class Stage:
    """The model at one point of the story, held against every test.  errors : as `compare` writes them"""

    name: str
    errors: Mapping[str, Any]


@notes_once()
@one_bar()
def demo(out: Path, target: str | None) -> int:
    """Exit code 0 when an effect was named, accepted, and the error on the held-out test fell."""
    start = time.monotonic()
    case = fresh(out)
    headline("1  The machine: solids, mesh, field, network")
    with within(SHORT):
        build(str(machine_of(case)), out / "machine", None)
        picture(machine_picture(case, out), "the parts and their names")
        headline("2  Calibrated on the brake stand")
        calibrate(str(case), True, None)
    folder = open_demo(case)
    headline("3  Held against the road")
    with within(SHORT):
        stages = [Stage("calibrated on the stand", print_comparison(folder))]
        picture(misses(folder, out), "after an hour on the road, what the model misses")
    headline("4  The old way: turn up the fan's air flow until the right flange agrees")
    fit = old_way(folder)
    stages.append(Stage(f"{KNOB} x {fit.factor:.2f} instead", fit.comparison.document()))
    headline("5  What is missing?")
    with within(LONGER):
        diagnosis = print_diagnosis(folder, out)
    picture(odds(diagnosis, out), "what the readings say")
    success, effects = False, diagnosis["named"]
    if effects:
        headline(f"6  Add {effects[0]}")
        with within(SHORT):
            success = add(str(case), effects[:1], False, str(out / "add.json")) == 0
        folder = open_demo(case)
        stages.append(Stage(f"with {effects[0]}", folder.compared.document()))
    headline("7  What is left, and where to look")
    say(remaining_error(diagnosis, stages[-1].errors))
    pages(folder, case, out)
    picture(out / "error.png", "the error, step by step")
    picture(out / "field-before-after.png", "the field before and after")
    return closing(stages, success, out, target, time.monotonic() - start)


def remaining_error(diagnosis: Mapping[str, Any], errors: Mapping[str, Any]) -> str:
    """What the worst sensor still misses, and what that is: as the diagnosis says it, or that it cannot be told."""
    rows = [(c, t["name"]) for t in errors["tests"] for c in t["channels"] if c["verdict"] == "over"]
    if not rows:
        return "Every sensor is within its limit in every test."
    worst, test = max(rows, key=lambda row: row[0]["rmse_K"] / row[0]["limit_K"])
    sentences = [r["words"] for r in diagnosis.get("remainder", []) if r["channel"] == worst["channel"]]
    if sentences:
        return str(sentences[0])
    return (
        f"{worst['channel']} is still {worst['rmse_K']:.1f} K off in {test} (limit {worst['limit_K']:.1f} K): within "
        f"the doubts of the model, these data cannot tell why{next_likely(diagnosis)}."
    )


def next_likely(diagnosis: Mapping[str, Any]) -> str:
    """The most probable second effect and the test that would tell."""
    tests = {c["effect"]: c["isolating_test"] for c in diagnosis["candidates"] if c["isolating_test"]}
    for row in diagnosis["odds"]:
        more = [e for e in row["effects"] if e not in diagnosis["named"]]
        if len(row["effects"]) == len(diagnosis["named"]) + 1 and more[0] in tests and not row.get("tests"):
            return f"; likeliest {more[0]} ({100 * row['probability']:.0f} %): {tests[more[0]]}"
    return ""


def open_demo(case: Path) -> Folder:
    """The case with its model as it stands; it serves all that is said and drawn of that model."""
    with progress() as tell:
        return open_case(str(case), tell)


def print_comparison(folder: Folder) -> dict[str, Any]:
    """The comparison, printed."""
    with progress() as tell:
        _, document = compared(folder, tell)
    give(document, None, lambda: comparison_answer(document, str(folder.settings.path)))
    return document


def print_diagnosis(folder: Folder, out: Path) -> dict[str, Any]:
    """The diagnosis, printed."""
    with progress() as tell:
        _, document = diagnosed(folder, tell)
    give(document, str(out / "diagnose.json"), lambda: diagnosis_answer(document, str(folder.settings.path)))
    return document


def pages(folder: Folder, case: Path, out: Path) -> None:
    """Pictures, recording and report."""
    with progress() as tell:
        rendered(folder, out, tell)
        write_page(folder, str(case), out, tell)


def picture(file: Path | None, words: str) -> None:
    """Name a picture where the story has come to it; nothing where this computer cannot draw it."""
    if file is not None and file.exists():
        say(f"Picture: {file}: {words}")


def machine_picture(case: Path, out: Path) -> Path | None:
    """The parts, each with its name."""
    from viz import regions, split

    built = open_demo(case).built
    assert built is not None, "the demo's case is built from geometry"
    return _picture(out / "1-machine.png", lambda png: regions(split(built.mesh), png=png).close())


def misses(folder: Folder, out: Path) -> Path | None:
    """The machine at the end of the held-out test, its sensors labelled by what the calibrated model misses."""
    from viz import cutaway, sensors, split
    from viz.data import LATE

    test, built = by_interest(folder)[0], folder.built
    assert built is not None, "the demo's case is built from geometry"

    def draw(png: Path) -> None:
        nodes = split(built.mesh)
        now = fields(folder.case, test, nodes, 1)[1][-1]
        labels, limits = sensors(comparison_of(folder, test), folder.positions), temperature_range(folder, nodes)
        title = f"{end_of(test)}: temperature of the model"
        cutaway(nodes, now, sensors=labels, title=title, limits=limits, note=LATE, png=png)

    return _picture(out / "2-misses.png", draw)


def _picture(png: Path, draw: Callable[[Path], Any]) -> Path | None:
    """The picture, None where graphics are missing (`thermoscope check` says how to get them)."""
    from viz import require_gl

    try:
        require_gl()
        draw(png)
    except MissingDependency as fault:
        notes([str(fault)])
        return None
    return png


def odds(diagnosis: Mapping[str, Any], out: Path) -> Path | None:
    """The probability of every hypothesis."""
    from viz import posterior

    if not diagnosis:
        return None
    posterior(diagnosis["odds"], png=out / "3-odds.png")
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


def headline(words: str) -> None:
    say(f"=== {words} ===")


def old_way(folder: Folder) -> OneFactorFit:
    """One knob, turned until the right flange agrees on the first road test."""
    from validation.calibration.one_factor_fit import one_factor_fit

    with progress() as tell:
        tell("turning the fan's air flow")
        fit = one_factor_fit(folder.case, KNOB, flange(folder.case.tests))
    flow = 138 * fit.factor
    say(f"{flow:.0f} m3/h instead of 138 bring it closest on road-1; see below what else they do")
    return fit


def flange(tests: Sequence[Any]) -> str:
    """The channel on the right flange."""
    return next(c.name for t in tests for c in t.channels if c.place == "flange.right")


def closing(stages: Sequence[Stage], success: bool, out: Path, target: str | None, seconds: float) -> int:
    """The table the story ends with: rms error per test, all sensors, and on the right flange."""
    first, last = stages[0].errors["tests"], stages[-1].errors["tests"]
    hold_out = [(a, b) for a, b in zip(first, last, strict=True) if a["role"] == "hold-out"]
    fell = success and all(b["rmse_K"] < a["rmse_K"] for a, b in hold_out)
    document = {"case": CASE, "stages": [{"stage": s.name, **s.errors} for s in stages], "fell": fell}
    give(document, target, lambda: answer(stages, out, seconds))
    return 0 if fell else 1


def answer(stages: Sequence[Stage], out: Path, seconds: float) -> Answer:
    """The errors, model by model."""
    headers = ["model", *(f"{t['name']}{'*' if t['role'] == 'hold-out' else ''}" for t in stages[0].errors["tests"])]
    rows = [[s.name, *(t["rmse_K"] for t in s.errors["tests"])] for s in stages]
    flange = [[s.name, *(right_flange(t) for t in s.errors["tests"])] for s in stages]
    sentence = f"{out / 'report.html'} tells it all. {seconds:.0f} s; * was never used."
    return Answer(
        sentence,
        [
            Grid("Error of all sensors, rms (K)", headers, rows, keep=headers),
            Grid("Error on the right flange alone, rms (K)", headers, flange, keep=headers),
        ],
        f"recording {out}/*.rrd; thermoscope show serve {out / CASE}",
    )


def right_flange(test: Mapping[str, Any]) -> float:
    return next((c["rmse_K"] for c in test["channels"] if c["place"] == "flange.right"), float("nan"))
