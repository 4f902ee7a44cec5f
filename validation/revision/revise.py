"""Add an effect, take it out, calibrate: a new model and a report of what it did to the error of every test."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite, sqrt

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from geom.one_thread import one_blas_thread
from geom.table import Table, TableResult, select_fields
from geom.text import table
from lumped.model.multipliers import parameter_values
from lumped.model.network import Parameter
from lumped.model.once import once
from lumped.schemas.reader import suggestion
from measured.case import STILL_K, AddedEffect, Case, Channel, Model, Test
from measured.sensors.faults import broken_channels, without
from measured.sensors.operators import of_measurement
from validation.calibration.calibrate import Fit, Progress, no_progress, with_model_error
from validation.calibration.intervals import Estimate, Profile, estimates
from validation.calibration.model_error import ModelError
from validation.calibration.profile import profiles
from validation.calibration.staged_fit import Search, belongs, merged, staged_fit
from validation.comparison.compare import Comparison, errors, physical
from validation.comparison.linearisation import segments
from validation.comparison.reading_correction import corrected_tests
from validation.effects import Effect, effect
from validation.effects.during import During
from validation.effects.input_terms import InputTerm, law_words
from validation.effects.time_window import checked, holds, lasts
from validation.parameters.unknowns import FREE, case_reference, scene_of, standing, working
from validation.revision.acceptance import (
    SAME,
    Check,
    Fold,
    FoldPrediction,
    bound_check,
    failures,
    fall,
    fold_prediction,
    folds,
    lone_tests,
    middle_instant,
    prediction_checks,
    squares,
    telling_tests,
    unseen_check,
    visible_check,
)
from validation.revision.repeated_events import repeated_events
from validation.tables import revision_tables

GETS_WORSE = 1.05  # a fit under priors may lose so much on single tests
LOST = 2.0  # a test that was fitted and is so many times worse has paid for another: no compromise costs that
TRAINING = ("calibrate", "validate")
FITTED = "fitted"  # the check of a calibration on the tests that it was fitted to
TOGETHER = " + "  # between the names of effects that are added in one step


@dataclass(frozen=True)
class Change:
    """Error of one test (K) before and after; `fitted` with sensors as the fit has them, None before a fit.

    seconds : that all its sensors were read, by which the error of several tests weighs them where it is told
    """

    name: str
    role: str
    before: float
    after: float
    fitted_before: float | None = None
    fitted_after: float | None = None
    seconds: float = 1.0

    def document(self) -> dict:
        return {
            "name": self.name,
            "role": self.role,
            "rmse_K": {"before": self.before, "after": self.after},
            "fitted_rmse_K": {"before": self.fitted_before, "after": self.fitted_after},
        }


@dataclass(frozen=True)
class Revision(TableResult):
    """What a revision did. accepted says whether the error fell where it should; the new model is given either way.

    laws : effect of the new model -> its law, or its size, with the interval, in words
    """

    action: str
    effect: str | None
    model: Model
    accepted: bool
    why: str
    tests: tuple[Change, ...]
    parameters: tuple[Estimate, ...]
    before: Comparison
    after: Comparison
    converged: bool
    checks: tuple[Check, ...] = ()
    laws: Mapping[str, str] = field(default_factory=dict)

    @property
    def worth_keeping(self) -> bool:
        """Whether it belongs into the model: also a calibration that only its own tests gain by, which is told."""
        gains = bool(self.checks) and all(c.passed for c in self.checks if c.check == FITTED)
        return self.accepted or (self.action == "calibrate" and self.converged and gains)

    @property
    def left_out_K(self) -> float | None:
        """Error (K rms) of tests that were left out in turn, with sensors as the rest has them; None where none was,
        and where a part of one test alone was predicted."""
        check = {"add": "no change", "calibrate": "left out"}.get(self.action)
        return next((c.value for c in self.checks if c.check == check and not c.partial), None)

    def __repr__(self) -> str:
        what = " ".join(x for x in (self.action, self.effect) if x)
        rows = [[t.name, t.role, t.before, t.after] for t in self.tests]
        accepted = "accepted" if self.accepted else "not accepted"
        return (
            f"Revision {self.revision}, {what}, {accepted}: {self.why}\n"
            f"{table(['test', 'role', 'rms before (K)', 'after (K)'], rows)}"
        )

    def tables(self) -> tuple[Table, ...]:
        """The error of every test before and after, and the parameters with their intervals."""
        return revision_tables(self.document())

    @property
    def revision(self) -> int:
        return self.model.revision

    def document(self) -> dict:
        head = select_fields(self, "action", "effect", "revision", "accepted", "why", "converged")
        return {**head, **select_fields(self, "tests", "parameters", "checks", "laws")}


def calibrate(
    case: Case,
    roles: Sequence[str] = ("calibrate",),
    progress: Progress = no_progress,
    profiled: Sequence[str] = (),
    search: Search | None = None,
) -> Revision:
    """Fit the free parameters to the tests of the given roles, stage by stage where tests free their own.

    profiled : globs of parameters to profile
    """
    return _revised(case, case.model, "calibrate", None, roles, progress, profiled, search)


def add(
    case: Case, names: str | Sequence[str], progress: Progress = no_progress, before: Comparison | None = None
) -> Revision:
    """Add effect 'kind@place', or several that need each other, and calibrate on all tests but the held-out ones.

    names : of one string "a + b" too.  What was never calibrated is calibrated first: an effect is compared with the
        best model without it.
    before : of the model as it stands, where it was compared
    """
    each = [n for text in ([names] if isinstance(names, str) else names) for n in text.split(TOGETHER)]
    new = [effect(name, scene_of(case)) for name in dict.fromkeys(each)]
    new.sort(key=lambda one: one.changes_others)  # an effect acts on what those before it brought
    for one in new:
        inside(one, case)
        if one.name in {e.name for e in case.model.effects}:
            right = "another effect, or `remove` it first"
            raise InputError(f"'{one.name}' is in the model already", f"case '{case.name}'", right)
    if not case.model.values:
        progress("calibrating without the effect")
        bare = calibrate(case, TRAINING, progress).model
        case, before = replace(case, model=replace(bare, revision=case.model.revision)), None
    model = replace(case.model, effects=(*case.model.effects, *(AddedEffect(one.kind, one.place) for one in new)))
    return _revised(case, model, "add", TOGETHER.join(one.name for one in new), TRAINING, progress, before=before)


def inside(one: Effect, case: Case) -> None:
    """An event lies inside the records of its tests; one of a boundary lasts as long as they do."""
    if isinstance(one, During) and one.event:
        for test in [t for t in case.tests if t.name in one.event.spans]:
            checked(one.event, test.name, float(test.time[0]), float(test.time[-1]), f"effect '{one.name}'")
            if one.mapping == "offset" and not lasts(one.condition, test):
                raise one.lasting("a boundary in a whole test")


def remove(case: Case, name: str, progress: Progress = no_progress) -> Revision:
    """Take an effect out and calibrate on all tests but the held-out ones."""
    left = tuple(e for e in case.model.effects if e.name != name)
    if len(left) == len(case.model.effects):
        right = suggestion(name, [e.name for e in case.model.effects] or ["none"], "its effects")
        raise InputError(f"'{name}' is not in the model", f"case '{case.name}'", right)
    values = {k: v for k, v in case.model.values.items() if k != name and not k.startswith(f"{name}^")}
    model = replace(case.model, effects=left, values=values)
    return _revised(case, model, "remove", name, TRAINING, progress)


@one_blas_thread
def _revised(
    case: Case,
    model: Model,
    action: str,
    name: str | None,
    roles: Sequence[str],
    progress: Progress,
    profiled: Sequence[str] = (),
    search: Search | None = None,
    before: Comparison | None = None,
) -> Revision:
    if broken := broken_channels(case.tests):
        case, before = replace(case, tests=without(case.tests, broken)), None
    before = before or errors(case)
    tests = [t for t in case.tests if t.role in roles]
    if not tests:
        what = f"no test has the role {' or '.join(roles)}"
        raise InputError(what, f"case '{case.name}'", "give at least one that role")
    training = replace(case.training(), model=model)
    sample = tests if action == "calibrate" else training.tests
    reference = replace(case_reference(training), tests=tuple(t.name for t in sample))
    training = replace(training, model=replace(model, reference=reference))
    together = tests if action == "calibrate" else _plain(tests)
    fits = staged_fit(training, together, start(training), search, progress)
    new = replace(training.model, values=_values(model, fits), revision=case.model.revision + 1)
    after = errors(replace(case, model=new))
    new = replace(new, reference=replace(reference, errors=after.sensor_errors))
    changes = tuple(
        Change(b.name, b.role, b.rmse_K, a.rmse_K, b.fitted_rmse_K, a.fitted_rmse_K, sum(c.seconds for c in a.channels))
        for b, a in zip(before.tests, after.tests, strict=True)
    )
    progress("predicting what was left out")
    alike = _fit_before(case)[0].error if action == "add" else None
    sure = [_sure(fit, tests, new, case, alike) for fit in fits]
    if action == "add" and name:
        acceptance = _effect_checks(case, sure[-1], name.split(TOGETHER), new, together, changes)
    else:
        acceptance = _fit_checks(case, sure[-1], new, changes) if action == "calibrate" else ()
    accepted, why = judge(action, changes, fits, acceptance, {t.name for t in tests})
    rows = merged(sure, lambda fit: estimates(fit, _profiled(fit, tests, new, profiled, progress)))
    new, effects = replace(new, intervals={p.name: p.ci95 for p in rows}), [effect(e.name) for e in new.effects]
    again = repeated_events(replace(case, model=new)) if action == "add" and accepted else ()
    laws = law_words(effects, fits[-1].network, new.values, new.intervals)
    forms = [laws[e.name] for e in effects if isinstance(e, InputTerm)]  # of others the table of values tells
    why = "; ".join([why, *(x.sentence for x in again), *forms])
    converged = all(fit.converged for fit in fits)
    return Revision(action, name, new, accepted, why, changes, tuple(rows), before, after, converged, acceptance, laws)


def _effect_checks(
    case: Case, fit: Fit, names: Sequence[str], new: Model, tests: Sequence[Test], changes: Sequence[Change]
) -> tuple[Check, ...]:
    """Does the model with the effects predict what was left out better than the one before, fitted to the same?

    Readings that a fault in one test explains are not predicted: what they should have been is not known. Of such a
    fault alone, all others must be predicted as well as before.
    """
    faults = [e for e in (effect(e.name) for e in new.effects) if isinstance(e, During) and e.base.temporary]
    aside = {*names} <= {e.name for e in faults}
    telling = [] if aside else telling_tests(fit, names)
    middle = middle_instant(fit, names, telling[0]) if len(telling) == 1 else None
    bare, values, predictions = _fit_before(case)
    present = [e.name for e in case.model.effects]
    lone = lone_tests(bare, present)

    def predicted(of: Fit, model: Model, values: Mapping[str, float], effects: Sequence[str]) -> list[FoldPrediction]:
        draft, small_tests = _corrected(of, tests, model, case, values)
        parts = folds(small_tests, telling, middle, lone)
        trusted = [replace(f, predicted=tuple(_trusted(t, faults) for t in f.predicted)) for f in parts]
        return [fold_prediction(draft, fold, values, effects) for fold in trusted]

    if (at := (middle, *telling, *(e.name for e in faults))) not in predictions:
        predictions[at] = predicted(bare, case.model, values, present)
    alike = replace(fit, noise=bare.noise)  # else the shapes that two residuals were given outweigh what they predict
    after = predicted(alike, new, parameter_values(fit.network, new.values), (*present, *names))
    # A sensor that always reads wrong makes what it read likelier by itself: what was left out has to fall as well.
    same = 1.0 if not aside and all(effect(name).fault for name in names) else SAME
    checks = prediction_checks(predictions[at], after, (bare.noise, fit.noise), telling, tuple(lone), aside, same)
    shows = tuple(visible_check(fit, n) for n in names) if aside else ()
    return (*(bound_check(fit, n) for n in names), *shows, *checks, _lost(changes, tests))


def _trusted(test: Test, faults: Sequence[During]) -> Test:
    """A test without the readings that faults in it explain."""
    mine = [e for e in faults if e.can_act(test.name)]

    def read(c: Channel) -> Array:
        return np.where(sum(holds(e.condition, test) for e in mine if e.base.place == c.name) > 0.0, np.nan, c.y)

    return replace(test, channels=tuple(replace(c, y=read(c)) for c in test.channels)) if mine else test


@once
def _fit_before(case: Case) -> tuple[Fit, dict[str, float], dict[tuple, list[FoldPrediction]]]:
    """The model as it stands, fitted to all tests but the held-out ones, its values, and what it predicts of them.

    Every effect that is tried on it is held against the same.
    """
    training, tests = case.training(), _plain(case.usable)
    reference = replace(case_reference(training), tests=tuple(t.name for t in training.tests))
    training = replace(training, model=replace(case.model, reference=reference))
    (plain,) = staged_fit(training, tests, start(training))
    bare = _sure(plain, tests, replace(case.model, values=_values(case.model, [plain])), case)
    return bare, parameter_values(bare.network, {**case.model.values, **bare.values}), {}


def _lost(changes: Sequence[Change], tests: Sequence[Test]) -> Check:
    """No test may pay for another: where one gets worse by far, as its sensors read and as the fit has them, something
    else differs between them."""
    sigma = {t.name: float(np.sqrt(np.mean([c.sigma_K**2 for c in t.channels]))) for t in tests}
    mine = [c for c in changes if c.name in sigma and isfinite(c.before)]
    read = {c.name: (c.before, c.after) for c in mine}
    fitted = {c.name: (c.fitted_before or c.before, c.fitted_after or c.after) for c in mine}
    both = _far_worse(read, sigma) & _far_worse(fitted, sigma)
    text = ", ".join(f"{c.name} {fall(c.before, c.after)}" for c in mine if c.name in both)
    words = f"{text}; something else differs between these tests" if both else "none gets far worse"
    return Check("other tests", not both, float(len(both)), 0.0, words)


def _far_worse(errors: Mapping[str, tuple[float, float]], sigma: Mapping[str, float]) -> set[str]:
    """Tests whose error (K), before and after, got worse by far.

    One that was far better than the tests on the whole may have been so by chance, as one in which the air was blocked
    is to a model that knows of no air: it may go half the way to them, as ratios go.
    """
    usual = float(np.sqrt(np.mean([before**2 for before, _ in errors.values()]))) if errors else 0.0
    least = {name: max(before, sigma[name]) for name, (before, _) in errors.items()}
    return {n for n, (_, now) in errors.items() if now > max(LOST * least[n], sqrt(least[n] * usual))}


def _fit_checks(case: Case, fit: Fit, new: Model, changes: Sequence[Change]) -> tuple[Check, ...]:
    """Does a calibration lower the error of its own tests, leave others as well predicted as they were before, and
    predict none worse than a guess of no change does?

    The others are the tests that a fit may use and this one did not, also where an effect was added on them; and each
    of its own left out in turn, where the model as it stood had not seen it either.
    """
    previous = {t.name for t in case.fitted} if case.model.values else set()
    fitted = [t for t in case.usable if t.name in {s.test for s in fit.parts}]
    values, square, seconds = parameter_values(fit.network, new.values), np.zeros(2), 0.0
    effects = [e.name for e in case.model.effects if e.name in fit.unknowns.names]
    lone = lone_tests(fit, effects)
    draft, small_tests = _corrected(fit, fitted, new, case, values)
    blind = [fold_prediction(draft, fold, values, effects) for fold in folds(small_tests, (), lone=lone)]
    for fold, now in zip(folds(fitted, (), lone=lone), blind, strict=True):
        if not previous & {t.name for t in fold.predicted}:
            was, _, span = squares(segments(standing(case), fold.predicted, case.model.values), fold)
            square += np.array([was, now.square_K2s])
            seconds += span
    changed = [c for c in changes if c.role in TRAINING and isfinite(c.before)]
    mine = [c for c in changed if c.name in {t.name for t in fitted}]
    unseen = [c for c in changed if c not in mine]
    groups = {kind: some for kind, some in (("unseen", unseen), (FITTED, mine)) if some}
    pairs = {"left out": np.sqrt(square / seconds)} if seconds else {}
    pairs |= {k: np.array([mean_square(some, "before"), mean_square(some, "after")]) for k, some in groups.items()}
    sigma = float(np.sqrt(np.mean([c.sigma_K**2 for t in fitted for c in t.channels])))
    which = {"left out": "each of its tests predicted from the others", FITTED: "the tests it was fitted to"}
    which["unseen"] = ", ".join(c.name for c in unseen)
    checks = [
        Check(kind, bool(b <= max(GETS_WORSE * a, sigma)), float(b), float(a), f"{fall(a, b)} ({which[kind]})")
        for kind, (a, b) in pairs.items()
    ]
    sums = {which["left out"]: [(now.square_K2s, now.no_change_K2s, now.seconds) for now in blind]}
    sums |= {which[kind]: _as_read(replace(case, model=new), some) for kind, some in groups.items()}
    return (*checks, *_no_change(sums, sigma), *(() if blind else (unseen_check(),)))


def _as_read(case: Case, changes: Sequence[Change]) -> list[tuple[float, float, float]]:
    """Of each test: squared errors over time (K2 s), as sensors read; the same where nothing changes; the time."""
    tests = [t for t in case.usable if t.name in {c.name for c in changes}]
    return [squares(segments(standing(case), [t], physical(case)), Fold((), (t,))) for t in tests]


def _no_change(sums: Mapping[str, Sequence[tuple[float, float, float]]], sigma: float) -> tuple[Check, ...]:
    """Of what a guess of no change predicts better than a fit by most, or nearly does; none of steady tests, which it
    knows.

    sums : what was predicted -> squared errors of the fit and of that guess over time (K2 s), and that time (s)
    """
    moving = {what: [row for row in rows if row[1] > STILL_K**2 * row[2]] for what, rows in sums.items()}
    each = {
        what: np.sqrt(np.sum(rows, axis=0)[:2] / sum(span for *_, span in rows))
        for what, rows in moving.items()
        if rows
    }
    if not each:
        return ()
    what, (error, none) = max(each.items(), key=lambda x: x[1][0] / max(x[1][1], sigma))
    words = f"{error:.2f} K where a guess of no change leaves {none:.2f} K ({what})"
    return (Check("no change", bool(error <= max(none, sigma)), float(error), float(none), words),)


def _plain(tests: Sequence[Test]) -> list[Test]:
    """The tests without stages: an effect is judged on all of them together."""
    return [replace(t, frees=()) if t.frees else t for t in tests]


def _values(model: Model, fits: Sequence[Fit]) -> dict[str, float]:
    """The model's values with those of every stage."""
    out = dict(model.values)
    for fit in fits:
        out |= fit.values
    return out


def _sure(fit: Fit, tests: Sequence[Test], model: Model, case: Case, steps_like: ModelError | None = None) -> Fit:
    """A stage's fit with the model error in its covariance, as the small network has it where there is one."""
    some, values = _conditions(fit, tests, model)
    draft, small_tests = _small(fit, some, model, case)
    return replace(with_model_error(draft, small_tests, values, case.doubt, steps_like=steps_like), network=fit.network)


def _small(fit: Fit, tests: Sequence[Test], model: Model, case: Case) -> tuple[Fit, Sequence[Test]]:
    """A fit on the small network, and the tests as that looks at them; both as they are where there is none."""
    training = replace(case.training(), model=model)
    small = training.small
    if small is training:
        return fit, tests
    return replace(fit, network=working(small)[0]), replace(training, tests=tuple(tests)).small.tests


def _corrected(
    fit: Fit, tests: Sequence[Test], model: Model, case: Case, values: Mapping[str, float]
) -> tuple[Fit, Sequence[Test]]:
    """The same, readings corrected at some values: what was left out is predicted from there."""
    draft, small_tests = _small(fit, tests, model, case)
    return draft, corrected_tests(fit.network, tests, draft.network, small_tests, values) if draft is not fit else tests


def _profiled(
    fit: Fit, tests: Sequence[Test], model: Model, globs: Sequence[str], progress: Progress
) -> dict[str, Profile]:
    """Profile intervals of a stage's own parameters that match a glob."""
    every = [p.name for p in fit.unknowns.parameters if not of_measurement(p)]
    names = [name for name in every if any(belongs(name, g) for g in globs)]
    return profiles(fit, *_conditions(fit, tests, model), names, progress)


def _conditions(fit: Fit, tests: Sequence[Test], model: Model) -> tuple[list[Test], dict[str, float]]:
    """The tests of a stage's fit, and the value of every parameter."""
    stage = {s.test for s in fit.parts}
    return [t for t in tests if t.name in stage], parameter_values(fit.network, model.values)


def start(case: Case) -> dict[str, float]:
    """Where the model stands; a new effect a little inside its bounds."""
    values, (_, unknowns) = dict(case.model.values), working(case)
    for e in case.model.effects:
        values.setdefault(e.name, nudge(next(p for p in unknowns.parameters if p.name == e.name)))
    return values


def nudge(p: Parameter) -> float:
    """A start a little inside the bounds, on the side the sign allows: a third of the usual size."""
    return float(np.clip(p.neutral + 0.3 * (p.sign or 1) * p.prior_sd / FREE, p.low, p.high))


def judge(
    action: str, changes: Sequence[Change], fits: Sequence[Fit], acceptance: Sequence[Check], fitted: Collection[str]
) -> tuple[bool, str]:
    """Accept what converges and passes its checks; a fit that nothing was left out of has to lower its tests' error.

    That error weighs all sensors alike and the fit does not, so it may rise by GETS_WORSE. It is not a check of an
    effect, which has to predict what was left out. Held-out tests have no say; what became of them is told after.
    fitted : names of the tests it was fitted to
    """
    in_fit = [c for c in changes if c.name in fitted]
    was, now = mean_square(in_fit, "before"), mean_square(in_fit, "after")
    converged = all(fit.converged for fit in fits)
    failed, lower = failures(acceptance), all(c.passed for c in acceptance if c.check == FITTED)
    falls = now <= (SAME if action == "add" else GETS_WORSE) * was
    reasons = [
        f"kept for the fitted tests only: {failed}" if failed and action == "calibrate" and lower else failed,
        "" if converged else "not converged",
        "" if falls or failed else "the tests that it was fitted to are told worse with it",
        f"rms over the tests used {fall(was, now)}",
        *other_changes(changes, fitted),
    ]
    return bool(falls and converged and not failed), "; ".join(filter(None, reasons))


def other_changes(changes: Sequence[Change], fitted: Collection[str]) -> list[str]:
    """What became of the tests that were not fitted, in words."""
    outside = [c for c in changes if c.name not in fitted]
    if not outside:
        return ["no held-out test"]
    called = "held-out tests" if all(c.role == "hold-out" for c in outside) else "other tests"
    was, now = (mean_square(outside, side, [c.seconds for c in outside]) for side in ("before", "after"))
    change = f"{called} {fall(was, now)}"
    worst = max(outside, key=lambda c: c.after - c.before)
    why = f": {worst.name} got worse" if now > was else ""
    return [f"{change}{why}"]


def mean_square(changes: Sequence[Change], side: str, weights: Sequence[float] | None = None) -> float:
    values = [getattr(c, side) for c in changes]
    return float(np.sqrt(np.average(np.square(values), weights=weights))) if values else float("nan")
