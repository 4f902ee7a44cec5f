"""Two tests of one machine under one load, weeks spread: does the later one repeat the earlier one, or what changed?

    later - earlier = g rise - s d(rise)/d(ln rate) + start + offset + noise        g, s : change of rise, time constant

What the case's network says of other ambients, starts, and loads within 2 % is taken off first, with each sensor's rise
and time constant as its earlier test has them. Every reading has its sigma anew in every test.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from extras.bench.measuring.curves import ALIKE, LATE, constant
from extras.bench.measuring.warming import LEVEL
from thermoscope import InputError, plugin as th

Verdict = Literal["changed", "equal", "cannot tell"]
WIDE = 0.05  # of a rise or a time constant: surer than that, nine in ten changes of a tenth are seen
LEAST = 8  # instants that both tests have of a sensor: four numbers and the noise are found from them
STRETCH = 0.05  # of time: small against what a network may be wrong by
RESOLVED_K = 0.03  # a logger of 0.1 K rounds by so much (1 / sqrt(12)): no difference is surer
TIME_CONSTANT_SHARE = 1.0 - np.exp(-1.0)  # share of a rise after one time constant
VERDICTS: tuple[Verdict, ...] = ("changed", "equal", "cannot tell")  # the first that is found holds for the machine
ALIKE_SHARE = 0.5  # of a rise's change that a time constant changes by: more is cooling
WAYS = {"rise": ("K", "more", "less"), "time constant": ("min", "longer", "shorter")}


@dataclass(frozen=True)
class Change:
    """A quantity of one sensor.  before : K or min;  change, u, U95 : shares of it;  p : of as much, were there none"""

    place: str
    channel: str
    quantity: str
    before: float
    change: float
    u: float
    U95: float
    p: float
    verdict: Verdict = "equal"

    @property
    def size(self) -> float:
        """In standard uncertainties."""
        return abs(self.change) / self.u

    @property
    def words(self) -> str:
        """What it is and was, and by how much it differs."""
        unit, more, less = WAYS[self.quantity]
        amount = f"{100 * abs(self.change):.1f} +- {100 * self.U95:.1f} % {more if self.change > 0 else less}"
        return f"{self.before * (1 + self.change):.1f} {unit} where it was {self.before:.1f} {unit}, {amount}"

    def document(self) -> dict[str, Any]:
        shares = {"after": self.before * (1 + self.change), "percent": 100 * self.change, "U95_percent": 100 * self.U95}
        names = ("place", "channel", "quantity", "before", "p", "verdict")
        return {**{n: getattr(self, n) for n in names}, **shares, "uncertainties": self.size}


@dataclass(frozen=True)
class Sensor:
    """changes : of rise and time constant

    earlier, later : rise over ambient (K), the later one at the earlier one's ambient, start and load
    band : half the width (K) in which 95 % of the later readings lie if nothing changed
    """

    changes: tuple[Change, ...]
    minutes: th.Array
    earlier: th.Array
    later: th.Array
    band: th.Array


@dataclass(frozen=True)
class Drift:
    """later, earlier : names of the tests;  left_out : sensors with too few readings, or that do not warm"""

    case: th.MeasuredCase
    later: str
    earlier: str
    sensors: tuple[Sensor, ...]
    left_out: tuple[str, ...]

    @property
    def changes(self) -> list[Change]:
        """The surest first."""
        return sorted((c for s in self.sensors for c in s.changes), key=lambda c: (c.verdict != "changed", -c.size))

    @property
    def verdict(self) -> Verdict:
        """Changed if anything did; equal if no rise that can be told is another."""
        verdicts = {c.verdict for c in self.changes if c.quantity == "rise" or c.verdict == "changed"}
        return next(v for v in VERDICTS if v in verdicts)

    @property
    def sentence(self) -> str:
        """The verdict, with what moved most in its uncertainties, and what that is a sign of."""
        verdict = self.verdict
        first = next(c for c in self.changes if c.verdict == verdict and (verdict == "changed" or c.quantity == "rise"))
        others = [
            f"; {v}: {', '.join(places)}"
            for v in ("changed", "cannot tell")
            if (places := self._places(v, first.place))
        ]
        word = "equal within uncertainty" if verdict == "equal" else f"{verdict}{self._sign(first.place)}"
        what = f"{first.quantity} of {first.place} {first.words}"
        return f"{self.later} against {self.earlier}: {what}: {word}{''.join(others)}."

    def _places(self, verdict: Verdict, but: str) -> list[str]:
        return list(dict.fromkeys(c.place for c in self.changes if c.verdict == verdict and c.place != but))

    def _sign(self, place: str) -> str:
        rise, slow = next(s.changes for s in self.sensors if s.changes[0].place == place)
        if rise.verdict != "changed" or max(rise.U95, slow.U95) > WIDE:
            return ""
        # 1 by a poorer film; copper that is warmer makes more heat, and adds a little.
        share = slow.change / rise.change
        if abs(share) <= ALIKE_SHARE:
            return ", in its heat or a contact within: it cools as before"
        return f", it cools {'less' if rise.change > 0 else 'better'}" if share > 0 else ""

    def document(self) -> dict[str, Any]:
        return {
            "case": self.case.name,
            "revision": self.case.model.revision,
            "test": self.later,
            "against": self.earlier,
            "verdict": self.verdict,
            "sentence": self.sentence,
            "part": self.changes[0].place if self.verdict == "changed" else None,
            "changes": [c.document() for c in self.changes],
            "left_out": list(self.left_out),
        }


def drift(case: th.MeasuredCase, later: th.Test, earlier: th.Test) -> Drift:
    """The later test against the earlier one. InputError where their loads differ or vary, or they share no sensor."""
    _comparable(later, earlier)
    pairs = list(_pairs(later.channels, earlier.channels))
    if not pairs:
        right = f"one at {', '.join(dict.fromkeys(c.place for c in earlier.channels)) or 'a place'}"
        raise InputError(f"has no sensor where {earlier.name} has one", f"test {later.name!r}", right)
    later, earlier = (replace(t, channels=c) for t, c in zip((later, earlier), zip(*pairs, strict=True), strict=True))
    network, values = th.standing(case), th.physical(case)
    air = th.ambient(network) or network.boundaries[0]

    def predicted(test: th.Test) -> list[th.Array]:
        """Rises of all sensors, and what they gain in a faster machine: in one whose time runs so much faster."""
        run, fast = (th.predict(network, replace(test, time=f * test.time), values).y.T for f in (1.0, 1.0 + STRETCH))
        return [run - test.boundaries[air], (fast - run) / STRETCH]

    rises = (np.array([c.y for c in t.channels]) - t.boundaries[air] for t in (later, earlier))
    later_rows, rows = (
        [y, *predicted(t), *predicted(_calm(t, air))] for t, y in zip((later, earlier), rises, strict=True)
    )
    there = [[_onto(earlier.time, later.time, y) for y in row] for row in later_rows]
    warm = predicted(_calm(earlier, air, 1.0))[0]
    columns = np.stack([*there, *rows, warm], axis=1)
    each = [(c.name, _sensor(c, earlier.time, x)) for c, x in zip(earlier.channels, columns, strict=True)]
    sensors = [s for _, s in each if s is not None]
    if not sensors:
        words = f"shares fewer than {LEAST} readings of any sensor with {earlier.name}, or none warms"
        raise InputError(words, f"test {later.name!r}", "two tests that are long enough, with a load")
    left_out = tuple(name for name, s in each if s is None)
    return Drift(case, later.name, earlier.name, tuple(_judged(sensors)), left_out)


def _comparable(later: th.Test, earlier: th.Test) -> None:
    where = f"test {later.name!r}"
    if set(later.inputs) != set(earlier.inputs):
        others = ", ".join(sorted(set(later.inputs) ^ set(earlier.inputs)))
        raise InputError(f"{others}: only in one of it and {earlier.name}", where, "the same inputs in both")
    if varying := next((t.name for t in (later, earlier) if not constant(t)), None):
        raise InputError("its load varies", f"test {varying!r}", "two tests under one constant load")
    for name in later.inputs:
        now, was = (float(np.mean(t.inputs[name][1:])) for t in (later, earlier))
        if abs(now - was) > ALIKE * max(abs(now), abs(was)):
            right = f"two tests whose loads differ by less than {100 * ALIKE:g} %"
            raise InputError(f"{name} is {now:.4g} here, and {was:.4g} in {earlier.name}", where, right)


def _pairs(later: Sequence[th.Channel], earlier: Sequence[th.Channel]) -> Iterator[tuple[th.Channel, th.Channel]]:
    """The same sensor in both tests: by its name, else the next one at its place."""
    left = list(earlier)
    for c in sorted(later, key=lambda c: c.name not in {e.name for e in earlier}):
        same = [e for e in left if e.name == c.name] or [e for e in left if e.place == c.place]
        if same:
            left.remove(same[0])
            yield c, replace(same[0], name=c.name, place=c.place, row=c.row)


def _calm(test: th.Test, air: str, above_K: float = 0.0) -> th.Test:
    """The test in an ambient that does not move, with a start there or so far above it."""
    mean = {name: np.full(test.time.size, float(np.mean(u))) for name, u in test.boundaries.items()}
    return replace(test, boundaries=mean, initial=float(mean[air][0]) + above_K)


def _onto(time: th.Array, other: th.Array, y: th.Array) -> th.Array:
    """Values at other times of the test, missing before the first and after the last reading."""
    read = np.isfinite(y)
    return np.interp(time, other[read], y[read], np.nan, np.nan) if read.any() else np.full(time.shape, np.nan)


def _sensor(sensor: th.Channel, time: th.Array, columns: th.Array) -> Sensor | None:
    """columns : (11, n_time) K: of the later, then of the earlier test the rise, its prediction with the gain of a
    faster machine, and both in an ambient that does not move; last, that of a start 1 K above ambient"""
    from scipy.stats import t as student

    read = np.isfinite(columns).all(axis=0)
    if read.sum() < LEAST:
        return None
    blocks = th.Blocks(th.blocks_of(int(read.sum())), 1 + len(columns))
    blocks.add(0, np.column_stack([time[read], columns[:, read].T]), np.ones(read.sum()))
    t, *rows = blocks.means().T
    (rise, full, full_gain, heat, heat_gain), warm = np.array(rows[:10]).reshape(2, 5, -1).swapaxes(0, 1), rows[10]
    air, air_gain = full - heat, full_gain - heat_gain  # by ambient and start, which warm all machines alike
    scale, faster = np.linalg.lstsq(np.column_stack([heat[1], heat_gain[1]]), rise[1] - air[1], rcond=None)[0]
    if scale * np.ptp(heat[1]) < sensor.sigma_K:
        return None
    share = np.clip(faster / scale, -1.0, 1.0)
    expected = scale * (heat + share * heat_gain) + air + share * air_gain
    after, shape = rise[0] - expected[0] + expected[1], expected[1] - air[1] - share * air_gain[1]
    X = np.column_stack([shape, -scale * heat_gain[1] - air_gain[1], warm - heat[1], np.ones_like(t)])
    offset = np.sqrt(2.0) * sensor.sigma_K  # of the difference of two readings
    changes, covariance, noise_K = _fitted(t, after - rise[1], X, offset)
    end = float(np.mean(rise[1, t >= LATE * t[-1]]))
    first = t[np.argmax(shape >= TIME_CONSTANT_SHARE * shape[-1])] / 60.0
    gain = offset / max(abs(end), sensor.sigma_K)
    sd = np.sqrt(np.diag(covariance)[:2] + np.array([gain**2, 0.0]))
    free = t.size - X.shape[1]
    factor, p = student.ppf(1.0 - LEVEL / 2.0, free), 2.0 * student.sf(np.abs(changes[:2]) / sd, free)
    band = factor * np.sqrt(np.einsum("ij,jk,ik->i", X, covariance, X) + (gain * shape) ** 2 + noise_K**2)
    numbers = np.array([[end, first], changes[:2], sd, factor * sd, p]).T.tolist()
    both = (Change(sensor.place, sensor.name, name, *row) for name, row in zip(WAYS, numbers, strict=True))
    return Sensor(tuple(both), t / 60.0, rise[1], after, band)


def _fitted(t: th.Array, d: th.Array, X: th.Array, offset_K: float) -> tuple[th.Array, th.Array, float]:
    """Generalised least squares: (weights, covariance, rms noise in K), meaned over all shapes that the noise may have.

    A shape counts by its restricted likelihood: the best one alone would be too sure. offset_K : of start and reading
    Source: Patterson and Thompson 1971, Biometrika 58, 545.
    """
    prior, free, fits = np.diag([0.0, 0.0, offset_K**-2, offset_K**-2]), t.size - X.shape[1], []
    for shape in th.NOISE_SHAPES:
        L, whole = np.linalg.cholesky(shape.matrix(t)), 1.0 + shape.a + shape.b
        white = np.linalg.solve(L, np.column_stack([X, d]))
        A, y = white[:, :-1], white[:, -1]
        left = y - A @ np.linalg.lstsq(A, y, rcond=None)[0]
        variance = max(float(left @ left) / free, RESOLVED_K**2 / whole)
        H = A.T @ A + variance * prior
        log = shape.log_prior() - np.log(np.diag(L)).sum() - 0.5 * (np.linalg.slogdet(H)[1] + free * np.log(variance))
        fits.append((log, np.linalg.solve(H, A.T @ y), variance * np.linalg.inv(H), variance * whole))
    log, each, covariance, noise = (np.array(x) for x in zip(*fits, strict=True))
    share = np.exp(log - log.max()) / np.exp(log - log.max()).sum()
    spread = each - share @ each
    total = np.einsum("k,kij->ij", share, covariance + spread[:, :, None] * spread[:, None, :])
    return share @ each, total, float(np.sqrt(share @ noise))


def _judged(sensors: Sequence[Sensor]) -> Iterator[Sensor]:
    """By Holm's rule, so that of equal tests no more than LEVEL have any change.

    Source: Holm 1979, Scandinavian Journal of Statistics 6, 65.
    """
    p = np.sort([c.p for s in sensors for c in s.changes])
    equal = np.flatnonzero(p > LEVEL / np.arange(p.size, 0, -1))
    limit = p[equal[0]] if equal.size else np.inf
    for s in sensors:
        words: list[Verdict] = [
            "changed" if c.p < limit else "equal" if c.U95 <= WIDE else "cannot tell" for c in s.changes
        ]
        yield replace(s, changes=tuple(replace(c, verdict=w) for c, w in zip(s.changes, words, strict=True)))
