"""True parameters: lognormal around what the drawing says, each from its own random stream."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True)
class Draw:
    """factor(key, sd): the same number for the same seed and key; `times` multiplies some of them on top."""

    seed: int
    times: Mapping[str, float] = field(default_factory=dict)
    spread: float = 1.0

    def stream(self, key: str) -> np.random.Generator:
        return np.random.default_rng([self.seed, *key.encode()])

    def factor(self, key: str, sd: float) -> float:
        drawn = float(np.clip(self.stream(key).standard_normal(), -2.0, 2.0))
        return float(np.exp(self.spread * sd * drawn)) * self.times.get(key, 1.0)

    def capacity(self, key: str, value: float, sd: float = 0.05) -> float:
        return value * self.factor(f"capacity.{key}", sd)

    def conductance(self, key: str, value: float, sd: float = 0.25) -> float:
        return value * self.factor(key, sd)

    def between(self, key: str, low: float, high: float) -> float:
        return float(self.stream(key).uniform(low, high))


class Listing(Draw):
    """A draw that remembers what was asked for: parameter -> sd."""

    @property
    def asked(self) -> dict[str, float]:
        return self.__dict__.setdefault("_asked", {})

    def factor(self, key: str, sd: float) -> float:
        self.asked[key] = sd
        return super().factor(key, sd)
