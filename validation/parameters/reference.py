"""What a model takes from the tests that a fit may use, and keeps: levels of inputs, sizes of effects, the load point.

An exponent turns its law about the level of its inputs. Were that looked up in the tests at hand, one file would be
another model wherever another test is recorded. So it is determined when the model is fitted, and stored with it.
"""

from collections.abc import Collection, Mapping, Sequence
from math import fsum

import numpy as np

from geom.arrays import Array
from lumped.model.network import Network
from lumped.model.quantities import INPUTS
from lumped.transfer.laws import CLOCK, Law
from measured.case import Reference, SignalReference, Test

LOADS = ("current", "torque")  # quantities that grow with the load
DIGITS = 9  # of what is stored: memory and file hold the same number
STILL = 0.1  # of its mean: an input that changes by less is one value
THIRD = 0.1  # of the distance of two values: farther from both is a third
RARE = 0.02  # of all samples: so many lie between two values where one switches to the other


def reference_of(network: Network, tests: Sequence[Test], effects: Collection[str] = ()) -> Reference:
    """Over these tests alone.  effects : in the network, whose sizes count"""
    load, records = load_point(network, tests), _records(tests)
    mains = {network.signal(q) for q in INPUTS}
    signals = {}
    for n, u in records.items():
        if np.isfinite(u).any():
            level, low, high = (_rounded(x) for x in (np.sqrt(np.nanmean(u**2)), np.nanmin(u), np.nanmax(u)))
            signals[n] = SignalReference(level, low, high, load.get(n), network.measures(n), n in mains)
    for name in dict.fromkeys(b for t in tests for b in t.boundaries):
        each = [np.asarray(t.boundaries[name], float) for t in tests if name in t.boundaries]
        mean = _rounded(np.mean([np.mean(u) for u in each]))
        low, high = min(float(u.min()) for u in each), max(float(u.max()) for u in each)
        signals[name] = SignalReference(mean, _rounded(low), _rounded(high), mean)
    start = tests[0].initial if tests else None
    mean_start = float(np.mean(list(start.values()))) if isinstance(start, Mapping) else start
    start_C, sizes = None if mean_start is None else _rounded(mean_start), effect_sizes(network, effects, tests)
    return Reference(signals, sizes, tuple(t.name for t in tests), start_C=start_C)


def _records(tests: Sequence[Test]) -> dict[str, Array]:
    """Input -> its samples in all tests that record it."""
    names = dict.fromkeys(name for t in tests for name in t.inputs)
    return {
        n: np.concatenate([np.atleast_1d(t.inputs[n]).astype(float) for t in tests if n in t.inputs]) for n in names
    }


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def load_point(network: Network, tests: Sequence[Test]) -> dict[str, float]:
    """Input -> value at the instant of the largest load, of the tests that record all that the laws read.

    Load is what measures one of LOADS; where nothing does, all inputs, each as a share of its largest.
    """
    reads = network.inputs - {CLOCK}
    complete = [t for t in tests if reads <= set(t.inputs)]
    loads = [n for n in sorted(reads) if network.measures(n) in LOADS]
    records = _records(complete)
    scale = {n: 1.0 if loads else float(np.max(np.abs(records[n]))) or 1.0 for n in (loads or sorted(reads)) if records}
    best: tuple[float, dict[str, float]] = (-1.0, {})
    for t in complete if scale else ():
        size = np.max([np.abs(t.inputs[n]) / s for n, s in scale.items()], axis=0)
        k = int(np.argmax(size))
        if size[k] > best[0]:
            best = float(size[k]), {n: _rounded(u[k]) for n, u in t.inputs.items()}
    return best[1]


def effect_sizes(network: Network, effects: Collection[str], tests: Sequence[Test]) -> dict[str, float]:
    """Effect that puts in watts -> mean of what its laws multiply its amplitude by; none where no test records it."""
    laws = {s.name: s.law for s in network.sources}
    watts = [p for p in network.parameters if p.name in effects and p.unit.split(" at ")[0] == "W"]
    size = {p.name: mean_factor([laws[t] for t, _ in p.targets if t in laws], tests) for p in watts}
    return {name: _rounded(f) for name, f in size.items() if f > 0}


def mean_factor(laws: Sequence[Law], tests: Sequence[Test]) -> float:
    """Mean size of what the laws multiply an amplitude by; 0 where nothing is known."""
    factors = [np.abs(law.size(t.inputs)) for law in laws for t in tests if set(law.reads) <= set(t.inputs)]
    return fsum(float(np.mean(f)) for f in factors) / len(factors) if factors else 0.0  # to the bit in any order


def value_counts(tests: Sequence[Test]) -> dict[str, int]:
    """Input -> how many values its size takes in these tests: 1, 2, or 3 for more.

    Two values say nothing of a shape between them: a coefficient for each would fit as well as any exponent.
    """
    return {name: _value_count(np.abs(u[np.isfinite(u)])) for name, u in _records(tests).items()}


def _value_count(u: Array) -> int:
    if u.size == 0 or np.ptp(u) <= STILL * np.mean(u):
        return 1
    upper = u > 0.5 * (u.min() + u.max())
    low, high = np.median(u[~upper]), np.median(u[upper])
    away = np.minimum(np.abs(u - low), np.abs(u - high)) > THIRD * (high - low)
    return 3 if np.mean(away) > RARE else 2
