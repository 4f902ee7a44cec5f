"""The comparison of a machine's case is kept by content: the same again without a run, anew when anything changed."""

import json
from dataclasses import replace

import numpy as np
import pytest
from motor_case import with_motor
from small_case import small_case

from thermoscope.case_folder import content, stored_comparison
from thermoscope.case_folder.content import result_key
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import comparison_of
from thermoscope.commands.show.viewer import stored_documents, viewer_documents


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path / "cache"))
    return with_motor(small_case(tmp_path))


def again(folder):
    """The same case as another command opens it."""
    return with_motor(folder.settings.path)


def test_a_comparison_that_was_made_before_is_read_and_not_run(folder, monkeypatch):
    first, budgets = folder.compared, folder.budgets
    curves = [comparison_of(folder, test).model for test in folder.case.tests]
    monkeypatch.setattr(stored_comparison, "compare", None)
    monkeypatch.setattr("thermoscope.case_folder.runs.predict", None)
    other = again(folder)
    assert other.compared == first
    assert other.budgets == budgets
    for test, curve in zip(other.case.tests, curves, strict=True):
        read = comparison_of(other, test)
        assert read.limits == first.limits[test.name]
        for name, T in curve.items():
            np.testing.assert_array_equal(read.model[name], T)


def test_whatever_decides_a_comparison_changes_its_key(folder, monkeypatch):
    case, settings = folder.case, folder.settings
    model, (test, *tests) = case.model, case.tests
    colder = replace(test, boundaries={name: np.asarray(u) - 1.0 for name, u in test.boundaries.items()})
    reading = replace(test, channels=(replace(test.channels[0], y=test.channels[0].y + 1.0), *test.channels[1:]))
    parameter = model.network.parameters[0]
    others = [
        replace(folder, case=replace(case, model=replace(model, values={parameter.name: 1.1 * parameter.value}))),
        *(replace(folder, case=replace(case, tests=(one, *tests))) for one in (colder, reading)),
        replace(folder, case=replace(case, answers={"event@1": True})),
    ]
    keys = [result_key(folder), *map(result_key, others)]
    assert result_key(again(folder)) == keys[0]
    file = settings.path / "case.toml"
    file.write_text(file.read_text() + "\n# another\n")
    keys.append(result_key(folder))
    (settings.tests[0].sheet.parent / "columns.toml").write_text("# of another sheet\n")
    keys.append(result_key(folder))
    content.code_digest.cache_clear()
    monkeypatch.setattr(content, "_modules", lambda rooms: iter([file]))
    keys.append(result_key(folder))
    content.code_digest.cache_clear()
    assert len(set(keys)) == len(keys) == 8


def test_the_table_of_doubt_counts_as_code():
    assert "doubt.csv" in {file.name for file in content._modules(("measured",))}


def test_a_network_declared_by_hand_is_quick_and_not_kept(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path / "cache"))
    folder = load_case(small_case(tmp_path))
    assert np.isfinite(folder.compared.rmse_K)
    assert list((tmp_path / "cache").glob("comparison-*")) == []


def test_a_machine_that_was_drawn_before_is_not_drawn_again(folder, monkeypatch):
    assert stored_documents(folder) is None
    parts = list(viewer_documents(folder, lambda message: None))
    monkeypatch.setattr("thermoscope.commands.show.viewer._documents", None)
    as_read = json.loads(json.dumps(parts))
    assert list(viewer_documents(again(folder), lambda message: None)) == as_read
