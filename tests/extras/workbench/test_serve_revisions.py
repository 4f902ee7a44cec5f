"""One tab's history: undo step by step, and never write over somebody else."""

import pytest

from extras.workbench.appearance import effective, undone
from geom.errors import InputError
from thermoscope.case_folder.history import History, Revision, load_history, save_history

ONE = Revision(0, "calibrate", values={"a": 1.0}, rmse_K={"t": (3.0, 2.0)})
TWO = Revision(0, "add", ("x@y",), "x@y", {"a": 1.1, "x@y": 5.0}, rmse_K={"t": (2.0, 0.5)})


def test_undo_goes_back_step_by_step_to_the_declared_model():
    history = History().and_then(ONE).and_then(TWO)
    once = undone(history)
    assert (once.last.action, once.last.effects, once.last.values) == ("step back", (), {"a": 1.0})
    twice = undone(once)
    assert (twice.last.effects, dict(twice.last.values)) == ((), {})
    assert undone(twice) is None
    assert len(twice.revisions) == 4


def test_undo_after_a_new_step_undoes_the_new_step():
    history = undone(History().and_then(ONE).and_then(TWO)).and_then(TWO)
    assert [r.action for r in effective(history)] == ["calibrate", "calibrate", "add"]
    assert undone(history).last.values == {"a": 1.0}


def test_undo_says_what_the_error_does():
    once = undone(History().and_then(ONE).and_then(TWO))
    assert once.last.rmse_K == {"t": (0.5, 2.0)}


def test_a_step_is_written_and_read_back(tmp_path):
    file = tmp_path / "model.toml"
    kept = save_history(file, History().and_then(ONE), History())
    assert kept == load_history(file)
    assert save_history(file, kept.and_then(TWO), kept).last.effects == ("x@y",)


def test_somebody_elses_step_is_not_written_over(tmp_path):
    file = tmp_path / "model.toml"
    mine = save_history(file, History().and_then(ONE), History())
    theirs = save_history(file, mine.and_then(TWO), mine)
    with pytest.raises(InputError, match="another tab"):
        save_history(file, mine.and_then(TWO), mine)
    assert load_history(file) == theirs
