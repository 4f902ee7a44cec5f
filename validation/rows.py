"""The tables of a diagnosis, from the evidence and the races of its search."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from validation.bar import Bar
from validation.calibrate import Fit
from validation.case import Case
from validation.evidence import Evidence
from validation.experiments import next_tests
from validation.findings import Candidate, Decision, Hidden, NextSensor, NextTest, Verdict
from validation.rivals import Race, constancy
from validation.sensors import next_sensors
from validation.sheet import rmse, segments

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Step:
    """One round of the search: the evidence, each candidate's kappa, and the race if one passed the threshold.

    settled : the model with a candidate in it, for each that is named
    """

    evidence: Evidence
    kappa: Array
    race: Race | None
    settled: Mapping[int, Fit] = field(default_factory=dict)


def tabulate(case: Case, steps: list[Step], bar: Bar, verdict: Verdict, rows: int = 20) -> tuple[Candidate, ...]:
    """Candidates that were in a race first, then the others by score."""
    out: dict[str, Candidate] = {}
    for step in steps:
        if step.race:
            for k in step.race.index:
                out.setdefault(step.evidence.names[k], raced(case, step, k, bar, verdict))
    first = steps[0]
    for k in np.argsort(-first.evidence.score.z / first.kappa)[:rows]:
        out.setdefault(first.evidence.names[k], plain(first, int(k), bar))
    order = {"named": 0, "group": 1, "cannot-tell": 2, "no": 3}
    return tuple(sorted(out.values(), key=lambda c: (order[c.decision], -c.score)))


def plain(step: Step, k: int, bar: Bar) -> Candidate:
    """A row from the score alone."""
    e, s, kappa = step.evidence, step.evidence.score, float(step.kappa[k])
    a, half, twin = float(s.amplitude[k]), 1.96 * kappa * float(s.sd[k]), e.twins[k]
    like = s.cosine[k]
    near = [e.names[m] for m in np.argsort(-np.abs(like)) if m != k and abs(like[m]) > 0.9][:5]
    hidden = not s.visible[k] or s.absorbed[k] > 0.995
    return Candidate(
        e.names[k], float(s.z[k]) / kappa, bar.threshold, a, e.parameters[k].unit, (a - half, a + half),
        "cannot-tell" if hidden else "no", confused_with=tuple(near), absorbed=float(s.absorbed[k]),
        smallest_detectable=bar.sizes[e.names[k]], twin=twin, title=e.effects[k].title,
        isolating_test=e.effects[k].isolating_test, kappa=kappa,
    )  # fmt: skip


def raced(case: Case, step: Step, k: int, bar: Bar, verdict: Verdict) -> Candidate:
    """A row with the refit's numbers."""
    assert step.race is not None
    e, found, row = step.evidence, step.race, plain(step, k, bar)
    fit, kappa = step.settled.get(k, found.fit(k)), float(step.kappa[k])
    a, half = fit.values[e.names[k]], 1.96 * kappa * float(fit.sd[fit.unknowns.names.index(e.names[k])])
    before, after = rmse(e.fit.parts), rmse(fit.parts)
    group = tuple(e.names[m] for m in found.group if m != k)
    member = k in found.group
    decision: Decision = "no" if not member else "group" if group else "named"
    if decision == "named" and verdict in ("outside", "absorbed"):
        decision = "cannot-tell"
    return replace(
        row, value=a, ci95=(a - half, a + half), decision=decision, rmse_K=(before, after),
        explained=1.0 - (after / before) ** 2, holdout_rmse_K=held_out(case, e.fit, fit),
        confused_with=group if member else row.confused_with,
        same_over_tests=constancy(e, k, kappa),
    )  # fmt: skip


def held_out(case: Case, before: Fit, after: Fit) -> tuple[float, float] | None:
    """Error (K) on the held-out tests, with nothing fitted to them."""
    tests = [t for t in case.tests if t.role == "hold-out"]
    if not tests:
        return None
    return (rmse(segments(before.network, tests, before.values)), rmse(segments(after.network, tests, after.values)))


def unseen(step: Step, bar: Bar) -> tuple[Hidden, ...]:
    """Effects that would have to be unusually large to show, most hidden first."""
    e, s = step.evidence, step.evidence.score
    size = np.array([bar.sizes[n] for n in e.names])
    unusual = size / np.array([p.prior_sd for p in e.parameters])
    names, twins = e.fit.unknowns.names, e.twins
    hit = [int(k) for k in np.argsort(-unusual) if unusual[k] > 2.0 or twins[k]]
    return tuple(
        Hidden(e.names[k], float(size[k]), e.parameters[k].unit, twins[k] or names[s.absorber[k]]) for k in hit
    )


def planned(steps: list[Step]) -> tuple[NextTest, ...]:
    """Tests that would separate the first group that could not be separated."""
    return next((tuple(next_tests(step.evidence, found, step.kappa)) for step, found in unresolved(steps)), ())


def sensed(steps: list[Step]) -> tuple[NextSensor, ...]:
    """Sensors that would separate the same group."""
    return next((tuple(next_sensors(step.evidence, found, step.kappa)) for step, found in unresolved(steps)), ())


def unresolved(steps: list[Step]) -> Iterator[tuple[Step, Race]]:
    """Races that ended in a group."""
    return ((step, step.race) for step in steps if step.race and len(step.race.group) > 1)


def confusion(step: Step, names: Sequence[str]) -> dict[str, dict[str, float]]:
    """Cosines between the traces of some candidates."""
    known = {n: k for k, n in enumerate(step.evidence.names)}
    c = step.evidence.score.cosine
    chosen = [n for n in names if n in known]
    return {a: {b: float(c[known[a], known[b]]) for b in chosen} for a in chosen}
