"""One code on one problem, in a process of its own: assembly, boundary terms and solve, CPU seconds and peak memory.

    python benchmarks/peers/field.py NAME MESH.npz TINY.npz

The problem: a laminated hollow cylinder (28, 28, 3 W/m/K), 1 kW of loss, films onto 20 degC on its four faces.
Every iterative solver runs to a relative residual of 1e-10. Each contender solves a tiny cylinder first, so that what
is loaded or compiled at first use counts for nobody. Prints one line of JSON.
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

IN_PLANE, THROUGH, WATTS, AIR = 28.0, 3.0, 1000.0, 20.0
FILMS = {"ambient": 60.0, "bore": 30.0, "left": 15.0, "right": 25.0}
TOLERANCE = 1e-10
Laps = dict[str, float]
Problem = tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]  # points, tets, facets by the fluid that washes them


class Watch:
    """CPU seconds by name."""

    def __init__(self) -> None:
        self.laps: Laps = {}
        self._last = time.process_time()

    def lap(self, name: str) -> None:
        now = time.process_time()
        self.laps[name] = self.laps.get(name, 0.0) + now - self._last
        self._last = now


class Timed:
    """A solver of fem.solvers.solve that tells the watch where boundary terms end and the solve begins and ends."""

    def __init__(self, inner: Any, watch: Watch) -> None:
        self._inner, self._watch, self.field = inner, watch, inner.field

    def factor(self, K: sp.csr_array, shift: float = 0.0) -> Callable[[np.ndarray], np.ndarray]:
        self._watch.lap("boundary")
        inverse = self._inner.factor(K, shift)
        self._watch.lap("solve")

        def solve(b: np.ndarray) -> np.ndarray:
            self._watch.lap("boundary")
            x = inverse(b)
            self._watch.lap("solve")
            return np.asarray(x)

        return solve


def thermoscope(problem: Problem) -> tuple[Laps, float]:
    """As its users run it: `steady` adds the boundary terms, refuses what floats, and checks the energy balance."""
    from fem.matrices.assembly import assemble
    from fem.matrices.material import laminated
    from fem.solvers.solve import Iterative, only_fixed, steady
    from geom.meshing.mesh import NamedMesh, Patch

    points, tets, facets = problem
    patches = {f"stack.{name}": Patch("stack", name, f) for name, f in facets.items()}
    mesh = NamedMesh(points, tets, np.zeros(len(tets), np.int64), ("stack",), patches, {})
    watch = Watch()
    field = assemble(mesh, {"stack": laminated(IN_PLANE, THROUGH)}, {"stack": 3.6e6})
    load = WATTS * field.load("stack")
    watch.lap("assembly")
    films = {f"stack.{name}": h for name, h in FILMS.items()}
    found = steady(Timed(Iterative(field, TOLERANCE), watch), films, {}, load, only_fixed(**dict.fromkeys(facets, AIR)))
    watch.lap("boundary")
    return watch.laps, float(found.T.max())


def scikit_fem(problem: Problem) -> tuple[Laps, float]:
    """`skfem.asm` as its documentation shows it; the better of pyamg's two classic solvers."""
    from skfem import Basis, BilinearForm, ElementTetP1, FacetBasis, LinearForm, MeshTet, asm
    from skfem.helpers import dot, grad, mul

    points, tets, facets = problem
    watch = Watch()
    mesh = MeshTet(np.ascontiguousarray(points.T), np.ascontiguousarray(tets.T))
    k = np.diag([IN_PLANE, IN_PLANE, THROUGH])

    @BilinearForm
    def conduction(u, v, w):  # type: ignore[no-untyped-def]
        return dot(mul(k[:, :, None, None], grad(u)), grad(v))

    @LinearForm
    def one(v, w):  # type: ignore[no-untyped-def]
        return 1.0 * v

    @BilinearForm
    def mass(u, v, w):  # type: ignore[no-untyped-def]
        return u * v

    basis = Basis(mesh, ElementTetP1())
    K, volume = asm(conduction, basis), asm(one, basis)
    b = WATTS * volume / volume.sum()
    watch.lap("assembly")
    number = _numbers(mesh.facets, mesh.nvertices)
    order = np.argsort(number)
    for name, f in facets.items():
        own = order[np.searchsorted(number, _numbers(np.sort(f, 1).T, mesh.nvertices), sorter=order)]
        face = FacetBasis(mesh, ElementTetP1(), facets=own)
        K = K + FILMS[name] * asm(mass, face)
        b = b + FILMS[name] * AIR * asm(one, face)
    watch.lap("boundary")
    seconds, T = _best_of_pyamg(sp.csr_matrix(K), b)
    return {**watch.laps, "solve": seconds}, float(T.max())


def _numbers(facets: np.ndarray, n: int) -> np.ndarray:
    a, b, c = facets.astype(np.int64)
    return (a * n + b) * n + c


def _best_of_pyamg(A: sp.csr_matrix, b: np.ndarray) -> tuple[float, np.ndarray]:
    import pyamg

    out = []
    for build in (pyamg.ruge_stuben_solver, pyamg.smoothed_aggregation_solver):
        watch = Watch()
        T = build(A).solve(b, tol=TOLERANCE, accel="cg", maxiter=500)
        watch.lap("solve")
        out.append((watch.laps["solve"], T))
    return min(out, key=lambda pair: pair[0])


def ngsolve_with(preconditioner: str) -> Callable[[Problem], tuple[Laps, float]]:
    def run(problem: Problem) -> tuple[Laps, float]:
        import ngsolve as ng

        points, tets, facets = problem
        mesh = _netgen(points, tets, facets)
        watch = Watch()
        V = ng.H1(mesh, order=1)
        u, v = V.TnT()
        k = ng.CoefficientFunction((IN_PLANE, 0, 0, 0, IN_PLANE, 0, 0, 0, THROUGH), dims=(3, 3))
        h = mesh.BoundaryCF(FILMS)
        a = ng.BilinearForm(V, symmetric=True)
        a += (k * ng.grad(u)) * ng.grad(v) * ng.dx + h * u * v * ng.ds
        f = ng.LinearForm(V)
        f += WATTS / ng.Integrate(ng.CoefficientFunction(1.0), mesh) * v * ng.dx + h * AIR * v * ng.ds
        amg = ng.Preconditioner(a, "h1amg") if preconditioner == "h1amg" else None
        a.Assemble()
        f.Assemble()
        watch.lap("assembly")
        T = ng.GridFunction(V)
        if amg is not None:
            inverse = ng.CGSolver(a.mat, amg.mat, tol=TOLERANCE, maxiter=1000, printrates=False)
        else:
            inverse = a.mat.Inverse(V.FreeDofs(), inverse="sparsecholesky")
        T.vec.data = inverse * f.vec
        watch.lap("solve")
        return watch.laps, float(T.vec.FV().NumPy().max())

    return run


def _netgen(points: np.ndarray, tets: np.ndarray, facets: dict[str, np.ndarray]):  # type: ignore[no-untyped-def]
    import ngsolve as ng
    from netgen.meshing import FaceDescriptor, Mesh as NetgenMesh

    out = NetgenMesh(dim=3)
    out.AddPoints(np.ascontiguousarray(points))
    for i, name in enumerate(facets):
        out.Add(FaceDescriptor(bc=i + 1, domin=1, surfnr=i + 1))
        out.SetBCName(i, name)
    for i, f in enumerate(facets.values()):
        out.AddElements(2, i + 1, np.ascontiguousarray(f, np.int32), base=0)
    # Netgen orients tetrahedra the other way round.
    out.AddElements(3, 1, np.ascontiguousarray(tets[:, [0, 2, 1, 3]], np.int32), base=0)
    return ng.Mesh(out)


def _problem(saved: np.lib.npyio.NpzFile) -> Problem:
    facets = {name: saved[f"facets/{name}"].astype(np.int64) for name in FILMS}
    return saved["points"], saved["tets"].astype(np.int64), facets


CONTENDERS = {
    "thermoscope": thermoscope,
    "scikit-fem + pyamg": scikit_fem,
    "ngsolve h1amg": ngsolve_with("h1amg"),
    "ngsolve Cholesky": ngsolve_with("cholesky"),
}


def main() -> None:
    name, mesh, tiny = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    for file in (tiny, mesh):
        with np.load(file) as saved:
            laps, hottest = CONTENDERS[name](_problem(saved))
    print(json.dumps({"laps": laps, "hottest_C": hottest, "peak_GiB": peak_gib()}))


def peak_gib() -> float:
    """Most memory this process held; Linux's ru_maxrss would count the parent's too."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024**2


if __name__ == "__main__":
    main()
