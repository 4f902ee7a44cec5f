"""How much current a planned test may have: by the model, it makes no place hotter than the tests at hand made it.

Nobody knows yet what the machine bears beyond. Each place is held against its own hottest mean, for a magnet or a
bearing does not bear what a winding does. Below BEARABLE_C that tells nothing about a place, and only the hottest place
of the machine counts. Fluids bear all. Means are compared, not hot spots: inside a part both rise with the same heat.

All currents of a test come down by one factor, never up. So do those of a test that changes no current: with the
ambient raised by 20 K, or half the flow, the record alone would make the machine hotter than it was. A test that is too
hot even without current is none to ask for. A machine without currents has nothing to bring down: its tests stay as
they are.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from geom.arrays import Array
from geom.errors import NoSolution
from lumped.integration.compiled import Precision
from lumped.integration.simulate import simulate
from lumped.model.network import Network, Row
from lumped.model.sites import solids
from measured.case import Test
from validation.comparison.predict import heat_model, record
from validation.inference.result import CurrentLevel
from validation.planning.candidate_tests import Experiment, candidate_tests, inputs_measuring
from validation.threads import side_by_side

BEARABLE_C = 80.0  # what the least of a machine bears: magnets without a suffix (80), class Y insulation (90)
MARGIN = 0.01  # of the rise that currents may make: the search ends at most so far below the limit
TRIALS = 8  # runs of a search at most; two or three do
COARSE = Precision(5e-2, 5e-4, False)  # a twentieth of a kelvin, where MARGIN is half of one


@dataclass(frozen=True)
class HeatLimits:
    """What each solid of a machine has borne in the tests at hand, by a model.

    network, values : of heat alone;  rows : of the solids' means;  limits (n_solid,) degC
    """

    network: Network
    values: Mapping[str, float]
    rows: Sequence[Row]
    limits: Array

    def excess(self, test: Test) -> Array:
        """(n_solid,) by how much (K) a test makes each hotter than its limit; infinite where the model runs away."""
        try:
            return _hottest(self.network, self.values, self.rows, test) - self.limits
        except NoSolution:  # the model lacks what cools it; with less current it may stand
            return np.full(self.limits.size, np.inf)


def heat_limits(network: Network, values: Mapping[str, float], tests: Sequence[Test]) -> HeatLimits:
    """By a calibrated model over the tests at hand."""
    bare, heat = heat_model(network, values)
    rows = [place.mean for place in solids(bare)]
    each = np.max(side_by_side(lambda test: _hottest(bare, heat, rows, test), tests), axis=0)
    return HeatLimits(bare, heat, rows, np.minimum(np.max(each), np.maximum(each, BEARABLE_C)))


def _hottest(network: Network, values: Mapping[str, float], rows: Sequence[Row], test: Test) -> Array:
    return np.asarray(simulate(network, record(test, {}), values, rows, precision=COARSE).y.max(axis=0))


def permissible_tests(
    test: Test, network: Network, models: Sequence[HeatLimits], only: str | None = None
) -> list[tuple[Experiment, Test]]:
    """The candidate tests with currents that every model permits; those that no current makes cool enough are left out.

    test : at hand, from which they are made;  only : the name of one, None for all
    """
    names = inputs_measuring(network, test.inputs, "current")
    candidates = [(e, plan) for e, plan in candidate_tests(test, network) if only in (None, e.name)]
    factors = side_by_side(lambda one: _factor(one[1], names, models), candidates, lambda one: one[1].time.size)
    return [
        (replace(e, current_factor=factor), plan.scaled(dict.fromkeys(names, factor)))
        for (e, plan), factor in zip(candidates, factors, strict=True)
        if factor is not None
    ]


def _factor(plan: Test, names: Sequence[str], models: Sequence[HeatLimits]) -> float | None:
    """Each model after the other: most plans stay below the next one's limits with what the ones before permit."""
    factor = 1.0
    for model in models if names else ():
        share = permissible_factor(partial(_excess_at, model, plan.scaled(dict.fromkeys(names, factor)), names))
        if share is None:
            return None
        factor *= share
    return factor


def _excess_at(model: HeatLimits, plan: Test, names: Sequence[str], factor: float) -> Array:
    return model.excess(plan.scaled(dict.fromkeys(names, factor)))


def permissible_factor(excess: Callable[[float], Array]) -> float | None:
    """The largest factor up to 1 on currents at which no excess (n,) K, each growing with the factor, is above zero.

    None where one is above zero even without current. Copper loss goes with the square of the current, and so, nearly,
    does each excess: secants in that square, the first that crosses counts, between a square that is permitted and one
    that is not.
    """
    runs = [(1.0, excess(1.0))]
    if np.max(runs[0][1]) <= 0.0:
        return 1.0
    runs.append((0.0, excess(0.0)))
    margin = -MARGIN * float(np.max(runs[1][1]))
    if margin < 0.0:
        return None
    low, high = 0.0, 1.0
    for _ in range(TRIALS):
        target = -0.5 * margin
        (a, f), (b, g) = sorted(runs, key=lambda run: abs(float(np.max(run[1])) - target))[:2]
        rising = (g - f) / (b - a)
        grows = np.isfinite(rising) & (rising > 0.0)
        square = float(np.min(a + (target - f[grows]) / rising[grows], initial=np.inf))
        square = square if low < square < high else 0.5 * (low + high)
        runs.append((square, excess(float(np.sqrt(square)))))
        over = float(np.max(runs[-1][1]))
        if -margin <= over <= 0.0:
            return float(np.sqrt(square))
        low, high = (square, high) if over < 0.0 else (low, square)
    return float(np.sqrt(low))


def current_levels(plan: Test, before: Test, network: Network) -> tuple[CurrentLevel, ...]:
    """What the currents of a planned test amount to, beside the test it was made from; those that never flow left out.

    Where a current is held, or switched, that is its level; else the rms of one turn of the record that is driven.
    """
    turn = before.time.size
    levels = {name: _level(plan.inputs[name], turn) for name in inputs_measuring(network, plan.inputs, "current")}
    rms = {name: float(np.sqrt(np.mean(np.asarray(before.inputs[name], float) ** 2))) for name in levels}
    return tuple(CurrentLevel(name, level, level / rms[name]) for name, level in levels.items() if level and rms[name])


def _level(current: Array, turn: int) -> float:
    flowing = np.abs(current[current != 0.0])
    even = flowing.size > 0 and np.ptp(flowing) <= 1e-9 * flowing.max()
    return float(flowing.max()) if even else float(np.sqrt(np.mean(current[:turn] ** 2)))
