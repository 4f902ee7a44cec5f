"""Many runs on a small network that agrees, where they begin, with the large one it stands for.

Every reading loses what the large network predicts above the small one at some values theta_0:

    r(theta) = y - y_small(theta) - [y_large(theta_0) - y_small(theta_0)]

At theta_0 the residuals are those of the large network. Away from it they miss how far the bracket changes, which is
the small network's error in what the parameters change; `fidelity_error` says how much that is.
Source: additive corrections between models of two fidelities, Kennedy and O'Hagan 2000, Biometrika 87, 1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from geom.arrays import Array
from lumped.model.network import Network
from measured.case import Case, Test
from validation.calibration.calibrate import calibrated, no_progress
from validation.comparison.predict import predict
from validation.inference.decide import Posterior
from validation.inference.evidence import with_members
from validation.parameters.unknowns import working
from validation.threads import side_by_side


def low_fidelity_case(case: Case, progress: Callable[[str], None] = no_progress) -> Case:
    """The case on its small network, corrected at the model's values; as it is where there is none.

    A model that was never calibrated is calibrated roughly first, and begins there, where the correction holds.
    """
    small = corrected(case, case.model.values)
    if small is case or case.model.values:
        return small
    training = small.training()
    network, unknowns = working(training)
    fit = calibrated(network, training.tests, unknowns, {}, 1, progress, rough=True)
    return corrected(replace(case, model=replace(case.model, values=fit.values)), fit.values)


def corrected(case: Case, values: Mapping[str, float]) -> Case:
    """The case on its small network, its readings corrected at some values; as it is where there is none."""
    small = case.small
    if small is case:
        return case
    large, less = (working(each)[0] for each in (case, small))
    gaps = _gaps(large, case.tests, less, small.tests, values)
    return replace(small, tests=tuple(_less(test, gap) for test, gap in zip(small.tests, gaps, strict=True)))


def fidelity_error(case: Case, small: Case, posterior: Posterior) -> dict[str, float]:
    """Channel -> how far (K) the small network's prediction of the most probable hypothesis is from the large one's.

    small : of `low_fidelity_case`, which the posterior is about; no error where that is the case itself
    """
    if small is case:
        return {}
    e, h = posterior.evidence, posterior.best
    network, _, fixed = with_members(e, h.members)
    values = {**fixed, **(h.fit.values if h.fit else e.fit.values)}
    large = e.hypothesis(h.members).extend(working(case)[0])
    by_name = {t.name: t for t in case.tests}
    tests = [by_name[t.name] for t in e.tests]
    out: dict[str, float] = {}
    for test, corrected_test, gap in zip(tests, e.tests, _gaps(large, tests, network, e.tests, values), strict=True):
        for j, (c, less) in enumerate(zip(test.channels, corrected_test.channels, strict=True)):
            off = float(np.nanmax(np.abs(gap[:, j] - (c.y - less.y)), initial=0.0))
            out[c.name] = max(out.get(c.name, 0.0), off)
    return out


def _gaps(
    large: Network, tests: Sequence[Test], small: Network, small_tests: Sequence[Test], values: Mapping[str, float]
) -> list[Array]:
    """What the large network predicts above the small one (n_time, n_channel) K, test by test."""

    def gap(pair: tuple[Test, Test]) -> Array:
        return predict(large, pair[0], values).y - predict(small, pair[1], values).y

    return side_by_side(gap, zip(tests, small_tests, strict=True), lambda pair: len(pair[0].time))


def _less(test: Test, gap: Array) -> Test:
    """The test with readings less `gap` (n_time, n_channel) K."""
    return replace(test, channels=tuple(replace(c, y=c.y - gap[:, j]) for j, c in enumerate(test.channels)))
