"""The noise of the tests that agree: one that contradicts them must not make everything look uncertain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from validation.inference.evidence import Evidence, extended_prior, under
from validation.inference.score import total
from validation.measurement.noise import Noise, fit_noise

FEWEST = 3  # tests: of two that contradict each other either may be the odd one


def without(evidence: Evidence, test: str) -> Evidence:
    """The evidence under the noise that the others leave when they are calibrated by themselves."""
    return under(evidence, noise_of_others(evidence, test)) if test and len(evidence.tests) >= FEWEST else evidence


def noise_of_others(evidence: Evidence, test: str) -> Noise:
    """By tangents: parameters and model error fitted to all tests but one."""
    e, p = evidence, evidence.p
    G, (theta, sd) = total({name: g for name, g in e.grams.items() if name != test}), extended_prior(e.fit)
    x = np.linalg.solve(G.JJ + np.diag(sd**-2.0), G.Jr - sd**-2.0 * theta)
    error, left = e.fit.error, []
    for s in [s for s in e.parts if s.test != test]:
        left.append(replace(s, r=s.r - s.J[:, :p] @ x[:p] - (error.of(s) @ x[p:] if error else 0.0)))
    return fit_noise(left)
