"""What the rows so far say: the case's own diagnosis by its first odds, and which sensors have stopped."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from warnings import catch_warnings, simplefilter

import numpy as np

from thermoscope import plugin as th

STUCK_S, MOTION_K = 120.0, 2.0  # equal readings for so long, while another sensor moved by as much
MOST_ROWS = 3000  # that odds are worked out from: three hours of a row every four seconds
SAME_K = 1e-6  # between equal readings: rows that were averaged differ in their last digits
EQUAL = 5  # last readings of a channel that may be those of a dead sensor
FEWEST = 15  # rows before anything is asked of a diagnosis
NOTHING, LEAST = "nothing", 0.01  # the probability from which a cause counts


@dataclass(frozen=True)
class Assessment:
    """odds : by leading cause, most probable first;  over : sensors that have stopped;  unseen : what cannot show yet

    test : the rows as they count;  posterior : all that the planner goes on from
    """

    odds: tuple[tuple[str, float], ...]
    over: tuple[str, ...]
    unseen: tuple[str, ...]
    test: th.Test
    posterior: th.Posterior

    @property
    def entropy(self) -> float:
        """Of the hypotheses (nats)."""
        p = th.probabilities(self.posterior.hypotheses)
        return float(-np.sum(p * np.log(np.maximum(p, 1e-300))))

    def gain_over(self, before: Mapping[str, float]) -> float:
        """What was learned since some odds (nats): how far the odds are, not how much surer.

        An answer that changes has taught as much as one that stays.
        """
        likely = [(n, p) for n, p in self.odds if p > LEAST]
        return float(sum(p * np.log(p / max(before.get(n, 0.0), LEAST)) for n, p in likely))


def assess(folder: th.Folder, name: str, quick: bool = True) -> Assessment:
    """Of all tests of a case, the rows of test `name` among them."""
    case = folder.case
    live = next(t for t in case.tests if t.name == name)
    live, over = without_stuck(live)
    live = thinned(live)
    case = replace(case, tests=tuple(live if t.name == name else t for t in case.tests))
    posterior = th.infer(case.training(), folder.settings.kinds, quick=quick)
    rows = [(e.cause, float(e.probability)) for e in th.explanations(posterior) if e.cause != "others"]
    hidden = tuple(h.effect for h in th.hidden_effects(posterior.evidence))
    return Assessment(tuple(sorted(rows, key=lambda r: -r[1])), over, hidden, live, posterior)


def without_stuck(test: th.Test) -> tuple[th.Test, tuple[str, ...]]:
    """The rows without last readings of a channel that are all equal, and the channels that have stopped by them.

    Some equal readings mean nothing yet; they are left out all the same, for they may be the first of a dead sensor.
    """
    over, channels = [], []
    for c in test.channels:
        read = np.flatnonzero(np.isfinite(c.y))
        different = read[np.abs(c.y[read] - c.y[read[-1]]) > SAME_K] if read.size else read
        tail = read[read > (different[-1] if different.size else -1)]
        if tail.size >= EQUAL:
            first = int(tail[0])
            c = replace(c, y=np.where(np.arange(c.y.size) <= first, c.y, np.nan))
            others = [o for o in test.channels if o.name != c.name]
            if test.time[-1] - test.time[first] >= STUCK_S and _motion(others, first) > MOTION_K:
                over.append(c.name)
        channels.append(c)
    return replace(test, channels=tuple(channels)), tuple(over)


def thinned(test: th.Test, most: int = MOST_ROWS) -> th.Test:
    """At most so many rows, means of so many at a time, and one channel for each place: the mean of its sensors."""
    step = -(-test.time.size // most)
    at = np.arange(0, test.time.size, step)
    count = np.diff(np.append(at, test.time.size))

    def mean(u: th.Array | float) -> th.Array:
        return np.asarray(np.add.reduceat(np.broadcast_to(np.asarray(u, float), test.time.shape), at) / count)

    groups: dict[str, list[th.Channel]] = {}
    for c in test.channels:
        groups.setdefault(c.place, []).append(c)
    with catch_warnings():
        simplefilter("ignore", RuntimeWarning)  # rows in which no sensor of a place was read
        y = {p: np.nanmean([c.y for c in some], axis=0) if len(some) > 1 else some[0].y for p, some in groups.items()}
    channels = tuple(replace(some[0], y=mean(y[p]) if step > 1 else y[p]) for p, some in groups.items())
    if step == 1:
        return replace(test, channels=channels)
    inputs, boundaries = ({n: mean(u) for n, u in each.items()} for each in (test.inputs, test.boundaries))
    return replace(test, time=mean(test.time), inputs=inputs, boundaries=boundaries, channels=channels, recorded=None)


def _motion(channels: Sequence[th.Channel], first: int) -> float:
    late = [c.y[first:][np.isfinite(c.y[first:])] for c in channels]
    return max((float(np.ptp(y)) for y in late if y.size), default=0.0)
