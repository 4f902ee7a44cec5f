"""thermoscope show report CASE, thermoscope show render CASE"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import viz as viz  # so named in the wheel as well
from geom.description.names import file_stem
from geom.errors import MissingDependency
from geom.text import counted
from measured.case import Case, Test
from measured.sensors.sampling import sampled
from thermoscope.case_folder import runs
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import Revision
from thermoscope.commands.open_case import current_diagnosis, last_diagnosis, open_case_for_writing
from thermoscope.commands.show.picture import Subject, draw_field
from thermoscope.commands.show.viewer import viewer_page
from thermoscope.console.options import Case as CaseName, Json, Out
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import Progress, give, notes, progress, versions
from validation.comparison.error_budget import documents
from validation.parameters.unknowns import strain_words
from validation.threads import side_by_side
from viz.data import Comparison, late_mean
from viz.figures import paper
from viz.machine.missing import placed

FRAMES = 61  # instants of a test that a page can step through
NO_PDF = "No PDF: WeasyPrint or Chromium prints it; thermoscope check says how to install one."
LIKELY = 0.5  # probability from which an event is drawn


def report(case: CaseName, out: Out = None, target: Json = None) -> int:
    """One self-contained HTML page: verdict, pictures, numbers with their uncertainty."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        path = write_page(folder, case, out or folder.settings.out, tell)
        tell("printing")
        pdf = viz.write_pdf(path)
    document = {"case": folder.case.name, "revision": folder.case.model.revision, "report": str(path)}
    printed = [f"As PDF: {pdf}" if pdf else NO_PDF]
    if not (folder.settings.out / "diagnosis.json").exists():
        printed.append(f"It has no diagnosis yet: thermoscope explain diagnose {case}")
    give({**document, "pdf": pdf and str(pdf)}, target, lambda: Summary(f"The report is {path}.", printed))
    return 0


def write_page(
    folder: Folder, case: str, into: Path, tell: Progress, pictures: Mapping[str, Path] | None = None
) -> Path:
    """Write into/report.html with its pictures, drawn anew or those given; `case` is what commands call the case."""
    from thermoscope.case_folder.stored_comparison import yardstick_document
    from viz.pages.report import Report, write_report

    tell("running the model and its error budget")
    plain = yardstick_document(folder.yardstick, folder.compared, folder.case)
    compared = {**folder.compared.document(), **plain, "strained": strain_words(folder.case)}
    diagnosis, earlier = _diagnosis(folder)
    curves = [marked(runs.comparison_of(folder, test), diagnosis) for test in runs.by_interest(folder)]
    tell("drawing")
    viewed = "" if folder.built is None else viewer_page(folder, tell)
    page = Report(
        folder.case.name,
        folder.settings.description,
        compared,
        diagnosis,
        runs.steps(folder),
        runs.parameters(folder),
        curves,
        field_pictures(folder, into) if pictures is None else pictures,
        assumptions(folder),
        commands(folder, case),
        provenance(),
        earlier,
        documents(folder.budgets),
        viewed,
        runs.finding_words(folder, compared),
    )
    return write_report(page, into / "report.html")


def marked(comparison: Comparison, diagnosis: Mapping[str, Any] | None) -> Comparison:
    """The comparison with the events that a diagnosis finds likely."""
    likely = [e for e in (diagnosis or {}).get("events", []) if e["probability"] > LIKELY]
    spans = [(s["begin_s"], s["end_s"]) for e in likely for s in e["spans"] if s["test"] == comparison.test.name]
    return replace(comparison, events=(*comparison.events, *spans))


def render(case: CaseName, out: Out = None, target: Json = None) -> int:
    """Pictures (PNG) and a recording (.rrd) for the rerun viewer."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        into = out or folder.settings.out
        files = rendered(folder, into, tell)
    if folder.built is None:
        notes(["this case has no geometry (a hand-declared network): no field and no recording"])
    document = {"case": folder.case.name, "files": [str(f) for f in files]}
    give(document, target, lambda: Summary(f"{counted(len(files), 'file')} in {into}.", [str(f.name) for f in files]))
    return 0


def rendered(folder: Folder, into: Path, tell: Progress, pictures: Mapping[str, Path] | None = None) -> list[Path]:
    """The pictures of an open case, drawn anew or those given of its field, and its recording."""
    into.mkdir(parents=True, exist_ok=True)
    tell("running the model and its error budget")
    _ = folder.compared
    tell("drawing curves")
    curves = [marked(runs.comparison_of(folder, test), current_diagnosis(folder)) for test in runs.by_interest(folder)]
    kinds = (("curves", viz.measured_and_model), ("residuals", viz.residuals))
    every = [(draw, c, into / f"{name}-{file_stem(c.test.name)}.png") for c in curves for name, draw in kinds]
    paper.draw_all([partial(_write_figure, *one) for one in every])
    paths = [png for *_, png in every]
    if folder.history.revisions:
        paths.append(into / "error.png")
        viz.staircase(runs.steps(folder), png=paths[-1])
    files = [*paths, *(field_pictures(folder, into) if pictures is None else pictures).values()]
    if folder.built is not None:
        tell("writing the recording")
        files.append(_recording(folder, into))
    return files


def _write_figure(draw: Callable[..., Any], comparison: Comparison, png: Path) -> None:
    draw(comparison, png=png)


def _diagnosis(folder: Folder) -> tuple[Mapping[str, Any] | None, bool]:
    """What the page shows, and whether it is of the model before its last step."""
    current = current_diagnosis(folder)
    if current is not None:
        return current, False
    last = last_diagnosis(folder)
    return last, last is not None


def field_pictures(folder: Folder, into: Path) -> dict[str, Path]:
    """Caption -> picture of the field at the end of the most telling test, alone or beside the model before; and where
    heat is missing, if this model was diagnosed."""
    if folder.built is None:
        return {}
    diagnosis = current_diagnosis(folder)
    try:
        viz.require_gl()
    except MissingDependency as fault:
        notes([str(fault)])
        return {}
    into.mkdir(parents=True, exist_ok=True)
    s, file = Subject(folder, lambda message: None), into / "field.png"
    draw_field(s, file)
    out = {f"Temperature at the end of {s.test.name}; labels: measured minus modelled.": file}
    if diagnosis is not None and placed(diagnosis):
        where, missing = diagnosis["where"], into / "missing-heat.png"
        test = list(where[0]["heat"])[-1]
        viz.missing_in_machine(s.nodes, where, test, png=missing).close()
        caption = f"Heat that would have to enter (or leave, below zero) during {test}; unlikely places are grey."
        out[caption] = missing
    earlier = runs.before_last(folder)
    if earlier is not None:
        both, titles = into / "field-before-after.png", (f"{s.when}, before the last step", f"{s.when}, now")
        fields, row = (s.field(earlier), s.field()), (s.sensors_before, s.sensors)
        viz.pair(s.nodes, *fields, titles=titles, sensors=row, limits=s.limits, png=both).close()
        out[f"End of {s.test.name} before and after the last step of the model, and what that changed."] = both
    return out


def _recording(folder: Folder, into: Path) -> Path:
    s, revisions = Subject(folder, lambda message: None), (Revision(0, "calibrate"), *folder.history.revisions)
    cases = [runs.at_revision(folder, r) for r in revisions]  # with each model of its history, as declared first
    return viz.write_recording(
        into / f"{file_stem(s.test.name)}.rrd",
        s.nodes,
        s.comparison,
        runs.fields(folder.case, s.test, s.nodes, FRAMES),
        folder.positions,
        history=runs.steps(folder),
        revision_fields=np.array(side_by_side(s.field, cases)),
        revision_residuals=side_by_side(lambda case: residual_at_end(case, s.test), cases),
        limits=s.limits,
    )


def residual_at_end(case: Case, test: Test) -> dict[str, float]:
    """Sensor -> measured - modelled (K) over the last fifth of a test, where the machine is warm."""
    model = runs.readings(case, test)
    late = {c.name: late_mean(c.y - model[c.name]) for c in test.channels}
    return {name: K for name, K in late.items() if K is not None}


def assumptions(folder: Folder) -> list[str]:
    """What the numbers of the page rest on."""
    s, case = folder.settings, folder.case
    kind = "a network declared by hand" if s.machine is None else "a network condensed from the machine's field"
    roles = {role: [t.name for t in case.tests if t.role == role] for role in runs.ORDER}
    summary = "; ".join(f"{role}: {', '.join(names)}" for role, names in roles.items() if names)
    sigma = sorted({f"{c.sigma_K:g}" for t in case.tests for c in t.channels}, key=float)
    spread = " to ".join(sigma[:: max(1, len(sigma) - 1)])
    return [
        f"The model is {kind} with {len(case.model.network.parameters)} adjustable parameters.",
        f"Tests by role: {summary}.",
        *([f"Sample steps: {sampled(folder.steps)}."] if folder.steps else []),
        f"Sensors are taken to be right within {spread} K (one standard deviation).",
        *folder.notes,
    ]


def commands(folder: Folder, case: str) -> list[str]:
    """What leads from the declared model to this page."""
    calls = [r for r in folder.history.revisions if r.action in ("calibrate", "add", "remove")]
    lines = [f"thermoscope model {r.action} {case} {r.effect}".strip() for r in calls]
    return [*lines, f"thermoscope show report {case}"]


def provenance() -> str:
    """Date, versions, computer."""
    now = datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z")
    return f"{now}; {versions()}, NumPy {np.__version__}"
