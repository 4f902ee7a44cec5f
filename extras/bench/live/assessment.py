"""What the rows so far say: the case's own diagnosis by its first odds, and which sensors have stopped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from thermoscope.plugin import Channel, Folder, Posterior, Test, explanations, hidden_effects, infer, probabilities

STUCK_S, MOTION_K = 120.0, 2.0  # equal readings for so long, while another sensor moved by as much
EQUAL = 5  # last readings of a channel that may be those of a dead sensor
FEWEST = 15  # rows before anything is asked of a diagnosis
NOTHING = "nothing"


@dataclass(frozen=True)
class Assessment:
    """odds : by leading cause, most probable first;  over : sensors that have stopped;  unseen : what cannot show yet

    test : the rows as they count;  posterior : all that the planner goes on from
    """

    odds: tuple[tuple[str, float], ...]
    over: tuple[str, ...]
    unseen: tuple[str, ...]
    test: Test
    posterior: Posterior

    @property
    def entropy(self) -> float:
        """Of the hypotheses (nats)."""
        p = probabilities(self.posterior.hypotheses)
        return float(-np.sum(p * np.log(np.maximum(p, 1e-300))))


def assess(folder: Folder, name: str, quick: bool = True) -> Assessment:
    """Of all tests of a case, the rows of test `name` among them."""
    case = folder.case
    live = next(t for t in case.tests if t.name == name)
    live, over = without_stuck(live)
    case = replace(case, tests=tuple(live if t.name == name else t for t in case.tests))
    posterior = infer(case.training(), folder.settings.kinds, quick=quick)
    rows = [(e.cause, float(e.probability)) for e in explanations(posterior) if e.cause != "others"]
    hidden = tuple(h.effect for h in hidden_effects(posterior.evidence))
    return Assessment(tuple(sorted(rows, key=lambda r: -r[1])), over, hidden, live, posterior)


def without_stuck(test: Test) -> tuple[Test, tuple[str, ...]]:
    """The rows without last readings of a channel that are all equal, and the channels that have stopped by them.

    Some equal readings mean nothing yet; they are left out all the same, for they may be the first of a dead sensor.
    """
    over, channels = [], []
    for c in test.channels:
        read = np.flatnonzero(np.isfinite(c.y))
        different = read[c.y[read] != c.y[read[-1]]] if read.size else read
        tail = read[read > (different[-1] if different.size else -1)]
        if tail.size >= EQUAL:
            first = int(tail[0])
            c = replace(c, y=np.where(np.arange(c.y.size) <= first, c.y, np.nan))
            others = [o for o in test.channels if o.name != c.name]
            if test.time[-1] - test.time[first] >= STUCK_S and _motion(others, first) > MOTION_K:
                over.append(c.name)
        channels.append(c)
    return replace(test, channels=tuple(channels)), tuple(over)


def _motion(channels: Sequence[Channel], first: int) -> float:
    late = [c.y[first:][np.isfinite(c.y[first:])] for c in channels]
    return max((float(np.ptp(y)) for y in late if y.size), default=0.0)
