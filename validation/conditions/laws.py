"""From missing heat to a law: declared losses and films that would have to be more or less where an input is large."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from measured.doubt import PRIOR, RARE
from validation.conditions.refine import columns
from validation.effects import extended
from validation.effects.above import KIND, Above
from validation.inference.evidence import Evidence, extended_prior, projected
from validation.inference.posterior import log_bayes_of
from validation.inference.score import score, total
from validation.parameters.model_form import EXACT_LOSSES, is_film

Array = NDArray[np.float64]
LEVELS = (0.5, 0.75)  # quantiles of an input at which its law may turn
MOST, HOPELESS = 4, 5.0  # laws that join the other effects; nats below nothing beyond which none does
VARIED = 0.2  # of its largest value: an input that moves less shows no law


def laws(evidence: Evidence, values: Mapping[str, float]) -> list[Above]:
    """Corrections that could carry weight."""
    turns = levels(evidence)
    effects = [
        Above(f"{x}|{name}>{level:g}")
        for x, names in targets(evidence, list(turns)).items()
        for name in names
        for level in turns[name]
    ]
    if not effects:
        return []
    share = 1.0 / len(effects)
    prior = np.log(PRIOR["effect"].share * RARE[KIND].share * share / PRIOR["nothing"].share)
    sd = np.array([q.prior_sd for q in extended(evidence.fit.network, effects).parameters[-len(effects) :]])
    scores = score(
        total(projected(evidence.fit, columns(evidence, effects, values))),
        *extended_prior(evidence.fit),
        np.zeros(len(effects), int),
    )
    worth = log_bayes_of(scores, sd) + prior
    order = [int(k) for k in np.argsort(-worth) if scores.visible[k] and worth[k] > -HOPELESS]
    return [Above(effects[k].place, share) for k in order[:MOST]]


def targets(evidence: Evidence, inputs: Sequence[str]) -> dict[str, list[str]]:
    """Declared losses with every input, but for those whose law is not in doubt; films with those they follow."""
    network = evidence.fit.network
    losses = {s.name: list(inputs) for s in network.sources if not s.origin and s.kind not in EXACT_LOSSES}
    films = [x for x in network.links if not x.origin and is_film(network, x)]
    return losses | {x.name: [r for r in x.law.reads if r in inputs] for x in films}


def levels(evidence: Evidence) -> dict[str, list[float]]:
    """Input -> values at which its law may turn."""
    out = {}
    for name in dict.fromkeys(n for t in evidence.tests for n in t.inputs):
        u = np.abs(np.concatenate([t.inputs[name] for t in evidence.tests if name in t.inputs]))
        at = [float(f"{x:.2g}") for x in np.quantile(u, LEVELS)]
        if np.ptp(u) > VARIED * u.max() and all(name in t.inputs for t in evidence.tests):
            out[name] = list(dict.fromkeys(x for x in at if 0.0 < x < u.max()))
    return out
