"""A diagnosis that is stopped at its first odds says so, and keeps nothing."""

import json

import pytest
from small_case import small_case
from two_bodies import bench

from thermoscope.case_folder.folder import load_case
from thermoscope.commands.explain import diagnose as command
from thermoscope.commands.open_case import last_diagnosis
from validation import diagnose
from validation.diagnosis import PRELIMINARY


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("quick"))


def test_first_odds_are_those_that_a_whole_search_tells_on_its_way():
    """The same hypotheses with the same odds, by either way; the whole search has none of its own marked so."""
    told = []
    whole = diagnose(bench(), plan=False, report=lambda so_far: told.append(so_far().document()))
    quick = diagnose(bench(), plan=False, quick=True).document()
    assert [o["hypothesis"] for o in quick["odds"]] == [o["hypothesis"] for o in told[0]["odds"]]
    assert [o["probability"] for o in quick["odds"]] == pytest.approx([o["probability"] for o in told[0]["odds"]])
    assert (quick["preliminary"], whole.document()["preliminary"]) == (True, False)
    assert PRELIMINARY not in whole.words
    first, last = (x.partition(":")[0] for x in (quick["odds"][0]["hypothesis"], whole.odds[0].hypothesis))
    assert first == last  # its ends may differ


def test_quick_odds_are_marked_in_terminal_and_document_and_not_kept(case, tmp_path, capsys):
    target = tmp_path / "quick.json"
    command.diagnose(str(case), str(target), quick=True)
    document = json.loads(target.read_text())
    assert document["preliminary"] is True
    assert document["words"].startswith(PRELIMINARY)
    assert "Preliminary odds" in capsys.readouterr().out
    assert last_diagnosis(load_case(case)) is None


def test_who_waits_is_told_once_what_is_known(monkeypatch, capsys):
    so_far, found = command.SoFar(lambda message: None), diagnose(bench(), plan=False, quick=True)
    monkeypatch.setattr(command, "LONG_S", 0.0)
    so_far.tell("scoring")
    assert capsys.readouterr().err == ""
    so_far.learn(lambda: found)
    so_far.tell("refitting")
    so_far.tell("refitting another")
    assert capsys.readouterr().err == f"note: after 0 min: {found.words}\n"


def test_a_search_that_is_stopped_shows_its_first_odds(case, monkeypatch, capsys):
    """Ctrl-C once they are known: the verdict so far, marked, and that nothing was kept."""

    def stopped(folder, tell, without, only, quick, report):
        report(lambda: diagnose(bench(), plan=False, quick=True))
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "diagnosed", stopped)
    with pytest.raises(KeyboardInterrupt):
        command.diagnose(str(case))
    shown = capsys.readouterr()
    assert "Preliminary odds" in shown.out
    assert "stopped: its odds are preliminary; a diagnosis of before stays in out/" in shown.err
