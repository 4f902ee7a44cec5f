"""Many runs on a small network that agrees, where they begin, with the large one it stands for.

Every reading loses what the large network predicts above the small one at some values theta_0:

    r(theta) = y - y_small(theta) - [y_large(theta_0) - y_small(theta_0)]

At theta_0 the residuals are those of the large network; away from it they miss the change of the bracket, which is the
small network's error in what the parameters change. Source: additive corrections of multi-fidelity optimisation,
Alexandrov and others 2001, J. Aircraft 38, 1093.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from validation.calibration.calibrate import calibrated, no_progress
from validation.calibration.unknowns import working
from validation.case import Case, LowFidelity, Test
from validation.comparison.predict import predict

Array = NDArray[np.float64]


def at_low_fidelity(case: Case, progress: Callable[[str], None] = no_progress) -> Case:
    """The case on its small network, corrected at the model's values; as it is where there is none.

    A model that was never calibrated is calibrated roughly first, and begins there, where the correction holds.
    """
    if not usable(case):
        return case
    small = corrected(case, case.model.values)
    if case.model.values:
        return small
    network, unknowns = working(small)
    fit = calibrated(network, small.training().tests, unknowns, {}, 1, progress, rough=True)
    return corrected(replace(case, model=replace(case.model, values=fit.values)), fit.values)


def usable(case: Case) -> bool:
    """Whether the case has a small network of the one it stands on, which knows all its sensors."""
    low = case.low
    known = low is not None and all((t.name, c.name) in low.rows for t in case.tests for c in t.channels)
    return known and low is not None and low.of is case.model.network


def corrected(case: Case, values: Mapping[str, float]) -> Case:
    """The case on its small network, its readings corrected at some values."""
    assert case.low is not None
    low = case.low
    small = replace(case, model=replace(case.model, network=low.network), low=None,
                    tests=tuple(_seen_by(low, test) for test in case.tests))  # fmt: skip
    large_network, small_network = working(case)[0], working(small)[0]
    gaps = [
        predict(large_network, test, values).y - predict(small_network, own, values).y
        for test, own in zip(case.tests, small.tests, strict=True)
    ]
    tests = tuple(_less(test, gap) for test, gap in zip(small.tests, gaps, strict=True))
    return replace(small, tests=tests)


def _seen_by(low: LowFidelity, test: Test) -> Test:
    return replace(test, channels=tuple(replace(c, row=low.rows[test.name, c.name]) for c in test.channels))


def _less(test: Test, gap: Array) -> Test:
    """The test with readings less `gap` (n_time, n_channel) K."""
    return replace(test, channels=tuple(replace(c, y=c.y - gap[:, j]) for j, c in enumerate(test.channels)))
