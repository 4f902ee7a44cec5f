"""thermoscope show viewer CASE"""

import json
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from geom.description.names import file_stem
from geom.disk_cache import recalled, store
from geom.errors import InputError
from geom.plugins import plugins
from geom.storage import cache_folder, write_whole
from lumped.machine.bases import unused
from measured.case import Test
from thermoscope.case_folder import runs
from thermoscope.case_folder.content import digest, result_key
from thermoscope.case_folder.error_field import error_gain, network_run
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import Revision
from thermoscope.commands.open_case import needs_geometry, open_case
from thermoscope.console.options import Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import Progress, give, progress
from thermoscope.parts import required
from validation.parameters.unknowns import standing
from validation.threads import side_by_side

MOST = 5  # revisions in a page: each adds its amplitudes, and its fields while the page is made
FRAMES = 61  # instants of a test: between them the page draws straight lines


def viewer(
    case: Case,
    out: Annotated[Path | None, typer.Option("--out", metavar="FILE", help="An HTML file.")] = None,
    target: Json = None,
) -> int:
    """One HTML file: the machine to turn, cut and play in any browser, without a server or network."""
    if out is not None and (out.suffix != ".html" or out.is_dir()):
        raise InputError("is not a name of a page", f"--out {out}", "a file NAME.html")
    needs_geometry(case)
    required(("pyvista",))
    with progress() as tell:
        folder = open_case(case, tell)
        file = write_case(folder, out or Path("out") / f"{file_stem(folder.case.name)}-viewer.html", tell)
    give({"case": folder.case.name, "viewer": str(file)}, target, lambda: Summary(f"{file}"))
    return 0


def write_case(folder: Folder, file: Path, tell: Progress) -> Path:
    """Write the page of an open case, and return its path."""
    page = viewer_page(folder, tell)
    tell(f"writing {file}")
    return write_whole(file, page)


def viewer_page(folder: Folder, tell: Progress) -> str:
    """The page of an open case that has a machine: all its tests."""
    from viz.viewer.page import render, with_limits

    parts = list(viewer_documents(folder, tell))
    return render(with_limits({key: value for part in parts for key, value in part.items()}, folder.compared.limits))


def viewer_documents(folder: Folder, tell: Progress) -> Iterator[dict[str, Any]]:
    """What the page draws, in three parts: the machine in one test, then in all of them, then what takes longest.

    Keys of a later part replace those of an earlier one. Without the errors that count as agreement, for which the
    model runs many times more. Kept by content.
    """
    parts = stored_documents(folder)
    if parts is not None:
        yield from parts
        return
    making = _documents(folder, tell)
    yield (first := next(making))
    yield (every := next(making))
    rest = list(making)
    whole = json.dumps([first, every, *rest])
    store(_file(folder), whole)  # before the last part: who has it may end this
    yield from rest


def stored_documents(folder: Folder) -> list[dict[str, Any]] | None:
    """What the page draws, from the cache; None where this very model was not drawn before."""
    if folder.built is None:
        return None
    return recalled(_file(folder), lambda file: list(json.loads(file.read_text(encoding="utf-8"))))


def _file(folder: Folder) -> Path:
    models = revisions(folder), folder.history.last, sorted(folder.positions.items())
    return cache_folder() / f"viewer-{digest(result_key(folder, 'viz', 'extras'), models)}.json"


def _documents(folder: Folder, tell: Progress) -> Iterator[dict[str, Any]]:
    from viz import split
    from viz.viewer.page import Earlier, ErrorMap, Recorded, analysis_document, machine_document, temperature_document

    assert folder.built is not None
    machine, nodes, earlier = folder.built.machine, split(folder.built.mesh), runs.before_last(folder)
    others = [runs.at_revision(folder, r) for r in revisions(folder)[2:]]
    conductivity = {part.name: machine.conductivity(part.name) for part in machine.parts}
    names = [
        f"{r.number}: {runs.step_words(folder.case, r) if r.number else 'as it was'}" for r in revisions(folder)
    ] or ["now"]

    def absent(test: Test) -> list[str]:
        return unused(machine, test.inputs)

    def played(test: Test) -> Recorded:
        times, now = runs.fields(folder.case, test, nodes, FRAMES)
        before = None if earlier is None else runs.fields(earlier, test, nodes, FRAMES)[1]
        rest = tuple(Earlier(runs.fields(case, test, nodes, FRAMES)[1], runs.readings(case, test)) for case in others)
        return Recorded(runs.comparison_of(folder, test, {}), times, now, before, rest, absent=absent(test))

    def analysis(run: Recorded) -> Recorded:
        test = run.comparison.test
        channels, gain = error_gain(folder, test, nodes)
        between = ErrorMap(tuple(c.name for c in channels), gain.mean, gain.explained)
        return replace(run, error_map=between, network=network_run(folder.case, test, run.times))

    tell("running the model on a first test")
    order, cache, looks_of = runs.by_interest(folder), cache_folder(), plugins("sections").get("looks")
    standing(folder.case)  # one network for both of the following
    with ThreadPoolExecutor() as pool:
        # To make them takes longer than all else of the first picture
        looks = looks_of and looks_of.cached_looks(machine, nodes, cache)
        shape = pool.submit(machine_document, folder.case.name, nodes, conductivity, looks)
        comparison = pool.submit(runs.current_comparison, folder, order[0])
        run = runs.fields(folder.case, order[0], nodes, FRAMES)
    first, limits = [Recorded(comparison.result(), *run, absent=absent(order[0]))], runs.stored_range(folder)
    now = temperature_document(nodes, first, folder.positions, conductivity, names[:1], limits)
    yield shape.result() | now
    tell("running every test")
    with ThreadPoolExecutor() as pool:
        shapes = None if looks or looks_of is None else pool.submit(looks_of.packed_looks, machine, nodes, cache=cache)
        limits = runs.temperature_range(folder, nodes)  # first: the last two runs of a test are remembered
        tests = side_by_side(played, order)
        now = temperature_document(nodes, tests, folder.positions, conductivity, names, limits)
    yield now | ({"looks": shapes.result()} if shapes else {})
    tell("residuals between the sensors, and heat flows")
    yield analysis_document(side_by_side(analysis, tests), nodes, folder.built.mesh)


def revisions(folder: Folder) -> list[Revision]:
    """The last one first, then the one before it, the start, and the others with the newest first, MOST in all."""
    newest_first = [Revision(0, "calibrate"), *folder.history.revisions][::-1]
    return [*newest_first[:2], *newest_first[2:][-1:], *newest_first[2:-1]][:MOST] if len(newest_first) > 1 else []
