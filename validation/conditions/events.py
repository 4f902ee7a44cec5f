"""The events of a posterior as rows: when, how probable, what it was most likely, and how much."""

from __future__ import annotations

import numpy as np

from validation.conditions.windows import ALIKE
from validation.effects.during import During
from validation.effects.time_window import Event
from validation.inference.posterior import Posterior, probabilities
from validation.inference.result import PossibleEvent


def possible_events(posterior: Posterior) -> tuple[PossibleEvent, ...]:
    """Every stretch that was tried, most probable first; it is probable as far as any explanation of it is.

    A film and a heat input explain one stretch with ends of their own: what overlaps by half is one event.
    """
    effects, P = posterior.evidence.effects, probabilities(posterior.hypotheses)
    share = np.zeros(len(effects))
    for h, p in zip(posterior.hypotheses, P, strict=True):
        share[list(h.members)] += p
    nats = {k: h.log_bayes for k, h in posterior.single.items()}
    event_of = {k: x.event for k, x in enumerate(effects) if isinstance(x, During) and x.event}
    groups: list[list[int]] = []
    for k in sorted(event_of, key=lambda k: (-share[k], -nats[k])):
        group = next((g for g in groups if event_of[g[0]].overlap(event_of[k]) >= ALIKE), None)
        if group is None:
            groups.append([k])
        else:
            group.append(k)
    probability = [sum(float(p) for h, p in zip(posterior.hypotheses, P) if set(g) & set(h.members)) for g in groups]
    rows = [_row(posterior, g[0], event_of[g[0]], p) for g, p in zip(groups, probability, strict=True)]
    return tuple(sorted(rows, key=lambda r: -r.probability))


def _row(posterior: Posterior, k: int, event: Event, probability: float) -> PossibleEvent:
    """An event by its most probable explanation."""
    e, fit = posterior.evidence, posterior.single[k].fit
    value = float(e.score.amplitude[k] if fit is None else fit.theta[e.p])
    document = event.document()
    return PossibleEvent(
        event.name,
        document["words"],
        tuple(document["spans"]),
        probability,
        e.names[k],
        e.effects[k].title,
        value,
        e.parameters[k].unit,
    )
