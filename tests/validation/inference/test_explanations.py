"""What is shown of the odds: every hypothesis once, by the cause that leads it, in plain words."""

from test_steadiness import posterior

from validation.inference.hypotheses import inclusion
from validation.inference.say import explanations


def test_the_leading_cause_has_the_probability_of_its_row_among_the_candidates():
    p = posterior()
    first = explanations(p)[0]
    assert first.cause == "convection@flange.right"
    assert first.words == "forced convection by vehicle wind at flange.right"
    assert first.probability == inclusion(p.hypotheses, len(p.evidence.effects)).max()
    assert first.alone <= first.probability


def test_every_hypothesis_is_told_once():
    rows = explanations(posterior())
    assert abs(sum(row.probability for row in rows) - 1.0) < 1e-12
    assert len({row.cause for row in rows}) == len(rows)
