"""What small amplitudes of hypotheses do to the readings about a fitted state: columns of the linear model.

Tangents come from one run of every test; exchanged plugs and large amplitudes, which tangents misjudge, from finite
differences.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import permutations
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from geom.arrays import Array
from lumped.model.multipliers import parameter_values
from lumped.model.network import Network, Parameter
from measured.case import Test
from validation.comparison.linearisation import Segment, segments
from validation.effects.base import Effect
from validation.effects.during import During
from validation.effects.registry import extended

if TYPE_CHECKING:
    from validation.calibration.calibrate import Fit


class WithColumns(Protocol):
    """Anything that says what its amplitudes do to the readings."""

    def columns(self, run: "Linearised") -> Sequence[Array]:
        """(n_reading, n_amplitude) K per unit, for each segment of the run."""
        ...


@dataclass(frozen=True)
class Linearised:
    """A fitted state and what hypotheses do to the readings about it.

    parts : segments of the fit, r (n_reading,) K and J (n_reading, p) K per unit of each calibrated parameter
    tangents : name of a hypothesis -> for each segment (n_reading, n_amplitude) K per unit of its amplitudes
    """

    parts: tuple[Segment, ...]
    tangents: Mapping[str, Sequence[Array]]

    def segments(self, hypotheses: Iterable[WithColumns]) -> tuple[Segment, ...]:
        """The segments with the columns of some hypotheses behind the calibrated parameters' own."""
        blocks = [h.columns(self) for h in hypotheses]
        return tuple(replace(s, J=np.column_stack([s.J, *(b[i] for b in blocks)])) for i, s in enumerate(self.parts))


def split_columns(parts: Sequence[Segment], p: int, names: Sequence[str]) -> Linearised:
    """Segments whose J has p calibrated parameters and then a column for each name, as a linearised run."""
    tangents = {name: [s.J[:, p + k : p + k + 1] for s in parts] for k, name in enumerate(names)}
    return Linearised(tuple(replace(s, J=s.J[:, :p]) for s in parts), tangents)


def amplitudes(network: Network, effects: Sequence[Effect]) -> tuple[Parameter, ...]:
    """The parameter that each effect brings into a network, in their order."""
    return extended(network, effects).parameters[len(network.parameters) :]


def effect_columns(
    fit: "Fit", tests: Sequence[Test], effects: Sequence[Effect], values: Mapping[str, float]
) -> list[Segment]:
    """Segments of a fit with one more column (K per unit) for each of some effects.

    Parameters: `tests` of which only those are run in which an effect can act; `values` of what is not calibrated.
    """
    acting, J = {t.name: tuple(k for k, e in enumerate(effects) if can_act(e, t)) for t in tests}, dict[Any, Array]()
    for some in filter(
        None, dict.fromkeys(acting.values())
    ):  # what cannot act in a test would be run there all the same
        network = extended(fit.network, [effects[k] for k in some])
        state = {**parameter_values(network, values), **fit.values}
        here = [t for t in tests if acting[t.name] == some]
        for s in segments(network, here, state, network.parameters[-len(some) :]):
            J[s.test, s.channel] = np.zeros((s.r.size, len(effects)))
            J[s.test, s.channel][:, some] = s.J
    K = len(effects)
    return [replace(s, J=np.hstack([s.J, J.get((s.test, s.channel), np.zeros((s.r.size, K)))])) for s in fit.parts]


def can_act(effect: Effect, test: Test) -> bool:
    """Can the effect act in the test?  What an input says may be in any."""
    return not isinstance(effect, During) or effect.can_act(test.name) or effect.condition in test.inputs


def exchange_columns(
    parts: Sequence[Segment], effects: Sequence[Effect], columns: Sequence[Sequence[Array]]
) -> list[list[Array]]:
    """Columns of exchanged plugs from what was read (y_1 - y_2) instead of what is predicted (T_2 - T_1).

    A model calibrated to exchanged readings has both places at nearly one temperature, so that exchanging its
    predictions would change little; the readings themselves can be exchanged exactly.

    Parameters: `parts` segments with the residual r; `columns` of each effect, for each segment (n, 1) K per unit.
    Returns: the columns, those of all-or-nothing effects replaced.
    """
    index = {(s.test, s.channel): i for i, s in enumerate(parts)}
    out = [list(each) for each in columns]
    for k, effect in enumerate(effects):
        for a, b in permutations(effect.place.split("|"), 2) if effect.whole else ():
            for i, s in enumerate(parts):
                if s.channel == a and (s.test, b) in index:
                    other = parts[index[s.test, b]]
                    out[k][i] = (s.r - np.interp(s.time, other.time, other.r))[:, None] - out[k][i]
    return out


def finite_change(
    network: Network, tests: Sequence[Test], parts: Sequence[Segment], effect: Effect, values: Mapping[str, float]
) -> list[Array]:
    """For each segment (n, 1) what an effect does to it (K) at an amplitude of its own; a clock is of its own test."""
    acting = [t for t in tests if t.name == effect.place] or tests
    new = {(s.test, s.channel): s.r for s in segments(network, acting, values)}
    return [(s.r - new.get((s.test, s.channel), s.r))[:, None] for s in parts]
