"""Asking the user: the yes-or-no question that would tell most and needs no test, and what an answer does to the odds.

An answer is wrong with the probability of the table's line "answer"; the information expected of it is the mutual
information between it and the hypotheses, H(answer) - H(wrong). Source: Lindley 1956.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from geom.arrays import Array
from measured.doubt import SHARPNESS, USUAL
from validation.effects.base import Effect, place_words
from validation.effects.during import During
from validation.effects.time_window import event, odd_tests
from validation.inference.decide import SURE, Posterior
from validation.inference.evidence import Evidence
from validation.inference.hypotheses import Weighed, inclusion, probabilities
from validation.inference.result import Question

WORTH = 0.1  # nats: an answer that tells less is not worth a question
LIKE = 0.3  # of the time in either: then a question speaks of a hypothesis's event
THINGS = {
    "loss.constant": "something that heats",
    "convection.constant": "a fan, a draught or an open lid",
    "blockage": "a cover, a shield or dirt",
    "flow": "a pump or fan at another speed, or a squeezed hose",
    "conduction.bench": "another mounting",
    "input.factor": "another range or shunt at the meter",
    "ambient.offset": "a thermometer somewhere else",
}


def with_answers(evidence: Evidence, hypotheses: Sequence[Weighed], answers: Mapping[str, bool]) -> list[Weighed]:
    """The hypotheses with what the user said as evidence.  answers : what was asked about -> yes or no"""
    wrong, out = USUAL["answer"], list(hypotheses)
    for about, yes in answers.items():
        of_it = {k for k, e in enumerate(evidence.effects) if concerns(e, about)}
        right = [bool(of_it & set(h.members)) == yes for h in out]
        odds = [float(np.log(1.0 - wrong if x else wrong)) / SHARPNESS for x in right]
        out = [replace(h, log_prior=h.log_prior + x) for h, x in zip(out, odds, strict=True)]
    return out


def concerns(effect: Effect, about: str) -> bool:
    """Would the answer be yes if this effect were there?"""
    if not isinstance(effect, During):
        return effect.name == about
    subject = event(about)
    if subject is None:
        return about in effect.tests or about == effect.condition
    if effect.event is None:
        return bool(set(effect.tests) & set(subject.tests))
    return effect.event.overlap(subject) > LIKE


def best_question(posterior: Posterior) -> Question | None:
    """The question expected to tell most; None where the odds are clear, or no answer would change them."""
    P, e = probabilities(posterior.hypotheses), posterior.evidence
    if P.max() >= SURE:
        return None
    subjects = dict.fromkeys(
        about
        for x in e.effects
        if isinstance(x, During) or x.fault
        for about in (odd_tests(x.condition) or (x.condition,) if isinstance(x, During) else (x.name,))
    )
    rows = [(about, yes_probability(posterior, P, about)) for about in subjects]
    about, yes = max(rows, key=lambda row: information(row[1]), default=("", 0.0))
    if information(yes) < WORTH:
        return None
    return Question(about, words(posterior, about), yes, information(yes))


def yes_probability(posterior: Posterior, P: Array, about: str) -> float:
    """Probability that the answer is yes."""
    yes = {k for k, e in enumerate(posterior.evidence.effects) if concerns(e, about)}
    return float(sum(p for p, h in zip(P, posterior.hypotheses, strict=True) if yes & set(h.members)))


def information(yes: float) -> float:
    """Nats expected of an answer that is wrong now and then."""
    wrong = USUAL["answer"]
    return entropy(yes * (1.0 - wrong) + (1.0 - yes) * wrong) - entropy(wrong)


def entropy(p: float) -> float:
    return float(-sum(x * np.log(x) for x in (p, 1.0 - p) if x > 0.0))


def words(posterior: Posterior, about: str) -> str:
    """The question, with the likeliest thing that a yes would mean."""
    e = posterior.evidence
    share = inclusion(posterior.hypotheses, len(e.effects)) * [concerns(x, about) for x in e.effects]
    best = e.effects[int(np.argmax(share))]
    if not isinstance(best, During):
        return f"can it be: {best.statement}?"
    return f"was there {THINGS.get(best.kind, best.title)} {place_words(best.base.place)} {best.when}?"
