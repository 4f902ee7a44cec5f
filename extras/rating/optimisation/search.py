"""The Pareto set of a design problem, by methods of pymoo (Blank and Deb 2020).

NSGA-II (Deb et al. 2002) keeps what crowds least; U-NSGA-III (Seada and Deb 2016) keeps what lies close to even
directions. Constraints come first in both: of two designs the one that misses its limits by less is better.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from extras.rating.optimisation.problem import Performance, Problem
from thermoscope import InputError, MissingDependency, plugin as th

Method = Callable[[int, int, int], Any]
CHUNKS = 16  # tasks per generation on a cluster


@dataclass(frozen=True)
class Design:
    """x : point of the space;  performance : what it does"""

    x: th.Array
    performance: Performance


@dataclass(frozen=True)
class Effort:
    """How long to search: designs per generation, generations, seed of its chance."""

    population: int = 48
    generations: int = 30
    seed: int = 1


class StoppedSearchError(KeyboardInterrupt):
    """The user stopped a search.  designs : the best so far, that meet every limit;  judged : designs in all"""

    def __init__(self, designs: list[Design], judged: int) -> None:
        super().__init__()
        self.designs, self.judged = designs, judged


def nsga2(objectives: int, population: int, seed: int) -> Any:
    """NSGA-II. Any number of objectives."""
    from pymoo.algorithms.moo.nsga2 import NSGA2

    return NSGA2(pop_size=population)


def unsga3(objectives: int, population: int, seed: int) -> Any:
    """U-NSGA-III with as many even directions as designs (Riesz energy)."""
    from pymoo.algorithms.moo.unsga3 import UNSGA3
    from pymoo.util.ref_dirs import get_reference_directions

    directions = get_reference_directions("energy", objectives, population, seed=seed)
    return UNSGA3(directions, pop_size=population)


METHODS: dict[str, Method] = {"nsga2": nsga2, "unsga3": unsga3}


def pareto_set(
    problem: Problem,
    method: Method = nsga2,
    effort: Effort = Effort(),
    executor: Executor | None = None,
    progress: th.CaseProgress = lambda message: None,
) -> list[Design]:
    """Designs that meet every limit and that no other beats in all objectives, by rising peak temperature.

    executor : where designs are judged, such as a Dask cluster's; None: here

    Raises InputError where no design meets its limits, with the limit that the nearest one misses,
    MissingDependency without pymoo, and StoppedSearchError where the user stops it and some meet their limits.
    """
    try:
        import pymoo  # noqa: F401
    except ImportError:
        raise MissingDependency(
            "the package 'pymoo' is not installed: pip install 'thermoscope[optimise]' (or pip install pymoo)"
        ) from None
    archive: list[Design] = []
    posed = _posed(problem, archive, executor)
    algorithm = method(len(problem.aimed), effort.population, effort.seed)
    algorithm.setup(posed, termination=("n_gen", effort.generations), seed=effort.seed, verbose=False)
    try:
        for generation in range(1, effort.generations + 1):
            algorithm.next()
            progress(f"generation {generation} of {effort.generations}")
    except KeyboardInterrupt:
        if not any(design.performance.feasible for design in archive):
            raise
        raise StoppedSearchError(non_dominated(archive, problem), len(archive)) from None
    return non_dominated(archive, problem)


def _posed(problem: Problem, archive: list[Design], executor: Executor | None) -> Any:
    """The problem as pymoo wants it; every design that is judged goes to the archive."""
    from pymoo.core.problem import Problem as Posed

    space, limits = problem.space, problem.limits()

    class Judged(Posed):
        def __init__(self) -> None:
            low, high = np.transpose([(v.low, v.high) for v in space.variables])
            numbers = {"n_var": low.size, "n_obj": len(problem.aimed), "n_ieq_constr": len(limits)}
            super().__init__(**numbers, xl=low, xu=high)

        def _evaluate(self, X: th.Array, out: dict[str, th.Array], *args: Any, **others: Any) -> None:
            designs = judged(problem, X, executor)
            archive.extend(Design(x, p) for x, p in zip(X, designs, strict=True))
            out["F"] = np.array([[p.objectives[o] for o in problem.aimed] for p in designs])
            out["G"] = np.array([[p.excess.get(n, 0.0) for n in limits] for p in designs])

    return Judged()


def judged(problem: Problem, X: Sequence[th.Array] | th.Array, executor: Executor | None = None) -> list[Performance]:
    """What the designs X (n, k) do."""
    if executor is None:
        return [problem.of(x) for x in X]
    jobs = [executor.submit(_some, problem, part) for part in np.array_split(np.asarray(X), CHUNKS) if len(part)]
    return [p for job in jobs for p in job.result()]


def _some(problem: Problem, X: th.Array) -> list[Performance]:
    return [problem.of(x) for x in X]


def non_dominated(designs: Sequence[Design], problem: Problem) -> list[Design]:
    """Those that meet every limit and that none beats. Raises InputError where there is none."""
    able = [d for d in designs if d.performance.feasible]
    if not able:
        raise infeasible(designs)
    F = np.array([[d.performance.objectives[o] for o in problem.aimed] for d in able])
    best = [i for i, f in enumerate(F) if not np.any(np.all(f >= F, axis=1) & np.any(f > F, axis=1))]
    once = {tuple(F[i].round(9)): able[i] for i in best}
    return sorted(once.values(), key=lambda d: [d.performance.objectives[o] for o in problem.aimed])


def infeasible(designs: Sequence[Design]) -> InputError:
    """The design that misses its limits by least, and which limits these are."""
    fits = [d for d in designs if d.performance.objectives["peak_degC"] < 1e9]
    if not fits:
        return InputError(f"no design is possible: {designs[0].performance.why}", "--vary", "other bounds")
    nearest = min(fits, key=lambda d: sum(max(e, 0.0) for e in d.performance.excess.values()))
    excess = {n: e for n, e in nearest.performance.excess.items() if e > 0.0}
    worst = ", ".join(f"'{n}' by {100.0 * e:.3g} %" for n, e in sorted(excess.items(), key=lambda p: -p[1]))
    what = f"no design of {len(designs)} meets all limits: the nearest one exceeds {worst}"
    return InputError(what, "--limit", "less torque, a higher limit, or wider bounds (--vary NAME=LOW:HIGH)")
