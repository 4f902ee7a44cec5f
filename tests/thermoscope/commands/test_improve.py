"""thermoscope explain improve and undo: the error staircase, what is never added, what stays in the history."""

import io
import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from small_case import small_case

from measured.case import Case, Model, Test
from thermoscope.case_folder.history import load_history
from thermoscope.cli import whole_app
from thermoscope.commands.explain import improve as command
from validation.inference.decide import SURE
from validation.inference.result import Candidate, Diagnosis, Odds
from validation.revision import improvement
from validation.revision.improvement import offered, singletons
from viz.pages.words import ending


@pytest.fixture(scope="module")
def improved(tmp_path_factory):
    """A case that lacks convection at the flange, improved without asking; exit code, document, folder."""
    folder = tmp_path_factory.mktemp("improve")
    case, target = small_case(folder), folder / "improve.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(folder / "cache"))
        code = command.improve(str(case), True, 3, str(target))
    return code, json.loads(target.read_text()), case


def test_it_ends_adequate_and_says_how_near_the_best_plain_model_is_here_and_in_the_report(improved):
    code, document, case = improved
    assert (code, document["verdict"], document["adequate"]) == (0, "adequate", True)
    assert document["why"].endswith(f" {document['plain_left_out_K']:.2f} K")
    fitted = (
        f"as fitted this model leaves {document['left_out_K']:.2f} K; "  # one test: nothing was left out of its fit
    )
    assert fitted in document["why"]
    assert document["left_out_K"] < 1.1 * document["plain_left_out_K"]
    ended = json.loads((case / "out" / "diagnosis.json").read_text())
    assert document["why"][1:] in ending(ended)


def test_the_staircase_falls_on_the_test_never_used(improved):
    stairs = improved[1]["stairs"]
    assert [s["effect"] for s in stairs] == [None, None, "convection@flange"]
    town = [next(t["rmse_K"] for t in s["tests"] if t["role"] == "hold-out") for s in stairs]
    assert town[0] > 2.0
    assert town[-1] < 0.4  # K, the smallest sigma declared


def test_undo_brings_the_model_before_back_and_forgets_nothing(improved, capsys):
    with pytest.raises(SystemExit) as done:
        whole_app()(["model", "undo", str(improved[2]), "--to", "1", "--json", "-"])
    assert done.value.code == 0
    document = json.loads(capsys.readouterr().out)
    assert document["effects"] == []
    assert document["rmse_K"]["town"] > 2.0
    history = load_history(improved[2] / "model.toml")
    assert [r.action for r in history.revisions] == ["calibrate", "add", "step back"]
    assert history.last.values == history.revisions[0].values


def row(name, decision):
    return Candidate(name, 9.0, 3.0, 1.0, "W/K", (0.5, 1.5), decision)


def answer(verdict, *rows):
    groups = (tuple(r.effect for r in rows),) if rows else ()
    found = Diagnosis(verdict, "words", tuple(g[0] for g in groups), groups, rows, (), (), (), 1.0, 0.5, 3.0)
    return replace(found, odds=tuple(Odds(r.effect, (r.effect,), r.probability) for r in rows))


@pytest.mark.parametrize(
    ("found", "names"),
    [
        (answer("adequate"), []),
        (answer("absorbed", row("flow@fan", "cannot-tell")), []),
        (answer("outside", row("mass@yoke", "cannot-tell")), []),
        (answer("named", row("mass@yoke", "named")), ["mass@yoke"]),
        (answer("group", row("mass@yoke", "group"), row("iron@yoke", "group")), ["mass@yoke", "iron@yoke"]),
    ],
)
def test_what_cannot_be_told_is_never_offered(found, names):
    assert [c.effect for c in offered(found)] == names


@pytest.mark.parametrize(
    ("found", "name"),
    [
        (answer("named", replace(row("mass@yoke", "named"), probability=0.7)), "mass@yoke"),
        (answer("named", replace(row("mass@yoke", "named"), probability=0.3)), None),  # unknown heat is likelier
        (answer("group", row("mass@yoke", "group"), row("iron@yoke", "group")), None),
        (answer("data", row("sensor.bias@T_yoke", "named")), None),
        (answer("several", row("sensor.bias@T_yoke", "named")), None),
        (
            answer("data", replace(row("sensor.loose@T_yoke in dusk", "named"), probability=0.99)),
            "sensor.loose@T_yoke in dusk",
        ),
        (answer("data", replace(row("time.offset@dusk", "named"), probability=0.99)), "time.offset@dusk"),
        (answer("data", replace(row("sensor.gain@T_yoke", "named"), probability=0.99)), None),
    ],
)
def test_what_is_sure_is_added_without_asking_but_no_lasting_fault(found, name):
    assert singletons(found, offered(found)) == name


def test_what_stands_alone_is_added_if_it_is_likelier_than_not_and_one_of_several_if_it_is_sure():
    for verdict, others, least in (("named", (), 0.5), ("group", (row("iron@yoke", "group"),), SURE)):
        for probability in (least - 0.01, least + 0.01):
            first = replace(row("mass@yoke", verdict), probability=probability)
            chosen = singletons(answer(verdict, first, *others), (first, *others))
            assert chosen == (first.effect if probability > least else None)


@pytest.mark.parametrize(("word", "name"), [("2\n", "iron@yoke"), ("\n", None), ("", None), ("3\n", None)])
def test_asking_takes_a_number_of_the_list(word, name, monkeypatch, capsys):
    found = answer("group", row("mass@yoke", "group"), row("iron@yoke", "group"))
    monkeypatch.setattr("sys.stdin", io.StringIO(word))
    assert command.user_choice(found, offered(found)) == name
    assert capsys.readouterr().out == ""  # stdout belongs to the result


@pytest.mark.parametrize(
    ("own", "all_tests", "other", "kept"),
    [
        ("accepted", "accepted", "validate", "own"),
        ("worth keeping", "accepted", "validate", "all"),
        ("worth keeping", "refused", "validate", "own"),
        ("worth keeping", "accepted", "hold-out", "own"),
        ("refused", "accepted", "validate", "all"),
        ("refused", "refused", "validate", None),
    ],
)
def test_a_calibration_that_spoils_others_gives_way_to_one_of_all_tests(own, all_tests, other, kept, monkeypatch):
    def fit(case, roles=("calibrate",), progress=None):
        of_all, what = len(roles) > 1, all_tests if len(roles) > 1 else own
        stands = what == "accepted"
        return SimpleNamespace(
            of="all" if of_all else "own", accepted=stands, worth_keeping=stands or what == "worth keeping"
        )

    monkeypatch.setattr(improvement, "calibrate", fit)
    tests = [Test(role, role, np.arange(2.0), {}, {}, ()) for role in ("calibrate", other)]
    done = improvement._first_fit(Case("one", Model(None), tuple(tests)), lambda message: None)
    assert (done.of if done else None) == kept
