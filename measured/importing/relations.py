"""What readings say of each other: which column was made of others, which could be a temperature, and what heats.

Each sensor has noise that no other has. A column that equals a function of others to within the last digit, over a
span of many digits, was therefore computed.
"""

import itertools
from collections.abc import Container, Mapping, Sequence
from functools import partial

import numpy as np

from geom.arrays import Array

SAME = "the same readings as"
MOST = 50_000  # rows in which a filtered column is looked for
ROWS = 4000  # that are enough to tell a relation
DIGITS = 40.0  # of the last digits, that a column has to span before an equality says anything
GAP = 3.0  # tolerances by which sensors must differ somewhere
EQUAL = 0.05  # between weights of a mean
CALM = 0.7  # noise of a filtered column over that of its sensor
WINDOWS = range(2, 241)  # rows of a moving average
NEAR = 0.1  # of the span: a filtered column is close to its sensor
LAGS = 6  # time constants of a response, from a few rows to the record
FINE = 1e-4  # of the span: what programs lose on the way
SCALES = ((1.8, 32.0), (1.0, 273.15), (10.0, 0.0), (0.1, 0.0))  # degF, K and tenths of degC
START_K = 8.0  # between columns of one machine at rest
LIMITS = (-40.0, 250.0)  # degC of what has no unit
STEP = 0.2  # of its span: a temperature does not jump by more from row to row
USUAL = 95.0  # per cent of its steps
DECIMALS = 5  # that loggers write
COARSE = 12  # different values: fewer are a state or a step
BLOCKS = 200  # of a record, over which readings are averaged
NAMES = 8  # of columns, before the rest is counted
NOISE_K = 0.2  # of sensors: no misfit below it tells columns apart


def resolution(values: Array) -> float:
    """The last digit that a column shows; of one in another unit the least step between readings."""
    values = values[np.isfinite(values)]
    for digits in range(DECIMALS):
        scaled = values * 10.0**digits
        if np.all(np.abs(scaled - np.round(scaled)) < 1e-6 * np.maximum(np.abs(scaled), 1.0)):
            return 10.0**-digits
    steps = np.diff(np.unique(values))
    steps = steps[steps > 1e-9 * max(float(np.ptp(values)) if values.size else 0.0, 1e-9)]
    return float(steps.min()) if steps.size else 0.0


def functional_relations(hot: Mapping[str, Array], others: Mapping[str, Array], free: Container[str]) -> dict[str, str]:
    """Columns that are functions of temperatures, with the function.

    hot : temperatures in degC, those with names of parts first;  others : numbers of any kind, at the same rows

    free : columns that may be in any unit
    """
    columns = {c: v for c, v in {**hot, **others}.items() if np.isfinite(v).sum() > COARSE}
    good = np.all([np.isfinite(v) for v in columns.values()], axis=0) if columns else np.zeros(1, bool)
    if good.sum() < COARSE:
        return {}
    rows = np.flatnonzero(good)
    every = {c: v[rows[:: max(1, rows.size // ROWS)]] for c, v in columns.items()}
    full = {c: v[rows[:MOST]] for c, v in columns.items() if c in hot}
    digit = {c: resolution(v) for c, v in every.items()}
    wide = [c for c in every if float(np.ptp(every[c])) > DIGITS * digit[c] > 0.0]
    out: dict[str, str] = {}
    for c in wide:
        margin = digit[c] / 2 + FINE * float(np.ptp(every[c]))
        sources = {n: every[n] for n in wide if n in hot and n != c and n not in out}
        before = [n for n in sources if c in others or wide.index(n) < wide.index(c)]
        near = partial(_within, every[c], margin, digit)
        scales = [(1.0, 0.0), *(SCALES if c in free else ())]  # of the units that temperatures have
        if copy := next((n for n in before for a, b in scales if near(a * every[n] + b, [n], a)), ""):
            out[c] = f"{SAME} '{copy}'"
        elif sources:
            ways = (_extreme(every[c], sources, digit[c], digit), _mean(every[c], sources, near))
            if words := next(filter(None, ways), "") or _difference(every[c], sources, near):
                out[c] = words
    for c, n in itertools.permutations([c for c in wide if c in hot and c not in out], 2):
        if c not in out and n not in out and _is_filtered(full[c], full[n], 1.5 * max(digit[c], digit[n])):
            out[c] = f"'{n}', filtered"
    return out


def is_equal(y: Array, other: Array) -> bool:
    """The same numbers but for their last digits, over many of them."""
    good = np.isfinite(y) & np.isfinite(other)
    if good.sum() < COARSE:
        return False
    span, digit = float(np.ptp(y[good])), max(resolution(y[good]), resolution(other[good]))
    return span > DIGITS * digit and float(np.abs(y - other)[good].max()) <= digit + FINE * span


def is_product(y: Array, factors: Sequence[Array]) -> bool:
    """Is it two of several columns times a constant?"""
    for a, b in itertools.combinations(factors, 2):
        good = np.isfinite(y) & np.isfinite(a * b)
        size = float(np.sum((a * b)[good] ** 2))
        if good.sum() < COARSE or not size > 0.0 or min(np.ptp(a[good]), np.ptp(b[good])) == 0.0:
            continue
        factor = float(np.sum((y * a * b)[good]) / size)
        slack = resolution(y[good]) + factor * (np.abs(a) * resolution(b[good]) + np.abs(b) * resolution(a[good]))
        if np.all((np.abs(y - factor * a * b) <= slack + FINE * float(np.ptp(y[good])))[good]):
            return True
    return False


def _within(
    y: Array, margin: float, digit: Mapping[str, float], other: Array, names: Sequence[str], factor: float = 1.0
) -> bool:
    """Equal to within the last digits of both?"""
    return bool(np.max(np.abs(y - other)) <= margin + factor * max(digit[n] for n in names) / 2)


def _extreme(y: Array, others: Mapping[str, Array], margin: float, digit: Mapping[str, float]) -> str:
    """The largest or the least of several columns, each of which is it for a while."""
    for name, sign in (("largest", 1.0), ("least", -1.0)):
        slack = {n: sign * (y - v) for n, v in others.items()}
        limits = {n: (margin + digit[n]) / 2 + 1e-9 for n in others}
        within = [n for n, gap in slack.items() if float(gap.min()) >= -limits[n]]
        if len(within) < 2 or not np.all(np.min([slack[n] - limits[n] for n in within], axis=0) <= 0.0):
            continue
        reach = np.array([slack[n] <= limits[n] for n in within])
        alone = [n for n, at in zip(within, reach & (reach.sum(axis=0) == 1), strict=True) if at.mean() > 0.01]
        if len(alone) > 1:
            return f"the {name} of {names_of(alone, 3)}"
    return ""


def _mean(y: Array, others: Mapping[str, Array], near: partial[bool]) -> str:
    """The mean of several columns."""
    from scipy.optimize import nnls

    if len(others) < 2:
        return ""
    names, table = [*others], np.array([*others.values()]).T
    weights = nnls(table, y)[0]
    part = [n for n, w in zip(names, weights, strict=True) if w > EQUAL]
    shares = weights[weights > EQUAL]
    if len(part) < 2 or np.ptp(shares) > EQUAL or abs(shares.sum() - 1.0) > EQUAL:
        return ""
    mean = np.mean([others[n] for n in part], axis=0)
    tolerance = GAP * float(np.abs(y - mean).max())
    differ = all(float(np.abs(others[n] - y).max()) > tolerance for n in part)
    return f"the mean of {names_of(part, 3)}" if near(mean, part) and differ else ""


def _difference(y: Array, sources: Mapping[str, Array], near: partial[bool]) -> str:
    """One column less another, both of which start far from zero."""
    high = [n for n, v in sources.items() if abs(float(v[0])) > 2.0 * abs(float(y[0])) + 1.0]
    pairs = itertools.permutations(high, 2)
    return next((f"'{a}' less '{b}'" for a, b in pairs if near(sources[a] - sources[b], [a, b])), "")


def _is_filtered(y: Array, x: Array, limit: float) -> bool:
    """Is it the other after a lag of the first order or a moving average of rows?"""
    from scipy.signal import lfilter

    span = float(np.ptp(y))
    if span < DIGITS * limit or float(np.mean(np.abs(y - x))) > NEAR * span:
        return False
    if float(np.std(np.diff(y, 2))) > CALM * float(np.std(np.diff(x, 2))):
        return False
    for source in (x[1:], x[:-1]):
        gap = source - y[:-1]
        share = float(gap @ np.diff(y) / max(float(gap @ gap), 1e-300))
        for a in share * np.array([0.95, 1.0, 1.05]) if 0.0 < share < 1.0 else ():
            lagged = lfilter([a], [1.0, a - 1.0], source, zi=[(1.0 - a) * y[0]])[0]
            if float(np.max(np.abs(lagged - y[1:]))) <= limit:
                return True
    sums = np.concatenate([[0.0], np.cumsum(x)])
    for rows in (n for n in WINDOWS if 3 * n < y.size):
        means = (sums[rows:] - sums[:-rows]) / rows
        for late in {rows - 1, rows // 2}:
            part = y[late : late + means.size]
            if float(np.max(np.abs(part - means[: part.size])[rows:-rows])) <= limit:
                return True
    return False


def names_of(columns: Sequence[str], most: int = NAMES) -> str:
    """ "'a', 'b' and 3 more"."""
    more = f" and {len(columns) - most} more" if len(columns) > most else ""
    return ", ".join(f"'{c}'" for c in columns[:most]) + more


def is_smooth(values: Array) -> bool:
    """Are most steps from row to row small beside its span?  A probe may be moved, and a record have a gap."""
    return float(np.percentile(np.abs(np.diff(values)), USUAL)) < STEP * float(np.ptp(values)) + 1.0


def is_like_temperature(values: Array, starts: Sequence[float], band_K: float = START_K) -> bool:
    """Does it start where temperatures of the same recording start, in many small steps?

    starts : of those that are known (degC); without any a room's are taken;  band_K : from them
    """
    values = values[np.isfinite(values)]
    if values.size < COARSE or np.unique(values).size < COARSE or not (values % 1).any():
        return False
    low, high = (min(starts), max(starts)) if starts else (10.0, 35.0)
    inside = LIMITS[0] < float(values.min()) and float(values.max()) < LIMITS[1]
    return is_smooth(values) and inside and low - band_K < float(np.median(values[:5])) < high + band_K


def misfit(seconds: Array, rise: Array, heat: Array, exponent: float) -> float:
    """What is left (K rms) of a rise over the room after the response to a heat, with every time constant there is."""
    from scipy.optimize import nnls
    from scipy.signal import lfilter

    rows = slice(None, None, max(1, rise.size // ROWS))
    good = np.isfinite(rise) & np.isfinite(heat) & np.isfinite(seconds)
    t, y, u = (v[good][rows] for v in (seconds, rise, np.abs(heat) ** exponent))
    if y.size < COARSE or not float(np.ptp(u)) > 0.0:
        return float(np.std(y)) if y.size else np.inf
    step = float(np.median(np.diff(np.unique(t))))  # rows may share their instant
    shares = -np.expm1(-step / np.geomspace(3.0 * step, max(float(t[-1] - t[0]), 10.0 * step), LAGS))
    table = [lfilter([a], [1.0, a - 1.0], u / u.max()) for a in shares]
    table += [np.exp(np.log1p(-a) * np.arange(y.size)) for a in shares[LAGS // 2 :]]  # what it started with
    return float(nnls(np.array(table).T, y - min(float(y.min()), 0.0))[1] / np.sqrt(y.size))


def quickness(values: Array, heat: Array) -> float:
    """How fast a temperature begins to rise at the largest square of the heat, in K per block of rows.

    By least squares on what it rises by, against the heat and what has risen so far.
    """
    good = np.isfinite(values) & np.isfinite(heat)
    rows = max(1, int(good.sum()) // BLOCKS)
    count = int(good.sum()) // rows
    if count < COARSE:
        return 0.0
    y, u = (v[good][: rows * count].reshape(count, rows).mean(axis=1) for v in (values, heat**2))
    if not float(np.ptp(u)) > 0.0:
        return 0.0
    table = np.column_stack([(u[1:] + u[:-1]) / 2.0 / u.max(), y[:-1], np.ones(count - 1)])
    return float(np.linalg.lstsq(table, np.diff(y), rcond=None)[0][0])
