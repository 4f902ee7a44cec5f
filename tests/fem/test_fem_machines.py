"""A machine of every family: what goes in comes out, with streams, radiation and copper that warms."""

import numpy as np
import pytest

from fem.matrices.assembly import assemble
from fem.matrices.material import Conductivity, CopperLoss, Radiation
from fem.solvers.newton import solve_nonlinear
from fem.solvers.solve import Solver, steady
from fem.solvers.streams import Stream, cut, flowing
from geom import build_mesh, load_machine

pytestmark = pytest.mark.heavy

TINY = {"size_m": 0.1, "segments": 36, "across": 1, "axial_m": 0.2}
CELLS = 3
ONE_OF_EACH_FAMILY = ["ipmsm-48s8p-jacket", "pmsm-m1", "series-dc-100kw", "tefc-industrial"]


def losses(machine):
    """A hundred watts in every winding, twenty in every other part."""
    return {part.name: 100.0 if "winding" in part.name else 20.0 for part in machine.parts}


@pytest.fixture(scope="module", params=ONE_OF_EACH_FAMILY)
def machine(request):
    return load_machine(request.param)


@pytest.fixture(scope="module")
def solved(machine):
    """Solver, films, contacts and fluids: jackets and inner air stream from left to right, the ambient stands."""
    mesh = build_mesh(machine, **TINY)
    inner = sorted({p.fluid for p in mesh.patches.values()} - {"ambient"})
    for fluid in inner:
        mesh = cut(mesh, fluid, lambda x: x[:, 2], CELLS if "jacket" in fluid else 1)
    found = {p.name: machine.material_of(p.name) for p in machine.parts}
    field = assemble(
        mesh,
        {name: Conductivity(m.k_plane, m.k_plane, m.k_axial) for name, m in found.items()},
        {name: m.rho * m.cp for name, m in found.items()},
    )
    h = {face: 12.0 if film.fluid == "ambient" else 200.0 for face, film in field.films.items()}
    streams = [Stream(fluid, 400.0 if "jacket" in fluid else 20.0, 25.0) for fluid in inner]
    films, fluids = flowing(field, h, streams, {"ambient": 20.0})
    return Solver(field), films, dict.fromkeys(field.contacts, 1000.0), fluids


def test_energy_in_is_energy_out(machine, solved):
    solver, films, contacts, fluids = solved
    field, watts = solver.field, losses(machine)
    load = field.losses(watts)
    found = steady(solver, films, contacts, load, fluids)
    assert load.sum() == pytest.approx(sum(watts.values()), rel=1e-13)
    assert found.energy_balance < 1e-9
    assert found.T.min() > 20.0


def test_energy_with_everything_that_depends_on_temperature(machine, solved):
    solver, films, contacts, fluids = solved
    field = solver.field
    terms = [CopperLoss(p, q) for p, q in losses(machine).items() if "winding" in p]
    terms += [Radiation(face, 0.8, 20.0) for face, film in field.films.items() if film.fluid == "ambient"]
    found = solve_nonlinear(solver, films, contacts, np.zeros(field.n), fluids, terms)
    assert found.injected > sum(term.watts for term in terms if isinstance(term, CopperLoss))
    assert found.energy_balance < 1e-9
