"""What a free network knows and the declared one lacks, as effects with place and start."""

from dataclasses import make_dataclass, replace
from types import SimpleNamespace

import pytest
from two_bodies import bench

from geom.errors import NoSolution
from measured.case import AddedEffect
from thermoscope.case_folder.stored_comparison import yardstick_document
from validation.calibration.calibrate import no_progress
from validation.comparison.compare import errors
from validation.effects import effect
from validation.inference.result import Candidate
from validation.parameters.unknowns import scene_of
from validation.revision import improvement
from validation.revision.improvement import Refusal, Supervisor, _added, further_step, singletons
from validation.revision.revise import TOGETHER
from validation.yardstick.suggestions import suggested_effects
from validation.yardstick.terms import Term
from validation.yardstick.yardstick import yardstick

SILENT = SimpleNamespace(groups=(), odds=(), verdict="outside")  # a diagnosis that names nothing


Said = make_dataclass("Said", ["groups", "odds", "verdict", "named", "candidates", "words"])  # of a diagnosis


def link(place, other, on, value, share=0.2, unit="W/K"):
    return Term(place, "link", other, on, value, value, value, unit, share)


def without(case, *links):
    """The case whose network lacks some of its links."""
    network = case.model.network
    kept = tuple(x for x in network.links if set(x.places) not in [set(pair) for pair in links])
    assert len(kept) < len(network.links)
    return replace(case, model=replace(case.model, network=replace(network, links=kept, parameters=())))


@pytest.fixture(scope="module")
def case():
    return bench(held=())


def test_what_is_declared_is_not_suggested(case):
    assert [s for s in suggested_effects(yardstick(case).terms, case) if s.other] == []


def test_a_link_that_was_left_out_is_suggested_with_the_size_that_it_has(case):
    """The film of 2 W/K from the body to the air."""
    poorer = without(case, ("body", "ambient"))
    first = suggested_effects(yardstick(poorer).terms, poorer)[0]
    assert (first.place, first.other, first.inputs) == ("body", "ambient", ())
    assert first.most == pytest.approx(2.0, rel=0.05)
    low, high = first.interval
    assert low < first.most < high < 1.1 * low
    assert first.words == f"body to ambient: {first.rest:.3g} W/K [{low:.3g}, {high:.3g}]"
    assert "convection.constant@body" in first.starts


def test_a_start_makes_the_conductance_that_was_found(case):
    """Whatever the law counts in: a bare node in W/K, a face in W/m2/K."""
    poorer = without(case, ("body", "ambient"))
    (found,) = suggested_effects([link("body", "ambient", "", 2.0)], poorer)
    for name, start in found.starts.items():
        grown = effect(name).extend(poorer.model.network)
        new = [x for x in grown.links if x.name not in {y.name for y in poorer.model.network.links}]
        size = sum(abs(x.vals).max() * x.law.size(case.tests[0].inputs) for x in new)
        assert start * size == pytest.approx(2.0)


def test_both_ends_of_a_link_are_one_suggestion(case):
    poorer = without(case, ("core", "body"))
    found = suggested_effects([link("core", "body", "", 4.0, 0.3), link("body", "core", "", 3.8, 0.2)], poorer)
    assert [(s.place, s.other, s.most) for s in found] == [("core", "body", 4.0)]


def test_a_link_that_follows_an_input_is_told_at_rest_and_at_most(case):
    """ "power_W" stands for any input: what matters is that no declared law of the link reads it."""
    name = next(iter(case.tests[0].inputs))
    (found,) = suggested_effects([link("body", "ambient", "", 2.0), link("body", "ambient", f"{name}^2", 1.5)], case)
    assert (found.rest, found.most, found.inputs) == (2.0, 3.5, (name,))
    assert found.words == f"body to ambient: 2 W/K at rest, 3.5 at the largest {name}"


def test_ends_that_an_added_effect_joins_are_not_told_as_lacking(case):
    """Whatever else the free network has that film follow."""
    poorer, name = without(case, ("body", "ambient")), next(iter(case.tests[0].inputs))
    terms = (link("body", "ambient", "", 2.0), link("body", "ambient", f"{name}^2", 1.5))
    yard = replace(yardstick(poorer), terms=terms)
    mended = replace(poorer, model=replace(poorer.model, effects=(AddedEffect("convection.constant", "body"),)))
    lacking = [yardstick_document(yard, errors(c), c)["yardstick"]["lacking"] for c in (poorer, mended)]
    assert [len(rows) for rows in lacking] == [1, 0]


def test_no_effect_is_suggested_on_a_link_that_an_added_effect_brought(case):
    """`add` knows the places of the declared network only, and would refuse it."""
    turning = [replace(t, inputs={**t.inputs, "speed_rpm": 1000.0 * t.inputs["load"]}) for t in case.tests]
    poorer = without(replace(case, tests=tuple(turning)), ("core", "body"))
    mended = replace(poorer, model=replace(poorer.model, effects=(AddedEffect("coupling", "body|core"),)))
    terms = (link("body", "core", "", 2.0), link("body", "core", "speed_rpm", 1.5))
    (found,) = suggested_effects(terms, mended)
    assert found.effects
    assert [effect(name, scene_of(mended)).name for name in found.starts] == list(found.starts)


def test_per_capacity_there_is_no_start(case):
    (found,) = suggested_effects([link("core", "ambient", "", 1e-3, unit="1/s")], case)
    assert (found.starts, found.unit) == ({}, "1/s")


def test_improve_adds_what_a_free_network_has_where_the_diagnosis_names_nothing(case):
    """The film that was left out is accepted, with the words of the free network as its evidence."""
    poorer = without(case, ("body", "ambient"))
    refused = []
    step, evidence = further_step(poorer, Supervisor(singletons, suggest=True), SILENT, 9.0, refused, no_progress)
    assert step is not None, refused
    assert step.accepted
    assert evidence["free network"].startswith("body to ambient: ")
    assert further_step(poorer, Supervisor(singletons), SILENT, 9.0, refused, no_progress) == (None, {})


def test_nothing_is_suggested_where_the_model_predicts_as_well_as_a_free_network(case):
    refused = []
    assert further_step(case, Supervisor(singletons, suggest=True), SILENT, 0.01, refused, no_progress) == (None, {})
    assert not refused


@pytest.mark.parametrize("groups", [(), (("convection.constant@body", "convection.buoyant@body"),)])
def test_where_no_name_was_added_the_likeliest_sets_are_tried_and_the_criterion_decides(case, groups):
    """No name was given, or two that cannot be told apart and nobody to ask."""
    poorer = without(case, ("body", "ambient"))
    odds = [
        SimpleNamespace(causes=(n,), probability=p) for n, p in (("mass@core", 0.6), ("convection.constant@body", 0.3))
    ]
    sensor = SimpleNamespace(causes=("sensor.gain@T_body",), probability=0.05)  # asked for, whatever it predicts
    odds = (SimpleNamespace(causes=(), probability=0.1), sensor, *odds)
    said = SimpleNamespace(groups=groups, odds=odds, verdict="outside")
    refused = []
    step, evidence = further_step(poorer, Supervisor(singletons, suggest=True), said, 9.0, refused, no_progress)
    assert (step.effect, step.accepted, evidence["probability"]) == ("convection.constant@body", True, 0.3)
    assert [r.effects for r in refused] == [("mass@core",)]


@pytest.mark.parametrize(("suggest", "name"), [(True, "convection.constant@body"), (False, None)])
def test_a_lasting_fault_that_is_left_hides_nothing_after_it_where_nobody_is_asked(case, suggest, name):
    """A user who takes nothing of what he is asked has stopped; a rule has only passed over one of two."""
    poorer = without(case, ("body", "ambient"))
    names = ("sensor.gain@T_body", "convection.constant@body")
    rows = tuple(Candidate(n, 9.0, 3.0, 1.0, "1", (0.5, 1.5), "named", probability=0.99) for n in names)
    odds = (SimpleNamespace(causes=names, probability=0.99),)
    said = Said(((names[0],), (names[1],)), odds, "several", names, rows, "two are missing")
    step, _, why = _added(poorer, Supervisor(singletons, suggest=suggest), said, 0.0, [], no_progress)
    assert (step and step.effect, bool(why)) == (name, name is None)


@pytest.mark.parametrize(("suggest", "count"), [(True, 2), (False, 1)])
def test_a_set_that_is_sure_is_added_whole_where_nobody_is_asked(case, suggest, count):
    poorer = without(case, ("body", "ambient"), ("core", "body"))
    names = ("coupling@body|core", "convection.constant@body")
    rows = tuple(Candidate(n, 9.0, 3.0, 1.0, "1", (0.5, 1.5), "named", probability=0.99) for n in names)
    odds = (SimpleNamespace(causes=names, probability=0.99),)
    said = Said(((names[0],), (names[1],)), odds, "several", names, rows, "two are missing")
    ask = Supervisor(lambda _, choice: choice[0].effect, suggest=suggest)
    step, _, why = _added(poorer, ask, said, 0.0, [], no_progress)
    assert (len(step.effect.split(TOGETHER)), why) == (count, "")


def test_what_did_not_predict_is_not_tried_again(case):
    poorer = without(case, ("body", "ambient"))
    odds = (SimpleNamespace(causes=("mass@core",), probability=0.6),)
    said = SimpleNamespace(groups=(), odds=odds, verdict="outside")
    refused = [Refusal(("mass@core",), "more heat capacity", "it was worse")]
    further_step(poorer, Supervisor(singletons, suggest=True), said, 9.0, refused, no_progress)
    assert [r.effects for r in refused].count(("mass@core",)) == 1


def test_what_makes_the_model_run_away_is_refused_and_the_next_is_tried(case, monkeypatch):
    poorer, fitted = without(case, ("body", "ambient")), improvement.add

    def add(some, names, progress):
        if tuple(names) == ("mass@core",):
            raise NoSolution("more heat than its links carry away")
        return fitted(some, names, progress)

    monkeypatch.setattr(improvement, "add", add)
    each = (("mass@core", 0.6), ("convection.constant@body", 0.3))
    said = SimpleNamespace(
        groups=(), odds=tuple(SimpleNamespace(causes=(n,), probability=p) for n, p in each), verdict="outside"
    )
    refused = []
    step, _ = further_step(poorer, Supervisor(singletons, suggest=True), said, 9.0, refused, no_progress)
    assert step.effect == "convection.constant@body"
    assert [(r.effects, r.why) for r in refused] == [(("mass@core",), "the model runs away with it")]
