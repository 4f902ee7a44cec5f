"""A part alone, between neighbours as whole-machine solutions have them: its coefficients change at hardly any cost.

What a part looks like depends most on its own films and contacts. Whole-machine solutions at random coefficients try a
few of their combinations; here each part is solved for by itself at many more, its neighbours' temperatures given.
(Oversampling of local problems: Babuska and Lipton 2011, Buhr and Smetana 2018.)
"""

from collections.abc import Iterable, Mapping

import numpy as np
import scipy.sparse as sp

from fem.matrices.assembly import FieldModel
from fem.solvers.multifrontal import analyse, factorise
from fem.solvers.two_processes import in_two_processes
from geom.arrays import Array as Floats

Point = tuple[Mapping[str, float], Mapping[str, float]]  # films and contacts (W/m2/K)


def local_solutions(
    field: FieldModel, S: Floats, loads: Floats, points: Iterable[Point], width: int, rng: np.random.Generator
) -> dict[str, Floats]:
    """part -> (n_part, k) fields of the part, at each point as strong as a whole-machine solution of unit energy.

    S (n, n_snapshot) : whole-machine solutions of unit energy; `width` random sums of them are the neighbours' states
    loads (n, n_zone) : 1 W in every zone; those of the part join, and 1 W through each of its faces
    points : films and contacts of the machine at other coefficients
    """
    draws = [(*point, rng.standard_normal((S.shape[1], width)) / np.sqrt(S.shape[1])) for point in points]
    if not draws:
        return {part: np.zeros((block.n, 0)) for part, block in field.blocks.items()}
    units = {part: _unit_loads(field, loads, part) for part in field.blocks}
    pattern = field.stiffness(*draws[0][:2])
    order = {part: analyse(sp.csr_array(pattern[b.dofs][:, b.dofs]), b.xyz) for part, b in field.blocks.items()}

    def solved(draw: tuple[Mapping[str, float], Mapping[str, float], Floats]) -> dict[str, Floats]:
        K, state, fields = field.stiffness(*draw[:2]), S @ draw[2], {}
        for part, block in field.blocks.items():
            rows = K[block.dofs]
            A = sp.csr_array(rows[:, block.dofs])
            inverse = factorise(A, order[part])
            near = inverse(A @ state[block.dofs] - rows @ state)
            fields[part] = np.hstack([near, of_unit_energy(inverse(units[part]), A)])
        return fields

    solutions = in_two_processes(solved, draws, field.n)
    return {part: np.hstack([fields[part] for fields in solutions]) for part in field.blocks}


def _unit_loads(field: FieldModel, loads: Floats, part: str) -> Floats:
    """(n_part, k) the zones' and the faces' unit loads that are in the part."""
    rows = field.block(part).dofs
    fluxes = [field.flux(face)[rows] for face, film in field.films.items() if film.trace.part == part]
    inside = loads[rows]
    return np.column_stack([inside[:, inside.any(axis=0)], *fluxes])


def of_unit_energy(T: Floats, A: sp.csr_array) -> Floats:
    """Fields (n, k) scaled to T' A T = 1."""
    return np.asarray(T * unit_energy_scale(T, A))


def unit_energy_scale(T: Floats, A: sp.csr_array) -> Floats:
    """(k,) what scales fields (n, k) to T' A T = 1."""
    return np.asarray(1.0 / np.sqrt(np.einsum("ij,ij->j", T, A @ T)))
