"""Pictures, film, recording and the viewer (the workbench's machine, too) take their colours from one range."""

import json
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

import viz
from extras.workbench import appearance, steps
from lumped.build import pipeline
from lumped.condensation.reduction import Recipe
from thermoscope.case_folder import runs
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.history import History, Revision
from thermoscope.case_folder.runs import by_interest, fields, stored_range, temperature_range
from thermoscope.commands.show import pages, viewer
from viz.colours import rounded

pytestmark = pytest.mark.heavy
TINY = Recipe(tolerance=0.3, random_points=1, local_points=1, local_states=1, max_states=40)


@pytest.fixture(scope="module")
def folder(root):
    quick = partial(pipeline.build, size_m=0.15, segments=24, recipe=TINY)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pipeline, "build", quick)
        return load_case(root / "cases" / "road-test")


def silent(message):
    pass


def test_one_range_for_all(folder, tmp_path, monkeypatch):
    """What is drawn at one instant of one test shows colours of all instants of all tests."""
    nodes, given = viz.split(folder.built.mesh), []
    expected = temperature_range(folder, nodes)
    every = [fields(folder.case, test, nodes, 7)[1] for test in by_interest(folder)]
    assert expected[0] <= min(T.min() for T in every) + 1.0
    assert expected[1] >= max(T.max() for T in every) - 1.0
    scene = SimpleNamespace(close=lambda: None)
    monkeypatch.setattr(viz, "cutaway", lambda *_, limits, **__: given.append(limits) or scene)
    monkeypatch.setattr(viz, "write_recording", lambda path, *_, limits, **__: given.append(limits) or path)
    monkeypatch.setattr(runs, "by_interest", lambda folder: by_interest(folder)[:1])  # one test: each costs time
    pages.rendered(folder, tmp_path, silent)
    bench = next(steps.machine_documents(folder, silent))
    page = viewer.viewer_page(folder, silent)
    data = json.loads(page.partition('id="data">')[2].partition("</script>")[0])
    assert np.array(given) == pytest.approx(np.array([expected] * 2))
    assert (data["marks"][0], data["marks"][-1]) == rounded(*expected)
    assert bench["marks"] == data["marks"]


def test_a_step_of_the_model_begins_with_the_colours_of_the_model_before(folder, tmp_path, monkeypatch):
    """Until all tests have run with it, so that its first picture compares with the last one."""
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path / "cache"))
    nodes, parameter = viz.split(folder.built.mesh), folder.case.model.network.parameters[0]
    first, second = (Revision(n, "calibrate", values={parameter.name: n * parameter.value}) for n in (1, 2))
    before, now = (appearance.at(folder, History(of)) for of in ((first,), (first, second)))
    assert stored_range(now) is None
    expected = temperature_range(before, nodes)
    assert stored_range(now) == stored_range(before) == expected
