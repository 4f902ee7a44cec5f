"""thermoscope show plan CASE"""

from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from geom.description.names import file_stem
from geom.errors import InputError
from thermoscope.case_folder.folder import Folder
from thermoscope.commands.open_case import current_diagnosis, open_case
from thermoscope.commands.show.pages import provenance
from thermoscope.console.options import Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give, progress
from validation.tables import currents

MOST = 3  # effects of a diagnosis that are compared: each costs a calibration


def plan(
    case: Case,
    effects: Annotated[
        list[str] | None,
        typer.Option(
            "--effect", metavar="EFFECT@PLACE", help="A hypothesis; several are possible. Else the last diagnosis's."
        ),
    ] = None,
    test: Annotated[str | None, typer.Option(metavar="NAME", help="Candidate test; else the best.")] = None,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="An HTML file.")] = None,
    target: Json = None,
) -> int:
    """A page to pin on the bench: the test to drive next, and the curves that each hypothesis predicts."""
    from validation.revision.predicted_curves import hypotheses, predicted_curves, schedule
    from viz.pages.bench_page import BenchPage, write_bench_page

    if out is not None and (out.suffix != ".html" or out.is_dir()):
        raise InputError("is not a name of a page", f"--out {out}", "a file NAME.html")
    with progress() as tell:
        folder = open_case(case, tell)
        models = hypotheses(folder.case, effects or suspected(folder), tell)
        tell("predicting tests")
        curves = predicted_curves(folder.case, models, test)
        file = out or Path("out") / f"{file_stem(folder.case.name)}-plan.html"
        last = folder.case.tests[-1]
        steps = schedule(curves.test, last)
        page = BenchPage(folder.case.name, curves, last.name, steps, provenance(), hottest(folder))
        write_bench_page(page, file)
    levels = [c.document() for c in curves.currents]
    document = {
        "case": folder.case.name,
        "test": curves.experiment.name,
        "hours": curves.experiment.hours,
        "currents": levels,
        "current_factor": curves.experiment.current_factor,
        "hypotheses": list(curves.curves),
        "closest_sigma": curves.closest(),
        "page": str(file),
        "sensors": [{"channel": c.name, "apart_K": curves.spread_K(c.name)} for c in curves.test.channels],
    }
    what = f"{file}: {curves.experiment.name}, {curves.experiment.hours:g} h"
    give(document, target, lambda: Summary("; ".join(filter(None, [what, currents(levels)]))))
    return 0


def hottest(folder: Folder) -> float:
    """The hottest reading of all tests (degC)."""
    return max(float(np.nanmax(c.y)) for test in folder.case.tests for c in test.channels if np.isfinite(c.y).any())


def suspected(folder: Folder) -> list[str]:
    """The effects that the last diagnosis of this model holds for possible, most probable first."""
    document = current_diagnosis(folder)
    if document is None:
        right = f"thermoscope explain diagnose {folder.case.name} first, or --effect EFFECT@PLACE"
        raise InputError("has no diagnosis of the model as it stands", folder.case.name, right)
    by_score = sorted(document["candidates"], key=lambda c: -c["score"])
    likely = [c["effect"] for c in by_score if c["decision"] != "no"] or [c["effect"] for c in by_score]
    if not likely:
        raise InputError("has a diagnosis without candidates", folder.case.name, "--effect EFFECT@PLACE")
    return likely[:MOST]
