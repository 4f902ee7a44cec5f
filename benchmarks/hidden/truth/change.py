"""What is different in a true machine from the one that was drawn: hidden effects, faults of the measurement."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hidden.truth.body import Body, Joint, Skeleton
from hidden.truth.machine import Term

Array = NDArray[np.float64]
Terms = Callable[[Skeleton], tuple[Term, ...]]
Reading = Callable[[Array, Array, Array], Array]


def no_terms(skeleton: Skeleton) -> tuple[Term, ...]:
    return ()


@dataclass(frozen=True)
class Change:
    """factors : on drawn parameters;  bodies, joints, terms : more physics
    signals : what else drives the machine and nobody records, name -> (time in s) -> value
    readings : sensor -> what happens to its readings (time, T, ambient);  swaps : pairs of exchanged plugs
    shown : sensor -> what the logger makes of the finished readings, noise and steps included
    offsets : input -> how far (K) the recorded value lies above the true one
    """

    factors: Mapping[str, float] = field(default_factory=dict)
    bodies: tuple[Body, ...] = ()
    joints: tuple[Joint, ...] = ()
    terms: Terms = no_terms
    signals: Mapping[str, Callable[[Array], Array]] = field(default_factory=dict)
    readings: Mapping[str, Reading] = field(default_factory=dict)
    swaps: tuple[tuple[str, str], ...] = ()
    offsets: Mapping[str, float] = field(default_factory=dict)
    shown: Mapping[str, Callable[[Array], Array]] = field(default_factory=dict)

    def __add__(self, other: Change) -> Change:
        factors = {k: self.factors.get(k, 1.0) * other.factors.get(k, 1.0) for k in {**self.factors, **other.factors}}
        return Change(
            factors, self.bodies + other.bodies, self.joints + other.joints,
            lambda s: self.terms(s) + other.terms(s), {**self.signals, **other.signals},
            {**self.readings, **other.readings}, self.swaps + other.swaps, {**self.offsets, **other.offsets},
            {**self.shown, **other.shown},
        )  # fmt: skip


NOTHING = Change()
