"""What a diagnosis rests on: the calibrated model, the score of every candidate effect, the simulated null."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.multipliers import values_of
from lumped.network import Network, Parameter
from validation.calibrate import Fit, Known, calibrated, minimise, silent
from validation.case import Case, Test
from validation.effects import Effect, catalogue, extended
from validation.fitting import Unknowns, at_level, scene_of, widened, working
from validation.noise import Noise, fit_noise
from validation.null import Null, simulated_null
from validation.score import Gram, Score, gram, score, total
from validation.sheet import Segment, reach, segments

Array = NDArray[np.float64]
TWIN = 0.9995
MATTERS_K = 1.0
NEARLY, TRIED, PLAIN = 0.4, 3, 30.0  # linear amplitude, how many, deviance: of all-or-nothing effects


@dataclass(frozen=True)
class Evidence:
    """The score of candidates at one calibrated state.

    network : the model with all candidates at zero;  parts : segments with nuisance, then candidate columns
    """

    tests: tuple[Test, ...]
    fit: Fit
    network: Network
    effects: tuple[Effect, ...]
    parameters: tuple[Parameter, ...]
    parts: tuple[Segment, ...]
    grams: Mapping[str, Gram]
    score: Score

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(e.name for e in self.effects)

    @property
    def twins(self) -> list[str | None]:
        """For each effect the free parameter that does the same, if there is one."""
        G = total(self.grams)
        scale = np.sqrt(np.outer(np.diag(G.JJ), np.diag(G.ZZ)))
        alike = np.abs(G.JZ) / np.where(scale > 0, scale, np.inf)
        best = np.argmax(alike, axis=0)
        return [self.fit.unknowns.names[j] if alike[j, k] > TWIN else None for k, j in enumerate(best)]

    @property
    def matters(self) -> NDArray[np.bool_]:
        """Which effects, as large as the score has them, would move any reading by more than a user cares for (K,)."""
        p, a = len(self.fit.unknowns.parameters), np.abs(self.score.amplitude)
        return np.asarray(a * reach(self.parts)[p:] >= cared_for(self.parts))

    def of(self, few: Sequence[int]) -> Evidence:
        """With some of its effects only; the network keeps the others, at zero."""
        chosen = list(few)
        grams = {name: g.of(chosen) for name, g in self.grams.items()}
        return replace(
            self, effects=tuple(self.effects[k] for k in chosen), parameters=tuple(self.parameters[k] for k in chosen),
            parts=self.parts_of(chosen), grams=grams,
            score=score(total(grams), self.fit.theta, self.fit.unknowns.sd, self.score.sign[chosen]),
        )  # fmt: skip

    def parts_of(self, few: Sequence[int]) -> tuple[Segment, ...]:
        """The segments with nuisance columns and those of some effects."""
        p = len(self.fit.unknowns.parameters)
        columns = [*range(p), *(p + k for k in few)]
        return tuple(replace(s, J=s.J[:, columns]) for s in self.parts)

    def resharpened(self, noise: Noise) -> Score:
        """The score under another noise."""
        p = len(self.fit.unknowns.parameters)
        G = total(gram(self.parts, noise, p))
        return score(G, self.fit.theta, self.fit.unknowns.sd, self.score.sign)


def cared_for(parts: Sequence[Segment]) -> float:
    """Change of a reading (K) below which nobody minds what is missing: 1 K, or what the sensors may be wrong by."""
    return max(MATTERS_K, float(np.median([s.sigma_K for s in parts])))


def diagnosing(case: Case) -> tuple[Test, ...]:
    """The tests an effect may be chosen on: all but the held-out ones."""
    return tuple(t for t in case.tests if t.role != "hold-out")


def candidates(case: Case, kinds: Sequence[str] | None = None) -> tuple[Effect, ...]:
    """The catalogue on this case, less what the model has already."""
    inside = {e.name for e in case.model.effects}
    found = tuple(e for e in catalogue(scene_of(case), kinds) if e.name not in inside)
    if not found:
        where = f"case '{case.name}', kinds {', '.join(kinds or ['of the catalogue'])}"
        raise InputError("no effect can sit anywhere in this network", where, "other kinds, or inputs that they need")
    return found


def scored(case: Case, effects: Sequence[Effect], fit: Fit) -> Evidence:
    """One run of every test with all candidates' tangents at a calibrated state."""
    network = at_level(extended(fit.network, effects), {e.name for e in effects}, case.tests)
    by_name = {p.name: p for p in network.parameters}
    parameters = tuple(by_name[e.name] for e in effects)
    tests, p = diagnosing(case), len(fit.unknowns.parameters)
    values = {**{q.name: case.model.values.get(q.name, q.value) for q in network.parameters}, **fit.values}
    parts = tuple(segments(network, tests, values, (*fit.unknowns.parameters, *parameters)))
    exchange(parts, effects, p)
    grams = gram(parts, fit.noise, p)
    sign = np.array([q.sign for q in parameters], int)
    found = score(total(grams), fit.theta, fit.unknowns.sd, sign)
    return Evidence(tests, fit, network, tuple(effects), parameters, parts, grams, found)


def exchange(parts: Sequence[Segment], effects: Sequence[Effect], p: int) -> None:
    """Set the columns of exchanged plugs to what was read (y_1 - y_2) instead of what is predicted (T_2 - T_1).

    A model calibrated to exchanged readings has both places at nearly one temperature, so that exchanging its
    predictions would change little; the readings themselves can be exchanged exactly.  p : columns before the effects'
    """
    other = {(a, k): b for k, e in enumerate(effects) if e.whole for a, b in permutations(e.place.split("|"), 2)}
    known = {(s.test, s.channel): s for s in parts}
    for (a, k), b in other.items():
        for s in (s for s in parts if s.channel == a and (s.test, b) in known):
            t = known[s.test, b]
            s.J[:, p + k] = s.r - np.interp(s.time, t.time, t.r) - s.J[:, p + k]


def possible(evidence: Evidence) -> Evidence:
    """Without the all-or-nothing effects that do not clearly explain the readings whole.

    Those that come nearest are tried: what is whole is too large for tangents.
    """
    score, whole = evidence.score, [k for k, e in enumerate(evidence.effects) if e.whole]
    drop = 2.0 * score.u - np.diag(score.V)
    near = sorted((k for k in whole if score.amplitude[k] > NEARLY), key=lambda k: -drop[k])[:TRIED]
    kept = [k for k, e in enumerate(evidence.effects) if not e.whole or (k in near and explains(evidence, k))]
    return evidence if len(kept) == len(evidence.effects) else evidence.of(kept)


def explains(evidence: Evidence, k: int) -> bool:
    """Does an all-or-nothing effect, fitted, remove a clear deviance and come out whole rather than not?"""
    found = polished(evidence, [k], refit(evidence, [k]))
    return bool(found.theta[-1] > 0.5 and 2.0 * (evidence.fit.objective - found.objective) > PLAIN)


def calibrated_case(
    case: Case, progress: Callable[[str], None] = silent, start: Mapping[str, float] | None = None
) -> Fit:
    """The model calibrated on every test but the held-out ones."""
    network, unknowns = working(case)
    return calibrated(network, diagnosing(case), unknowns, {**case.model.values, **(start or {})}, progress=progress)


def null_of(
    evidence: Evidence,
    draws: int,
    seed: int = 0,
    workers: int = 2,
    cache: Path | None = None,
    progress: Callable[[str], None] = silent,
) -> Null:
    """The simulated null of this model and test plan."""
    e = evidence
    return simulated_null(
        e.fit, e.fit.network, e.tests, e.parts, e.score.sign, draws, seed, workers, cache, progress
    )  # fmt: skip


def refit(evidence: Evidence, members: Sequence[int], noise: Noise | None = None, start: Fit | None = None) -> Fit:
    """All free parameters and the amplitudes of some candidates, fitted anew with the evidence's Jacobian."""
    network, unknowns, held = with_members(evidence, members)
    theta = start.theta if start else np.concatenate([evidence.fit.theta, first_amplitudes(evidence, members)])
    return minimise(network, evidence.tests, unknowns, theta, noise or evidence.fit.noise, held, 10,
                    Known(evidence.parts_of(members)))  # fmt: skip


def polished(evidence: Evidence, members: Sequence[int], fit: Fit) -> Fit:
    """A refit gone on with a Jacobian of its own."""
    network, unknowns, held = with_members(evidence, members)
    return minimise(network, evidence.tests, unknowns, fit.theta, fit.noise, held, 8, draft=True)


def with_members(evidence: Evidence, members: Sequence[int]) -> tuple[Network, Unknowns, dict[str, float]]:
    fit, chosen = evidence.fit, [evidence.parameters[k] for k in members]
    network = extended(fit.network, [evidence.effects[k] for k in members])
    unknowns = Unknowns((*fit.unknowns.parameters, *(widened(p) for p in chosen)))
    return network, unknowns, values_of(network, fit.values)


def first_amplitudes(evidence: Evidence, members: Sequence[int]) -> Array:
    """Linear estimates, kept to the admissible side and within three prior deviations; what is whole at its end."""
    whole = [evidence.effects[k].whole for k in members]
    a = np.where(whole, 1.0, evidence.score.amplitude[list(members)])
    sd = np.array([evidence.parameters[k].prior_sd for k in members])
    low = np.array([evidence.parameters[k].low for k in members])
    high = np.array([evidence.parameters[k].high for k in members])
    return np.clip(np.clip(a, -3.0 * sd, 3.0 * sd), 0.9 * low, 0.9 * high)


def sharpened(fit: Fit) -> Noise:
    """The noise of the residual that this fit leaves."""
    return fit_noise(fit.parts)
