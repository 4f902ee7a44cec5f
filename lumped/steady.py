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
ABOVE_K = 30.0  # still air takes nothing without a difference: a start without one would leave the nodes unheld


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
    """Newton's method on F(x) = 0 from above the mean boundary temperature: one instant without heat capacities.

    Arguments as for `simulate`.

    Raises ThermoscopeError where there is no rest: a node that nothing holds, or losses that grow faster with
    temperature than the cooling does (thermal runaway).
    """
    from lumped.kernel import integrate, stages, work

    core = compiled(network, inputs, 1, values, rows, tangents)
    n, nr, p, ne = len(network.states), len(rows), core.tangents.dC.shape[1], core.terms.m.size
    u = boundary_table(network, boundaries, 1)
    hidden = np.array(["#" in s for s in network.states], bool)
    x0 = np.where(hidden, 0.0, ABOVE_K + (u.mean() if u.size else 20.0))
    z, y, dy, scratch = np.zeros((1, network.size)), np.zeros((1, nr)), np.zeros((1, nr, p)), work(n, ne, p)
    failed = integrate(
        np.zeros(1), u, np.zeros(n), core.K0, core.terms, core.tangents, core.rows, np.zeros(core.terms.row.size),
        core.curved, True,
        stages(x0, u[0], core.terms), scratch, z, y, dy, np.zeros((0, ne)),
    )  # fmt: skip
    if failed >= 0 or np.linalg.eigvals(scratch.G).real.min() <= 0:
        why = "a node nothing holds, or thermal runaway"
        raise ThermoscopeError(f"network '{network.name}' does not come to rest: {why}")
    return Steady((*network.states, *network.boundaries), z[0], y[0], dy[0] if p else None)
