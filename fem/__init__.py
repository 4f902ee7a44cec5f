"""How does heat move inside it: conduction on a named mesh, steady and over time.

field = assemble(mesh, conductivity, capacity)
found = steady(Solver(field), films, contacts, field.losses(watts), only_fixed(ambient=20.0))
"""

from fem.matrices.assembly import FieldModel, assemble
from fem.matrices.material import Conductivity, LoopWound, isotropic, laminated, wound
from fem.matrices.terms import CopperLoss, Radiation, Term, VaryingConductivity
from fem.matrices.winding import bundle, homogenised, unit_cell
from fem.solvers.newton import NonlinearSolution, solve_nonlinear
from fem.solvers.solve import Fluids, Iterative, Solver, Steady, only_fixed, steady
from fem.solvers.streams import Stream, cut, flowing
from fem.solvers.transient import transient

__all__ = [
    "Conductivity",
    "CopperLoss",
    "FieldModel",
    "Fluids",
    "Iterative",
    "LoopWound",
    "Radiation",
    "NonlinearSolution",
    "Solver",
    "Steady",
    "Stream",
    "Term",
    "VaryingConductivity",
    "assemble",
    "bundle",
    "cut",
    "flowing",
    "homogenised",
    "isotropic",
    "laminated",
    "only_fixed",
    "solve_nonlinear",
    "steady",
    "transient",
    "unit_cell",
    "wound",
]
