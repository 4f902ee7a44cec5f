"""What an optimisation may change, between which bounds, and what that does beyond a scaled network.

Ratios condensed / scaled of another geometry are learned at few geometries and interpolated between:

ratio(g) = exp(sum_i c_i share_i),  c_i = log(condensed / scaled) / share_i at one geometry per variable

They are of rises above the surroundings, of copper loss and of settling time. Their error is what further geometries
show that were not learned from.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from thermoscope import plugin as th


@dataclass(frozen=True)
class Variable:
    """A number of a machine file, a drive cycle or an operating point.

    name : its key with dots, geometry.jacket.height_mm, or an input of the network
    usual : what it is in the reference;  whole : takes integers only;  conducts : whether its change changes conduction
    """

    name: str
    low: float
    high: float
    usual: float
    whole: bool = False
    conducts: bool = False


@dataclass(frozen=True)
class Space:
    """All variables of an optimisation."""

    variables: tuple[Variable, ...]

    @property
    def usual(self) -> dict[str, float]:
        """Name -> its value in the reference."""
        return {v.name: v.usual for v in self.variables}

    def named(self, x: Sequence[float] | th.Array) -> dict[str, float]:
        """Name -> value; integers rounded."""
        return {v.name: float(round(u)) if v.whole else float(u) for v, u in zip(self.variables, x, strict=True)}

    def share(self, values: Mapping[str, float]) -> th.Array:
        """(k,) how far each variable that changes conduction is from the reference, in widths of its range."""
        conducting = [v for v in self.variables if v.conducts]
        return np.array([(values[v.name] - v.usual) / (v.high - v.low) for v in conducting])


@dataclass(frozen=True)
class Corrections:
    """slopes : quantity -> (k,) of log ratios, per share of every variable that changes conduction"""

    slopes: Mapping[str, th.Array] = field(default_factory=dict)

    def ratio(self, quantity: str, share: th.Array) -> float:
        """Condensed over scaled; 1 for what was not learned."""
        slope = self.slopes.get(quantity)
        return 1.0 if slope is None else float(np.exp(slope @ share))


NONE = Corrections()


def learned(shares: Sequence[th.Array], ratios: Sequence[Mapping[str, float]]) -> Corrections:
    """From geometries at `shares` (n, k), each with the ratio of every quantity there; least squares, least norm."""
    if not shares:
        return NONE
    X = np.array(shares)
    logs = {q: np.log([r[q] for r in ratios]) for q in ratios[0]}
    return Corrections({q: np.asarray(np.linalg.lstsq(X, y, rcond=None)[0], float) for q, y in logs.items()})


def errors(
    corrections: Corrections, shares: Sequence[th.Array], ratios: Sequence[Mapping[str, float]]
) -> dict[str, float]:
    """Quantity -> the largest relative error at geometries that were not learned from."""
    return {
        q: max(abs(corrections.ratio(q, s) / r[q] - 1.0) for s, r in zip(shares, ratios, strict=True))
        for q in (ratios[0] if ratios else {})
    }
