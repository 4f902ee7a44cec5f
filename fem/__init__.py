"""How does heat move inside it: conduction on a named mesh, steady and over time.

field = assemble(mesh, conductivity, capacity)
found = steady(Solver(field), films, contacts, field.losses(watts), only_fixed(ambient=20.0))
"""

from fem.assembly import FieldModel, assemble
from fem.gap import AirGap
from fem.material import Conductivity, LoopWound, isotropic, laminated, wound
from fem.newton import Settled, settle
from fem.solve import Fluids, Iterative, Solver, Steady, only_fixed, steady
from fem.streams import Stream, cut, flowing
from fem.terms import CopperLoss, Radiation, Term, VaryingConductivity
from fem.transient import transient
from fem.winding import bundle, homogenised, unit_cell

__all__ = [
    "AirGap",
    "Conductivity",
    "CopperLoss",
    "FieldModel",
    "Fluids",
    "Iterative",
    "LoopWound",
    "Radiation",
    "Settled",
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
    "settle",
    "steady",
    "transient",
    "unit_cell",
    "wound",
]
