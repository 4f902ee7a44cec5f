"""The user disagrees: effects left out of the question, asked about alone, or with odds of their own and a reason."""

import json
from dataclasses import replace

import pytest
from command_line import answered
from small_case import small_case
from two_bodies import bench

from geom.errors import InputError
from measured.doubt import Odds
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.settings import read_settings
from thermoscope.commands.explain.diagnose import diagnose as diagnose_command
from thermoscope.commands.open_case import last_diagnosis
from validation import diagnose
from validation.inference.conditions import check_names
from validation.scope import Scope

ODDS = '[odds."convection@flange"]\nfactor = {}\nreason = "{}"\n'


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return small_case(tmp_path_factory.mktemp("disagree"))


def odds_against_nothing(found):
    """Hypothesis -> odds against nothing missing."""
    P = {o.hypothesis: o.probability for o in found.odds}
    return {name: p / P["nothing"] for name, p in P.items()}


def test_what_is_left_out_is_no_hypothesis_and_stands_in_the_first_line(case, tmp_path, capsys):
    """The wind is there, and the user says it is not: what was left out is said and kept."""
    target = tmp_path / "found.json"
    diagnose_command(str(case), str(target), ["convection@flange", "sensors"])
    found = json.loads(target.read_text())
    names = {name for row in found["odds"] for name in row["effects"]} | {c["effect"] for c in found["candidates"]}
    assert not any(n.startswith(("convection@flange", "sensor.")) for n in names)
    assert "as asked, without convection@flange, sensors" in found["words"]
    kept = last_diagnosis(load_case(case))
    assert (kept["without"], kept["only"]) == (["convection@flange", "sensors"], [])


def test_only_what_is_asked_about_is_weighed():
    found = diagnose(bench(), plan=False, scope=Scope(only=("convection.constant",)))
    kinds = {name.partition("@")[0] for o in found.odds for name in o.effects}
    assert kinds == {"convection.constant"}
    assert found.words.startswith("as asked, only convection.constant; missing: ")
    assert found.document()["only"] == ["convection.constant"]


def test_to_leave_all_out_is_refused():
    with pytest.raises(InputError, match="every effect that can be here is left out"):
        diagnose(bench(()), plan=False, scope=Scope(("radiation",), ("radiation",)))


def test_odds_of_the_case_multiply_those_before_the_readings():
    """One to ten against radiation: its odds against nothing fall to a tenth."""
    plain = bench(())
    stated = replace(plain, odds={"radiation@body": Odds(0.1, "it is polished")})
    before, found = odds_against_nothing(diagnose(plain, plan=False)), diagnose(stated, plan=False)
    after = odds_against_nothing(found)
    assert after["radiation@body"] == pytest.approx(0.1 * before["radiation@body"], rel=0.02)
    assert found.words.startswith("odds of radiation@body times 0.1 (it is polished); ")
    assert found.document()["stated_odds"] == [{"effect": "radiation@body", "factor": 0.1, "reason": "it is polished"}]


@pytest.mark.parametrize(
    ("name", "nearest"),
    [
        ("convecton", "did you mean 'convection'"),
        ("convection@flang", "did you mean 'convection@flange'"),
        ("sensor", "did you mean 'sensors'"),
    ],
)
def test_wrong_names_are_refused_with_the_nearest(case, name, nearest):
    given = answered("explain", "diagnose", case, "--without", name)
    assert given.code == 2
    assert nearest in given.err


def test_laws_and_what_holds_for_a_while_have_names_too(case):
    given = load_case(case).case
    check_names(given, ["law", "loss.constant@yoke", "law@loss:copper|current_A>90"], "here")
    with pytest.raises(InputError, match="did you mean"):
        check_names(given, ["loss.constant@rotor"], "here")


def test_the_odds_of_a_case_are_read_with_their_reason(case, tmp_path):
    text = (case / "case.toml").read_text()
    (tmp_path / "case.toml").write_text(text + ODDS.format(0.1, "the flange is inside a box"))
    assert read_settings(tmp_path).odds == {"convection@flange": Odds(0.1, "the flange is inside a box")}


@pytest.mark.parametrize(
    ("factor", "reason", "says"),
    [(0.0, "no", "from 0.01 to 100"), (1e3, "yes", "from 0.01 to 100"), (0.1, " ", "reason is empty")],
)
def test_odds_without_bounds_or_reason_are_refused(case, tmp_path, factor, reason, says):
    (tmp_path / "case.toml").write_text((case / "case.toml").read_text() + ODDS.format(factor, reason))
    with pytest.raises(InputError, match=says):
        read_settings(tmp_path)
