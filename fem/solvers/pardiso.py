"""Intel's PARDISO, where the extra "direct" is installed: proprietary freeware that nothing here needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from fem.matrices.assembly import FieldModel
from geom.arrays import Array as Floats
from geom.errors import InputError

POSITIVE_DEFINITE = 2  # PARDISO's word for real, symmetric and positive definite


@dataclass(frozen=True)
class Pardiso:
    """Does what fem.solvers.solve.Solver does."""

    field: FieldModel

    def __post_init__(self) -> None:
        try:
            import pypardiso  # noqa: F401
        except ImportError as missing:
            raise InputError("pypardiso is not installed", "Pardiso", "pip install 'thermoscope[direct]'") from missing

    def factor(self, K: sp.csr_array, shift: float = 0.0) -> Callable[[Floats], Floats]:
        """The inverse of K + shift M, shift in 1/s, as a function of right-hand sides (n,) or (n, k)."""
        from pypardiso import PyPardisoSolver

        A = sp.csr_matrix(sp.triu(K + shift * self.field.M if shift else K, format="csr"))
        A.sort_indices()
        solver = PyPardisoSolver(mtype=POSITIVE_DEFINITE)
        solver.factorize(A)

        def solve(b: Floats) -> Floats:
            columns = np.asfortranarray(b.reshape(len(b), -1), float)
            return np.asarray(solver.solve(A, columns)).reshape(b.shape)

        return solve
