"""How sure a temperature at rest is: the same normal distribution as along a record, without a run."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lumped.integration.steady import steady
from lumped.model.network import Network, Row
from measured.case import Test
from measured.sensors.operators import head
from validation.bands.posterior import ParameterPosterior
from validation.comparison.uncertainty import moved_boundaries, moved_inputs


@dataclass(frozen=True)
class AtRest:
    """of : what is known of the model;  network : its own, perhaps with more parameters, none of them a sensor's

    Thermometers of the boundaries are as unsure as the table of doubt says, whatever a calibration made of their bias.
    """

    of: ParameterPosterior
    network: Network

    def sd(
        self, values: Mapping[str, float], inputs: Mapping[str, float], boundaries: Mapping[str, float], row: Row
    ) -> float:
        """One standard deviation (K) of a temperature; values : of the network, those of a design among them."""
        free = [p for p in self.network.parameters if p.name in self._thermal]
        size = np.array([p.prior_sd if p.name in self.of.doubts else 1.0 for p in free])
        at = steady(self.network, inputs, boundaries, values, [row], free)
        assert at.dy is not None
        columns = {p.name: float(dy) for p, dy in zip(free, at.dy[0] * size, strict=True)}
        for name, test in self._moved(inputs, boundaries):
            u, T = ({n: float(np.asarray(x)[0]) for n, x in of.items()} for of in (test.inputs, test.boundaries))
            columns[name] = float(steady(self.network, u, T, values, [row]).y[0] - at.y[0])
        sd = np.array([p.prior_sd for p in free]) / size
        Sigma = self.of.of(list(columns), np.concatenate([sd, np.ones(len(columns) - len(free))]))
        J, rise = np.array(list(columns.values())), float(at.y[0] - np.mean(list(boundaries.values())))
        offset = float(J @ self.of.offsets(list(columns)))
        return float(np.sqrt(max(J @ Sigma @ J, 0.0) + offset**2 + (self.of.slow(row) * rise) ** 2))

    @cached_property
    def _thermal(self) -> set[str]:
        """Parameters that move a rest: neither a sensor's nor a start's."""
        names = {*self.of.names, *self.of.doubts}
        return {p.name for p in self.network.parameters if p.name in names and head(p) == "thermal"}

    def _moved(self, inputs: Mapping[str, float], boundaries: Mapping[str, float]) -> Iterator[tuple[str, Test]]:
        """The operating point with one input or boundary off by what its instrument may be."""
        one = np.ones(1)
        test = Test(
            "rest",
            "hold-out",
            np.zeros(1),
            {n: u * one for n, u in inputs.items()},
            {b: T * one for b, T in boundaries.items()},
            (),
        )
        yield from moved_inputs(self.network, test, self.of.doubt)
        yield from moved_boundaries(test, self.of.doubt)
