"""The events of a posterior as rows: when, how probable, what it was most likely, and how much."""

from __future__ import annotations

import numpy as np

from validation.diagnosis.result import PossibleEvent
from validation.effects.during import During
from validation.inference.posterior import Posterior, probabilities


def possible_events(posterior: Posterior) -> tuple[PossibleEvent, ...]:
    """Every stretch that was tried, most probable first; it is probable as far as any explanation of it is."""
    rows = [row for found in posterior.events if (row := _row(posterior, found.name)) is not None]
    return tuple(sorted(rows, key=lambda r: -r.probability))


def _row(posterior: Posterior, name: str) -> PossibleEvent | None:
    e, single = posterior.evidence, posterior.single
    own = [k for k, x in enumerate(e.effects) if isinstance(x, During) and x.gate == name]
    if not own:
        return None
    P = probabilities(posterior.hypotheses)
    share = np.zeros(len(e.effects))
    held = 0.0
    for h, p in zip(posterior.hypotheses, P, strict=True):
        share[list(h.members)] += p
        held += float(p) if set(own) & set(h.members) else 0.0
    k = max(own, key=lambda i: (share[i], single[i].log_bayes))
    effect, fit = e.effects[k], single[k].fit
    assert isinstance(effect, During)
    assert effect.event is not None
    value = float(e.score.amplitude[k] if fit is None else fit.theta[e.p])
    document = effect.event.document()
    return PossibleEvent(name, document["words"], tuple(document["spans"]), held, effect.name, effect.title, value,
                     e.parameters[k].unit)  # fmt: skip
