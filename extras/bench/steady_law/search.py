"""Which forms of a law the readings speak for: the evidence of each, from the simplest ones on."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from extras.bench.steady_law.forms import PRIORS, Form, simplest, temperature
from extras.bench.steady_law.steady_tests import SteadyTests
from thermoscope import plugin as th

MOST = 7  # numbers of a law; forms of one more are weighed too, as doubts
LEADING = 6  # forms that each round goes on from
READ_K, READ_TESTS = 0.1, 2.0  # before any reading: a mean is right to 0.1 K, which counts as much as two tests
NEGLIGIBLE = 7.0  # ln of evidence: a form a thousand times less probable than the best
ITERATIONS, SMALLEST = 60, 1e-6  # of a fit, and the fall of -ln(probability) that ends it


@dataclass(frozen=True)
class Fit:
    """x : numbers of a form;  covariance : of them;  sigma_K : of a test's mean about the law at the usual rise"""

    form: Form
    x: th.Array
    covariance: th.Array
    sigma_K: float
    log_evidence: float


def fitted(form: Form, tests: SteadyTests, parent: Fit | None = None) -> Fit:
    """The most probable numbers, and their evidence by Laplace's integral; over sigma it is exact (Jeffreys)."""
    y, w = tests.mean, tests.scatter(tests.mean)
    centre, sd = np.array([PRIORS[str(kind)] for kind, *_ in form.labels]).T
    free, earlier = READ_TESTS + y.size, dict(zip(parent.form.labels, parent.x, strict=True)) if parent else {}

    def state(x: th.Array) -> tuple[float, float, th.Array, th.Array]:
        """-ln(probability), sigma squared, its gradient and Hessian (Gauss and Newton)"""
        T, J = temperature(form, x, tests)
        J, left, off = J / w[:, None], (T - y) / w, (x - centre) / sd
        variance = (READ_TESTS * READ_K**2 + float(left @ left)) / free
        gradient, H = J.T @ left / variance + off / sd, J.T @ J / variance + np.diag(sd**-2)
        return 0.5 * free * np.log(variance) + 0.5 * float(off @ off), variance, gradient, H

    x, damping = np.array([earlier.get(label, c) for label, c in zip(form.labels, centre, strict=True)]), 1e-2
    cost, variance, gradient, H = state(x)
    for _ in range(ITERATIONS):
        trial = x - np.clip(np.linalg.solve(H + damping * np.diag(np.diag(H)), gradient), -1.0, 1.0)
        new = state(trial)
        if new[0] >= cost:
            damping *= 5.0
            continue
        fall, x, damping = cost - new[0], trial, 0.2 * damping
        cost, variance, gradient, H = new
        if fall < SMALLEST:
            break
    unbiased = free / max(free - x.size, 1.0)
    log_evidence = -cost - 0.5 * float(np.linalg.slogdet(H * sd[:, None] * sd)[1])
    return Fit(
        form, x, np.asarray(np.linalg.inv(H) * unbiased, float), float(np.sqrt(variance * unbiased)), log_evidence
    )


def searched(tests: SteadyTests, tell: Callable[[str], None] = lambda _: None) -> list[Fit]:
    """Forms that the readings do not exclude, the most probable first; one of them at least is small enough."""
    fits, parents = {form: fitted(form, tests) for form in simplest(tests)}, set[Form]()
    while leading := [f for f in _ordered(fits)[:LEADING] if f.form not in parents]:
        for parent in leading:
            parents.add(parent.form)
            for form in parent.form.larger(tests):
                if form not in fits and len(form.labels) <= min(MOST + 1, len(tests.heat) - 2):
                    fits[form] = fitted(form, tests, parent)
        tell(f"weighing forms of the law: {len(fits)}")
    # To follow these inputs is as probable as to follow those, in however many forms.
    alike = Counter(form.inputs for form in fits)
    every = _ordered({n: replace(f, log_evidence=f.log_evidence - np.log(alike[n.inputs])) for n, f in fits.items()})
    law = next(f for f in every if f.x.size <= MOST)
    return [f for f in every if f is law or f.log_evidence > every[0].log_evidence - NEGLIGIBLE]


def _ordered(fits: dict[Form, Fit]) -> list[Fit]:
    return sorted(fits.values(), key=lambda f: -f.log_evidence)
