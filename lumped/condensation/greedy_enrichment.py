"""From a wish to a network: favour the parts that miss, look at new random points, learn those before them, repeat."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lumped.condensation.reduction import FullPoint, Reduction
from lumped.condensation.reduction_error import Accuracy, Errors, LoadCases, merged, point_errors
from lumped.model.network import Network

Tell = Callable[[str], None]
FAVOURS = 6  # times the shapes are dealt out anew before new solutions are asked for
MARGIN = 0.5  # points already learned from are met this much better than wished, because new ones are not
RESERVE = 0.7  # a size is good enough when the points it is checked at use up no more than this of the wish
STRONGEST = 4.0  # a part's favour grows at most by this at a time


@dataclass(frozen=True)
class Check:
    """A point where networks are compared with the field: T (n, n_case) of the load cases, in single precision as
    solutions are; the rest as of a point."""

    films: Mapping[str, float]
    contacts: Mapping[str, float]
    T: NDArray[np.floating]
    shift: float


def checks(points: Sequence[FullPoint], cases: LoadCases) -> list[Check]:
    """What is asked of a network at points that are solved, in a sixth of their memory."""
    return [Check(p.films, p.contacts, cases.of_field(p.X).astype(np.float32), p.shift) for p in points]


@dataclass(frozen=True)
class Round:
    """One look at fresh points: what the network missed, before anything was learned from them."""

    states: int
    points: tuple[str, ...]
    errors: Errors
    met: bool

    def document(self) -> dict[str, Any]:
        return {"states": self.states, "points": list(self.points), "met": self.met, "random": self.errors.document()}


@dataclass(frozen=True)
class Enrichment:
    """weights : favour of each part;  rounds : of checks, in order"""

    network: Network
    weights: Mapping[str, float]
    rounds: tuple[Round, ...] = field(default=())

    @property
    def met(self) -> bool:
        return bool(self.rounds) and self.rounds[-1].met


@dataclass(frozen=True)
class Size:
    """A network of a given size: errors at the nominal coefficients, and the worst of several random ones.

    requested : largest number of states, 0: the means only;  met : with a reserve for points that were not looked at
    """

    requested: int
    network: Network
    nominal: Errors
    random: Errors
    met: bool

    @classmethod
    def of(
        cls, reduction: Reduction, requested: int, points: Sequence[Check], cases: LoadCases, accuracy: Accuracy
    ) -> "Size":
        """points : the nominal one first, then random ones"""
        network = reduction.network(tolerance=0.0, max_states=max(requested, len(reduction.field.blocks)))
        nominal, *others = errors_at(points, reduction, network, cases)
        random = merged(others)
        most = max(excess(nominal, accuracy), excess(random, accuracy))
        return cls(requested, network, nominal, random, most <= RESERVE)

    def document(self) -> dict[str, Any]:
        return {
            "asked": self.requested,
            "states": len(self.network.states),
            "met": self.met,
            "nominal": self.nominal.document(),
            "random": self.random.document(),
        }


def enrich(
    reduction: Reduction,
    cases: LoadCases,
    accuracy: Accuracy,
    rounds: int = 3,
    learned: Sequence[Check] = (),
    guides: Sequence[FullPoint] = (),
    fresh: int = 3,
    tell: Tell = lambda message: None,
) -> Enrichment:
    """A network that meets the wish at random points it has not seen, or the one the last of `rounds` looked at.

    reduction : learns what is missed;  learned : points that are among its snapshots;  guides : random ones, solved too
    fresh : random points per round, the first one soon after a step of loss, too; those that were missed guide the
        next, and are learned after it with an extreme one
    """
    weights: dict[str, float] = {}
    first = len(learned) + len(guides)
    met = list(learned) or checks(reduction.solved([reduction.nominal_point()]), cases)
    history: list[Round] = []
    for k in range(rounds):
        # Shapes are dealt out by guides, points that were not learned: those that were are met by very few.
        network = allotted_shapes(reduction, [*met, *checks(guides, cases)], cases, accuracy, weights)
        guides = guides if k < rounds - 1 else ()  # after the last round nothing is learned
        seeds = range(first + fresh * k, first + fresh * (k + 1))
        new = reduction.solved([*map(reduction.random_point, seeds), reduction.early_point(seeds[0])])
        errors = merged(errors_at(checks(new, cases), reduction, network, cases))
        history.append(Round(len(network.states), tuple(p.name for p in new), errors, excess(errors, accuracy) <= 1.0))
        tell(f"error with {len(network.states)} states: {errors}")
        if history[-1].met or k == rounds - 1:
            break
        fuller = [*guides, *reduction.solved([reduction.extreme_point(first + k)])]
        met, guides = [*met, *checks(fuller, cases)], new
        reduction.learn(fuller)
        del fuller  # what was learned is let go before the next points are solved
    return Enrichment(network, dict(weights), tuple(history))


def excess(errors: Errors, accuracy: Accuracy) -> float:
    """1 where the worst part is just good enough."""
    return max(map(accuracy.excess, errors.parts.values()))


def allotted_shapes(
    reduction: Reduction, learned: Sequence[Check], cases: LoadCases, accuracy: Accuracy, weights: dict[str, float]
) -> Network:
    """Deal out shapes until the points already solved are met: parts that miss get more."""
    network, previous = reduction.network(weights=weights), None
    for _ in range(FAVOURS):
        if network is not previous:
            errors, previous = merged(errors_at(learned, reduction, network, cases)), network
        missing = {part: accuracy.excess(e) for part, e in errors.parts.items() if accuracy.excess(e) > MARGIN}
        if not missing:
            break
        for part, excess in missing.items():
            weights[part] = weights.get(part, 1.0) * min(max(excess / MARGIN, 1.3), STRONGEST)
        network = reduction.network(weights=weights)
    return network


def errors_at(points: Sequence[Check], reduction: Reduction, network: Network, cases: LoadCases) -> list[Errors]:
    """Of the network at every point, in two processes where there is room."""
    return reduction.solver.each(lambda _, p: point_errors(network, p.films, p.contacts, p.T, cases, p.shift), points)
