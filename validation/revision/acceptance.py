"""What a step must stand up to: it predicts what it was not fitted to better than the model did before, and than none.

Each test is left out in turn, of the only one that tells of the step what follows half of it: fitted to the rest, with
the step and without it, and its readings predicted. Log predictive density, of the most probable parameters and both
times under the noise of the model without the step, and error, of those that follow the readings, have to agree.
Held-out tests have no say.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from geom.arrays import Array, Mask, sample_columns
from geom.table import TableRow, unit_suffix
from measured.case import STILL_K, Test
from measured.sensors.blocks import groups
from validation.calibration.calibrate import ROUGH, CachedSegments, Fit, minimise
from validation.comparison.linearisation import Segment, segments
from validation.effects.registry import effect
from validation.effects.sensors.input_fault import is_misread
from validation.noise import FOLLOWED, Noise
from validation.parameters.unknowns import Unknowns, sorted_unknowns, to_value

NOTHING: Mapping[str, float] = MappingProxyType({})
GAIN = 1.15  # nats, odds of 3 to 1: less is not worth more than a bare mention (Jeffreys 1961, appendix B)
SAME = 1.01  # times the error before: what two digits show as no change
VISIBLE = 3.0  # deviations: one of a thousand that are not there is so far off
FELT = 1e-3  # of the largest trace (rms) in a test: below it a step does not act there
FEWEST = 3  # readings of a channel that a fit looks at
MOST_FOLDS = 8  # of many tests so many shares are left out in turn: each costs two fits
REFITS = 3  # steps of such a fit: it begins at an optimum that all tests but few share


@dataclass(frozen=True)
class Check(TableRow):
    """One check: what it found, the limit, and whether that is good enough.

    partial : of a part of the readings alone
    """

    check: str
    passed: bool
    value: float
    limit: float
    words: str
    partial: bool = False


@dataclass(frozen=True)
class Fold:
    """Tests, or halves of one, that are fitted, and those that are predicted from them."""

    fitted: tuple[Test, ...]
    predicted: tuple[Test, ...]


@dataclass(frozen=True)
class FoldPrediction:
    """How well a fold was predicted.

    nats : noise -> log density of its readings;  square_K2s, seconds : their squared errors over the time that they
    stand for;  no_change_K2s : the same where every sensor stays as it began
    """

    nats: Callable[[Noise], float]
    square_K2s: float
    no_change_K2s: float
    seconds: float


def folds(
    tests: Sequence[Test], telling: Sequence[str], middle: float | None = None, lone: Mapping[str, float] = NOTHING
) -> list[Fold]:
    """Each test, or of many each share of them, left out in turn; where one alone tells of a step, its later part.

    None of a steady test, whose later part repeats what was fitted.

    telling : names of the tests in which the step acts;  middle : when (s) half of what it does there has been seen
    lone : tests that alone tell of something in the model, see `lone_tests`: of these the later part
    """
    halved = telling[0] if len(telling) == 1 else tests[0].name if len(tests) == 1 else ""
    out = []
    if not halved:  # else the other tests say nothing of the step, only of what it costs to fit one number more
        count = min(len(tests), MOST_FOLDS)
        cut = {t.name: halves(t, lone[t.name]) for t in tests if t.name in lone and not t.is_steady}
        others = [t for t in tests if t.name in cut or t.name not in lone]
        for share in filter(None, [others[i::count] for i in range(count)]):
            fitted = [cut[t.name][0] if t in share else t for t in tests if t not in share or t.name in cut]
            out.append(Fold(tuple(fitted), tuple(cut[t.name][1] if t.name in cut else t for t in share)))
    for test in (t for t in tests if t.name == halved and not t.is_steady):
        first, second = halves(test, middle)
        out.append(Fold(tuple(first if t is test else t for t in tests), (second,)))
    return out


def halves(test: Test, middle: float | None = None) -> tuple[Test, Test]:
    """A test with the readings of its first half, and with those of its second; or before and after an instant (s)."""
    start = groups(test.time.size)
    cut = start.size // 2 if middle is None else np.clip(np.searchsorted(test.time[start], middle), 1, start.size - 1)
    first = np.arange(test.time.size) < start[cut]

    def read(where: Mask) -> Test:
        return replace(test, channels=tuple(replace(c, y=np.where(where, c.y, np.nan)) for c in test.channels))

    return read(first), read(~first)


def telling_tests(fit: Fit, names: Sequence[str]) -> list[str]:
    """The tests in which the traces of some parameters reach a sensor."""
    columns = [fit.unknowns.names.index(name) for name in names]
    size: dict[str, float] = {}
    for s in fit.parts:
        size[s.test] = max(size.get(s.test, 0.0), float(np.max(np.abs(s.J[:, columns]), initial=0.0)))
    return [name for name, largest in size.items() if largest > FELT * max(size.values())]


def lone_tests(fit: Fit, names: Sequence[str]) -> dict[str, float]:
    """Tests that alone tell of some of the parameters, such as an event in one of them, and when (s) half is seen.

    Left out whole, such a test would be predicted without what the model knows of it.
    """
    alone: dict[str, list[str]] = {}
    for name in names:
        if len(telling := telling_tests(fit, [name])) == 1:
            alone.setdefault(telling[0], []).append(name)
    return {test: middle_instant(fit, some, test) for test, some in alone.items()}


def middle_instant(fit: Fit, names: Sequence[str], test: str) -> float:
    """When (s) half of what some parameters do to a test's readings has been seen: of a late event that is late."""
    columns, parts = [fit.unknowns.names.index(name) for name in names], [s for s in fit.parts if s.test == test]
    time = np.concatenate([s.time for s in parts])
    size = np.concatenate([np.sum(s.J[:, columns] ** 2, axis=1) for s in parts])
    order = np.argsort(time, kind="stable")
    total = np.cumsum(size[order])
    return float(time[order][np.searchsorted(total, 0.5 * total[-1])])


def fold_prediction(fit: Fit, fold: Fold, fixed: Mapping[str, float], effects: Collection[str] = ()) -> FoldPrediction:
    """A fold as a fit's model, fitted to the rest of it, predicts it.

    fit : to all tests, model error in account;  fixed : values of what is not free;  effects : as of `reading_fit`
    """
    learnt = _rows(fit, fold.fitted)
    causes, machine, others = sorted_unknowns(fit.unknowns, effects)
    rows, parts = [fit.unknowns.names.index(name) for name in machine.names], [s for s, _ in learnt]

    def fitted(some: Unknowns, theta: Array, noise: Noise, like: Sequence[Segment]) -> dict[str, float]:
        cache = CachedSegments(like, nearby=True)
        network, tests = fit.network, fold.fitted
        return minimise(network, tests, some, theta, noise, values, REFITS, cache, draft=True, worth=ROUGH).values

    values = dict(fixed)
    likely = fitted(fit.unknowns, fit.theta, fit.noise, parts)
    there = segments(fit.network, fold.predicted, {**values, **likely})

    def nats(noise: Noise) -> float:  # its rows are made anew: kept for every fold, they would fill the memory
        return _log_density(replace(fit, noise=noise), _rows(fit, fold.fitted), there)

    values |= {name: likely[name] for name in causes.names} | dict.fromkeys(others.names, 0.0)
    values |= fitted(machine, fit.theta[rows], FOLLOWED.robust(parts), [replace(s, J=s.J[:, rows]) for s in parts])
    return FoldPrediction(nats, *squares(segments(fit.network, fold.predicted, values), fold))


def squares(parts: Sequence[Segment], fold: Fold) -> tuple[float, float, float]:
    """Squared errors of a fold's predicted tests over time, the same where nothing changes (K2 s); and that time."""
    both = [(t.name, c) for t in (*fold.predicted, *fold.fitted) for c in t.channels if np.isfinite(c.y).any()]
    first = {(name, c.name): c.y[np.isfinite(c.y)][0] for name, c in both}
    read = {(t.name, c.name): c.y for t in fold.predicted for c in t.channels}
    still = sum(s.seconds * np.nanmean((read[s.test, s.channel] - first[s.test, s.channel]) ** 2) for s in parts)
    return sum(s.seconds * float(np.mean(s.r**2)) for s in parts), float(still), sum(s.seconds for s in parts)


def _rows(fit: Fit, tests: Sequence[Test]) -> list[tuple[Segment, Array]]:
    """A fit's segments where some tests, or halves of tests, were read; each with what the model error does there."""
    by_name = {(s.test, s.channel): s for s in fit.parts}
    out = []
    for test, c in ((t, c) for t in tests for c in t.channels if np.isfinite(c.y).sum() >= FEWEST):
        s, (begin, end) = by_name[test.name, c.name], test.time[np.isfinite(c.y)][[0, -1]]
        some = (s.time >= begin) & (s.time <= end)
        error = fit.error.of(s)[some] if fit.error else np.zeros((int(some.sum()), 0))
        out.append((replace(s, time=s.time[some], r=s.r[some], J=s.J[some]), error))
    return out


def _log_density(fit: Fit, learnt: Sequence[tuple[Segment, Array]], unseen: Sequence[Segment]) -> float:
    """Log density of unseen readings: noise, model error, and what the learnt ones leave open of the parameters.

    By the determinant lemma and Woodbury: with X the whitened columns of parameters and doubts and H their curvature,
    r'S^-1 r = r'r - r'X (H + X'X)^-1 X'r and log|S| = log|noise| + log|H + X'X| - log|H|.
    """
    doubts = fit.error.size if fit.error else 0
    H = np.diag(np.concatenate([fit.unknowns.sd**-2.0, np.ones(doubts)]))
    for s, D in learnt:
        X = fit.noise.whiten(s, np.column_stack([s.J, D]))
        H += X.T @ X
    more, pull, square, noise = H.copy(), np.zeros(len(H)), 0.0, 0.0
    every = {(s.test, s.channel): s for s in fit.parts}
    for s in unseen:  # a fault may have left a hole in their readings
        whole = every[s.test, s.channel]
        J = np.hstack([whole.J, fit.error.of(whole)]) if fit.error else whole.J
        X = fit.noise.whiten(s, np.column_stack([sample_columns(s.time, whole.time, J), s.r]))
        more += X[:, :-1].T @ X[:, :-1]
        pull += X[:, :-1].T @ X[:, -1]
        square += float(X[:, -1] @ X[:, -1])
        noise += fit.noise.logdet(s)
    inside = square - float(pull @ np.linalg.solve(more, pull))
    return -0.5 * (inside + noise + float(np.linalg.slogdet(more)[1] - np.linalg.slogdet(H)[1]))


def prediction_checks(
    before: Sequence[FoldPrediction],
    after: Sequence[FoldPrediction],
    noises: Sequence[Noise],
    telling: Sequence[str],
    lone: Sequence[str] = (),
    aside: bool = False,
    same: float = SAME,
) -> tuple[Check, ...]:
    """Does a step predict what was left out better than the model before it, and than no change where there is one?

    before, after : fold by fold, both fitted to the same;  telling : the tests in which the step acts
    lone : tests of which the later part alone was left out
    aside : a step that says of some readings, which are not predicted, that they mean something else: it gains nothing
        for the others, and must not cost them anything
    same : times the error before, up to which what is likelier may predict
    """
    part = len(telling) == 1
    if not after:
        return (unseen_check(),)
    nats = [log_density(b, noises) - log_density(a, noises) for b, a in zip(after, before, strict=True)]
    was, now = rms(before), rms(after)
    gain = -GAIN if aside else GAIN
    short = f" where {GAIN:.3g} would do" if 0.0 < sum(nats) <= gain else ""
    better = f"better in {sum(x > 0 for x in nats)} of {len(nats)}, log odds {sum(nats):+.3g}{short}"
    only = f"; seen in {telling[0]} only, judged on its later part: not yet tested elsewhere" if part else ""
    parts = f"; of {', '.join(lone)} the later part, since only it tells what held in it" if lone and not part else ""
    words = f"{fall(was, now)} (each part predicted from the others), {better}{only}{parts}"
    moving = [f for f in after if f.no_change_K2s > STILL_K**2 * f.seconds]  # a steady test is what it was
    error, none = rms(moving), rms([replace(f, square_K2s=f.no_change_K2s) for f in moving])
    beside = f"{error:.2f} K where a guess of no change leaves {none:.2f} K" if moving else "nothing left out changes"
    return (
        Check("left out", sum(nats) > gain and now <= same * was, sum(nats), gain, words, part),
        Check("no change", error < none or not moving, now, none, beside, part),
    )


def log_density(fold: FoldPrediction, noises: Sequence[Noise]) -> float:
    """Log density of a fold's readings (nats), averaged over what their noise may be."""
    return float(np.logaddexp.reduce([fold.nats(noise) for noise in noises]))


def unseen_check() -> Check:
    """Fails: nothing can be left out."""
    words = "one steady state: its later part repeats what was fitted, so nothing unseen judges this"
    return Check("left out", False, 0.0, GAIN, words, True)


def rms(folds: Sequence[FoldPrediction]) -> float:
    """Root mean square error (K) of what was left out."""
    return float(np.sqrt(sum(f.square_K2s for f in folds) / max(sum(f.seconds for f in folds), 1.0)))


def bound_check(fit: Fit, name: str) -> Check:
    """Whether an amplitude is inside its bounds: told, and no reason to refuse what predicts.

    What is fitted to nothing is refused; and a room, inlet or input that would have to be further off than any reading
    is: there something else is wrong.
    """
    k = fit.unknowns.names.index(name)
    p, value = fit.unknowns.parameters[k], to_value(fit.unknowns.parameters[k], float(fit.theta[k]))
    unit = unit_suffix(p.unit)
    inside = f"{name} {value:.3g} lies between {p.low:.5g} and {p.high:.5g}{unit}"
    if fit.at_bound[k] and value == p.neutral:
        return Check("bounds", False, value, p.high, f"{name} is fitted to {value:.3g}{unit}: it is not there")
    if fit.at_bound[k] and is_misread(effect(name), p):
        words = f"{name} would have to be more than {value:.3g}{unit}: nothing is read so far off"
        return Check("bounds", False, value, p.high, words)
    at = f"{name} sticks to the bound of what is physical, {value:.3g}{unit}: something else may take part"
    return Check("bounds", True, value, p.high, at if fit.at_bound[k] else inside)


def visible_check(fit: Fit, name: str) -> Check:
    """Whether the readings show an amplitude that no prediction is judged by."""
    k = fit.unknowns.names.index(name)
    far = abs(float(fit.theta[k])) / float(np.sqrt(fit.covariance[k, k]))
    words = f"{name} is {far:.1f} deviations from none, {VISIBLE:g} would do"
    return Check("shown", far > VISIBLE, far, VISIBLE, words)


def fall(before: float, after: float) -> str:
    """Two errors (K) in words, with the digits that tables have."""
    return " -> ".join(f"{x:.2f}" if x >= 0.1 else f"{x:.3g}" for x in (before, after)) + " K"


def failures(checks: Sequence[Check]) -> str:
    """The checks that failed, in words."""
    return "; ".join(c.words for c in checks if not c.passed)
