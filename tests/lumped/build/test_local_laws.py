"""The field with laws point by point, beside the network's laws of means."""

import numpy as np
import pytest

from fem.solvers.solve import Solver
from lumped.build.crosscheck import copper, crosscheck, radiating, with_local_laws
from lumped.machine.loss_sources import loss_shares

POINT = {"current_A": 8.0, "speed_rpm": 0.0}


@pytest.mark.heavy
def test_laws_point_by_point_move_heat_to_where_it_is_hot(built):
    """All heat leaves; in steady state little changes in the mean, and the hottest copper gets hotter."""
    shares, solver = loss_shares(built.machine, built.network), Solver(built.field)
    check = crosscheck(built.field, built.network, POINT, solver=solver, shares=shares)
    found = with_local_laws(built.field, built.network, POINT, check, shares, solver=solver)
    assert radiating(built.network)
    assert [source.kind for source, _ in copper(built.network)] == ["copper"]
    assert found.energy_balance < 1e-9
    rise = np.array([check.field, found.T]) - 20.0
    assert found.injected == pytest.approx(check.heat, rel=0.01)
    assert np.abs(rise[1] - rise[0]).max() < 0.03 * rise.max()
    assert rise[1].max() > rise[0].max()
