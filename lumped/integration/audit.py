"""Is the heat that was put in the heat that the losses declare?"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array
from lumped.integration.balance import Balance, Walk, counted, walk
from lumped.integration.compiled import compiled
from lumped.integration.record import Record
from lumped.integration.signals import Signals
from lumped.integration.simulate import march
from lumped.model.multipliers import multipliers
from lumped.model.network import Network, Source
from lumped.transfer.laws import CONSTANT, TemperatureLaw
from lumped.transfer.terms_value import temperature_value


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
    """Declared: every loss law in NumPy, at the temperatures of a run and the inputs between its samples.

    Injected: what the compiled terms put into the nodes. Both by the quadrature of `balance`.
    """
    core = compiled(network, record, values, all_terms=True)
    run = march(network, record, core, keep_states=True)
    way, m = walk(network, record, core, run), multipliers(network, values)
    signals = record.inputs if isinstance(record.inputs, Signals) else Signals(record.inputs, run.time.size)
    energies = {s.name: m.get(s.name, 1.0) * _heat(s, signals, way) for s in network.sources}
    heat = counted(network, core, run, way)
    return Audit(energies, {name: float(x[-1]) for name, x in heat.injected.items()}, heat)


def _heat(source: Source, signals: Signals, way: Walk) -> float:
    factor = signals.along(source.name, source.law, way.at)
    return float(np.sum(way.weight * factor * _over(source.law.temperature, source, way.x)))


def _over(law: TemperatureLaw, source: Source, x: Array) -> Array | float:
    if law == CONSTANT:
        return 1.0
    probe = x[:, source.probe.index] @ source.probe.weights
    return np.array([temperature_value(law, float(T), 0.0) for T in probe])
