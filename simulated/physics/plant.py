"""The motor in transient: conduction, films, air stream and losses, stepped by a two-stage L-stable scheme.

Film and loss coefficients are taken at an extrapolated temperature; with those, solid and air are solved together, so
that each stage balances to the tolerance of the linear solver.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import cg

from simulated.physics.air import AIR_AT_INLET, AirPath
from simulated.physics.conduction import Body
from simulated.physics.losses import Losses, copper
from simulated.physics.surfaces import Conditions, Films

Array = NDArray[np.float64]
GAMMA = 1 - np.sqrt(0.5)
TOLERANCE_W = 1e-5  # 2-norm of what is left over in the nodes
TOLERANCE_K = 1e-5  # of the air between two passes
ARMATURE = ("winding.armature", "winding.armature.left", "winding.armature.right")


@dataclass(frozen=True)
class State:
    """T (n,) nodes and air (cells,) in degC."""

    T: Array
    air: Array


@dataclass(frozen=True)
class Flows:
    """Heat (W) over a step: made by losses, carried off by the outer faces, carried off by the air."""

    made: float
    outside: float
    exhaust: float


@dataclass(frozen=True)
class Plant:
    """A motor whose every coefficient is fixed."""

    body: Body
    losses: Losses
    films: Films
    air: AirPath
    _cache: dict[str, object] = field(default_factory=dict, repr=False, compare=False)

    def start(self, T: float) -> State:
        return State(np.full(len(self.body.points), T), np.full(self.air.size, T))

    def step(self, now: State, slope: Array, conditions: Conditions, dt: float) -> tuple[State, Array, Flows]:
        """One step of SDIRK2 (Alexander 1977). slope : (n,) K/s of the step before, for the extrapolation."""
        inner, flows1 = self._stage(now.T, now.T + GAMMA * dt * slope, now, conditions, GAMMA * dt)
        rate = (inner.T - now.T) / (GAMMA * dt)
        base = now.T + (1 - GAMMA) * dt * rate
        end, flows2 = self._stage(base, now.T + dt * rate, inner, conditions, GAMMA * dt)
        weighted = ((1 - GAMMA) * a + GAMMA * b for a, b in zip(flows1, flows2))
        return end, (end.T - now.T) / dt, Flows(*weighted)

    def _stage(
        self, base: Array, guess: Array, before: State, now: Conditions, dt: float
    ) -> tuple[State, tuple[float, float, float]]:
        """Solve capacity (T - base) / dt = heat(T), all coefficients at `guess`."""
        body = self.body
        out, inside, mixing = self._films(guess, before.air, now)
        heat, stirring = self.sources(guess, now)
        flow = AIR_AT_INLET * now.flow / 3600
        advection, inlet = self.air.advection()
        wall = np.asarray(mixing.sum(axis=0)).ravel()
        cells = np.linalg.inv(flow * advection + np.diag(wall))
        feed = stirring + flow * inlet * now.ambient
        matrix = self._matrix(guess, body.capacity / dt + out + inside)
        fixed = body.capacity / dt * base + heat + out * now.ambient
        T, air = guess, before.air
        for _ in range(20):
            T = self._solved(matrix, fixed + mixing @ air, T)
            fresh = cells @ (feed + mixing.T @ T)
            done = np.abs(fresh - air).max() < TOLERANCE_K
            air = fresh
            if done:
                break
        exhaust = flow * (air[-1] - now.ambient)
        return State(T, air), (heat.sum() + stirring.sum(), float(out @ (T - now.ambient)), float(exhaust))

    def _films(self, T: Array, air: Array, now: Conditions) -> tuple[Array, Array, sparse.csr_matrix]:
        """Conductances (W/K): node to ambient (n,), node to air (n,), and node to each cell (n, cells)."""
        n = len(T)
        out, rows, cols, vals = np.zeros(n), [], [], []
        for face in self.body.faces.values():
            fluid = now.ambient if face.fluid == "ambient" else air[self.air.cells(face, self.body)]
            g = face.areas * self.films.coefficient(face.part, face.fluid, T[face.nodes], fluid, now)
            if face.fluid == "ambient":
                out[face.nodes] += g
            else:
                rows.append(face.nodes)
                cols.append(self.air.cells(face, self.body))
                vals.append(g)
        entries = (np.concatenate(vals), (np.concatenate(rows), np.concatenate(cols)))
        mixing = sparse.coo_matrix(entries, shape=(n, self.air.size)).tocsr()
        return out, np.asarray(mixing.sum(axis=1)).ravel(), mixing

    def sources(self, T: Array, now: Conditions) -> tuple[Array, Array]:
        """Heat into the nodes (n,) and into the air cells (W)."""
        heat, losses = np.zeros_like(T), self.losses
        left, right = losses.bearings(now.rpm, self.mean("bearing.left", T), self.mean("bearing.right", T))
        iron = losses.iron_loss(np.sqrt(now.current2), now.rpm)
        for part, watts in zip(ARMATURE, losses.armature(now.current2)):
            self._add(heat, part, watts, lambda nodes: copper(T[nodes]))
        self._add(heat, "winding.field", losses.R_field * now.current2, lambda nodes: copper(T[nodes]))
        self._add(heat, "commutator", losses.brushes(now.current, now.rpm))
        self._add(heat, "bearing.left", left)
        self._add(heat, "bearing.right", right)
        self._add(heat, "rotor.core", losses.iron_rotor_share * iron)
        self._add(heat, "poles", (1 - losses.iron_rotor_share) * iron)
        shares = {"airgap": 0.5, "air.left": 0.25, "air.right": 0.25}
        stirring = sum(share * self.air.spread(fluid) for fluid, share in shares.items())
        return heat, losses.windage * (now.rpm / 1000) ** 2.8 * stirring

    def _add(
        self, heat: Array, part: str, watts: float, factor: Callable[[Array], Array | float] = lambda _: 1.0
    ) -> None:
        nodes, shares = self._shares(part)
        heat[nodes] += watts * shares * factor(nodes)

    def _shares(self, part: str) -> tuple[NDArray[np.int64], Array]:
        if part not in self._cache:
            nodes = self.body.nodes(part)
            volume = self.body.volume[nodes]
            self._cache[part] = nodes, volume / volume.sum()
        return self._cache[part]  # type: ignore[return-value]

    def mean(self, part: str, T: Array) -> float:
        nodes, shares = self._shares(part)
        return float(shares @ T[nodes])

    def resistance(self, T: Array) -> float:
        """Armature and field in series (ohm)."""
        means = [self.mean(part, T) for part in ARMATURE]
        return self.losses.resistance(float(np.dot(self.losses.ends, means)), self.mean("winding.field", T))

    def _solved(self, matrix: sparse.csr_matrix, rhs: Array, guess: Array) -> Array:
        """Conjugate gradients, scaled by the diagonal: capacity over a short step dominates the matrix."""
        scale = sparse.diags(1 / matrix.diagonal())
        T, failed = cg(matrix, rhs, guess, rtol=0.0, atol=TOLERANCE_W, maxiter=3000, M=scale)
        if failed:
            raise RuntimeError("the linear solver did not converge")
        return T

    def _matrix(self, T: Array, diagonal: Array) -> sparse.csr_matrix:
        """Conduction plus a diagonal; conductivities follow the temperature in strides of 3 K."""
        known = self._cache.get("conduction")
        means = self.body.part_means(T)
        if known is None or np.abs(known[0] - means).max() > 3.0:  # type: ignore[index]
            known = self._cache["conduction"] = (means, *_with_diagonal(self.body.conduction(T)))
        _, matrix, places = known  # type: ignore[misc]
        full = matrix.copy()
        full.data[places] += diagonal
        return full


def _with_diagonal(matrix: sparse.csr_matrix) -> tuple[sparse.csr_matrix, NDArray[np.int64]]:
    """The matrix, sorted, and where its diagonal entries stand in `data`."""
    matrix = matrix.tocsr()
    matrix.sort_indices()
    rows = np.repeat(np.arange(matrix.shape[0]), np.diff(matrix.indptr))
    return matrix, np.flatnonzero(matrix.indices == rows)
