"""Networks of other geometries, condensed anew on a coarse mesh: what they say beside the scaled network.

Both sides of a ratio are of the same mesh, so what is coarse about it cancels to first order.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from extras.rating.design.machine_keys import short_key
from extras.rating.optimisation.problem import COPPER, SETTLING, Problem
from extras.rating.optimisation.scaling import Scaling, design_parameters
from extras.rating.optimisation.space import Corrections, Variable, errors, learned
from extras.rating.points import hot_spots
from thermoscope import InputError, Network, plugin as th

HALVINGS = 6  # of the way to a bound; nearer, a variable says nothing
SIZE_M, ACROSS = 0.12, 0.5  # elements twice as large as those of a case; temperatures differ by 2 % of the rise


def coarse_network(machine: th.MachineDescription, progress: th.CaseProgress) -> Network:
    """Seconds; from the cache where it was made before."""
    ready = th.prepared(machine, SIZE_M, 48, progress, across=ACROSS)
    # fewer snapshots than a case's: enough to rank designs
    coarse = th.Recipe(tolerance=0.03, max_states=110, shifts=(1 / 20, 1 / 700), random_points=1)
    return th.motor_network(machine, th.reduced(ready, coarse).network(max_states=coarse.max_states))


class Condensations:
    """Ratios condensed / scaled of one problem, at any of its geometries."""

    def __init__(self, problem: Problem, progress: th.CaseProgress) -> None:
        self.problem, self.progress = problem, progress
        self.usual = problem.space.usual

    @cached_property
    def reference(self) -> Problem:
        """The problem on the coarse network of the reference, scaled."""
        assert self.problem.machine_at is not None
        machine = self.problem.machine_at(self.usual)
        self.progress("coarse network of the reference")
        bare = self._on(coarse_network(machine, self.progress))
        return replace(bare, scaling=Scaling(bare.network, machine))

    def _on(self, network: Network) -> Problem:
        larger = network.extended(parameters=design_parameters(network))
        rows = {n: p.mean for n, p in larger.places.items()}
        spots = hot_spots(larger, rows, {s.name: s.limit for s in self.problem.spots})
        inputs = {n: u for n, u in self.problem.inputs.items() if n in larger.inputs}
        from_machine = tuple(n for n in self.problem.from_machine if n in inputs)
        bare = replace(self.problem, values={}, scaling=None, sure=None)
        return replace(bare, network=larger, inputs=inputs, spots=spots, from_machine=from_machine)

    def ratios(self, design: Mapping[str, float]) -> dict[str, float]:
        """Quantity -> condensed over scaled, at values of the variables."""
        scaled = self.reference.judged(design)
        self.progress("network of " + ", ".join(f"{short_key(n)} {u:.4g}" for n, u in self._geometry(design)))
        condensed = self._on(coarse_network(self._machine(design), self.progress)).judged(design)
        around = float(np.mean(list(self.problem.boundaries.values())))
        out = {n: (T - around) / (scaled.places[n] - around) for n, T in condensed.places.items()}
        return out | {q: condensed.objectives[q] / scaled.objectives[q] for q in (COPPER, SETTLING)}

    def _machine(self, design: Mapping[str, float]) -> th.MachineDescription:
        """Of the geometry alone: films and streams follow the inputs, so that the cache serves every flow."""
        assert self.problem.machine_at is not None
        return self.problem.machine_at({**self.usual, **dict(self._geometry(design))})

    def _geometry(self, design: Mapping[str, float]) -> list[tuple[str, float]]:
        return [(v.name, design[v.name]) for v in self.problem.space.variables if v.conducts]

    def learn(self) -> Corrections:
        """One geometry per variable that changes conduction, at its bound that is further away.

        Where no machine can be built there, half as far, and so on.
        """
        points = [p for v in self.problem.space.variables if v.conducts and (p := self._far(v)) is not None]
        return learned([self.problem.space.share(p) for p in points], [self.ratios(p) for p in points])

    def _far(self, v: Variable) -> dict[str, float] | None:
        """A geometry with one variable far from the reference; None where none but the reference can be built."""
        assert self.problem.machine_at is not None
        far = v.high if v.high - v.usual > v.usual - v.low else v.low
        for halving in range(HALVINGS):
            value = v.usual + (far - v.usual) * 0.5**halving
            point = {**self.usual, v.name: float(round(value)) if v.whole else value}
            if point[v.name] == v.usual:
                break
            try:
                self.problem.machine_at(point)
            except InputError:
                continue
            return point
        return None

    def verified(self, designs: Sequence[Mapping[str, float]]) -> dict[str, float]:
        """Quantity -> the largest relative error of the interpolation at designs that it was not learned from."""
        space = self.problem.space
        return errors(self.problem.corrections, [space.share(d) for d in designs], [self.ratios(d) for d in designs])
