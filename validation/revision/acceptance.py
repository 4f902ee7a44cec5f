"""What an added effect must stand up to: its bounds, and the prediction of each test from the others.

Each test is left out in turn and predicted by the model with the effect and by the refitted model without it. Nothing
is simulated again: the fit's own residuals and Jacobian say it, model error in account. Held-out tests have no say.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from validation.calibration.calibrate import Fit
from validation.comparison.linearisation import Segment
from validation.inference.score import Gram, gram
from validation.parameters.unknowns import to_value

Array = NDArray[np.float64]
FELT = 1e-6  # of the largest trace in a test: below it the effect does not act there


@dataclass(frozen=True)
class Check:
    """One check: what it found, the limit, and whether that is good enough."""

    check: str
    passed: bool
    value: float
    limit: float
    words: str

    def document(self) -> dict:
        return dict(vars(self))


def checks(fit: Fit, name: str) -> tuple[Check, ...]:
    """The checks of one effect at a fit that has it among its unknowns."""
    k = fit.unknowns.names.index(name)
    return (bounds(fit, k), cross_validation(fit, k))


def bounds(fit: Fit, k: int) -> Check:
    """Is the amplitude inside its physical bounds?"""
    p, value = fit.unknowns.parameters[k], to_value(fit.unknowns.parameters[k], float(fit.theta[k]))
    free = not bool(fit.at_bound[k])
    inside = f"{value:.3g} lies between {p.low:.3g} and {p.high:.3g} {p.unit}"
    words = inside if free else f"its amplitude sticks to a bound, {value:.3g} {p.unit}"
    return Check("bounds", free, value, p.high, words)


def cross_validation(fit: Fit, k: int) -> Check:
    """Does the effect foretell tests that it was not fitted to better than the refitted model without it?"""
    falls = predicted_without(fit, k)
    if len(falls) < 2:
        return Check("left out", True, float("nan"), 0.0, "felt in one test only")
    fell, whole = sum(f > 0 for f in falls.values()), sum(falls.values())
    words = f"each test predicted from the others: better in {fell} of {len(falls)}, deviance {-whole:+.3g} in all"
    return Check("left out", whole > 0, whole, 0.0, words)


def predicted_without(fit: Fit, k: int) -> dict[str, float]:
    """Test -> deviance without the effect minus with it, both fitted to the other tests (linear about the fit)."""
    error, p = fit.error, fit.theta.size
    d = error.size if error else 0
    parts = [_last(error.beside(s, p) if error else s, k) for s in fit.parts]
    grams = gram(parts, fit.noise, p + d - 1)
    order = np.append(np.delete(np.arange(p + d), k), k)
    theta = np.concatenate([fit.theta, np.zeros(d)])[order]
    weight = np.concatenate([fit.unknowns.sd, np.ones(d)])[order] ** -2.0
    whole, out = {name: _joined(g) for name, g in grams.items()}, {}
    for name, form in whole.items():
        others = [g for other, g in whole.items() if other != name]
        if not others or not _felt(grams, name):
            continue
        A, b = (np.asarray(sum(part)) for part in zip(*((g[0], g[1]) for g in others), strict=True))
        out[name] = _deviance(form, _step(A, b, theta, weight, -1)) - _deviance(form, _step(A, b, theta, weight, None))
    return out


def _last(s: Segment, k: int) -> Segment:
    """The segment with column k behind all others."""
    return replace(s, J=np.column_stack([np.delete(s.J, k, axis=1), s.J[:, k]]))


def _felt(grams: Mapping[str, Gram], name: str) -> bool:
    """Does the effect act in this test at all?"""
    return bool(grams[name].ZZ[0, 0] > FELT * max(g.ZZ[0, 0] for g in grams.values()))


def _joined(g: Gram) -> tuple[Array, Array, float]:
    """J'J, J'r and r'r with the effect as the last column."""
    A = np.block([[g.JJ, g.JZ], [g.JZ.T, g.ZZ]])
    return A, np.concatenate([g.Jr, g.Zr]), g.rr


def _step(A: Array, b: Array, theta: Array, weight: Array, without: int | None) -> Array:
    """Move from theta to the optimum of some tests; `without` holds one coordinate at zero."""
    step = np.zeros_like(theta)
    free = np.ones(theta.size, bool)
    if without is not None:
        free[without], step[without] = False, -theta[without]
    H = A + np.diag(weight)
    rhs = b - weight * theta - H @ step
    step[free] = np.linalg.solve(H[np.ix_(free, free)], rhs[free])
    return step


def _deviance(gram: tuple[Array, Array, float], step: Array) -> float:
    A, b, square = gram
    return float(square - 2.0 * b @ step + step @ A @ step)


def failures(checks: Sequence[Check]) -> str:
    """The checks that failed, in words."""
    return "; ".join(c.words for c in checks if not c.passed)
