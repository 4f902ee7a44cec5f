"""The benchmark's own machinery: its cases repeat, its judge is fair, and the simplest cases come out right."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hidden import judge
from hidden.answer import answer
from hidden.cases import SHARES, Label, plan
from hidden.kinds import KINDS
from hidden.page import markdown
from hidden.peers import peers
from hidden.run import held_out
from hidden.score import met, rows
from hidden.sizes import sizes
from hidden.truth.archetype import measured, truly
from hidden.truth.change import NOTHING
from hidden.truth.draw import Draw
from hidden.truth.faults import bias, swapped
from hidden.user import case_of

from lumped.model.sites import solids
from validation import add, calibrate
from validation.effects import kinds
from validation.effects.streams.flow import flows

pytestmark = pytest.mark.nightly

SAID = {"verdict": "adequate", "groups": [], "where": [], "pulls": [], "words": "", "candidates": {}, "lead": ""}


def said(verdict, *groups, **more):
    return {**SAID, "verdict": verdict, "groups": [list(g) for g in groups], **more}


def label(group, *truth, **more):
    own = {"machine": "tefc", "group": group, "truth": list(truth), "size": 0.0, "place": "", "amplitude": []}
    own |= {"test": "", "span": [], "right": [[t] for t in truth], "twins": [[] for _ in truth]}
    return {**own, **more}


def test_wilson_interval_is_the_published_one():
    """Newcombe 1998, table I: 81 of 263 gives 0.2553 to 0.3662; 0 of 20 gives 0 to 0.1611."""
    assert judge.wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=1e-4)
    assert judge.wilson(0, 20) == pytest.approx((0.0, 0.1611), abs=1e-4)


def test_page_has_every_promise_and_every_method_once():
    quiet = {"case": "nothing missing", "measure": "false alarm", "ours": 0.0125, "n": 80, "ci95": [0.0, 0.067]}
    table = [{**quiet, "target": "<= 0.05"}, {**quiet, "peer": 0.5, "peer_name": "AIC refit"}]
    lines = markdown(table).splitlines()
    assert lines[2] == "| nothing missing: false alarm | 80 | 1 % | 0 to 7 % | <= 5 % |"
    assert lines[-4:] == [
        "| method | false alarm (80) |",
        "|---|---|",
        "| this diagnosis | 1 % |",
        "| AIC after refits | 50 % |",
    ]


def test_a_promise_is_met_or_short_or_none_was_made():
    cases = {("<= 0.05", 0.05): True, ("<= 0.05", 0.06): False, (">= 0.90", 0.9): True, (">= 0.90", 0.89): False}
    cases |= {("0.85 to 0.95", 0.88): True, ("0.85 to 0.95", 0.96): False, ("", 0.5): None}
    assert {case: met({"target": case[0], "ours": case[1]}) for case in cases} == cases


def test_plan_keeps_the_proportions_and_never_shares_seeds():
    dev, test = (plan(s, 102, list(SHARES), list(KINDS)) for s in ("dev", "test"))
    count = [sum(x.group == c for x in dev) for c in SHARES]
    np.testing.assert_allclose(count, 102 * np.array(list(SHARES.values())) / sum(SHARES.values()), atol=1.0)
    assert not {x.seed for x in dev} & {x.seed for x in test}
    assert dev == plan("dev", 102, list(SHARES), list(KINDS))
    assert dev[:60] == plan("dev", 60, list(SHARES), list(KINDS))


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_hidden_effects_have_a_name_in_the_catalogue_and_a_size(kind):
    known, network = kinds(), case_of("", kind.name, ()).model.network
    named = [i.name for i in (*network.links, *network.sources)]
    inputs = {name for law in (x.law for x in (*network.links, *network.sources)) for name in law.reads}
    sites = {*network.states, *named, *(name.split(":", 1)[1] for name in named)}
    for hidden in (*kind.missing, *kind.passing):
        told = [name.split("@") for name in kind.right(hidden.name)]
        assert any(effect in known for effect, _ in told), hidden.name
        own = {"input.factor": inputs, "flow": {p.name for p in flows(network)}}
        assert all(set(place.split("|")) <= own.get(effect, sites) for effect, place in told), hidden.name
    assert {h.name for h in kind.missing} <= set(sizes()[kind.name])
    for name in kind.foreign:
        assert name.split(" at ")[1] in {p.name for p in solids(network)}


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_parameters_that_can_be_far_off_are_the_users(kind):
    own = {p.name for p in case_of("", kind.name, ()).model.network.parameters}
    assert set(kind.absorbed) <= own


@pytest.mark.parametrize("kind", KINDS.values(), ids=lambda k: k.name)
def test_every_hidden_effect_moves_heat_where_its_name_says(kind):
    """At one unit of size, on a machine at work: heat changes, in no more than two bodies."""
    table, draw = sizes()[kind.name], Draw(1)
    base = kind.build(draw, NOTHING)
    T = 60.0 + 10.0 * np.random.default_rng(0).standard_normal(base.skeleton.C.size)
    _, _, driving = truly(kind, kind.plans[3], 1, NOTHING)
    u = {**{k: float(np.median(v)) for k, v in driving.items()}, **{f"T_{b}": 25.0 for b in kind.baths}}
    for hidden in kind.missing:
        change = hidden.make(table[hidden.name]["size"])
        signals = {k: float(signal(np.array([1800.0]))[0]) for k, signal in change.signals.items()}
        moved = kind.build(draw, change).heat(T, {**u, **signals}) - base.heat(T, u)
        assert np.abs(moved).sum() > 0.02, hidden.name
        assert np.count_nonzero(np.abs(moved) > 1e-9) <= 22, hidden.name


def test_faults_happen_to_readings_only():
    kind, small = KINDS["tefc"], (replace(KINDS["tefc"].plans[0], minutes=15.0),)
    (good,), (bad,), (cross,) = (
        measured(kind, 2, c, small) for c in (NOTHING, bias("core", 4.0), swapped("core", "housing"))
    )
    read = np.isfinite(good.readings["core"])
    np.testing.assert_allclose((bad.readings["core"] - good.readings["core"])[read], 4.0, atol=0.11)
    np.testing.assert_array_equal(bad.readings["housing"], good.readings["housing"])
    np.testing.assert_array_equal(cross.readings["core"], good.readings["housing"])


def test_judge_on_nothing_missing():
    for verdict, alarm in (("adequate", False), ("absorbed", False), ("named", True), ("outside", True)):
        assert judge.false_alarm(label("nothing"), said(verdict, ["a@b"])) is alarm
    assert judge.false_alarm(label("one", "a@b"), said("named", ["a@b"])) is None


def test_judge_on_one_effect():
    one = label("one", "a@b", size=2.0, amplitude=[1.0])
    assert judge.right_name(one, said("named", ["a@b"]), 2.0, True)
    assert not judge.right_name(one, said("group", ["a@b", "c@d"]), 2.0, True)
    assert judge.right_name(one, said("named", ["a@b"]), 4.0, True) is None
    assert judge.right_name({**one, "twins": [["c@d"]]}, said("named", ["a@b"]), 2.0, True) is None
    assert judge.truth_inside(one, said("group", ["c@d", "a@b"]), 2.0)
    assert judge.confidently_wrong(one, said("named", ["c@d"]))
    assert not judge.confidently_wrong(one, said("group", ["c@d", "e@f"]))
    assert judge.confidently_wrong(one, said("data", ["sensor.gain@b"]))
    assert not judge.confidently_wrong(label("fault", "sensor.bias@b"), said("data", ["sensor.gain@b"]))


def test_judge_on_first_guesses():
    """A method that only knows places is right when the effect sits there, at either end of a link."""
    one = label("one", "gap.convection@core|rotor", size=2.0)
    assert judge.leads(one, "gap.convection@core|rotor", 2.0)
    assert judge.leads(one, "core", 2.0)
    assert not judge.leads(one, "windage@rotor", 2.0)
    assert judge.leads(one, "core", 4.0) is None


def test_judge_on_intervals():
    """90 % of a normal is 1.645 / 1.96 of the half width of 95 %."""
    one = label("one", "a@b", size=4.0, amplitude=[1.0])
    found = said("named", ["a@b"], candidates={"a@b": {"value": 1.9, "ci95": [0.9, 2.9], "decision": "named"}})
    assert judge.covered(one, found) is False
    assert judge.covered({**one, "amplitude": [1.1], "area": 0.1}, found) is False
    assert judge.covered({**one, "amplitude": [0.11], "area": 0.1}, found) is True
    assert judge.covered({**one, "amplitude": []}, found) is None
    assert judge.covered({**one, "amplitude": [1.1]}, found) is True


def test_judge_on_the_other_classes():
    assert judge.pair_as_group(label("pair", "a@b", twins=[["c@d"]]), said("group", ["c@d", "a@b", "e@f"]))
    assert not judge.pair_as_group(label("pair", "a@b", twins=[["c@d"]]), said("named", ["a@b"]))
    assert judge.both_found(label("two", "a@b", "c@d"), said("several", ["c@d", "x@y"], ["a@b"]))
    assert not judge.both_found(label("two", "a@b", "c@d"), said("several", ["c@d"], ["x@y"]))
    assert judge.fault_found(label("fault", "sensor.bias@core"), said("data", ["sensor.bias@core"]))
    assert not judge.fault_found(label("fault", "sensor.bias@core"), said("named", ["sensor.bias@core"]))
    assert judge.fault_found(label("fault", "sensor.swap@core|rotor"), said("data", ["sensor.swap@rotor|core"]))
    hot = label("foreign", "cable at rotor", place="rotor")
    assert judge.foreign_found(hot, said("outside", where=[["core", 30.0]]), {"rotor": {"core"}})
    assert not judge.foreign_found(hot, said("outside", where=[["housing", 30.0]]), {"rotor": {"core"}})


def test_judge_on_what_an_addition_is_worth():
    """1 K as it is, 0.4 K with the truth: a claim that leaves 0.7 K reached half of the fall."""
    worth = {"before": 1.0, "best": 0.4, "claimed": 0.7}
    assert judge.share_of_fall({"worth": worth}) == pytest.approx(0.5)
    assert judge.share_of_fall({"worth": {**worth, "best": 0.96}}) is None
    assert judge.share_of_fall({}) is None


def test_judge_on_the_proposed_test():
    pair = label("pair", "a@b", twins=[["c@d"]])
    assert judge.resolved(pair, {"followed": {"verdict": "named", "groups": [["a@b"]]}})
    assert judge.resolved(pair, {"followed": {"verdict": "named", "groups": [["c@d"]]}}) is False
    assert judge.resolved(pair, {"followed": None}) is None


def test_table_leaves_out_what_no_case_tests():
    pairs = [(label("nothing"), {**SAID, "cpu_s": 1.0}), (label("nothing"), {**said("named", ["a@b"]), "cpu_s": 2.0})]
    table = {r["measure"]: r for r in rows(pairs)}
    assert table["false alarm"]["ours"] == 0.5
    assert table["false alarm"]["n"] == 2
    assert "both found, none false" not in table


def test_labels_hold_everything_that_is_needed_to_make_the_case_again():
    for one in plan("dev", 30, list(SHARES), list(KINDS)):
        read = json.loads(json.dumps(one.document()))
        assert Label(**{k: _tuples(v) for k, v in read.items()}) == one


def _tuples(value):
    return tuple(_tuples(v) for v in value) if isinstance(value, list) else value


def test_a_strong_road_wind_is_seen_by_us_and_by_a_plain_fit():
    """Far beyond anything the thresholds could argue about."""
    kind = KINDS["tefc"]
    hidden = next(h for h in kind.missing if h.name == "convection@flange.de")
    case = case_of("wind", "tefc", measured(kind, 3, hidden.make(6.0)))
    found = answer(case, plan=False)
    assert peers(case, with_refits=False)["forward BIC"] == ["convection@flange.de", True]
    assert found["verdict"] != "adequate"
    assert "convection@flange.de" in found["groups"][0]


def test_the_true_effect_in_the_users_network_restores_the_fit():
    """Hidden by a law other than the catalogue's, in a machine finer than the network: still at least half of the
    squared error on the held-out test goes with the effect's name."""
    name, word, amplitude = "servo", "ac copper@copper", 300.0
    kind = KINDS[name]
    hidden = next(h for h in kind.missing if h.name == word)
    case = case_of(word, name, measured(kind, 21, hidden.make(amplitude)))
    base = calibrate(case, roles=("calibrate", "validate"))
    restored = add(replace(case, model=base.model), kind.right(word)[0])
    assert held_out(restored) ** 2 < 0.5 * held_out(base) ** 2
