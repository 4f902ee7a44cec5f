"""A small network that agrees, at some values of its parameters, with the large one it stands for.

Every reading loses what the large network predicts above the small one at some values theta_0:

    r(theta) = y - y_small(theta) - [y_large(theta_0) - y_small(theta_0)]

At theta_0 the residuals are those of the large network. Away from it they miss how far the bracket changes, which is
the small network's error in what the parameters change.
Source: additive corrections between models of two fidelities, Kennedy and O'Hagan 2000, Biometrika 87, 1.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from geom.arrays import Array
from lumped.model.network import Network
from measured.case import Case, Test
from validation.comparison.predict import predict
from validation.parameters.unknowns import working
from validation.threads import side_by_side


def corrected(case: Case, values: Mapping[str, float]) -> Case:
    """The case on its small network, its readings corrected at some values; as it is where there is none."""
    small = case.small
    if small is case:
        return case
    large, less = (working(each)[0] for each in (case, small))
    return replace(small, tests=corrected_tests(large, case.tests, less, small.tests, values))


def corrected_tests(
    large: Network, tests: Sequence[Test], small: Network, small_tests: Sequence[Test], values: Mapping[str, float]
) -> tuple[Test, ...]:
    """Tests as the small network looks at them, their readings corrected at some values."""
    gaps = reading_gaps(large, tests, small, small_tests, values)
    return tuple(_less(test, gap) for test, gap in zip(small_tests, gaps, strict=True))


def reading_gaps(
    large: Network, tests: Sequence[Test], small: Network, small_tests: Sequence[Test], values: Mapping[str, float]
) -> list[Array]:
    """What the large network predicts above the small one (n_time, n_channel) K, test by test."""

    def gap(pair: tuple[Test, Test]) -> Array:
        return predict(large, pair[0], values).y - predict(small, pair[1], values).y

    return side_by_side(gap, zip(tests, small_tests, strict=True), lambda pair: len(pair[0].time))


def _less(test: Test, gap: Array) -> Test:
    """The test with readings less `gap` (n_time, n_channel) K."""
    return replace(test, channels=tuple(replace(c, y=c.y - gap[:, j]) for j, c in enumerate(test.channels)))
