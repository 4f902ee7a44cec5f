"""One tab's history: undo step by step."""

from extras.workbench.appearance import effective, undone
from thermoscope.case_folder.history import History, Revision

ONE = Revision(0, "calibrate", values={"a": 1.0}, rmse_K={"t": (3.0, 2.0)})
TWO = Revision(0, "add", ("x@y",), "x@y", {"a": 1.1, "x@y": 5.0}, rmse_K={"t": (2.0, 0.5)})


def test_undo_goes_back_step_by_step_to_the_declared_model():
    history = History().and_then(ONE).and_then(TWO)
    once = undone(history)
    assert (once.last.action, once.last.effects, once.last.values) == ("step back", (), {"a": 1.0})
    assert once.last.rmse_K == {"t": (0.5, 2.0)}, "what the error does"
    twice = undone(once)
    assert (twice.last.effects, dict(twice.last.values)) == ((), {})
    assert undone(twice) is None
    assert len(twice.revisions) == 4


def test_undo_after_a_new_step_undoes_the_new_step():
    history = undone(History().and_then(ONE).and_then(TWO)).and_then(TWO)
    assert [r.action for r in effective(history)] == ["calibrate", "calibrate", "add"]
    assert undone(history).last.values == {"a": 1.0}
