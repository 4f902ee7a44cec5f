"""From evidence to probabilities: nothing, one effect, two, or heat of unknown cause.

Under a linear model with Gaussian noise and model error the log Bayes factor of effects A against nothing is closed:
with u, V the efficient score and its covariance, and amplitudes a ~ half-normal(s) where physics has a sign,

    log BF = 1/2 u'(V + S^-1)^-1 u - 1/2 log det(1 + V S) + log P(sign a | readings) / P(sign a),  S = diag(s^2)

averaged over a few s, since nobody knows the usual size well. What carries weight is refitted (refits.py).
Source: Kass and Raftery 1995; Kaipio and Somersalo 2005 for the model error in V.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from measured.doubt import PRIOR, RARE, SIZES, temper
from validation.calibration.calibrate import Fit
from validation.effects import Effect
from validation.effects.above import Above
from validation.effects.during import During
from validation.inference.evidence import Evidence
from validation.inference.missing_heat import MissingHeat
from validation.inference.score import Score, log_sign_gain, one_size

if TYPE_CHECKING:
    from validation.conditions.contradiction import Contradiction

Array = NDArray[np.float64]
NOTHING = "nothing"
LEADING = 60  # effects whose pairs are compared: beyond them neither of two carries weight


@dataclass(frozen=True)
class Hypothesis:
    """What may be missing.

    members : indices of effects, none for nothing;  heat : place of heat of unknown cause, if that is it
    log_prior : log prior probability;  log_bayes : log evidence over that of nothing (nats);  fit : once refitted
    loud : log evidence under the larger noise that nothing asks for, over that of nothing under the other
    """

    members: tuple[int, ...] = ()
    heat: str = ""
    log_prior: float = 0.0
    log_bayes: float = 0.0
    loud: float = -np.inf
    fit: Fit | None = field(default=None, compare=False)

    @property
    def nats(self) -> float:
        """Log evidence, but for a constant, averaged over what the noise may be."""
        return float(np.logaddexp(self.log_bayes, self.loud))

    def name(self, evidence: Evidence) -> str:
        if self.heat:
            return f"heat@{self.heat}"
        return " + ".join(evidence.names[k] for k in self.members) or NOTHING


def tempered_by(hypotheses: Sequence[Hypothesis]) -> float:
    """What divides the log evidence of all: larger where the best has much."""
    none = next((h.nats for h in hypotheses if not h.members and not h.heat), 0.0)
    return temper(max(h.nats for h in hypotheses) - none)


def weights(hypotheses: Sequence[Hypothesis]) -> Array:
    """(n,) log posterior probabilities, but for a constant."""
    share = tempered_by(hypotheses)
    return np.array([h.log_prior + h.nats / share for h in hypotheses])


def probabilities(hypotheses: Sequence[Hypothesis]) -> Array:
    """(n,) that sum to one."""
    x = weights(hypotheses)
    return np.asarray(np.exp(x - logsumexp(x)))


def prior_shares(evidence: Evidence) -> Array:
    """(K,) prior probability of each effect alone: its class's share over kinds, its kind's over places.

    What held in one test or for a while has a share of its own, which says what it costs to say when.
    """
    lasting = [e for e in evidence.effects if not isinstance(e, During | Above)]
    kinds = [e.kind for e in lasting]
    faults = {e.kind: e.fault for e in lasting}
    weight = {k: RARE[k].share if k in RARE else 1.0 for k in faults}
    whole = {f: sum(w for k, w in weight.items() if faults[k] == f) for f in (False, True)}
    share = {k: PRIOR["fault" if faults[k] else "effect"].share * w / whole[faults[k]] for k, w in weight.items()}
    alone = {k: w / kinds.count(k) for k, w in share.items()}
    condition, law = PRIOR["condition"].share, PRIOR["effect"].share * RARE["law"].share

    def of(e: Effect) -> float:
        return (
            condition * e.share if isinstance(e, During) else law * e.share if isinstance(e, Above) else alone[e.kind]
        )

    return np.array([of(e) for e in evidence.effects])


def singles(evidence: Evidence) -> list[Hypothesis]:
    """Nothing, and each effect by itself."""
    prior, bayes = prior_shares(evidence), linear(evidence)
    one = [Hypothesis((k,), "", float(np.log(prior[k])), float(bayes[k])) for k in range(len(prior))]
    return [Hypothesis(log_prior=float(np.log(PRIOR["nothing"].share))), *one]


def by_tangent(evidence: Evidence) -> Array:
    """(K,) log Bayes factor of each effect against nothing by its tangent alone."""
    return log_bayes_of(evidence.score, np.array([q.prior_sd for q in evidence.parameters]))


def linear(evidence: Evidence) -> Array:
    """(K,) log Bayes factor of each effect against nothing; of a joint or a clock also at a large amplitude, of plugs
    exchanged."""
    tangent = by_tangent(evidence)
    must = np.array([e.whole for e in evidence.effects])
    both = np.logaddexp(tangent, evidence.whole) - np.where(np.isfinite(evidence.whole), np.log(2.0), 0.0)
    return np.asarray(np.where(must, evidence.whole, both))


def log_bayes_of(s: Score, sd: Array) -> Array:
    """(K,) log Bayes factors by tangents, averaged over the usual sizes `sd`; 0 where nothing is seen."""
    sizes = [one_size(s.u, np.diag(s.V), f * sd, s.sign) for f in SIZES]
    return np.asarray(np.where(s.visible, logsumexp(sizes, axis=0) - np.log(len(SIZES)), 0.0))


def pairs(evidence: Evidence, ones: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Every two of the leading effects, in proportion to the prior of each."""
    e, prior = evidence, prior_shares(evidence)
    usable = [h for h in ones if h.members and not e.effects[h.members[0]].whole and e.score.visible[h.members[0]]]
    usable.sort(key=lambda h: -(h.log_prior + h.log_bayes))
    few = np.array([h.members[0] for h in usable[:LEADING]], int)
    if few.size < 2:
        return []
    i, j = np.triu_indices(few.size, 1)
    a, b = few[i], few[j]
    share = prior[a] * prior[b]
    every = (np.sum(prior) ** 2 - np.sum(prior**2)) / 2.0
    log_prior = np.log(PRIOR["two"].share * share / every)
    more = np.maximum(linear(e) - by_tangent(e), 0.0)  # what a large amplitude gains beyond its tangent
    bayes = two(e, a, b) + np.maximum(more[a], more[b])
    return [Hypothesis((int(k), int(m)), "", float(p), float(v)) for k, m, p, v in zip(a, b, log_prior, bayes)]


def two(evidence: Evidence, a: NDArray[np.int64], b: NDArray[np.int64]) -> Array:
    """Log Bayes factors of pairs (a_i, b_i) against nothing."""
    s, sd = evidence.score, np.array([q.prior_sd for q in evidence.parameters])
    out = []
    for f in SIZES:
        A, B = s.V[a, a] + (f * sd[a]) ** -2.0, s.V[b, b] + (f * sd[b]) ** -2.0
        X, det = s.V[a, b], np.maximum(A * B - s.V[a, b] ** 2, 1e-300)
        ma, mb = (B * s.u[a] - X * s.u[b]) / det, (A * s.u[b] - X * s.u[a]) / det
        gain = 0.5 * (s.u[a] * ma + s.u[b] * mb) - 0.5 * np.log((f * sd[a]) ** 2 * (f * sd[b]) ** 2 * det)
        out.append(
            gain + log_sign_gain(ma / np.sqrt(B / det), s.sign[a]) + log_sign_gain(mb / np.sqrt(A / det), s.sign[b])
        )
    return np.asarray(logsumexp(out, axis=0) - np.log(len(SIZES)))


def unknown_heat(evidence_nats: Mapping[str, float]) -> list[Hypothesis]:
    """Heat of unknown cause at each place.  evidence_nats : place -> log Bayes factor against nothing"""
    share = float(np.log(PRIOR["heat"].share / max(len(evidence_nats), 1)))
    return [Hypothesis((), place, share, nats) for place, nats in evidence_nats.items()]


def averaged(hypotheses: Sequence[Hypothesis], loud: Evidence, over: float) -> list[Hypothesis]:
    """The hypotheses with their evidence under a larger noise as well, so that what is merely noisier is a rival.

    over : log evidence of nothing under that noise over the one it has without.  Heat of unknown cause gains nothing
    there.
    """
    alone = linear(loud)
    many = [h for h in hypotheses if len(h.members) == 2]
    both = (
        dict(zip([h.members for h in many], two(loud, *np.array([h.members for h in many], int).T), strict=True))
        if many
        else {}
    )

    def gain(h: Hypothesis) -> float:
        return float(both[h.members] if h.members in both else alone[h.members[0]] if h.members else 0.0)

    return [replace(h, loud=over + gain(h)) for h in hypotheses]


def against_nothing(hypotheses: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The hypotheses with evidence of which nothing has none."""
    none = next(h.nats for h in hypotheses if not h.members and not h.heat)
    return [replace(h, log_bayes=h.log_bayes - none, loud=h.loud - none) for h in hypotheses]


def inclusion(hypotheses: Sequence[Hypothesis], count: int) -> Array:
    """(K,) probability that each effect is among what is missing."""
    out = np.zeros(count)
    for h, p in zip(hypotheses, probabilities(hypotheses), strict=True):
        out[list(h.members)] += p
    return out


@dataclass(frozen=True)
class Posterior:
    """What follows from the readings.

    heat : of unknown cause at each place, most evident first
    against : what would have to differ between the tests
    """

    evidence: Evidence
    hypotheses: tuple[Hypothesis, ...]
    heat: tuple[MissingHeat, ...]
    against: Contradiction | None = None

    @property
    def single(self) -> dict[int, Hypothesis]:
        """Each effect by itself."""
        return {h.members[0]: h for h in self.hypotheses if len(h.members) == 1}

    @property
    def best(self) -> Hypothesis:
        return self.hypotheses[int(np.argmax(probabilities(self.hypotheses)))]
