"""What a fit leans on and should not: told with the answer, bounded by what is possible, narrowed by the user."""

from dataclasses import replace

import pytest
from one_body import FILM, measured, one_node
from playground import Truth

from measured.case import AddedEffect, Case, Model
from measured.doubt import USUAL, split_answers
from validation.effects import effect
from validation.parameters.unknowns import large_nuisances, strain_words, working


def case(**values):
    return Case("one", Model(one_node(FILM), values=values), (measured("warm"),))


def test_what_is_beyond_two_deviations_is_said_worst_first():
    off = case(**{"film": 5.0, "slope of body": -0.15, "bias of ambient": 1.1, "bias of body": 0.5})
    assert [(row[0], pytest.approx(row[3])) for row in large_nuisances(off)] == [
        ("slope of body", -5.0),
        ("bias of ambient", 2.2),
    ]
    assert strain_words(off) == (
        "The fit moved the slope of body by -0.15 (5.0 times the usual deviation), the bias of ambient by +1.1 K (2.2)."
    )
    assert strain_words(case(**{"film": 5.0, "slope of body": 0.05})) == ""
    assert strain_words(case()) == ""


def test_what_the_user_knows_narrows_a_boundary_and_a_sensor():
    doubt, answers = split_answers(USUAL, {"boundary:ambient": 0.1, "bias:body": 0.05, "warm": True})
    assert answers == {"warm": True}
    known = {p.name: p for p in working(replace(case(), doubt=doubt))[1].parameters}
    usual = {p.name: p for p in working(case())[1].parameters}
    assert (known["bias of ambient"].prior_sd, known["bias of body"].prior_sd) == (0.1, 0.05)
    assert usual["bias of ambient"].prior_sd == USUAL["boundary"]
    assert known["slope of body"] == usual["slope of body"]


@pytest.mark.parametrize(("sd", "most"), [(None, 10.0), (0.1, 2.0)])
def test_a_room_is_off_by_no_more_than_its_doubt_allows(sd, most):
    """Twenty deviations: 10 K of a thermometer that is usual, 2 K of one that was checked to 0.1 K."""
    name, whole = "ambient.offset@ambient", Truth(3).case()
    doubt = split_answers(USUAL, {} if sd is None else {"boundary:ambient": sd})[0]
    model = replace(whole.model, effects=(AddedEffect(*name.split("@")),))
    for of in (
        working(replace(whole, doubt=doubt), [effect(name)])[0],
        working(replace(whole, model=model, doubt=doubt))[0],
    ):
        (p,) = [p for p in of.parameters if p.name == name]
        assert (p.low, p.high) == pytest.approx((-most, most))
