"""One model, other machines: calibrated values go to networks of machines that were not used, and are tested there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from thermoscope import plugin as th

COVERAGE = 2.0  # standard uncertainties: 95 %
LIMITS = np.sqrt(6.0)  # of a sum of two even errors of one size, both at their limit, over its standard deviation
LATE = 0.25  # share of a test at its end that is compared: where it has settled


@dataclass(frozen=True)
class Row:
    """One sensor in one test, means over the settled end (degC).

    U95_K : 95 % uncertainty of the measurement;  worst_K : its worst case, cold and hot meter both at their limits, the
    bound that the procedure's paper holds the difference against
    """

    test: str
    channel: str
    measured_C: float
    simulated_C: float
    U95_K: float
    worst_K: float

    @property
    def difference_K(self) -> float:
        return self.measured_C - self.simulated_C

    @property
    def within(self) -> bool:
        return abs(self.difference_K) <= self.worst_K

    def document(self) -> dict[str, Any]:
        return {**vars(self), "difference_K": self.difference_K, "within": self.within}


@dataclass(frozen=True)
class Transfer:
    """A case with another case's values: what was taken over, and how it stands."""

    case: th.MeasuredCase
    parameters: tuple[str, ...]
    rows: tuple[Row, ...]

    @property
    def agrees(self) -> bool:
        return all(r.within for r in self.rows)

    def document(self) -> dict[str, Any]:
        return {
            "case": self.case.name,
            "parameters": list(self.parameters),
            "agrees": self.agrees,
            "rows": [r.document() for r in self.rows],
        }


def transferred(source: th.MeasuredCase, target: th.MeasuredCase) -> Transfer:
    """Values of parameters that both networks declare under one name; sensors' own ones and losses stay behind.

    What a machine loses is its own: its resistance is measured cold, its magnetic loss given.
    """
    theirs = {p.name for p in target.model.network.parameters if not p.name.startswith("loss.")}
    values = {k: v for k, v in th.physical(source).items() if k in theirs}
    case = th.with_model(target, replace(target.model, values={**target.model.values, **values}))
    return Transfer(case, tuple(values), tuple(end_errors(case)))


def end_errors(case: th.MeasuredCase) -> list[Row]:
    """Every channel of every test at its end, against the model as it stands."""
    network = th.standing(case)
    out = []
    for test in case.tests:
        y = th.predict(network, test, th.physical(case)).y
        late = test.time >= test.time[-1] - LATE * (test.time[-1] - test.time[0])
        for j, c in enumerate(test.channels):
            rows = late & np.isfinite(c.y)
            if rows.any():
                means = float(c.y[rows].mean()), float(y[rows, j].mean())
                out.append(Row(test.name, c.name, *means, COVERAGE * c.sigma_K, float(LIMITS * c.sigma_K)))
    return out
