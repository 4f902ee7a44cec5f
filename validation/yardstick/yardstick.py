"""How good could a model be from these inputs? Three plain models that know little or no physics say so.

What may be fitted teaches them; what is held out is predicted by them once and has no say. Their choices (window,
powers, ridge) are made by leaving out each test in turn, or each third of the only one.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial, wraps
from itertools import pairwise, product
from typing import Any, Protocol, TypeVar

import numpy as np

from geom.arrays import Array
from geom.one_thread import one_blas_thread
from lumped.model.network import Network
from lumped.model.once import once
from measured.case import Case
from measured.sensors.faults import broken_channels, without
from validation.yardstick.black_box import BlackBoxLessons
from validation.yardstick.free_network import Form, FreeNetwork, NetworkLessons, Shape
from validation.yardstick.records import Columns, Folds, Record, row_step, table_columns, table_record
from validation.yardstick.terms import Term, needed_terms

WINDOWS = (1 / 200, 1 / 40, 1 / 13, 2 / 9)  # of a test: short ones drown in noise, long ones in what happens in them
LINE, SQUARE = (1.0, 0.0), (2.0, 0.0)
# Of an input that a link follows: not at all, as films in ducts do, as fans work
POWERS = ((), (LINE,), (LINE, SQUARE))
# In place of a line: two regimes too
SHAPES = (((0.5, 0.0),), (SQUARE,), ((1.0, 0.25),), ((1.0, 0.5),), ((1.0, 0.75),))
RIDGES = (1e-9, 1e-6, 1e-4, 1e-2)  # over the diagonal: from none to one that shrinks all but what is plain
THIRDS = 3  # stretches of the only test: two teach, one is predicted
MOST_FOLDS = 12  # of many tests so many shares are left out in turn: each fit costs as much as that many tests
FEWEST = 12  # rows of a record: with fewer not even a window of one row says anything
KINDS = ("persistence", "black_box", "free_network")


class Plain(Protocol):
    """A model with no machine in it."""

    def run(self, record: Record) -> Array:
        """(n, n_sensor) degC, from the first reading of each sensor on."""
        ...


Fitter = Callable[[Sequence[int]], Plain]  # from the numbers of the records that teach it
R = TypeVar("R")


@once
def _memory(network: Network) -> dict[tuple[Any, ...], tuple[Any, Any]]:
    """What was learnt from tests of a network, with these tests."""
    return {}


def once_for_tests(work: Callable[[Case], R]) -> Callable[[Case], R]:
    """`work` of a case's tests and declared network, done once for the same ones: no effect or value changes it."""

    @wraps(work)
    def remembered(case: Case) -> R:
        memory, key = _memory(case.model.network), (work, *map(id, case.tests))
        if key not in memory:
            memory[key] = case.tests, work(case)
        return memory[key][1]  # type: ignore[no-any-return]

    return remembered


@dataclass(frozen=True)
class Yardstick:
    """What the plain models leave (K rms), by kind, KINDS.

    left_out : over the tests a fit may use, each predicted from the others;  hold_out : over the held-out tests
    tests : test -> kind -> K;  sensors : sensor -> kind -> K, over the tests that `errors` speaks of
    terms : what the free network needs
    """

    left_out: Mapping[str, float]
    hold_out: Mapping[str, float] = field(default_factory=dict)
    tests: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    sensors: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    terms: tuple[Term, ...] = ()

    @property
    def errors(self) -> Mapping[str, float]:
        """The errors to hold a model's against: of the held-out tests where there are any."""
        return self.hold_out or self.left_out

    @property
    def best_K(self) -> float:
        """The least of these errors (K); NaN where all ran away."""
        return min(filter(np.isfinite, self.errors.values()), default=float("nan"))

    def document(self) -> dict:
        """As `yardstick` in the document of a comparison."""
        return {
            **_errors_in({**self.errors, "best": self.best_K}),
            "over": "hold-out" if self.hold_out else "left out in turn",
            "left_out": _errors_in(self.left_out),
            "tests": [{"name": name, **_errors_in(of)} for name, of in self.tests.items()],
            "sensors": [{"channel": name, **_errors_in(of)} for name, of in self.sensors.items()],
            "terms": [term.document() for term in self.terms],
        }


def _errors_in(of: Mapping[str, float]) -> dict[str, float | None]:
    """Errors by kind, for a document; one that ran away is None."""
    return {f"{kind}_K": error if np.isfinite(error) else None for kind, error in of.items()}


@once_for_tests
@one_blas_thread
def yardstick(case: Case) -> Yardstick | None:
    """The plain models of a case; None where nothing can be learnt: no sensor, no test to fit, or too few rows."""
    prepared = folds_of(case)
    if prepared is None:
        return None
    folds, columns = prepared
    alone = _free_network(replace(case, tests=case.usable))
    every = columns.inputs, columns.boundaries, *columns.steady
    same = alone and (alone[1].inputs, alone[1].boundaries, *alone[1].steady) == every
    step = row_step(case.usable, columns)
    records = [r for fold in folds for r in fold]
    unseen = [table_record(t, columns, step) for t in _sound(case).tests if t.role == "hold-out"]
    unseen = [r for r in unseen if r.read.any()]  # one of other sensors says nothing about these
    which = {
        "persistence": _best(_persistences(folds, columns), folds),
        "black_box": _best(_black_boxes(folds, columns), folds),
        "free_network": alone[2] if alone and same else _best(_free_networks(folds, columns), folds),
    }
    models = {kind: fit(range(len(folds))) for kind, (fit, _) in which.items()}
    errors = {kind: [*left, *(error_of(models[kind], r) for r in unseen)] for kind, (_, left) in which.items()}

    def pooled(rows: Sequence[int], columns: Sequence[int] | slice = slice(None)) -> dict[str, float]:
        steps = [(*records, *unseen)[i].step for i in rows]
        return {kind: rms([of[i][:, columns] for i in rows], steps) for kind, of in errors.items()}

    names = [r.name for r in (*records, *unseen)]
    learnt, unseen_numbers = range(len(records)), range(len(records), len(names))
    scope = unseen_numbers or learnt
    return Yardstick(
        left_out=pooled(learnt),
        hold_out=pooled(unseen_numbers) if unseen_numbers else {},
        tests={name: pooled([i for i, other in enumerate(names) if other == name]) for name in dict.fromkeys(names)},
        sensors={sensor: pooled(scope, [j]) for j, sensor in enumerate(columns.sensors)},
        terms=needed_terms(which["free_network"][0], folds, columns, case),
    )


def folds_of(case: Case) -> tuple[Folds, Columns] | None:
    """The tests a fit may use as tables, what is left out at a time; None where nothing can be learnt from them."""
    sound = _sound(case)
    tests, columns = sound.usable, table_columns(sound.usable, sound.tests)
    if not columns.sensors:
        return None
    step = row_step(tests, columns)
    every = _parted([table_record(t, columns, step) for t in tests])
    records = [r for r in every if r.read.any()]  # of what all sensors stuck in nothing can be predicted
    if len(records) < 2 or min(len(r.time) for r in records) < FEWEST:
        return None
    return _folds(records), columns


@once_for_tests
def _sound(case: Case) -> Case:
    """The case without readings that mean nothing: a model is not judged by these either."""
    return replace(case, tests=without(case.tests, broken_channels(case.tests)))


@once_for_tests
def _free_network(case: Case) -> tuple[Folds, Columns, tuple[Fitter, list[Array]]] | None:
    """The best free network that a case's tests teach, with its errors; None where nothing can be learnt."""
    prepared = folds_of(case)
    return prepared and (*prepared, _best(_free_networks(*prepared), prepared[0]))


@one_blas_thread
def free_network_terms(case: Case) -> tuple[Term, ...]:
    """What a free network needs; nothing where nothing can be learnt."""
    case = replace(case, tests=case.usable)  # a held-out test that lacks an input must not take it from the others
    learnt = _free_network(case)
    return needed_terms(learnt[2][0], learnt[0], learnt[1], case) if learnt else ()


def persistence_error(case: Case) -> tuple[float, tuple[str, ...]] | None:
    """What no model at all leaves (K rms) on tests that are left out in turn, and of which sensors; None where nothing
    can be learnt from the tests."""
    prepared = folds_of(case)
    if prepared is None:
        return None
    folds, columns = prepared
    return rms(_best(_persistences(folds, columns), folds)[1], _steps(folds)), columns.sensors


def free_network_error(case: Case) -> tuple[float, tuple[str, ...]] | None:
    """The same of a free network."""
    learnt = _free_network(case)
    return learnt and (rms(learnt[2][1], _steps(learnt[0])), learnt[1].sensors)


def best_free_network(folds: Folds, columns: Columns) -> Form:
    """The window and powers with which a free network predicts best what was left out."""
    fit, _ = _best(_free_networks(folds, columns, POWERS), folds)
    whole = fit(range(len(folds)))
    assert isinstance(whole, FreeNetwork)
    return whole.form


def _parted(records: Sequence[Record]) -> list[Record]:
    """Records to leave out in turn: the tests, or stretches of the only one."""
    if len(records) != 1:
        return list(records)
    ends = np.linspace(0, len(records[0].time), THIRDS + 1).astype(int)
    return [records[0].stretch(a, b) for a, b in pairwise(ends)]


def _folds(records: Sequence[Record]) -> list[list[Record]]:
    """What is left out at a time: each record, or of many a share, chosen by what was read and not by their order."""
    count = min(len(records), MOST_FOLDS)
    order = sorted(range(len(records)), key=lambda i: (len(records[i].time), float(records[i].T.sum())))
    return [[records[i] for i in sorted(order[k::count])] for k in range(count)]


def _persistences(folds: Folds, columns: Columns) -> list[Fitter]:
    def fitter(boundary: int | None) -> Fitter:
        return lambda lessons: usual_rise([r for i in lessons for r in folds[i]], boundary)

    return [fitter(b) for b in (None, *range(len(columns.boundaries)))]


def _windows(folds: Folds) -> list[float]:
    """Windows (s), as shares of the middle one of the records' lengths: the same whatever the sample step."""
    length = float(np.median([r.time[-1] - r.time[0] for fold in folds for r in fold]))
    return [share * length for share in WINDOWS]


def _black_boxes(folds: Folds, columns: Columns) -> list[Fitter]:
    lessons = [BlackBoxLessons.of(folds, columns, h) for h in _windows(folds)]
    return [partial(a.fit, ridge=r) for a, r in product(lessons, RIDGES)]


def _free_networks(
    folds: Folds, columns: Columns, shapes: Sequence[tuple[Shape, ...]] = (*POWERS, *SHAPES)
) -> list[Fitter]:
    some = shapes if columns.inputs else ((),)
    return [NetworkLessons.of(folds, columns, Form(h, s)).fit for s, h in product(some, _windows(folds))]


def _best(fitters: Sequence[Fitter], folds: Folds) -> tuple[Fitter, list[Array]]:
    """The one that predicts best what was left out, with its errors there, record by record."""
    every, steps = range(len(folds)), _steps(folds)

    def left_out(fit: Fitter) -> list[Array]:
        models = [fit([j for j in every if j != i]) for i in every]
        return [error_of(model, r) for model, fold in zip(models, folds, strict=True) for r in fold]

    return min(((fit, left_out(fit)) for fit in fitters), key=lambda pair: rms(pair[1], steps))


def error_of(model: Plain, record: Record) -> Array:
    """(n, n_sensor) measured - modelled (K), NaN where nothing was read."""
    return np.where(record.read, record.T - model.run(record), np.nan)


def _steps(folds: Folds) -> list[float]:
    return [record.step for fold in folds for record in fold]


def rms(errors: Sequence[Array], steps: Sequence[float] = (1.0,)) -> float:
    """Root mean square error (K); NaN of none.  steps : (n_record,) s, what a row of each counts"""
    seconds = [step * np.count_nonzero(~np.isnan(e)) for e, step in zip(errors, steps, strict=True)]
    squares = [step * np.nansum(e**2) for e, step in zip(errors, steps, strict=True)]
    return float(np.sqrt(np.sum(squares) / np.sum(seconds))) if np.any(seconds) else float("nan")


@dataclass(frozen=True)
class Persistence:
    """What knows nothing: every sensor stays as it began, or keeps its usual distance from a boundary.

    boundary : the column whose temperature the sensors follow, None where they stay;  rise (n_sensor,) K above it"""

    boundary: int | None
    rise: Array

    def run(self, record: Record) -> Array:
        """(n, n_sensor) degC"""
        if self.boundary is None:
            return np.broadcast_to(record.T[0], record.T.shape)
        return record.boundary[:, [self.boundary]] + self.rise


def usual_rise(records: Sequence[Record], boundary: int | None) -> Persistence:
    """The model of some records."""
    if boundary is None:
        return Persistence(None, np.empty(0))
    each = [np.where(r.read, r.T - r.boundary[:, [boundary]], 0.0).sum(axis=0) * r.step for r in records]
    read = [r.read.sum(axis=0) * r.step for r in records]
    return Persistence(boundary, np.sum(each, axis=0) / np.maximum(np.sum(read, axis=0), 1e-300))
