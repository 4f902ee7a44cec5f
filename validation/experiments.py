"""How far the tests of the menu would set rivals apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from validation.case import Test
from validation.evidence import Evidence
from validation.findings import NextTest
from validation.foretell import foretold, read_by
from validation.menu import Experiment, possible
from validation.rivals import GAP, Race
from validation.score import gram, score, total
from validation.sheet import segments

Array = NDArray[np.float64]
DECISIVE = 20.0
CHECKED = 3
Gaps = dict[tuple[int, int], float]


def next_tests(
    evidence: Evidence, found: Race, amplitude: Mapping[int, float], kappa: Array
) -> list[NextTest]:  # fmt: skip
    """Tests that separate the race's group, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    """
    base = evidence.tests[-1]
    plans = [(e, read_by(found.best, e.made_from(base))) for e in possible(base)]
    promised = [(e, t, separation(evidence, t, found.group, amplitude, kappa)) for e, t in plans]
    promised.sort(key=lambda row: -min(row[2].values()) / row[0].hours)
    out = []
    for (experiment, _, _), gaps in zip(promised, proven(evidence, found, promised, kappa), strict=True):
        apart = tuple(f"{evidence.names[k]} / {evidence.names[m]}" for (k, m), g in gaps.items() if g >= DECISIVE)
        out.append(NextTest(experiment.name, apart, min(gaps.values()), experiment.hours))
    return sorted(out, key=lambda t: -t.predicted_gain / t.hours)


def proven(
    evidence: Evidence, found: Race, promised: Sequence[tuple[Experiment, Test, Gaps]], kappa: Array
) -> list[Gaps]:  # fmt: skip
    """What is left of the gaps that tangents promise, for each test.

    Tangents promise too much: they do not know how far the rivals can bend. Refits show how much for the first CHECKED
    tests and the pairs that might come apart; what was not refitted keeps the largest share that any of those kept.
    """
    kept: list[Gaps] = [
        {pair: foretold(evidence, found, t, pair, float(kappa[pair[0]])) for pair, gap in gaps.items() if gap >= GAP}
        for _, t, gaps in promised[:CHECKED]
    ]
    kept += [{}] * (len(promised) - len(kept))
    shares = [g / gaps[pair] for own, (_, _, gaps) in zip(kept, promised, strict=True) for pair, g in own.items()]
    share = float(np.clip(max(shares, default=1.0), 0.0, 1.0))
    return [
        {pair: max(min(gap, own.get(pair, share * gap)), 0.0) for pair, gap in gaps.items()}
        for own, (_, _, gaps) in zip(kept, promised, strict=True)
    ]


def separation(
    evidence: Evidence, planned: Test, members: Sequence[int], amplitude: Mapping[int, float], kappa: Array
) -> Gaps:
    """For every pair the deviance gap with the planned test added: a^2 V_kk (1 - c_kl^2) / kappa^2, the smaller way."""
    fit, p, chosen = evidence.fit, len(evidence.fit.unknowns.parameters), list(members)
    columns = (*fit.unknowns.parameters, *(evidence.parameters[k] for k in chosen))
    parts = segments(evidence.network, [planned], fit.values, columns)
    G = total(evidence.grams)
    seen = replace(G, JZ=G.JZ[:, chosen], ZZ=G.ZZ[np.ix_(chosen, chosen)], Zr=G.Zr[chosen])
    both = seen + gram(parts, fit.noise, p)[planned.name]
    s = score(both, fit.theta, fit.unknowns.sd, evidence.score.sign[chosen])
    V, c = np.diag(s.V), s.cosine
    out = {}
    for i, j in combinations(range(len(chosen)), 2):
        strength = min(amplitude[chosen[x]] ** 2 * V[x] / kappa[chosen[x]] ** 2 for x in (i, j))
        out[chosen[i], chosen[j]] = float(strength * (1.0 - c[i, j] ** 2))
    return out
