"""Coolant channels as one-dimensional streams that pick up heat along their path.

A stream is a row of cells. Where the walls of a cell are at one temperature, what leaves it is the exact exponential

    T_out = T_wall - (T_wall - T_in) exp(-h A / mcp)

which a film of (exp(h A / mcp) - 1) mcp / A onto the cell's outlet temperature reproduces. So streams stay lumped
nodes with films, and heat is conserved to rounding.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fem.matrices.assembly import FieldModel
from fem.solvers.solve import Fluids
from geom.arrays import Array as Floats
from geom.errors import InputError
from geom.meshing.mesh import NamedMesh, Patch


@dataclass(frozen=True)
class Stream:
    """fluid : its name in the mesh before `cut`;  mcp : mass flow times specific heat (W/K);  inlet : degC"""

    fluid: str
    mcp: float
    inlet: float

    def __post_init__(self) -> None:
        if not self.mcp > 0:
            raise InputError(f"a stream of {self.mcp} W/K", f"stream '{self.fluid}'", "a flow above 0")


def cut(mesh: NamedMesh, fluid: str, along: Callable[[Floats], Floats], cells: int) -> NamedMesh:
    """The mesh with every face that `fluid` washes cut into `cells` of equal length, named face@0, face@1 ...

    along : length of the path (m, or any measure) at points (n, 3), growing with the flow
    """
    faces = {name: p for name, p in mesh.patches.items() if p.fluid == fluid}
    if not faces:
        fluids = sorted({p.fluid for p in mesh.patches.values()})
        raise InputError(f"no face is washed by '{fluid}'", "stream", f"fluids: {', '.join(fluids)}")
    where = {name: along(mesh.points[p.facets].mean(1)) for name, p in faces.items()}
    low, high = min(s.min() for s in where.values()), max(s.max() for s in where.values())
    number = {
        n: np.minimum((cells * (s - low) / max(high - low, 1e-300)).astype(int), cells - 1) for n, s in where.items()
    }
    if len(np.unique(np.concatenate([*number.values()]))) < cells:
        raise InputError(
            f"{cells} cells along '{fluid}', some without a facet", "stream", "fewer cells or a finer mesh"
        )
    pieces = {
        f"{name}@{k}": Patch(p.part, f"{fluid}@{k}", p.facets[number[name] == k])
        for name, p in faces.items()
        for k in range(cells)
        if (number[name] == k).any()
    }
    return replace(mesh, patches={n: p for n, p in mesh.patches.items() if n not in faces} | pieces)


def flowing(
    field: FieldModel, films: Mapping[str, float], streams: Sequence[Stream], fixed: Mapping[str, float]
) -> tuple[dict[str, float], Fluids]:
    """Films onto the cells' outlet temperatures, and the fluids for `steady`, `solve_nonlinear` or `transient`.

    films : h (W/m2/K) by face, of a cut face for all its cells;  fixed : temperatures (degC) of the other fluids
    """
    h = {face: films[face if face in films else face.split("@")[0]] for face in field.films}
    names = [_cells(field, stream) for stream in streams]
    row = {name: k for k, name in enumerate(n for cells in names for n in cells)}
    D, s = np.zeros((len(row), len(row))), np.zeros(len(row))
    for stream, cells in zip(streams, names, strict=True):
        s[row[cells[0]]] = stream.mcp * stream.inlet
        for k, cell in enumerate(cells):
            D[row[cell], row[cell]] = stream.mcp
            if k:
                D[row[cell], row[cells[k - 1]]] = -stream.mcp
            walls = [face for face, film in field.films.items() if film.fluid == cell]
            units = sum(h[face] * field.films[face].trace.area for face in walls) / stream.mcp
            for face in walls:
                h[face] *= np.expm1(units) / units if units > 0 else 1.0
    return h, Fluids(tuple(row), D, s, fixed)


def _cells(field: FieldModel, stream: Stream) -> list[str]:
    cells = [f for f in field.fluids if f.rpartition("@")[0] == stream.fluid]
    if not cells:
        raise InputError(f"no cells of stream '{stream.fluid}'", "flowing", "cut the mesh along the stream first")
    return sorted(cells, key=lambda f: int(f.rpartition("@")[2]))
