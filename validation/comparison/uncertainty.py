"""How far a comparison can be believed: uncertainty of readings, inputs and arithmetic, per sensor and test.

    u_val^2 = u_reading^2 + u_input^2 + u_numeric^2 ,   model error = -(E +- 2 u_val) ,   E = reading - model

Inputs are moved one at a time by their own standard uncertainty; the arithmetic is what the integrator leaves.
Source: ASME V&V 20-2009, chapter 3 (inputs, sampled one at a time).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumped.integration.simulate import simulate
from lumped.model.network import Network
from validation.case import Test
from validation.comparison.predict import predict, record, thermal
from validation.doubt import USUAL

Array = NDArray[np.float64]
COVERAGE = 2.0


@dataclass(frozen=True)
class Uncertainty:
    """Standard uncertainties (K, rms over the test) of one sensor, and what is left of the error.

    inputs : what each input contributes;  error_K : rms of reading minus model
    """

    test: str
    channel: str
    reading_K: float
    inputs: Mapping[str, float]
    numeric_K: float
    error_K: float

    @property
    def input_K(self) -> float:
        return float(np.sqrt(sum(u**2 for u in self.inputs.values())))

    @property
    def u_val_K(self) -> float:
        return float(np.sqrt(self.reading_K**2 + self.input_K**2 + self.numeric_K**2))

    @property
    def explained(self) -> bool:
        """Is the error no more than what all this leaves open?"""
        return self.error_K <= COVERAGE * self.u_val_K

    def document(self) -> dict:
        own = {"reading_K": self.reading_K, "input_K": self.input_K, "numeric_K": self.numeric_K}
        total = {"u_val_K": self.u_val_K, "error_K": self.error_K, "explained": self.explained}
        return {"test": self.test, "channel": self.channel, **own, **total, "inputs": dict(self.inputs)}


def uncertainties(network: Network, test: Test, values: Mapping[str, float]) -> list[Uncertainty]:
    """One row per channel that was read."""
    y = predict(network, test, values).y
    moved = {name: predict(network, other, values).y - y for name, other in shifted_inputs(test)}
    late = _late(network, test, values)
    out = []
    for j, c in enumerate(test.channels):
        if np.isfinite(c.y).any():
            inputs = {name: _rms(d[:, j]) for name, d in moved.items()}
            error = _rms((c.y - y[:, j])[np.isfinite(c.y)])
            out.append(Uncertainty(test.name, c.name, c.sigma_K, inputs, late[j], error))
    return out


def _late(network: Network, test: Test, values: Mapping[str, float]) -> list[float]:
    """Error of the time steps at every channel (K)."""
    bare = thermal(network)
    heat = {p.name: values[p.name] for p in bare.parameters if p.name in values}
    return simulate(bare, record(test, {}), heat, [c.row for c in test.channels]).time_error_K.tolist()


def _rms(a: Array) -> float:
    return float(np.sqrt(np.mean(a**2)))


def shifted_inputs(test: Test) -> Iterator[tuple[str, Test]]:
    """The test with one input or boundary at a time off by its standard uncertainty."""
    for name, u in test.inputs.items():
        if np.any(u):
            yield name, test.scaled({name: 1.0 + USUAL["input"]})
    for name, u in test.boundaries.items():
        yield name, replace(test, boundaries={**test.boundaries, name: np.asarray(u, float) + USUAL["boundary"]})
