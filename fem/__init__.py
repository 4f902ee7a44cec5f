"""How does heat move inside it: conduction on a named mesh, steady and over time.

field = assemble(mesh, conductivity, capacity)
found = steady(Solver(field), films, contacts, field.losses(watts), only_fixed(ambient=20.0))
"""

from fem.matrices.assembly import FieldModel as FieldModel, assemble as assemble
from fem.matrices.material import Conductivity as Conductivity, LoopWound as LoopWound, isotropic as isotropic
from fem.matrices.material import laminated as laminated, wound as wound
from fem.matrices.material import CopperLoss as CopperLoss, Radiation as Radiation, Term as Term
from fem.matrices.winding import bundle as bundle, homogenised as homogenised, unit_cell as unit_cell
from fem.solvers.newton import NonlinearSolution as NonlinearSolution, solve_nonlinear as solve_nonlinear
from fem.solvers.solve import Fluids as Fluids, Iterative as Iterative, Solver as Solver, Steady as Steady
from fem.solvers.solve import only_fixed as only_fixed, steady as steady
from fem.solvers.streams import Stream as Stream, cut as cut, flowing as flowing
from fem.solvers.newton import transient as transient
