"""What the warming curves of a case say: eq. 8 and eq. 9 for every sensor, the 3 to 4 % rule, equal tests pooled."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

import numpy as np

from extras.bench.measuring.warming import Equilibrium, Repeats, Warming, equilibrium, fit_eq8, repeats, spaced_window
from thermoscope import InputError, plugin as th

R = TypeVar("R")
STEADY = 0.02  # a load that strays further from its mean (rms) is not a constant load
ALIKE = 0.02  # tests whose mean loads differ by less are repeats of one test
LATE = 0.75  # share of a test after which its readings count as its end


@dataclass(frozen=True)
class Curve:
    """One sensor in one test.  warming, equilibrium : None where `why` says what is missing for it"""

    channel: str
    place: str
    warming: Warming | None
    equilibrium: Equilibrium | None
    why: str = ""

    def document(self) -> dict[str, Any]:
        eq8, steady = self.warming and self.warming.document(), self.equilibrium and self.equilibrium.document()
        return {"channel": self.channel, "place": self.place, "eq8": eq8, "equilibrium": steady, "why": self.why}


@dataclass(frozen=True)
class Curves:
    """curves, rules : by test;  pooled : (tests, place) -> rises over ambient pooled, and whether they repeat"""

    case: th.MeasuredCase
    curves: dict[str, tuple[Curve, ...]]
    rules: "dict[str, tuple[Assembly, ...]]"
    pooled: dict[tuple[tuple[str, ...], str], Repeats]

    @property
    def agrees(self) -> bool:
        """Whether every assembly is within 4 % and equal tests repeat."""
        calibrated = all(worst(rows)["calibrated"] for rows in self.rules.values() if rows)
        return calibrated and all(repeats_of.repeat for repeats_of in self.pooled.values())

    def document(self) -> dict[str, Any]:
        tests = [
            {
                "name": name,
                "curves": [c.document() for c in rows],
                "assemblies": [{"place": a.place, **a.document()} for a in self.rules[name]],
                "rule": worst(self.rules[name]) if self.rules[name] else None,
            }
            for name, rows in self.curves.items()
        ]
        equal = [
            {"tests": list(names), "place": place, **pooled.document()}
            for (names, place), pooled in self.pooled.items()
        ]
        head = {"case": self.case.name, "revision": self.case.model.revision, "agrees": self.agrees}
        return {**head, "tests": tests, "repeats": equal}


def curves(case: th.MeasuredCase, resolution_K: float = 0.5) -> Curves:
    """All of it for the tests of a case; resolution_K : of the thermocouples (electrical readings by their sigma)."""
    network = th.standing(case)
    values, air = th.physical(case), th.ambient(network) or network.boundaries[0]
    rules = {t.name: _rules(t, th.predict(network, t, values).y, resolution_K) for t in case.tests}
    curves_of = {t.name: tuple(curve(t, c, resolution_K) for c in t.channels) for t in case.tests}
    return Curves(case, curves_of, rules, dict(_pooled(case.tests, air)))


def curve(test: th.Test, channel: th.Channel, resolution_K: float = 0.5) -> Curve:
    """Eq. 8 and eq. 9 of one sensor, as far as its record allows."""
    minutes, fine = test.time / 60.0, max(resolution_K, channel.sigma_K)
    start = test.initial if isinstance(test.initial, float) else None
    warming, why = _result_or_reason(lambda: fit_eq8(minutes, channel.y, start, resolution_K))
    if not constant(test):
        warming, why = None, "the load varies: eq. 8 is for constant load"
    steady, short = _result_or_reason(lambda: equilibrium(minutes, channel.y, fine, window_min(test, channel)))
    return Curve(channel.name, channel.place, warming, steady, "; ".join(w for w in (why, short) if w))


def window_min(test: th.Test, channel: th.Channel) -> float:
    """Ten minutes, or twice the time between readings where they are rarer."""
    return spaced_window(test.time[np.isfinite(channel.y)] / 60.0)


def _result_or_reason(look: Callable[[], R]) -> tuple[R | None, str]:
    try:
        return look(), ""
    except InputError as fault:
        return None, f"{fault.where}: {fault.what}"
    except RuntimeError:
        return None, "eq. 8: no such curve fits these readings"


def constant(test: th.Test) -> bool:
    """Is the load the same all the time, but for a start from zero?"""
    return all(np.std(v[1:]) <= STEADY * max(abs(float(np.mean(v[1:]))), 1e-12) for v in test.inputs.values())


def _rules(test: th.Test, predicted: th.Array, resolution_K: float) -> "tuple[Assembly, ...]":
    window = max((window_min(test, c) for c in test.channels), default=10.0)
    rules, _ = _result_or_reason(lambda: assemblies(test, predicted, resolution_K, window))
    return tuple(rules or ())


def _pooled(tests: Sequence[th.Test], air: str) -> Iterator[tuple[tuple[tuple[str, ...], str], Repeats]]:
    for group in alike(tests):
        for place in dict.fromkeys(c.place for c in group[0].channels):
            ends = [end for end in (_end(test, place, air) for test in group) if end]
            if len(ends) > 1:
                names = tuple(test.name for test in group)
                yield (names, place), repeats([rise for rise, _ in ends], max(u for _, u in ends))


def alike(tests: Sequence[th.Test]) -> list[list[th.Test]]:
    """Groups of two tests or more under the same constant load."""
    groups: list[list[th.Test]] = []
    for test in (t for t in tests if constant(t)):
        home = next((g for g in groups if _same(g[0], test)), None)
        if home is None:
            groups.append([test])
        else:
            home.append(test)
    return [g for g in groups if len(g) > 1]


def _same(a: th.Test, b: th.Test) -> bool:
    if set(a.inputs) != set(b.inputs) or abs(a.time[-1] / b.time[-1] - 1.0) > ALIKE:
        return False
    pairs = [(float(np.mean(a.inputs[n])), float(np.mean(b.inputs[n]))) for n in a.inputs]
    return all(abs(x - y) <= ALIKE * max(abs(x), abs(y)) for x, y in pairs)


def _end(test: th.Test, place: str, boundary: str) -> tuple[float, float] | None:
    """Rise over ambient (K) of a place in the last quarter, and the sensor's uncertainty (K)."""
    late, air = test.time >= LATE * test.time[-1], np.broadcast_to(test.boundaries[boundary], test.time.shape)
    ends = []
    for c in (c for c in test.channels if c.place == place):
        rows = late & np.isfinite(c.y)
        if rows.any():
            ends.append((float(np.mean(c.y[rows] - air[rows])), c.sigma_K))
    return (float(np.mean([r for r, _ in ends])), max(u for _, u in ends)) if ends else None


# The published acceptance rule, assembly by assembly: percent of the measured temperature.
CLOSE, TOLERANCE, NEVER = 3.0, 4.0, 7.0
Verdict = Literal["calibrated", "allowed", "correct the model", "beyond 7 %"]


@dataclass(frozen=True)
class Assembly(th.TableRow):
    """T_e measured and calculated (degC) of one assembly, at equilibrium or, where it was not reached, at the end.

    percent : of the measured temperature in degC, as published;  percent_of_rise : of its rise over ambient
    U95_percent : what the reading itself is uncertain by; where it is more than the rule, the rule asks too much
    """

    properties = ("verdict",)

    place: str
    steady: bool
    measured: float
    calculated: float
    percent: float
    percent_of_rise: float
    U95_percent: float = 0.0

    @property
    def verdict(self) -> Verdict:
        limits: tuple[tuple[float, Verdict], ...] = (
            (CLOSE, "calibrated"),
            (TOLERANCE, "allowed"),
            (NEVER, "correct the model"),
        )
        return next((word for limit, word in limits if self.percent <= limit), "beyond 7 %")


def assembly(place: str, T_exp: tuple[float, bool], T_calc: float, ambient: float, u_K: float = 0.0) -> Assembly:
    """T_exp : (degC, whether it was steady);  u_K : its standard uncertainty."""
    measured, steady = T_exp
    off = 100.0 * abs(T_calc - measured)
    rise = max(abs(measured - ambient), 1e-9)
    return Assembly(place, steady, measured, T_calc, off / abs(measured), off / rise, 200.0 * u_K / abs(measured))


def assemblies(
    test: th.Test, predicted: th.Array, resolution_K: float = 0.5, window_min: float = 10.0
) -> list[Assembly]:
    """Every place of a test: the mean of its channels, the prediction (n_time, n_channel) likewise."""
    ambient = float(np.mean([u[-1] for u in test.boundaries.values()]))
    out = []
    for place in dict.fromkeys(c.place for c in test.channels):
        columns = [j for j, c in enumerate(test.channels) if c.place == place and np.isfinite(c.y).any()]
        if columns:
            read = np.ma.masked_invalid([test.channels[j].y for j in columns])
            y = read.mean(axis=0).filled(np.nan)  # where none was read there is no mean
            end = equilibrium(test.time / 60.0, y, resolution_K, window_min)
            late = test.time >= test.time[-1] - 60.0 * window_min
            calculated = float(np.mean(predicted[late][:, columns]))
            u = max(test.channels[j].sigma_K for j in columns)
            out.append(assembly(place, (float(np.nanmean(y[late])), end.reached), calculated, ambient, u))
    return out


def worst(rows: Sequence[Assembly]) -> Mapping[str, Any]:
    """The summary the paper gives: typical and largest error (%), and whether the model counts as calibrated."""
    errors = [r.percent for r in rows]
    typical, calibrated = float(np.median(errors)), all(e <= TOLERANCE for e in errors)
    return {"typical_percent": typical, "largest_percent": max(errors), "calibrated": calibrated}
