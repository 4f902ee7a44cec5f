"""thermoscope show report CASE, thermoscope show render CASE"""

from __future__ import annotations

import platform
from collections.abc import Mapping
from dataclasses import replace
from datetime import datetime
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.description.names import file_stem
from geom.errors import MissingDependency
from measured.case import Case, Test
from measured.sensors.sampling import sampled
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import Revision
from thermoscope.case_folder.runs import (
    ORDER,
    at_revision,
    before_last,
    by_interest,
    comparison_of,
    end_of,
    fields,
    parameters,
    readings,
    steps,
    temperature_range,
)
from thermoscope.commands.open_case import open_case_for_writing
from thermoscope.commands.show.viewer import viewer_page
from thermoscope.commands.stored_diagnosis import current_diagnosis, last_diagnosis
from thermoscope.console.answer import Answer
from thermoscope.console.terminal import Progress, give, notes, progress

if TYPE_CHECKING:
    from viz.data import Comparison
    from viz.rendering.nodes import SplitMesh

FRAMES = 61  # instants of a test that a page can step through
NO_PDF = "No PDF: WeasyPrint or Chromium prints it; thermoscope check says how to install one."
LIKELY = 0.5  # probability from which an event is drawn


def report(case: str, out: Path | None, target: str | None) -> int:
    """One page, as PDF too where this computer can. Its diagnosis is the last one there was; none is started here."""
    from viz import write_pdf

    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        path = write_page(folder, case, out or folder.settings.out, tell)
        tell("printing")
        pdf = write_pdf(path)
    document = {"case": folder.case.name, "revision": folder.case.model.revision, "report": str(path)}
    printed = [f"As PDF: {pdf}" if pdf else NO_PDF]
    if not (folder.settings.out / "diagnosis.json").exists():
        printed.append(f"It has no diagnosis yet: thermoscope explain diagnose {case}")
    give({**document, "pdf": pdf and str(pdf)}, target, lambda: Answer(f"The report is {path}.", printed))
    return 0


def write_page(folder: Folder, case: str, into: Path, tell: Progress) -> Path:
    """Write into/report.html with its pictures; `case` is what the commands on it call the case."""
    from thermoscope.case_folder.stored_yardstick import yardstick_document
    from validation.comparison.error_budget import documents
    from viz.pages.report import Report, write_report

    tell("running the model and its error budget")
    compared = {**folder.compared.document(), **yardstick_document(folder.yardstick, folder.compared, folder.case)}
    diagnosis, earlier = _diagnosis(folder)
    curves = [marked(comparison_of(folder, test), diagnosis) for test in by_interest(folder)]
    tell("drawing")
    viewed = "" if folder.built is None else viewer_page(folder, tell)
    page = Report(
        folder.case.name,
        folder.settings.description,
        compared,
        diagnosis,
        steps(folder),
        parameters(folder),
        curves,
        _pictures(folder, into, None if earlier else diagnosis),
        assumptions(folder),
        commands(folder, case),
        provenance(),
        earlier,
        documents(folder.budgets),
        viewed,
    )
    return write_report(page, into / "report.html")


def marked(comparison: Comparison, diagnosis: Mapping[str, Any] | None) -> Comparison:
    """The comparison with the events that a diagnosis finds likely."""
    likely = [e for e in (diagnosis or {}).get("events", []) if e["probability"] > LIKELY]
    spans = [(s["begin_s"], s["end_s"]) for e in likely for s in e["spans"] if s["test"] == comparison.test.name]
    return replace(comparison, events=(*comparison.events, *spans))


def render(case: str, out: Path | None, target: str | None) -> int:
    """Curves and errors always; the field and the recording where the geometry is known."""
    with progress() as tell:
        folder = open_case_for_writing(case, tell)
        into = out or folder.settings.out
        files = rendered(folder, into, tell)
    if folder.built is None:
        notes(["this case has no geometry (a hand-declared network): no field and no recording"])
    document = {"case": folder.case.name, "files": [str(f) for f in files]}
    give(document, target, lambda: Answer(f"{len(files)} files in {into}.", [str(f.name) for f in files]))
    return 0


def rendered(folder: Folder, into: Path, tell: Progress) -> list[Path]:
    """The pictures of an open case, and its recording."""
    into.mkdir(parents=True, exist_ok=True)
    tell("running the model and its error budget")
    _ = folder.compared
    tell("drawing curves")
    files = [*_plots(folder, into), *_pictures(folder, into, current_diagnosis(folder)).values()]
    if folder.built is not None:
        tell("writing the recording")
        files.append(_recording(folder, into))
    return files


def _diagnosis(folder: Folder) -> tuple[Mapping[str, Any] | None, bool]:
    """What the page shows, and whether it is of the model before its last step."""
    current = current_diagnosis(folder)
    if current is not None:
        return current, False
    last = last_diagnosis(folder)
    return last, last is not None


def _plots(folder: Folder, into: Path) -> list[Path]:
    from viz.figures import curves, errors

    paths = []
    for test in by_interest(folder):
        comparison = marked(comparison_of(folder, test), current_diagnosis(folder))
        for name, draw in (("curves", curves.measured_and_model), ("residuals", curves.residuals)):
            paths.append(into / f"{name}-{file_stem(test.name)}.png")
            draw(comparison, png=paths[-1])
    if folder.history.revisions:
        paths.append(into / "error.png")
        errors.staircase(steps(folder), png=paths[-1])
    return paths


def _pictures(folder: Folder, into: Path, diagnosis: Mapping[str, Any] | None) -> dict[str, Path]:
    """Caption -> picture of the field at the end of the most telling test, alone or beside the model before.

    diagnosis : of this model; it says where heat is missing
    """
    if folder.built is None:
        return {}
    from viz import cutaway, pair, require_gl, sensors, split
    from viz.data import LATE

    try:
        require_gl()
    except MissingDependency as fault:
        notes([str(fault)])
        return {}
    into.mkdir(parents=True, exist_ok=True)
    nodes, test = split(folder.built.mesh), by_interest(folder)[0]
    now, file = fields(folder.case, test, nodes, 1)[1][-1], into / "field.png"
    all_sensors = sensors(comparison_of(folder, test), folder.positions)
    title = f"{end_of(test)}: temperature of the model"
    limits = temperature_range(folder, nodes)
    cutaway(nodes, now, sensors=all_sensors, title=title, limits=limits, note=LATE, png=file)
    out = {f"Temperature at the end of {test.name}; labels: measured minus modelled.": file}
    out |= _missing_heat(diagnosis, nodes, into)
    earlier = before_last(folder)
    if earlier is not None:
        both = into / "field-before-after.png"
        titles = (f"{end_of(test)}, before the last step", f"{end_of(test)}, now")
        pair(nodes, fields(earlier, test, nodes, 1)[1][-1], now, titles=titles, limits=limits, png=both)
        out[f"End of {test.name} before and after the last step of the model."] = both
    return out


def _missing_heat(diagnosis: Mapping[str, Any] | None, nodes: SplitMesh, into: Path) -> dict[str, Path]:
    """Caption -> picture of where a diagnosis puts the missing heat; none where it cannot tell."""
    from viz import missing_in_machine
    from viz.machine.missing import placed

    if diagnosis is None or not placed(diagnosis):
        return {}
    where = diagnosis["where"]
    test, file = list(where[0]["heat"])[-1], into / "missing-heat.png"
    missing_in_machine(nodes, where, test, png=file).close()
    return {f"Heat that would have to enter (or leave, below zero) during {test}; unlikely places are grey.": file}


def _recording(folder: Folder, into: Path) -> Path:
    from viz import split, write_recording

    assert folder.built is not None
    nodes, test = split(folder.built.mesh), by_interest(folder)[0]
    frames = fields(folder.case, test, nodes, FRAMES)
    path = into / f"{file_stem(test.name)}.rrd"
    ends = np.array([fields(case, test, nodes, 1)[1][-1] for case in every_revision(folder)])
    return write_recording(
        path,
        nodes,
        comparison_of(folder, test),
        frames,
        folder.positions,
        history=steps(folder),
        revision_fields=ends,
        revision_residuals=[residual_at_end(case, test) for case in every_revision(folder)],
        limits=temperature_range(folder, nodes),
    )


def every_revision(folder: Folder) -> list[Case]:
    """The case with each model of its history, as declared first."""
    return [at_revision(folder, r) for r in (Revision(0, "calibrate"), *folder.history.revisions)]


def residual_at_end(case: Case, test: Test) -> dict[str, float]:
    """Sensor -> measured - modelled (K) over the last fifth of a test, where the machine is warm."""
    model, late = readings(case, test), slice(int(0.8 * len(test.time)), None)
    return {c.name: float(np.nanmean((c.y - model[c.name])[late])) for c in test.channels if np.isfinite(c.y).any()}


def assumptions(folder: Folder) -> list[str]:
    """What the numbers of the page rest on."""
    s, case = folder.settings, folder.case
    kind = "a network declared by hand" if s.machine is None else "a network condensed from the machine's field"
    roles = {role: [t.name for t in case.tests if t.role == role] for role in ORDER}
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
    parts = [f"thermoscope {version('thermoscope')}", f"Python {platform.python_version()}", f"NumPy {np.__version__}"]
    return f"{now}; {', '.join(parts)}; {platform.system()} {platform.machine()}"
