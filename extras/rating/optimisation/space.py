"""What an optimisation may change, between which bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

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
    def low(self) -> th.Array:
        return np.array([v.low for v in self.variables])

    @property
    def high(self) -> th.Array:
        return np.array([v.high for v in self.variables])

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
