"""Where a network comes to rest under constant inputs, with exact tangents."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array
from geom.errors import NoSolution
from geom.table import Table, TableResult
from geom.text import table
from lumped.integration.compiled import compiled
from lumped.integration.reach import tell_reach
from lumped.integration.record import Record
from lumped.model.network import Network, Parameter, Row
from lumped.numerics.stages import stages, work
from lumped.numerics.steady_start import solve_steady_start

SCREEN = 20  # temperatures that a notebook shows
ABOVE_K = 30.0  # still air takes nothing without a difference: a start without one would leave the nodes unheld


@dataclass(frozen=True)
class Steady(TableResult):
    """z (n_states + n_boundaries) degC; y (n_rows,); dy (n_rows, n_tangents)."""

    names: tuple[str, ...]
    z: Array
    y: Array
    dy: Array | None

    def __repr__(self) -> str:
        if len(self.names) > SCREEN:
            return f"<Steady: {len(self.names)} temperatures, by name>"
        (one,) = self.tables()
        return table(one.columns, one.rows)

    def tables(self) -> tuple[Table, ...]:
        """A row for each place."""
        return (Table("Steady temperatures", ["place", "degC"], [[name, self[name]] for name in self.names]),)

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

    Raises NoSolution where there is no rest: a node that nothing holds, or losses that grow faster with
    temperature than the cooling does (thermal runaway).
    """
    core = compiled(network, Record(np.zeros(1), inputs, boundaries), values, rows, tangents)
    n, p, u = len(network.states), core.tangents.first.shape[1], core.forcing.u[0]
    hidden = np.array(["#" in s for s in network.states], bool)
    x0 = np.where(hidden, 0.0, ABOVE_K + (u.mean() if u.size else 20.0))
    both, scratch = stages(x0, u, core.terms), work(n, u.size, core.terms, p)
    rests = solve_steady_start(np.zeros(n), core.K0, core.terms, core.tangents, core.forcing.factor[0], both, scratch)
    if not rests or not _comes_to_rest(scratch.G[:, :n]):
        why = "a node nothing holds, or thermal runaway"
        raise NoSolution(f"{network.title} does not come to rest: {why}")
    z, dz = both.z[0, :-1], scratch.D[:, :p]
    tell_reach(core, z)
    y, dy = [r.at(z) for r in rows], [r.weights @ dz[r.index] for r in rows]
    return Steady((*network.states, *network.boundaries), z, np.array(y), np.reshape(dy, (len(rows), p)) if p else None)


def _comes_to_rest(G: Array) -> bool:
    """Whether all eigenvalues of G (n, n) have positive real parts, as they have where G + G' is positive definite."""
    try:
        np.linalg.cholesky(G + G.T)  # a hundredth of the work
    except np.linalg.LinAlgError:
        return bool(np.linalg.eigvals(G).real.min() > 0)
    return True
