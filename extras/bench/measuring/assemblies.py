"""The published acceptance rule, assembly by assembly: within 3 to 4 % of the measured temperature, never above 7 %."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from extras.bench.measuring.warming import equilibrium
from thermoscope import plugin as th

CLOSE, TOLERANCE, NEVER = 3.0, 4.0, 7.0  # percent of the temperature, as published
Verdict = Literal["calibrated", "allowed", "correct the model", "beyond 7 %"]


@dataclass(frozen=True)
class Assembly:
    """T_e measured and calculated (degC) of one assembly, at equilibrium or, where it was not reached, at the end.

    percent : of the measured temperature in degC, as published;  percent_of_rise : of its rise over ambient
    U95_percent : what the reading itself is uncertain by; where it is more than the rule, the rule asks too much
    """

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

    def document(self) -> dict[str, Any]:
        return {**vars(self), "verdict": self.verdict}


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
            y = np.nanmean([test.channels[j].y for j in columns], axis=0)
            end = equilibrium(test.time / 60.0, y, resolution_K, window_min)
            late = test.time >= test.time[-1] - 60.0 * window_min
            calculated = float(np.mean(predicted[late][:, columns]))
            u = max(test.channels[j].sigma_K for j in columns)
            out.append(assembly(place, (float(np.nanmean(y[late])), end.reached), calculated, ambient, u))
    return out


def worst(rows: Sequence[Assembly]) -> Mapping[str, Any]:
    """The summary the paper gives: typical and largest error (%), and whether the model counts as calibrated."""
    errors = [r.percent for r in rows]
    return {
        "typical_percent": float(np.median(errors)),
        "largest_percent": max(errors),
        "calibrated": all(e <= TOLERANCE for e in errors),
    }
