"""Which base a machine stood on: every base of the network held against one test, the films left as calibrated.

A wrong base would otherwise be made good by a film that other tests contradict.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geom.errors import InputError
from validation.case import Case, Test
from validation.procedure.carry import Row, settled

LEVEL = 0.01
MODEL_K = 1.0  # what a calibrated network of a dozen nodes may miss


@dataclass(frozen=True)
class Hypothesis:
    """base : the switch that is 1, "" for none;  p : of a misfit this large by the measurement's uncertainty alone

    offset_K : mean of simulated minus measured: above 0, the real base carries off more heat than this one
    """

    base: str
    p: float
    offset_K: float
    rows: tuple[Row, ...]

    @property
    def excluded(self) -> bool:
        return self.p < LEVEL

    def document(self) -> dict[str, Any]:
        return {"base": self.base or "none", "p": self.p, "offset_K": self.offset_K, "excluded": self.excluded}


def which_base(case: Case, name: str, switches: Sequence[str]) -> list[Hypothesis]:
    """All bases, the most likely first; `switches` are the inputs that couple one base each."""
    test = next((t for t in case.tests if t.name == name), None)
    if test is None or any(s not in test.inputs for s in switches):
        known = ", ".join(t.name for t in case.tests)
        raise InputError(f"no test '{name}' with inputs {', '.join(switches)}", case.name, f"tests: {known}")
    found = [_held(case, test, base, switches) for base in ("", *switches)]
    return sorted(found, key=lambda h: -h.p)


def _held(case: Case, test: Test, base: str, switches: Sequence[str]) -> Hypothesis:
    from scipy.stats import chi2

    inputs = {**test.inputs, **{s: np.full(test.time.size, float(s == base)) for s in switches}}
    rows = tuple(settled(replace(case, tests=(replace(test, inputs=inputs),))))
    sigma = {c.name: float(np.hypot(c.sigma_K, MODEL_K)) for c in test.channels}
    square = sum((r.difference_K / sigma[r.channel]) ** 2 for r in rows)
    return Hypothesis(base, float(chi2.sf(square, len(rows))), float(np.mean([r.difference_K for r in rows])), rows)
