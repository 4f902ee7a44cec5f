"""Where a network comes to rest under constant inputs, with exact tangents."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geom.errors import ThermoscopeError
from lumped.compiled import compiled
from lumped.network import Network, Parameter, Row
from lumped.simulate import boundary_table

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Steady:
    """z (n_states + n_boundaries) degC; y (n_rows,); dy (n_rows, n_tangents)."""

    names: tuple[str, ...]
    z: Array
    y: Array
    dy: Array | None

    def __getitem__(self, name: str) -> float:
        """Temperature (degC) of a named state or boundary."""
        return float(self.z[self.names.index(name)])


def steady(
    network: Network,
    inputs: Mapping[str, Array | float],
    boundaries: Mapping[str, Array | float],
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tangents: Sequence[Parameter] = (),
) -> Steady:
    """Newton's method on F(x) = 0 from the mean boundary temperature; arguments as for `simulate`.

    Raises ThermoscopeError where there is no rest: a node that nothing holds, or losses that grow faster with
    temperature than the cooling does (thermal runaway).
    """
    from lumped.kernel import rest, stage, work

    core = compiled(network, inputs, 1, values, rows, tangents)
    n, nr, p = len(network.states), len(rows), core.tangents.dC.shape[1]
    u = boundary_table(network, boundaries, 1)
    hidden = np.array(["#" in s for s in network.states], bool)
    x0 = np.where(hidden, 0.0, u.mean() if u.size else 20.0)
    z, y, dy, G = np.zeros(network.size), np.zeros((1, nr)), np.zeros((1, nr, p)), np.zeros((n, n))
    ne = core.terms.m.size
    found = rest(
        u, x0, np.zeros(n), core.K0, core.terms, core.tangents if p else None, core.rows,
        stage(n, u.shape[1], core.terms.row.size, ne), work(n, ne, p), z, y, dy, G,
    )  # fmt: skip
    if not found or np.linalg.eigvals(G).real.min() <= 0:
        why = "a node nothing holds, or thermal runaway"
        raise ThermoscopeError(f"network '{network.name}' does not come to rest: {why}")
    return Steady((*network.states, *network.boundaries), z, y[0], dy[0] if p else None)
