"""What is different in a true machine from the one that was drawn: effects, conditions, faults of measurement."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from hidden.truth.body import Array, Body, Joint, Skeleton
from hidden.truth.machine import Inputs, Term

Terms = Callable[[Skeleton], tuple[Term, ...]]
Reading = Callable[[Array, Array, Array], Array]
Recorded = Callable[[Array, Array], Array]


def no_terms(skeleton: Skeleton) -> tuple[Term, ...]:
    return ()


@dataclass(frozen=True)
class Change:
    """factors : on drawn parameters;  bodies, joints, terms : more physics
    signals : what else drives the machine and nobody records, name -> (time in s) -> value
    readings : sensor -> what happens to its readings (time, T, ambient);  swaps : pairs of exchanged plugs
    shown : sensor -> what the logger makes of the finished readings, noise and steps included
    inputs : input -> what is written down of it (time, true value)
    driven : input -> what it truly is (time, value of the plan, which is what is written down)
    in_test : what is different in one test alone
    """

    factors: Mapping[str, float] = field(default_factory=dict)
    bodies: tuple[Body, ...] = ()
    joints: tuple[Joint, ...] = ()
    terms: Terms = no_terms
    signals: Mapping[str, Callable[[Array], Array]] = field(default_factory=dict)
    readings: Mapping[str, Reading] = field(default_factory=dict)
    swaps: tuple[tuple[str, str], ...] = ()
    inputs: Mapping[str, Recorded] = field(default_factory=dict)
    driven: Mapping[str, Recorded] = field(default_factory=dict)
    shown: Mapping[str, Callable[[Array], Array]] = field(default_factory=dict)
    in_test: "Mapping[str, Change]" = field(default_factory=dict)

    def __add__(self, other: "Change") -> "Change":
        factors = {k: self.factors.get(k, 1.0) * other.factors.get(k, 1.0) for k in {**self.factors, **other.factors}}
        return Change(
            factors,
            self.bodies + other.bodies,
            self.joints + other.joints,
            lambda s: self.terms(s) + other.terms(s),
            {**self.signals, **other.signals},
            {**self.readings, **other.readings},
            self.swaps + other.swaps,
            {**self.inputs, **other.inputs},
            {**self.driven, **other.driven},
            {**self.shown, **other.shown},
            {**self.in_test, **other.in_test},
        )

    @property
    def lasts(self) -> bool:
        """Can it hold for a while?  Heat, films and flows can, parts and their joints cannot."""
        return not (self.bodies or self.joints or self.factors)

    def during(self, test: str) -> "Change":
        """What is different while a test runs."""
        own = self.in_test.get(test)
        return self if own is None else replace(self, in_test={}) + own


NOTHING = Change()


@dataclass(frozen=True)
class Pulsed:
    """A term that acts as far as the signal `event` says (0 to 1)."""

    term: Term

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        if u["event"]:
            own = np.zeros_like(q)
            self.term.into(own, T, u)
            q += u["event"] * own


def only_in(test: str, change: Change) -> Change:
    return Change(in_test={test: change})


def for_a_while(test: str, change: Change, begin: float, end: float) -> Change:
    """Terms, signals and inputs of a change that act from `begin` to `end` (s) of one test."""
    inside = lambda time: (time >= begin) & (time < end)  # noqa: E731
    pulsed = lambda s: tuple(Pulsed(term) for term in change.terms(s))  # noqa: E731
    signals = {name: _within(inside, signal) for name, signal in change.signals.items()}
    driven = {name: _instead(inside, true) for name, true in change.driven.items()}
    event = {"event": lambda time: inside(time).astype(float)}
    return only_in(test, Change(terms=pulsed, signals={**signals, **event}, driven=driven))


def _within(inside: Callable[[Array], Array], signal: Callable[[Array], Array]) -> Callable[[Array], Array]:
    return lambda time: np.where(inside(time), signal(time), 0.0)


def _instead(inside: Callable[[Array], Array], true: Recorded) -> Recorded:
    return lambda time, planned: np.where(inside(time), true(time, planned), planned)
