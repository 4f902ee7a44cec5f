"""From probabilities to one of seven verdicts by three costs: of a wrong name, of a miss, of an abstention.

What the numbers' own error could pass for is not named; nor is what hangs on which instants were looked at: every
hypothesis is weighed again on every second instant, and a verdict that changes then is withheld.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from scipy.special import logsumexp

from geom.arrays import Array
from measured.doubt import COSTS
from validation.calibration.calibrate import CachedSegments, Fit
from validation.calibration.model_error import ModelError
from validation.effects.base import Effect
from validation.effects.during import During
from validation.effects.time_window import Event
from validation.inference.contradiction import Contradiction
from validation.inference.evidence import Evidence, continued, log_bayes
from validation.inference.hypotheses import (
    SHARPNESS,
    Weighed,
    best_first,
    inclusion,
    probabilities,
    singles_by_member,
    weights,
)
from validation.inference.missing_heat import MissingHeat
from validation.inference.result import Check, Verdict

Group = tuple[int, ...]
NO_TESTS: Mapping[str, Event] = MappingProxyType({})
SURE = 1.0 - COSTS["abstain"].share / COSTS["wrong"].share  # probability from which a name costs less than a group
EXPLAINS = 0.9  # of the evidence of heat of unknown cause: a law that is off by a third leaves it a tenth
SAME = 0.5  # of the time in either of two events is in both: such are one
SILENT = COSTS["miss"].share / (COSTS["wrong"].share + COSTS["miss"].share)  # P(nothing) from which silence costs less


@dataclass(frozen=True)
class Posterior:
    """What follows from the readings.

    heat : of unknown cause at each place, most evident first
    against : what would have to differ between the tests
    """

    evidence: Evidence
    hypotheses: tuple[Weighed, ...]
    heat: tuple[MissingHeat, ...]
    against: Contradiction | None = None

    @property
    def single(self) -> dict[int, Weighed]:
        """Index of each cause -> the hypothesis that it alone is missing."""
        return dict(singles_by_member(self.hypotheses))

    @property
    def best(self) -> Weighed:
        return best_first(self.hypotheses)[0]


@dataclass(frozen=True)
class Decision:
    """groups : per thing that is missing the causes that may be it, most probable first;  sure : P(something)

    lead : P(a cause of the first group)
    others : what halves of the instants would decide, where that is something else
    checks : what it was held against;  withheld : what is not told, since a half says that nothing is missing
    """

    verdict: Verdict
    groups: tuple[Group, ...]
    sure: float
    others: "tuple[Decision, ...]" = ()
    checks: tuple[Check, ...] = ()
    withheld: "Decision | None" = None
    lead: float = 1.0


def decide(evidence: Evidence, hypotheses: Sequence[Weighed]) -> Decision:
    """The statement of least expected cost."""
    rows = [(h, float(p)) for h, p in zip(hypotheses, probabilities(hypotheses), strict=True)]
    something = 1.0 - sum(p for h, p in rows if h.nothing)
    if 1.0 - something > SILENT:
        return Decision("adequate", (), something)
    if sum(p for h, p in rows if h.heat) > 0.5 * something and not catalogue_explains(hypotheses):
        return Decision("outside", (), something)
    every = [(frozenset(h.members), p) for h, p in rows]
    groups = [smallest_cover(every)]
    while more := further_group(every, groups):
        groups.append(more)
    share, single = inclusion(hypotheses, len(evidence.effects)), singles_by_member(hypotheses)
    groups.sort(key=lambda g: precedence(share[g[0]], single[g[0]].nats if g[0] in single else -np.inf))
    lead = sum(p for members, p in every if members.intersection(groups[0]))
    if len(groups) > 1:
        verdict: Verdict = "several"
    elif all(evidence.effects[k].fault for k in groups[0]):
        verdict = "data"
    else:
        verdict = "named" if len(groups[0]) == 1 and lead >= SURE else "group"
    return Decision(verdict, tuple(groups), something, lead=lead)


def catalogue_explains(hypotheses: Sequence[Weighed]) -> bool:
    """Does something with a name explain nearly all that heat of unknown cause does?"""
    none = next(h.nats for h in hypotheses if h.nothing)
    effects, heat = (max(h.nats for h in hypotheses if bool(h.heat) is of_heat) for of_heat in (False, True))
    return effects - none > EXPLAINS * (heat - none)


def precedence(probability: float, nats: float) -> tuple[float, float]:
    """Sorts causes: the most probable first, of equally probable ones the one that explains more by itself.

    nats : log evidence of the cause alone
    """
    return -round(float(probability), 3), -nats


def smallest_cover(rows: Sequence[tuple[frozenset[int], float]], without: frozenset[int] = frozenset()) -> Group:
    """The fewest causes of which one is present with the probability SURE, given that any is; most probable first.

    Parameters: `rows` members and probability of each hypothesis; `without` causes that do not count.
    """
    rows = [(m - without, p) for m, p in rows if m - without]
    goal, out = SURE * sum(p for _, p in rows), []
    while rows and goal > 0.0:
        weight: dict[int, float] = {}
        for members, p in rows:
            for k in members:
                weight[k] = weight.get(k, 0.0) + p
        best = min(weight, key=lambda k: (-weight[k], k))
        out.append(best)
        goal -= weight[best]
        rows = [(m, p) for m, p in rows if best not in m]
        if goal <= 1e-12:
            break
    return tuple(out)


def further_group(rows: Sequence[tuple[frozenset[int], float]], groups: Sequence[Group]) -> Group:
    """What is missing beside the leads of the groups so far, if to keep silent about it costs more than to say it."""
    lead, last = frozenset(g[0] for g in groups), groups[-1]
    others = lead - set(last)
    compatible = [(m, p) for m, p in rows if others <= m and m & set(last)]
    both = [(m, p) for m, p in compatible if len(m) > len(groups)]
    if sum(p for _, p in both) < (1.0 - SILENT) * sum(p for _, p in compatible):
        return ()
    return smallest_cover([(m, p) for m, p in both if lead <= m], lead)


def clear_decision(posterior: Posterior, choice: Decision, budget: Mapping[str, float]) -> Decision:
    """The decision without what the error of the model's own numbers could pass for.

    budget : channel -> error (K) of the numbers there; what moves no reading by more is not named
    """
    e, single = posterior.evidence, posterior.single
    clear = tuple(g for g in choice.groups if signal_to_error(peak_changes(e, single[g[0]]), budget).above_budget)
    if len(clear) == len(choice.groups):
        return choice
    return Decision(choice.verdict if clear else "adequate", clear, choice.sure)


def peak_changes(evidence: Evidence, h: Weighed) -> dict[str, float]:
    """Channel -> largest change (K) that one cause makes there at its size, all else held."""
    k, out = h.members[0], dict[str, float]()
    fitted = evidence.score.amplitude[k] if h.fit is None else h.fit.theta[-1]
    size = 1.0 if evidence.effects[k].whole else float(fitted)
    for s, J in zip(evidence.run.parts, evidence.causes[k].columns(evidence.run), strict=True):
        out[s.channel] = max(out.get(s.channel, 0.0), float(np.max(np.abs(size * J))))
    return out


@dataclass(frozen=True)
class SignalToError:
    """What an effect changes at the sensors, beside what the numbers themselves may be wrong by.

    sensor : where it stands out most;  change_K, budget_K : largest change and error budget there
    """

    sensor: str
    change_K: float
    budget_K: float

    @property
    def above_budget(self) -> bool:
        """Whether at least one sensor sees more of the effect than of the error."""
        return self.change_K > self.budget_K


def signal_to_error(change: Mapping[str, Array | float], budget: Mapping[str, float]) -> SignalToError:
    """Where an effect stands out most from the error budget.

    change : sensor -> predicted change of its reading (K), a number or over time, NaN where nothing is read
    budget : sensor -> K, as `ErrorBudget.total_K`; a sensor that is not in it has none
    """
    sizes = {sensor: float(np.nanmax(np.abs(values), initial=0.0)) for sensor, values in change.items()}

    def share(sensor: str) -> float:
        error, size = budget.get(sensor, 0.0), sizes[sensor]
        return size / error if error > 0.0 else float("inf") if size > 0.0 else 0.0

    best = max(sizes, key=share, default="")
    return SignalToError(best, sizes.get(best, 0.0), budget.get(best, 0.0))


def steady_decision(posterior: Posterior, decision: Callable[[Posterior], Decision]) -> Decision:
    """The decision on all instants, with no more claimed than either half of them would, and nothing where half of
    them, on average of both, say that nothing is missing."""
    choice = decision(posterior)
    halves = [half_decision(posterior, decision, first, choice.verdict != "adequate") for first in (0, 1)]
    other = tuple(d for d in halves if differs(choice, d))
    silent = tuple(d for d in other if d.verdict == "adequate")
    if silent and np.mean([1.0 - d.sure for d in halves]) > SILENT:
        return Decision("adequate", (), choice.sure, silent, withheld=choice)
    if not other or not choice.groups:
        return replace(choice, others=other)
    groups = choice.groups
    for d in other:
        groups = united_groups(groups, d.groups)
    verdict: Verdict = "group" if choice.verdict == "named" else choice.verdict
    return replace(choice, verdict=verdict, groups=groups, others=other)


def half_decision(
    posterior: Posterior, decision: Callable[[Posterior], Decision], first: int, claims: bool
) -> Decision:
    """The decision on instants `first`, `first` + 2, ...; against what all instants claim, nothing only where that is
    so with half of the prior, too.

    What both halves find together is paid for once: the price of saying when several short events were is large.
    """
    half = half_posterior(posterior, first)
    if (choice := decision(half)).verdict != "adequate" or not claims:
        return choice
    every = tuple(replace(h, log_prior=0.5 * h.log_prior) for h in half.hypotheses)
    return decision(replace(half, hypotheses=every))


def united_events(e: Evidence, hypotheses: Sequence[Weighed]) -> tuple[Weighed, ...]:
    """The hypotheses in which one event is one cause: its most probable ends, repeats and variety of the effect stand
    for all, with the probability of all."""
    order, lead = best_first(hypotheses), dict[int, int]()
    whole = {t.name: Event.of({t.name: [(t.time[0], t.time[-1])]}) for t in e.tests}
    for k in dict.fromkeys(k for h in order for k in h.members if isinstance(e.effects[k], During)):
        lead[k] = next((j for j in lead.values() if is_same_event(e.effects[j], e.effects[k], whole)), k)
    alike: dict[tuple[str, frozenset[int]], list[Weighed]] = {}
    for h in order:
        alike.setdefault((h.heat, frozenset(lead.get(k, k) for k in h.members)), []).append(h)
    weight, out = dict(zip(order, SHARPNESS * weights(order), strict=True)), []
    for (_, members), every in alike.items():
        one = next((h for h in every if members == {*h.members}), None)
        if one is not None:
            more = float(logsumexp([weight[h] for h in every]) - weight[one]) / SHARPNESS
            out.append(replace(one, log_prior=one.log_prior + more))
    return tuple(out)


def is_same_event(one: Effect, other: Effect, whole: Mapping[str, Event] = NO_TESTS) -> bool:
    """Is it the same effect, or a variety of it, for about the same while, though in one of them it was again?

    whole : test -> the event that lasts all of it, for what held in a test
    """
    if not (isinstance(one, During) and isinstance(other, During) and one.base.place == other.base.place):
        return one == other
    if not (isinstance(one.base, type(other.base)) or isinstance(other.base, type(one.base))):
        return False
    first, second = (x.event or whole.get(x.condition) for x in (one, other))
    if first is None or second is None:
        return one == other
    a, b = first.repeats_at(second), second.repeats_at(first)
    alike = (a if b == second else first).overlap(b if a == first else second)
    return alike >= SAME


def differs(choice: Decision, other: Decision) -> bool:
    """Does another decision say something else: that nothing or another thing is missing, or the same less surely?"""
    if not choice.groups or len(choice.groups) != len(other.groups):
        return (choice.verdict, len(choice.groups)) != (other.verdict, len(other.groups))
    members = {k for g in choice.groups for k in g}
    names, again = ({g[0] for g in d.groups if len(g) == 1} for d in (choice, other))
    less_sure = not names <= again or choice.verdict == "named" != other.verdict
    return not {g[0] for g in other.groups} <= members or less_sure


def united_groups(groups: tuple[Group, ...], more: tuple[Group, ...]) -> tuple[Group, ...]:
    """The groups, each with the members of that other one which shares an effect with it or stands in its place; what
    one group has joins no other."""
    out, members = [], {k for g in groups for k in g}
    for i, g in enumerate(groups):
        alike = [m for m in more if set(m) & set(g)] or list(more[i : i + 1])
        out.append((*g, *dict.fromkeys(k for m in alike for k in m if k not in members)))
        members |= set(out[-1])
    return tuple(out)


def consistent_decision(choice: Decision, checks: tuple[Check, ...]) -> Decision:
    """The decision, unless what it claims is contradicted by its own numbers: then nothing in the catalogue explains
    them, and the checks say what would have to differ."""
    if any(c.contradicts for c in checks):
        return replace(choice, verdict="outside", groups=(), checks=checks)
    return replace(choice, checks=checks)


def half_posterior(posterior: Posterior, first: int) -> Posterior:
    """The posterior on instants `first`, `first` + 2, ...: refits are weighed where they stand, and all that was too
    improbable to be refitted gains or loses as the best of these does. So does nothing where it has gained by a noise
    of its own, which what explains all has no use for."""
    e, every = posterior.evidence, posterior.hypotheses
    fit = half_fit(e, e.fit, None, first)
    new = replace(e, fit=fit)
    bayes = {
        h.members: (log_bayes(e, h.fit, h.members), log_bayes(new, half_fit(e, h.fit, fit.error, first), h.members))
        for h in every
        if h.fit and h.members
    }
    best = max((h for h in every if h.members in bayes), key=lambda h: h.log_bayes, default=None)
    if best is None:
        return replace(posterior, evidence=new)
    whole, half = bayes[best.members]
    lost = 1.0 - float(np.clip(half / whole, 0.0, 1.0)) if whole > 0.0 else 0.0
    nothing = lost * max(whole - best.log_bayes, 0.0)  # of its gain by a noise of its own
    gained = {members: now - was + nothing for members, (was, now) in bayes.items()}
    share = max(gained[best.members] / best.log_bayes, -1.0) if best.log_bayes > 0.0 else 0.0
    increments = [gained[h.members] if h.members in gained else share * max(h.log_bayes, 0.0) for h in every]
    # under the louder noise nothing has that noise, too, and what it gains by one of its own is no gain over it
    louder = [d - nothing if h.members in gained else d for h, d in zip(every, increments, strict=True)]
    now = [
        replace(h, log_bayes=h.log_bayes + d, loud=h.loud + e)
        for h, d, e in zip(every, increments, louder, strict=True)
    ]
    return replace(posterior, evidence=new, hypotheses=tuple(now))


def half_fit(e: Evidence, fit: Fit, error: ModelError | None, first: int) -> Fit:
    """A fit where it stands, of every second instant.  error : of these instants, where it was made already"""
    if error is None and fit.error is not None:
        error = replace(fit.error, columns={key: columns[first::2] for key, columns in fit.error.columns.items()})
    parts = [replace(s, time=s.time[first::2], r=s.r[first::2], J=s.J[first::2]) for s in fit.parts]
    return continued(replace(fit, error=error), e.tests, e.fit.noise, 0, CachedSegments(parts, nearby=False))
