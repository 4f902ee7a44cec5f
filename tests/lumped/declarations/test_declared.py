"""Hand-declared networks: the documented example, and the messages for every kind of slip."""

import copy
import re
import tomllib

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geom.errors import InputError
from lumped.declarations.network import load_network, read_network
from lumped.integration.balance import balance
from lumped.integration.simulate import Record, simulate
from lumped.transfer.laws import Conductivity, Linear
from lumped.transfer.terms_value import temperature_value


@pytest.fixture(scope="module")
def example(root):
    text = (root / "docs/network-toml.md").read_text()
    return re.search(r"```toml\n(.*?)```", text, re.S).group(1)


@pytest.fixture
def data(example):
    return copy.deepcopy(tomllib.loads(example))


TIME = np.arange(0.0, 20000.0, 20.0)
INPUTS = {"id_A": -40.0, "iq_A": 90.0, "speed_rpm": 2000.0, "flow_l_min": 8.0}
AROUND = {"ambient": 22.0, "coolant": 30.0}


def test_the_documented_example_reads_and_runs(example, tmp_path):
    file = tmp_path / "network.toml"
    file.write_text(example)
    network = load_network(file)
    run = simulate(
        network, Record(TIME, INPUTS, AROUND), rows=[network.place("winding-resistance").mean], keep_states=True
    )
    winding, stator = run.z[-1, :2]
    assert run.y[-1, 0] == pytest.approx(0.9 * winding + 0.1 * stator)
    assert winding > stator > 30.0


def test_the_documented_circuit_warms_from_20_to_80_degC(root):
    second = re.findall(r"```toml\n(.*?)```", (root / "docs/network-toml.md").read_text(), re.S)[1]
    network = read_network(tomllib.loads(second))
    z = simulate(network, Record(np.arange(0.0, 9000.0, 10.0), {}, {"ambient": 20.0}), keep_states=True).z
    assert z[0, network.column("glycol.outlet")] == 20.0
    assert z[-1, network.column("glycol.outlet")] == pytest.approx(80.0, abs=1.0)
    rise = z[-1, network.column("glycol.outlet")] - z[-1, network.column("glycol.reservoir")]
    assert rise == pytest.approx(25.4, abs=0.1)  # 12,420 W into 8 l/min of 1,036 kg/m3 and 3,532 J/kg/K, at 67 degC
    assert [p.name for p in network.parameters] == ["film.glycol"]


def test_copper_loss_is_the_published_formula(data):
    """Liu et al. 2024: 1.5 Rs (id^2 + iq^2) (1 + alpha (T - 20)) (1 + 0.02174 f + 0.3874 f^2), f = rpm / 4000."""
    sources = {s.name: s for s in read_network(data).sources}
    copper, eddy = sources["loss:copper"], sources["loss:copper:eddy"]
    f = 0.5
    direct = 1.5 * 4.67e-3 * (40.0**2 + 90.0**2)
    assert copper.law.factor(INPUTS) == pytest.approx(direct, rel=1e-12)
    assert eddy.law.factor(INPUTS) == pytest.approx(direct * (0.02174 * f + 0.3874 * f * f), rel=1e-12)
    assert copper.law.temperature == Linear(0.0039, 20.0)
    assert eddy.law.temperature == Conductivity(0.0039, 20.0)


@pytest.mark.parametrize("ratio", [1.4, 3.0])
def test_eddy_currents_fall_with_resistivity(data, ratio):
    """Alternating over direct current 1.4 and 3 at 20 degC: at 150 degC direct grows by 1.507, the rest falls by it."""
    data["losses"]["copper"] |= {"ac": {"input": "speed_rpm", "at": 2000.0, "coefficients": [1.0, 0.0, ratio - 1.0]}}
    network = read_network(data)
    warm = 1.0 + 0.0039 * 130.0
    sources = [s for s in network.sources if s.name.startswith("loss:copper")]
    watts = [float(s.law.factor(INPUTS)) * temperature_value(s.law.temperature, 150.0, 0.0) for s in sources]
    direct = 1.5 * 4.67e-3 * (40.0**2 + 90.0**2)
    assert sum(watts) == pytest.approx(direct * (warm + (ratio - 1.0) / warm), rel=1e-12)


def test_measured_loss_less_copper_injects_the_measured_sum(data):
    data["losses"]["iron"] = {
        "kind": "measured",
        "at": "stator",
        "less": ["copper"],
        "electrical": {"product": ["electrical_W"]},
        "mechanical": {"product": ["torque_Nm", "speed_rpm"]},
    }
    given = {**INPUTS, "electrical_W": 12000.0, "torque_Nm": 50.0}
    network = read_network(data)
    heat = balance(network, Record(TIME, given, AROUND), {"loss.copper": 1.3})
    losses = [name for name in heat.injected if name.startswith(("loss:copper", "loss:iron"))]
    total = sum(heat.injected[name] for name in losses)
    assert_allclose(total, (12000.0 - 50.0 * 2000.0 * np.pi / 30) * TIME, rtol=1e-9, atol=1e-3)


def _conductance(document, G_W_K):
    document["links"]["winding-stator"].pop("R_K_W")
    document["links"]["winding-stator"]["G_W_K"] = G_W_K


SLIPS = {
    "missing unit": (lambda d: d["nodes"]["rotor"].update(C=1.0), r"nodes.rotor.*'C'.*C_J_K"),
    "unknown key": (lambda d: d["links"]["winding-stator"].update(colour=1), "links.winding-stator.*'colour'"),
    "unknown node": (lambda d: d["links"]["winding-stator"].update(between=["winding", "statr"]), "'statr'.*'stator'"),
    "no coefficient": (lambda d: d["links"]["winding-stator"].pop("R_K_W"), "winding-stator.*mechanism.*G_W_K"),
    "hardly any": (lambda d: _conductance(d, 1e-300), "winding-stator.*G_W_K = 1e-300 is not possible"),
    "two coefficients": (lambda d: d["links"]["winding-stator"].update(G_W_K=1.0), "G_W_K and R_K_W both given"),
    "text for a number": (lambda d: d["nodes"]["stator"].update(C_J_K="5616"), "C_J_K = '5616'"),
    "shares": (lambda d: d["losses"]["copper"].update(at={"winding": 0.5}), "losses.copper.*sum to 0.5"),
    "loss class": (lambda d: d["losses"]["copper"].update(kind="coper"), "'coper'.*did you mean 'copper'"),
    "lonely node": (lambda d: d["nodes"].update(lost={"C_J_K": 1.0}), "no heat can leave 'lost'"),
    "parameter": (lambda d: d["parameters"]["iron and friction"].update(acts_on=["loss:irn"]), "loss:irn.*loss:iron"),
    "flow": (lambda d: d["streams"]["water"].pop("flow_l_min_input"), "streams.water.*no flow"),
    "heated boundary": (lambda d: d["losses"]["bearing"].update(at="ambient"), "bearing.*boundary"),
}


@pytest.mark.parametrize(("slip", "message"), SLIPS.values(), ids=SLIPS)
def test_every_slip_is_one_message_that_says_what_would_be_right(data, slip, message):
    slip(data)
    with pytest.raises(InputError, match=message):
        read_network(data)


def test_a_file_that_is_no_toml(tmp_path):
    (tmp_path / "network.toml").write_text("[network\n")
    with pytest.raises(InputError, match="not readable as TOML"):
        load_network(tmp_path / "network.toml")
