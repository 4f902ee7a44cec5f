"""Channels that heat their coolant, against the exact exponential and the straight line; the air gap."""

import numpy as np
import pytest
from named_grids import bar, named

from fem.matrices.assembly import assemble
from fem.matrices.gap import AirGap
from fem.matrices.grids import ring
from fem.matrices.material import isotropic
from fem.matrices.streams import Stream, cut, flowing
from fem.solvers.solve import Fluids, Solver, only_fixed, steady
from geom.errors import InputError
from lumped.correlations.air_gap import taylor_film

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
        field, {"bar.left": 0.0, "bar.right": 0.0, "bar.water": h}, [Stream("water", mcp, 20.0)],
        {"left": 0.0, "right": 0.0},
    )  # fmt: skip
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
            field, {"bar.left": 0.0, "bar.right": 0.0, "bar.water": 150.0}, [Stream("water", 2.0, 15.0)],
            {"left": 0.0, "right": 0.0},
        )  # fmt: skip
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


def still(gap, r=0.06, k=0.03):
    return AirGap(r, gap, k, lambda w: 2.0)


def test_still_gap_is_an_annulus_of_air():
    """Rotor inside, stator outside, gap node between: P ln(rs / rr) / (2 pi k L) from wall to wall."""
    rr, gap, length, watts = 0.06, 0.001, 0.1, 20.0
    h_rotor, h_stator = still(gap).films(0.0)
    r = np.array([0.03, rr, rr + gap, 0.08])
    part = lambda c: named(c, (c[:, 0] < rr * 0.999, "rotor"), (c[:, 0] > rr + gap, "stator"))  # noqa: E731
    washed = lambda c: named(c, (c[:, 0] > 0.079, "ambient"), (np.abs(c[:, 0] - rr) < 0.002, "airgap"))  # noqa: E731
    mesh = ring(r, 180, np.linspace(0, length, 3), part, washed)
    field = assemble(mesh, {"rotor": isotropic(1e4), "stator": isotropic(1e4)}, {"rotor": 1.0, "stator": 1.0})
    films = {"rotor.airgap": h_rotor, "stator.airgap": h_stator, "stator.outer": 1e4}
    fluids = Fluids(("airgap",), np.zeros((1, 1)), np.zeros(1), {"ambient": 20.0})
    found = steady(Solver(field), films, {}, watts * field.load("rotor"), fluids)
    rise = field.mean("rotor") @ found.T - field.mean("stator") @ found.T
    # 180 chords lose 5e-5 of the walls' area; the rings themselves 1e-4 of the rise.
    assert rise == pytest.approx(watts * np.log1p(gap / rr) / (2 * np.pi * 0.03 * length), rel=5e-4)
    assert found.energy_balance < 1e-9


def test_gap_conducts_better_at_speed():
    rr, g = 0.145, 0.002
    gap = AirGap(rr, g, 0.03, lambda w: taylor_film(w, rr, g)[1].numbers["Nu"])
    slow, fast = gap.conductance(0.0), gap.conductance(300.0)
    assert slow == pytest.approx(2 * np.pi * 0.03 / np.log((rr + g) / rr))
    assert fast > 1.5 * slow
    both = [2 * np.pi * radius * h for radius, h in zip((rr, rr + g), gap.films(300.0), strict=True)]
    assert 1 / (1 / both[0] + 1 / both[1]) == pytest.approx(fast)


def test_gap_equals_two_taylor_films_where_it_is_thin():
    rr, g = 0.145, 0.002
    h, _ = taylor_film(100.0, rr, g)
    gap = AirGap(
        rr, g, h * g / taylor_film(100.0, rr, g)[1].numbers["Nu"], lambda w: taylor_film(w, rr, g)[1].numbers["Nu"]
    )
    assert gap.films(100.0) == pytest.approx((h, h), rel=g / rr)


def test_a_gap_without_width_is_refused():
    with pytest.raises(InputError, match="without width"):
        still(0.0)


def test_given_fluids_must_be_complete():
    field = channel(2, 1.0)
    with pytest.raises(InputError, match="no temperature for fluid"):
        steady(Solver(field), dict.fromkeys(field.films, 1.0), {}, np.zeros(field.n), only_fixed(left=0.0, right=0.0))
