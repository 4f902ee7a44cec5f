"""From the rounds of a search to one of seven verdicts, and its sentence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from validation.bar import Bar
from validation.calibrate import Fit
from validation.case import Case
from validation.evidence import cared_for
from validation.findings import Candidate, Verdict
from validation.gates import doubts, gates
from validation.null import Null
from validation.rivals import weak
from validation.rows import Step
from validation.sheet import rmse
from validation.where import Latent, located

STEPS = 3
BEYOND = 1.6
CLEARLY = 3.0  # in nats; dev. seeds: up to 1.9 of the null's where no heat is missing, from 4.7 on where water splashes
PULL = 3.0
# Beside what is found, the misfit of its form stays, which the null does not know. Heat has to move a reading as well
# there: a fouled housing leaves its rotor asking for up to 3.6 times the null's nats, for 0.2 to 0.3 K (dev. seeds).
FURTHER = 1.25
HIDES = "it may hide a missing effect"
NOTHING = "nothing in the catalogue explains all of it"


def judge(
    steps: list[Step], bar: Bar, heat: Sequence[Latent], doubtful: bool, pulled_: bool, broken: bool
) -> Verdict:  # fmt: skip
    """The verdict, method of docs/diagnosis.

    heat : missing where all that was found is in the model, most evident first
    """
    last, rounds = steps[-1], [s for s in steps if s.race]
    if broken:
        return "data"
    left = (last.evidence.score.z / last.kappa)[last.evidence.matters]
    if beyond(last.evidence.fit, bar.null) or (len(rounds) == STEPS and np.max(left, initial=0.0) > bar.threshold):
        return "outside"
    if not rounds:
        return "absorbed" if pulled_ else "outside" if unexplained(heat, bar.null) else "adequate"
    more = unexplained(heat, bar.null, FURTHER) and heat[0].moves_K >= cared_for(last.evidence.fit.parts)
    if len(rounds) > 1:
        return "outside" if more else "several"
    evidence, found = rounds[0].evidence, rounds[0].race
    assert found is not None
    if all(evidence.effects[k].fault for k in found.group):
        return "data"
    if weak(evidence, found):
        return "absorbed"
    if doubtful or more:
        return "outside"
    return "group" if len(found.group) > 1 else "named"


def refused(steps: list[Step]) -> str:
    """Checks for which `add` would refuse each of the group that was found, in words, or nothing.

    Of several effects, found one after the other, they are not asked: before the others are in the model an effect is
    judged by their residual, and with all in it three tests are too few to predict one from the others.
    """
    rounds = [(s, s.race) for s in steps if s.race]
    if len(rounds) != 1:
        return ""
    ((step, found),) = rounds
    names, group = step.evidence.names, found.group
    if any(step.evidence.effects[k].fault for k in group):
        return ""
    told = [doubts(gates(found.fit(k), names[k], float(step.kappa[k]))) for k in group]
    return f"{names[group[0]]} comes nearest, but {told[0]}" if all(told) else ""


def strained(case: Case, steps: list[Step], null: Null) -> str:
    """The declared parameter that calibration pulls FURTHER than chance allows with all that was found in the model."""
    declared = {p.name for p in case.nuisances or case.model.network.parameters}
    left = [p for p in pulled(steps[-1].evidence.fit, steps[0].evidence.fit, null, FURTHER) if p[0] in declared]
    return f"calibration of {left[0][0]} is still {abs(left[0][2]):.1f} deviations from its prior" if left else ""


def beyond(fit: Fit, null: Null) -> bool:
    """Is more left than simulated machines of this kind leave, and more than a model may be wrong by?"""
    channels = list(dict.fromkeys(s.channel for s in fit.parts))
    own = [[s for s in fit.parts if s.channel == c] for c in channels]
    left = np.array([rmse(parts) for parts in own])
    allowed = np.array([np.sqrt(np.mean([s.model_K**2 for s in parts])) for parts in own])
    usual = np.maximum(np.maximum(null.floor, np.median(null.floor)), allowed)
    return bool(np.any(left > BEYOND * usual))


def unexplained(heat: Sequence[Latent], null: Null, times: float = 1.0) -> bool:
    """Does a place ask for heat far more clearly than any does in simulated machines that lack none?"""
    return bool(heat) and located(heat[0].evidence_nats / times, CLEARLY * null.heat_nats)


def pulled(fit: Fit, first: Fit, null: Null, times: float = 1.0) -> tuple[tuple[str, float, float], ...]:
    """Calibrated parameters further from their prior than so many times what chance allows: name, value, deviations.

    first : the fit that the null was simulated for, whose parameters are in both
    """
    pull = dict(zip(fit.unknowns.names, fit.theta / fit.unknowns.sd, strict=True))
    pull = {n: pull[n] / usual for n, usual in zip(first.unknowns.names, null.pull_scale, strict=True)}
    limit = times * max(PULL, pull_threshold(null))
    hit = [n for n in sorted(pull, key=lambda n: -abs(pull[n])) if abs(pull[n]) > limit]
    return tuple((n, fit.values[n], float(pull[n])) for n in hit)


def pull_threshold(null: Null) -> float:
    best = np.max(np.abs(null.pulls / null.pull_scale), axis=1)
    return float(np.mean(best) + 2.6 * np.std(best))


def words(
    verdict: Verdict, groups: list[tuple[str, ...]], table: Sequence[Candidate], pulls: tuple, broken: Sequence[str],
    heat: list[Latent], usual_nats: float, doubt: str = "", strain: str = "",
) -> str:  # fmt: skip
    """The verdict in a sentence.

    heat : as in `judge`;  usual_nats : as in Diagnosis;  doubt, strain : see `refused` and `strained`
    """
    if verdict == "adequate":
        return "no evidence of a missing effect"
    if verdict == "absorbed":
        if pulls:
            return f"calibration of {pulls[0][0]} is {abs(pulls[0][2]):.1f} deviations from its prior: {HIDES}"
        return f"{table[0].effect} would do what calibration of {table[0].twin or 'the rest'} has done: {HIDES}"
    if broken:
        return f"check the measurement first: {'; '.join(broken)}"
    if verdict == "outside":
        place = f" at {heat[0].place}" if heat and located(heat[0].evidence_nats, usual_nats) else ""
        beside = f" beside what {' and '.join(g[0] for g in groups)} would explain" if groups and not doubt else ""
        return "; ".join(filter(None, [f"heat is missing or in excess{place}{beside}", NOTHING, doubt]))
    if verdict == "data":
        return f"check the measurement first: {' or '.join(groups[0])}"
    return "; ".join(filter(None, [_found(verdict, groups, table[0]), strain]))


def _found(verdict: Verdict, groups: list[tuple[str, ...]], best: Candidate) -> str:
    if verdict == "named":
        return f"missing: {best.title} at {best.effect.split('@')[1]}, {best.value:.3g} {best.unit}"
    if verdict == "group":
        return f"one of {', '.join(groups[0])}; these tests and sensors cannot tell them apart"
    return "missing: " + "; ".join(" or ".join(g) for g in groups)
