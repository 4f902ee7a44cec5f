"""A part alone, between neighbours as whole-machine solutions have them: its coefficients change at hardly any cost.

What a part looks like depends most on its own films and contacts. Whole-machine solutions at random coefficients try a
few of their combinations; here each part is solved for by itself at many more, its neighbours' temperatures given.
(Oversampling of local problems: Babuska and Lipton 2011, Buhr and Smetana 2018.)
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.matrices.assembly import FieldModel
from fem.solvers.multifrontal import Symbolic, analyse, factorise

Floats = NDArray[np.float64]


def local_solutions(
    field: FieldModel, S: Floats, loads: Floats, points: Iterable[sp.csr_array], width: int, rng: np.random.Generator
) -> dict[str, Floats]:
    """part -> (n_part, k) fields of the part, at each point as strong as a whole-machine solution of unit energy.

    S (n, n_snapshot) : whole-machine solutions of unit energy; `width` random sums of them are the neighbours' states
    loads (n, n_zone) : 1 W in every zone; those of the part join, and 1 W through each of its faces
    points : matrices (n, n) of the machine at other coefficients
    """
    solutions = {part: [np.zeros((block.n, 0))] for part, block in field.blocks.items()}
    units = {part: _unit_loads(field, loads, part) for part in field.blocks}
    order: dict[str, Symbolic] = {}
    for K in points:
        state = S @ (rng.standard_normal((S.shape[1], width)) / np.sqrt(S.shape[1]))
        for part, block in field.blocks.items():
            rows = K[block.dofs]
            A = sp.csr_array(rows[:, block.dofs])
            order[part] = order.get(part) or analyse(A, block.xyz)
            inverse = factorise(A, order[part])
            solutions[part] += [inverse(A @ state[block.dofs] - rows @ state), of_unit_energy(inverse(units[part]), A)]
    return {part: np.hstack(fields) for part, fields in solutions.items()}


def _unit_loads(field: FieldModel, loads: Floats, part: str) -> Floats:
    """(n_part, k) the zones' and the faces' unit loads that are in the part."""
    rows = field.block(part).dofs
    fluxes = [field.flux(face)[rows] for face, film in field.films.items() if film.trace.part == part]
    inside = loads[rows]
    return np.column_stack([inside[:, inside.any(axis=0)], *fluxes])


def of_unit_energy(T: Floats, A: sp.csr_array) -> Floats:
    """Fields (n, k) scaled to T' A T = 1."""
    return np.asarray(T / np.sqrt(np.einsum("ij,ij->j", T, A @ T)))
