"""What an added effect must stand up to: bounds, one amplitude in all tests, tests left out in turn, relevance.

All from the refit's own residuals and Jacobian; nothing is simulated again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from validation.apart import DECISIVE
from validation.calibrate import Fit
from validation.evidence import cared_for
from validation.fitting import to_value
from validation.score import Gram, gram, per_test, total
from validation.sheet import Segment, reach

Array = NDArray[np.float64]
CONSTANT = 0.01  # probability below which one amplitude in all tests is not believed


@dataclass(frozen=True)
class Gate:
    """One check: what it found, the limit, and whether that is good enough."""

    gate: str
    passed: bool
    value: float
    limit: float
    words: str

    def document(self) -> dict:
        return dict(vars(self))


def gates(fit: Fit, name: str, kappa: float = 1.0) -> tuple[Gate, ...]:
    """The checks of one effect at a fit that has it among its unknowns."""
    k = fit.unknowns.names.index(name)
    grams = gram([_last(s, k) for s in fit.parts], fit.noise, fit.theta.size - 1)
    return (bound_gate(fit, k), constancy_gate(fit, k, grams, kappa), left_out_gate(fit, k, grams), relevance(fit, k))


def _last(s: Segment, k: int) -> Segment:
    """The segment with column k behind all others."""
    return replace(s, J=np.column_stack([np.delete(s.J, k, axis=1), s.J[:, k]]))


def bound_gate(fit: Fit, k: int) -> Gate:
    p, value = fit.unknowns.parameters[k], to_value(fit.unknowns.parameters[k], float(fit.theta[k]))
    free = not bool(fit.at_bound[k])
    inside = f"{value:.3g} lies between {p.low:.3g} and {p.high:.3g} {p.unit}"
    return Gate(
        "bounds", free, value, p.high, inside if free else f"its amplitude sticks to a bound, {value:.3g} {p.unit}"
    )


def constancy_gate(fit: Fit, k: int, grams: Mapping[str, Gram], kappa: float) -> Gate:
    """Amplitude from each test alone, the other unknowns moving as all tests say: Q ~ chi2 of tests less one."""
    G = total(grams)
    weight = np.delete(fit.unknowns.sd, k) ** -2.0
    follow = np.linalg.solve(G.JJ + np.diag(weight), G.JZ)
    a, var = per_test(grams, 0, np.asarray(follow, float))
    if a.size < 2:
        return Gate("constancy", True, 1.0, CONSTANT, "felt in one test only")
    mean = np.sum(a / var) / np.sum(1.0 / var)
    p = float(chi2.sf(np.sum((a - mean) ** 2 / var) / kappa**2, a.size - 1))
    words = f"one amplitude in all tests: probability {p:.2g}"
    return Gate("constancy", p >= CONSTANT, p, CONSTANT, words)


def left_out_gate(fit: Fit, k: int, grams: Mapping[str, Gram]) -> Gate:
    """Each test predicted from the others, with and without the effect: where and how far the deviance falls.

    Better in half of the tests, or by so much in some that it decides: tests that hardly feel an effect tell little.
    """
    falls = left_out(fit, k, grams)
    if len(falls) < 2:
        return Gate("left out", True, float("nan"), 0.0, "one test only")
    fell, whole = sum(f > 0 for f in falls.values()), sum(falls.values())
    good = whole > 0 and (2 * fell >= len(falls) or whole > DECISIVE)
    words = f"each test predicted from the others: better in {fell} of {len(falls)}, deviance {-whole:+.3g} in all"
    return Gate("left out", good, whole, 0.0, words)


def left_out(fit: Fit, k: int, grams: Mapping[str, Gram]) -> dict[str, float]:
    """Test -> deviance without the effect minus with it, both fitted to the other tests (linear about the fit)."""
    order = np.append(np.delete(np.arange(fit.theta.size), k), k)
    theta, weight = fit.theta[order], fit.unknowns.sd[order] ** -2.0
    whole = [_joined(g) for g in grams.values()]
    out = {}
    for name, own in zip(grams, whole, strict=True):
        others = [g for g in whole if g is not own]
        if not others[0:1] or not _felt(grams, name):
            continue
        A, b = (sum(part) for part in zip(*((g[0], g[1]) for g in others), strict=True))
        full = _step(np.asarray(A), np.asarray(b), theta, weight, None)
        bare = _step(np.asarray(A), np.asarray(b), theta, weight, -1)
        out[name] = _deviance(own, bare) - _deviance(own, full)
    return out


def _felt(grams: Mapping[str, Gram], name: str) -> bool:
    """Does the effect act in this test at all?"""
    return bool(grams[name].ZZ[0, 0] > 1e-6 * max(g.ZZ[0, 0] for g in grams.values()))


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


def _deviance(own: tuple[Array, Array, float], step: Array) -> float:
    A, b, square = own
    return float(square - 2.0 * b @ step + step @ A @ step)


def relevance(fit: Fit, k: int) -> Gate:
    """The largest change of any reading that the effect makes, at fixed other parameters (K)."""
    moved = float(reach(fit.parts)[k] * abs(fit.theta[k]))
    limit = cared_for(fit.parts)
    return Gate("relevance", moved >= limit, moved, limit, f"moves a reading by up to {moved:.2g} K")


def doubts(checks: Sequence[Gate]) -> str:
    """The checks that failed, in words."""
    return "; ".join(g.words for g in checks if not g.passed)
