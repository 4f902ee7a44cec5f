"""Does the answer hang on which instants were looked at? Every hypothesis is weighed again on every second instant.

A verdict that changes then is withheld: what was claimed becomes a group, and the sentence says what else came out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from lumped.model.multipliers import values_of
from validation.calibration.calibrate import CachedSegments, Fit, minimise
from validation.calibration.model_error import ModelError
from validation.comparison.linearisation import Segment
from validation.inference.decision import Decision
from validation.inference.evidence import Evidence
from validation.inference.posterior import Posterior
from validation.inference.refits import log_bayes


def steady(posterior: Posterior, decision: Callable[[Posterior], Decision]) -> Decision:
    """The decision on all instants, with no more claimed than either half of them would."""
    choice = decision(posterior)
    halves = [decision(at_every_second(posterior, first)) for first in (0, 1)]
    other = tuple(d for d in halves if differs(choice, d))
    if not other or not choice.groups:
        return replace(choice, others=other)
    groups = choice.groups
    for d in other:
        groups = united(groups, d.groups)
    return replace(
        choice, verdict="group" if choice.verdict == "named" else choice.verdict, groups=groups, others=other
    )


def differs(choice: Decision, other: Decision) -> bool:
    """Does another decision say something else: that nothing or another thing is missing, or the same less surely?"""
    if not choice.groups or len(choice.groups) != len(other.groups):
        return (choice.verdict, len(choice.groups)) != (other.verdict, len(other.groups))
    members = {k for g in choice.groups for k in g}
    names, again = ({g[0] for g in d.groups if len(g) == 1} for d in (choice, other))
    less_sure = not names <= again or choice.verdict == "named" != other.verdict
    return not {g[0] for g in other.groups} <= members or less_sure


def united(groups: tuple[tuple[int, ...], ...], more: tuple[tuple[int, ...], ...]) -> tuple[tuple[int, ...], ...]:
    """The groups, each with the members of that other one which shares an effect with it or stands in its place; what
    one group has joins no other."""
    out, members = [], {k for g in groups for k in g}
    for i, g in enumerate(groups):
        alike = [m for m in more if set(m) & set(g)] or list(more[i : i + 1])
        out.append((*g, *dict.fromkeys(k for m in alike for k in m if k not in members)))
        members |= set(out[-1])
    return tuple(out)


def at_every_second(posterior: Posterior, first: int) -> Posterior:
    """The posterior on instants `first`, `first` + 2, ...: refits are weighed where they stand, and all that was too
    improbable to be refitted gains or loses as the best of these does."""
    e, every = posterior.evidence, posterior.hypotheses
    fit = thinned(e, e.fit, None, first)
    new = replace(e, fit=fit)
    gained = {
        h.members: log_bayes(new, thinned(e, h.fit, fit.error, first), h.members) - log_bayes(e, h.fit, h.members)
        for h in every
        if h.fit and h.members
    }
    best = max((h for h in every if h.members in gained), key=lambda h: h.log_bayes, default=None)
    share = max(gained[best.members] / best.log_bayes, -1.0) if best and best.log_bayes > 0.0 else 0.0
    increments = [gained[h.members] if h.members in gained else share * max(h.log_bayes, 0.0) for h in every]
    now = tuple(replace(h, log_bayes=h.log_bayes + d, loud=h.loud + d) for h, d in zip(every, increments, strict=True))
    return replace(posterior, evidence=new, hypotheses=now)


def thinned(e: Evidence, fit: Fit, error: ModelError | None, first: int) -> Fit:
    """A fit where it stands, of every second instant.  error : of these instants, where it was made already"""
    if error is None and fit.error is not None:
        error = replace(fit.error, columns={key: columns[first::2] for key, columns in fit.error.columns.items()})
    parts = [every_second(s, first) for s in fit.parts]
    fixed = values_of(fit.network, fit.values)
    return minimise(
        fit.network,
        e.tests,
        fit.unknowns,
        fit.theta,
        e.fit.noise,
        fixed,
        0,
        CachedSegments(parts, nearby=False),
        error=error,
    )


def every_second(s: Segment, first: int) -> Segment:
    return replace(s, time=s.time[first::2], r=s.r[first::2], J=s.J[first::2])
