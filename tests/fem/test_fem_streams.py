"""Channels that heat their coolant, against the exact exponential and the straight line; the air gap."""

import numpy as np
import pytest
from named_grids import bar

from fem.matrices.assembly import assemble
from fem.matrices.material import isotropic
from fem.solvers.solve import Solver, only_fixed, steady
from fem.solvers.streams import Stream, cut, flowing
from geom.errors import InputError

L = 0.3


def channel(cells, k, n=24):
    """A bar cooled by "water" that runs along its sides; its own conduction k."""
    mesh = cut(bar(L, n, 0.01, sides="water"), "water", lambda x: x[:, 0], cells)
    return assemble(mesh, {"bar": isotropic(k)}, {"bar": 1.0})


def area():
    return L * 4 * 0.01


@pytest.mark.parametrize("cells", [1, 3, 24])
def test_isothermal_wall_heats_its_coolant_exponentially(cells):
    """T(x) = T_wall - (T_wall - T_in) exp(-h U x / mcp), exact with any number of cells."""
    field, mcp, h = channel(cells, 1e7), 2.0, 150.0
    films = {"bar.left": 0.0, "bar.right": 0.0, "bar.water": h}
    films, fluids = flowing(field, films, [Stream("water", mcp, 15.0)], {"left": 0.0, "right": 0.0})
    found = steady(Solver(field), films, {}, 50.0 * field.load("bar"), fluids)
    wall = found.T.mean()
    x = (1 + np.arange(cells)) / cells
    assert found.u == pytest.approx(wall - (wall - 15.0) * np.exp(-h * area() * x / mcp), abs=1e-3)
    assert mcp * (found.u[-1] - 15.0) == pytest.approx(50.0, rel=1e-7)  # k = 1e7 costs digits


def test_uniform_heat_makes_a_straight_line():
    """Hardly any conduction along the wall: the coolant warms linearly, the wall stays q / h above it."""
    field, mcp, h = channel(12, 0.1, 48), 5.0, 400.0
    films, fluids = flowing(
        field,
        {"bar.left": 0.0, "bar.right": 0.0, "bar.water": h},
        [Stream("water", mcp, 20.0)],
        {"left": 0.0, "right": 0.0},
    )
    found = steady(Solver(field), films, {}, 60.0 * field.load("bar"), fluids)
    assert found.u == pytest.approx(20.0 + 60.0 / mcp * (1 + np.arange(12)) / 12, abs=0.05)
    trace = field.films["bar.water@6"].trace
    middle = 20.0 + 60.0 / mcp * 6.5 / 12
    assert float(trace.b @ found.T[trace.dofs] / trace.area) == pytest.approx(middle + 60 / (h * area()), rel=2e-3)
    assert found.energy_balance < 1e-9


def test_wall_that_conducts_converges_with_the_cells():
    """Wall and coolant coupled: the hottest spot settles as the stream is cut finer, nearly at second order."""
    peak = []
    for cells in (6, 12, 24):
        field = channel(cells, 15.0)
        films, fluids = flowing(
            field,
            {"bar.left": 0.0, "bar.right": 0.0, "bar.water": 150.0},
            [Stream("water", 2.0, 15.0)],
            {"left": 0.0, "right": 0.0},
        )
        peak.append(steady(Solver(field), films, {}, 40.0 * field.load("bar"), fluids).T.max())
    change = np.abs(np.diff(peak))
    assert change[0] > 3 * change[1]


def test_streams_are_refused_where_they_cannot_run():
    mesh = bar(L, 4, 0.01, sides="water")
    with pytest.raises(InputError, match="no face is washed by 'oil'"):
        cut(mesh, "oil", lambda x: x[:, 0], 2)
    with pytest.raises(InputError, match="without a facet"):
        cut(mesh, "water", lambda x: x[:, 0], 40)
    with pytest.raises(InputError, match="a flow above 0"):
        Stream("water", 0.0, 20.0)
    field = assemble(mesh, {"bar": isotropic(1.0)}, {"bar": 1.0})
    with pytest.raises(InputError, match="cut the mesh"):
        flowing(field, dict.fromkeys(field.films, 1.0), [Stream("water", 1.0, 20.0)], {})


def test_given_fluids_must_be_complete():
    field = channel(2, 1.0)
    with pytest.raises(InputError, match="no temperature for fluid"):
        steady(Solver(field), dict.fromkeys(field.films, 1.0), {}, np.zeros(field.n), only_fixed(left=0.0, right=0.0))
