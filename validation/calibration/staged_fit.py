"""Calibration in stages: an isolating test frees its own parameters, later tests take them as found."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase

import numpy as np

from geom.arrays import Numbers
from geom.errors import InputError
from lumped.model.multipliers import parameter_values
from lumped.model.network import Network, Parameter
from measured.case import Case, Test
from measured.sensors.operators import of_measurement, starts
from validation.calibration.calibrate import (
    CachedSegments,
    Fit,
    Keep,
    Progress,
    minimise,
    no_memory,
    no_progress,
    reading_fit,
    refitted,
)
from validation.comparison.linearisation import segments
from validation.comparison.reading_correction import corrected_tests
from validation.noise import FOLLOWED, fit_noise
from validation.parameters.unknowns import Unknowns, measured, sorted_unknowns, working

SAME = 0.5  # nats: two starts that end this close have found the same optimum


@dataclass(frozen=True)
class Stage:
    """Tests that are fitted together and the names of the parameters that are free then."""

    tests: tuple[Test, ...]
    free: frozenset[str]


@dataclass(frozen=True)
class Search:
    """How a fit looks for its optimum.

    starts : how many, the first where the model stands, the others drawn from the prior with `seed`
    begin : values of an interrupted fit, to go on from;  keep : told the values after every step
    """

    starts: int = 1
    seed: int = 0
    begin: Numbers = field(default_factory=dict)
    keep: Keep = no_memory


def fit_stages(case: Case, tests: Sequence[Test], unknowns: Unknowns) -> list[Stage]:
    """One stage per test that frees something, in the case's order, then one for all the others and what is left."""
    left, out = {p.name for p in unknowns.parameters if not of_measurement(p)}, []
    for test in tests:
        if test.frees:
            names = {n for n in left if any(belongs(n, g) for g in _freed_groups(case, test, left))}
            out.append(Stage((test,), frozenset(names)))
            left -= names
    together = tuple(t for t in tests if not t.frees)
    return [*out, Stage(together, frozenset(left))] if together else out


def _freed_groups(case: Case, test: Test, remaining: set[str]) -> tuple[str, ...]:
    for pattern in test.frees:
        if not any(belongs(n, pattern) for n in remaining):
            right = f"free and not freed by an earlier test: {', '.join(sorted(remaining))}"
            raise InputError(f"'{pattern}' frees nothing", f"case '{case.name}' test '{test.name}'", right)
    return test.frees


def belongs(name: str, pattern: str) -> bool:
    """Does a parameter, or the one whose form or share it is ("h^speed", "h:flange"), match a glob?"""
    return any(fnmatchcase(n, pattern) for n in (name, name.split("^")[0], name.split(":")[0]))


def staged_fit(
    case: Case, tests: Sequence[Test], start: Numbers, search: Search | None = None, progress: Progress = no_progress
) -> list[Fit]:
    """The case's free parameters fitted to some tests, stage after stage; the fit of each.

    A model that stands is not far from its next fit, so that where there is a small network, that one is fitted. The
    first calibration goes too far for a correction at its start.
    """
    network, unknowns = working(case)
    corrected = case.small is not case and bool(case.model.values)
    search = search or Search()
    values, fits, effects = {**start, **search.begin}, [], {e.name for e in case.model.effects}
    for stage in fit_stages(case, tests, unknowns):
        names = {p.name for p in unknowns.parameters if p.name in stage.free or measured_in(p, stage.tests)}
        free = Unknowns(tuple(p for p in unknowns.parameters if p.name in names))
        best = best_start(network, stage.tests, free, values, search, progress) if search.starts > 1 else values
        if corrected:
            fit = multifidelity_fit(case, stage.tests, free, best, effects, progress, search.keep)
        else:
            fit = reading_fit(network, stage.tests, free, best, effects, progress, search.keep)
        fits.append(fit)
        values |= fit.values
    return fits


def multifidelity_fit(
    case: Case,
    tests: Sequence[Test],
    unknowns: Unknowns,
    values: Numbers,
    effects: Collection[str],
    progress: Progress,
    keep: Keep,
) -> Fit:
    """What `reading_fit` finds on the small network of a case, its readings corrected at the start and at the end.

    Residuals and Jacobian are those of the large network there.
    """
    (network, _), (small, _) = working(case), working(case.small)
    small_tests, now = replace(case, tests=tuple(tests)).small.tests, dict(values)
    near = corrected_tests(network, tests, small, small_tests, now)
    draft = reading_fit(small, near, unknowns, now, effects, progress, keep)
    now |= draft.values
    now |= refitted(draft, corrected_tests(network, tests, small, small_tests, now), now, effects)
    fixed, theta = parameter_values(network, now), unknowns.coordinates(now)
    parts = segments(network, tests, fixed, unknowns.parameters)
    cache = CachedSegments(parts, nearby=False)
    whole = minimise(network, tests, unknowns, theta, fit_noise(parts), fixed, 0, cache)
    return replace(whole, converged=draft.converged, gradient=draft.gradient)


def measured_in(p: Parameter, tests: Sequence[Test]) -> bool:
    """Does a nuisance of the measurement concern one of these tests? An effect on it, such as two plugs exchanged,
    concerns all of them."""
    ends = (
        {t.name for t in tests} | {c.name for t in tests for c in t.channels} | {b for t in tests for b in t.boundaries}
    )
    target = p.targets[0][0]
    if not of_measurement(p) or not measured(p.name):
        return of_measurement(p)
    return bool(target.split(":", 1)[1] in ends or any(starts(target, t.name) for t in tests))


def best_start(
    network: Network, tests: Sequence[Test], unknowns: Unknowns, values: Numbers, search: Search, progress: Progress
) -> dict[str, float]:
    """Rough fits from several points of the prior; the values of the best."""
    rng, fixed = np.random.default_rng(search.seed), parameter_values(network, values)
    _, free, _ = sorted_unknowns(unknowns, ())
    first = free.coordinates(values)
    points = [first, *(free.sd * rng.standard_normal(first.size) for _ in range(search.starts - 1))]
    fits = [minimise(network, tests, free, x, FOLLOWED, fixed, draft=True, progress=progress) for x in points]
    alike = sum(f.objective < min(g.objective for g in fits) + SAME for f in fits)
    progress(f"{alike} of {len(fits)} starts end at the same optimum")
    return {**values, **min(fits, key=lambda f: f.objective).values}


def merged(fits: Sequence[Fit], row: Callable[[Fit], Sequence]) -> list:
    """Rows of all stages by their name; a later stage's word counts."""
    rows = {r.name: r for fit in fits for r in row(fit)}
    return list(rows.values())
