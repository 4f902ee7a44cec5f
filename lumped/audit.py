"""Is the heat that was put in the heat that the losses declare?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.balance import Balance, balance
from lumped.laws import CONSTANT, TemperatureLaw
from lumped.multipliers import multipliers
from lumped.network import Network, Source
from lumped.simulate import Record, simulate
from lumped.terms_value import temperature_value

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Audit:
    """declared_J, injected_J : source -> heat over the record;  balance : where it went"""

    declared_J: Mapping[str, float]
    injected_J: Mapping[str, float]
    balance: Balance

    @property
    def mismatch(self) -> float:
        """Largest |injected - declared| of a source over the sum of all |declared|."""
        scale = sum(abs(x) for x in self.declared_J.values()) or 1.0
        return max((abs(self.injected_J[s] - x) / scale for s, x in self.declared_J.items()), default=0.0)

    @property
    def residual(self) -> float:
        """Largest |in - out - stored| at any time over the largest of them."""
        return float(np.abs(self.balance.residual).max())


def audit(network: Network, record: Record, values: Mapping[str, float] | None = None) -> Audit:
    """Declared: every loss law in NumPy at the temperatures of a run, its trapezium over the record.

    Injected: what the scheme put into the nodes, counted term by term. Where a loss follows temperature the two differ
    by the trapezium's own error, which falls with the square of the step.
    """
    z = simulate(network, record, values, keep_states=True).z
    assert z is not None
    m, counted = multipliers(network, values), balance(network, record, values)
    inputs = {k: np.broadcast_to(np.asarray(v, float), record.time.shape) for k, v in record.inputs.items()}
    declared = {s.name: m.get(s.name, 1.0) * _heat(s, inputs, record.time, z) for s in network.sources}
    injected = {name: float(heat[-1]) for name, heat in counted.injected.items()}
    return Audit(declared, injected, counted)


def _heat(source: Source, inputs: Mapping[str, Array], time: Array, z: Array) -> float:
    law, factor = source.law.temperature, np.asarray(source.law.factor(inputs), float)
    return float(np.trapezoid(np.broadcast_to(factor, time.shape) * _over(law, source, z), time))


def _over(law: TemperatureLaw, source: Source, z: Array) -> Array | float:
    if law == CONSTANT:
        return 1.0
    probe = z[:, source.probe.index] @ source.probe.weights
    return np.array([temperature_value(law, float(T), 0.0) for T in probe])
