"""Could the error of the model's own numbers pass for an effect? Below its error budget nothing is to be named."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SignalToError:
    """What an effect changes at the sensors, beside what the numbers themselves may be wrong by.

    sensor : where it stands out most;  change_K, budget_K : largest change and error budget there
    """

    sensor: str
    change_K: float
    budget_K: float

    @property
    def above_budget(self) -> bool:
        """Whether at least one sensor sees more of the effect than of the error."""
        return self.change_K > self.budget_K


def signal_to_error(change: Mapping[str, Array | float], budget: Mapping[str, float]) -> SignalToError:
    """Where an effect stands out most from the error budget.

    change : sensor -> predicted change of its reading (K), a number or over time, NaN where nothing is read
    budget : sensor -> K, as `ErrorBudget.total_K`; a sensor that is not in it has none
    """
    sizes = {sensor: float(np.nanmax(np.abs(values), initial=0.0)) for sensor, values in change.items()}
    if not sizes:
        return SignalToError("", 0.0, 0.0)
    at = max(sizes, key=lambda s: _share(sizes[s], budget.get(s, 0.0)))
    return SignalToError(at, sizes[at], budget.get(at, 0.0))


def _share(change: float, budget: float) -> float:
    return change / budget if budget > 0.0 else float("inf") if change > 0.0 else 0.0
