"""What a hidden effect could be taken for: what it does to the true machine, explained by every other candidate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from validation.detectable import readings_with, recalibrated
from validation.evidence import Evidence, diagnosing, with_members
from validation.verdict import PULL

from hidden.kinds import KINDS
from hidden.truth.archetype import measured
from hidden.truth.change import Change
from hidden.user import case_of
from validation.calibrate import Fit, Known, minimise
from validation.case import Test
from validation.fitting import Unknowns, widened

Array = NDArray[np.float64]
LIKE, MOST = 0.4, 12


@dataclass(frozen=True)
class Reference:
    """A machine of a kind with nothing missing, calibrated by its user.

    evidence : from its tests;  still : readings the calibrated model foretells
    """

    kind: str
    seed: int
    evidence: Evidence
    still: list[Test]

    def recorded(self, change: Change) -> Sequence[Test]:
        """The tests of the machine with a change, as they are logged."""
        return diagnosing(case_of("", self.kind, measured(KINDS[self.kind], self.seed, change)))

    def moved(self, change: Change) -> list[Array]:
        """What a change of the machine does to every reading (K), channel by channel."""
        return differences(self.recorded(change), self.evidence.tests)

    def foretold(self, change: Change) -> list[Test]:
        """The tests as the calibrated model foretells them, and what a change of the machine does to every reading."""
        more = iter(self.moved(change))
        return [replace(t, channels=tuple(replace(c, y=c.y + next(more)) for c in t.channels)) for t in self.still]


def reference(kind: str, seed: int, evidence: Evidence) -> Reference:
    return Reference(kind, seed, evidence, readings_with(evidence, {}))


def differences(one: Sequence[Test], other: Sequence[Test]) -> list[Array]:
    return [a.y - b.y for s, t in zip(one, other, strict=True) for a, b in zip(s.channels, t.channels, strict=True)]


def gaps(e: Evidence, k: int, amplitude: float, tests: Sequence[Test], kappa: float) -> dict[str, float]:
    """Explanation -> deviance by which it explains a hidden effect worse than the effect's own name, over kappa^2.

    e : where nothing is missing;  k, amplitude : the effect in the catalogue's terms;  tests : with the effect
    Explanations are candidates whose traces are alike, and the calibrated parameter that the effect drags further than
    PULL deviations, were its prior wrong. Everything else is calibrated anew; one below zero follows the machine's law
    better than the own name does.
    """
    V, signed = e.score.V, amplitude * (int(e.score.sign[k]) or 1)
    alike = np.abs(e.score.cosine[k])
    near = [int(m) for m in np.argsort(-alike) if m != k and alike[m] > LIKE][:MOST]
    own = _explained(e, tests, k, signed)
    found = {e.names[m]: _explained(e, tests, m, signed * V[k, m] / V[m, m]) for m in near} | _dragged(e, tests)
    return {name: round(2.0 * (fit.objective - own.objective) / kappa**2, 2) for name, fit in found.items()}


def _explained(e: Evidence, tests: Sequence[Test], k: int, start: float) -> Fit:
    """The tests explained by effect k and the calibration; priors centre on the state that stands for the truth."""
    rival = e.parameters[k]
    network, unknowns, held = with_members(e, [k])
    first = float(np.clip(start, 0.9 * rival.low, 0.9 * rival.high))
    return minimise(network, tests, unknowns, np.append(e.fit.theta, first), e.fit.noise, held,
                    known=Known(e.parts_of([k]), renewed=True), centre=np.append(e.fit.theta, 0.0))  # fmt: skip


def _dragged(e: Evidence, tests: Sequence[Test]) -> dict[str, Fit]:
    """The tests explained by the parameter that calibration without an effect drags furthest, its prior widened."""
    bare = recalibrated(e, tests, e.fit.theta, e.fit.unknowns)
    pull, own = np.abs(bare.theta - e.fit.theta) / bare.unknowns.sd, bare.unknowns.parameters
    j = int(np.argmax(pull))
    if pull[j] <= PULL:
        return {}
    loose = Unknowns(tuple(widened(q) if i == j else q for i, q in enumerate(own)))
    return {f"calibrated {own[j].name}": recalibrated(e, tests, bare.theta, loose)}
