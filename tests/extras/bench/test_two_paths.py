"""R_ext and R_w: exact where the network has only two resistances, with a stated residual elsewhere."""

import pytest

from extras.bench.reduction.pm_network import PmSettings, pm_network
from extras.bench.reduction.two_paths import two_paths
from geom import load_machine
from geom.errors import InputError
from lumped.declarations.network import read_network

PAIR = {
    "network": {"name": "pair", "boundaries": ["ambient"]},
    "nodes": {"winding": {"C_J_K": 2000}, "machine": {"C_J_K": 20000}},
    "links": {
        "inside": {"between": ["winding", "machine"], "R_K_W": 0.08},
        "outside": {"between": ["machine", "ambient"], "R_K_W": 0.3},
    },
    "losses": {
        "copper": {"at": "winding", "kind": "copper", "currents": ["current_A"], "R20_ohm": 2.0},
        "iron": {"at": "machine", "kind": "constant", "P_W": 40},
    },
}


def test_two_resistances_come_back():
    found = two_paths(read_network(PAIR), {"current_A": 8.0}, winding="winding", machine="machine")
    assert (found.R_ext, found.R_w) == (pytest.approx(0.3), pytest.approx(0.08))
    assert found.largest_K < 1e-6
    assert found.rises(found.P_w, found.P_all) == (pytest.approx(found.winding_K), pytest.approx(found.machine_K))
    assert found.P_all == pytest.approx(found.P_w + 40.0)


def test_a_machine_leaves_a_residual():
    """Films that grow with the rise make R_ext fall with the load: taken from full load it is too small at half."""
    network = pm_network(load_machine("pmsm-m1"), PmSettings())
    found = two_paths(network, {"current_A": 8.0, "speed_rpm": 0.0})
    assert 0.15 < found.R_ext < 0.4
    assert 0.03 < found.R_w < 0.15
    assert found.residual[0.5][1] < -0.2
    assert found.largest_K < 0.15 * found.winding_K


def test_no_load():
    with pytest.raises(InputError, match="a load with a current"):
        two_paths(read_network(PAIR), {"current_A": 0.0}, winding="winding", machine="machine")
