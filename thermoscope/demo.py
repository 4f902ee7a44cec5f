"""thermoscope demo: the whole loop on the shipped case with a hidden effect."""

import os
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import viz as viz  # so named in the wheel as well
from geom.errors import InputError, MissingDependency
from geom.table import Table, percent
from thermoscope.case_folder.folder import Folder, find_case
from thermoscope.case_folder.settings import read_settings
from thermoscope.commands.explain.diagnose import diagnosed, diagnosis_summary
from thermoscope.commands.model.build import build_machine
from thermoscope.commands.model.calibrate import calibrate
from thermoscope.commands.model.revise import add
from thermoscope.commands.open_case import open_case
from thermoscope.commands.show.pages import field_pictures, rendered, write_page
from thermoscope.commands.show.picture import Subject, draw_field
from thermoscope.commands.test.compare import compared, comparison_summary
from thermoscope.console.options import Json
from thermoscope.console.progress_bar import one_bar
from thermoscope.console.summary import Summary, limited_lines
from thermoscope.console.terminal import give, notes, notes_once, progress, say
from thermoscope.files import checked_out
from validation.parameters.unknowns import value_words

if TYPE_CHECKING:
    from measured.case import Case
    from validation.calibration.one_factor_fit import OneFactorFit

CASE, KNOB, FLANGE = "road-test", "fan.flow", "flange.right"
SHORT, LONGER = 5, 10  # lines of a chapter after its first sentence: the whole story is at most 80
MARKER = ".made-by-thermoscope-demo"


@dataclass(frozen=True)
class Stage:
    """The model at one point of the story, held against every test.  errors : as `compare` writes them"""

    name: str
    errors: Mapping[str, Any]


@notes_once()
@one_bar()
def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", callback=checked_out)] = Path("out/demo"),
    target: Json = None,
) -> int:
    """The whole loop on the shipped case with a hidden effect: the error before and after."""
    start = time.monotonic()
    case = fresh(out)
    headline("1  The machine: solids, mesh, field, network")
    with limited_lines(SHORT):
        build_machine(str(read_settings(case).machine), out / "machine", None, None)
        picture(machine_picture(case, out), "the parts and their names")
        headline("2  Calibrated on the brake stand")
        calibrate(str(case), True, None)
    folder = open_demo(case)
    knob = ThreadPoolExecutor().submit(old_way, folder.case)  # run after run: it needs one core
    headline("3  Held against the road")
    with limited_lines(SHORT):
        stages = [Stage("calibrated on the stand", print_comparison(folder))]
        picture(misses(folder, out), "after an hour on the road, what the model misses")
    headline("4  The old way: turn up the fan's air flow until the right flange agrees")
    with progress() as tell:
        tell("turning the fan's air flow")
        fit = knob.result()
    say(f"{138 * fit.factor:.0f} m3/h instead of 138 bring it closest on road-1; see below what else they do")
    stages.append(Stage(f"{KNOB} x {fit.factor:.2f} instead", fit.errors.document()))
    headline("5  What is missing?")
    with limited_lines(LONGER):
        with progress() as tell:
            _, diagnosis = diagnosed(folder, tell)
        give(diagnosis, str(out / "diagnose.json"), lambda: diagnosis_summary(diagnosis, str(case)))
    picture(odds(diagnosis, out), "what the readings say")
    success, effects = False, diagnosis["named"]
    if effects:
        headline(f"6  Add {value_words(effects[0])}")
        with limited_lines(SHORT):
            success = add(str(case), effects[:1], False, str(out / "add.json")) == 0
        folder = open_demo(case)
        stages.append(Stage(f"with {value_words(effects[0])}", folder.compared.document()))
    headline("7  What is left, and where to look")
    say(remaining_error(diagnosis, stages[-1].errors))
    with progress() as tell:
        pictures = field_pictures(folder, out)
        rendered(folder, out, tell, pictures)
        write_page(folder, str(case), out, tell, pictures)
    picture(out / "error.png", "the error, step by step")
    picture(out / "field-before-after.png", "the field before and after")
    return closing(stages, success, out, target, time.monotonic() - start)


def remaining_error(diagnosis: Mapping[str, Any], errors: Mapping[str, Any]) -> str:
    """What the worst sensor still misses, and what that is: as the diagnosis says it, or that it cannot be told."""
    rows = [(c, t["name"]) for t in errors["tests"] for c in t["channels"] if c["verdict"] == "over"]
    if not rows:
        return "Every sensor is within its limit in every test."
    worst, test = max(rows, key=lambda row: row[0]["rmse_K"])
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
            return f"; likeliest {value_words(more[0])} ({percent(row['probability'])}): {tests[more[0]]}"
    return ""


def open_demo(case: Path) -> Folder:
    """The case with its model as it stands; it serves all that is said and drawn of that model."""
    with progress() as tell:
        return open_case(str(case), tell)


def print_comparison(folder: Folder) -> dict[str, Any]:
    """The comparison, printed."""
    with progress() as tell:
        _, document = compared(folder, tell)
    give(document, None, lambda: comparison_summary(document, str(folder.settings.path)))
    return document


def picture(file: Path | None, words: str) -> None:
    """Name a picture where the story has come to it; nothing where this computer cannot draw it."""
    if file is not None and file.exists():
        say(f"Picture: {file}: {words}")


def machine_picture(case: Path, out: Path) -> Path | None:
    """The parts, each with its name."""
    s = Subject(open_demo(case), lambda message: None)
    return _picture(out / "1-machine.png", lambda png: viz.regions(s.nodes, png=png).close())


def misses(folder: Folder, out: Path) -> Path | None:
    """The machine at the end of the held-out test, its sensors labelled by what the calibrated model misses."""
    s = Subject(folder, lambda message: None)
    return _picture(out / "2-misses.png", lambda png: draw_field(s, png))


def _picture(png: Path, draw: Callable[[Path], Any]) -> Path | None:
    """The picture, None where graphics are missing (`thermoscope check` says how to get them)."""
    try:
        viz.require_gl()
        draw(png)
    except MissingDependency as fault:
        notes([str(fault)])
        return None
    return png


def odds(diagnosis: Mapping[str, Any], out: Path) -> Path | None:
    """The probability of every explanation."""
    if not diagnosis:
        return None
    viz.posterior(diagnosis["explanations"], png=out / "3-odds.png")
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


def headline(words: str) -> None:
    say(f"=== {words} ===")


def old_way(case: "Case") -> "OneFactorFit":
    """One knob, turned until the right flange agrees on the first road test."""
    from validation.calibration.one_factor_fit import one_factor_fit

    return one_factor_fit(case, KNOB, next(c.name for t in case.tests for c in t.channels if c.place == FLANGE))


def closing(stages: Sequence[Stage], success: bool, out: Path, target: str | None, seconds: float) -> int:
    """The table the story ends with: rms error per test, all sensors, and on the right flange."""
    first, last = stages[0].errors["tests"], stages[-1].errors["tests"]
    hold_out = [(a, b) for a, b in zip(first, last, strict=True) if a["role"] == "hold-out"]
    fell = success and all(b["rmse_K"] < a["rmse_K"] for a, b in hold_out)
    took = {"seconds": round(seconds), "core_s": round(sum(os.times()[:4]))}  # other programs may run beside
    document = {"case": CASE, "stages": [{"stage": s.name, **s.errors} for s in stages], "fell": fell, **took}
    give(document, target, lambda: demo_summary(stages, out, seconds))
    return 0 if fell else 1


def demo_summary(stages: Sequence[Stage], out: Path, seconds: float) -> Summary:
    """The errors, model by model."""
    headers = ["model", *(f"{t['name']}{'*' if t['role'] == 'hold-out' else ''}" for t in stages[0].errors["tests"])]
    rows = [[s.name, *(t["rmse_K"] for t in s.errors["tests"])] for s in stages]
    flange = [
        [s.name, *(next(c["rmse_K"] for c in t["channels"] if c["place"] == FLANGE) for t in s.errors["tests"])]
        for s in stages
    ]
    sentence = f"{out / 'report.html'} tells it all. {seconds:.0f} s; * was never used."
    errors = {"Error of all sensors, rms (K)": rows, "Error on the right flange alone, rms (K)": flange}
    tables = [Table(title, headers, of, keep=headers) for title, of in errors.items()]
    return Summary(sentence, tables, f"recording {out}/*.rrd; thermoscope show serve {out / CASE}")
