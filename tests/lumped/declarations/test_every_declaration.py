"""Whatever network.toml can declare conserves heat, has its tangent, and is gone at multiplier zero.

The cases are the registries of the readers: what is added there without keys here fails.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from test_circuit import circuit, closed, network as circuit_network
from test_declared_films import MOVING, STILL

from lumped.correlations.contacts import GAPS, PRESSED
from lumped.declarations.films import moving_surfaces, still_surfaces
from lumped.declarations.links import FLOW_INPUTS, MECHANISMS, ROTATING
from lumped.declarations.loss_tables import LOSSES, MEASURED, PLAIN
from lumped.declarations.network import read_network
from lumped.declarations.parameters import MAPPINGS
from lumped.integration.balance import balance
from lumped.integration.simulate import Record, simulate
from lumped.model.network import Parameter
from lumped.transfer.exchanger import ARRANGEMENTS

pytestmark = pytest.mark.filterwarnings("ignore::lumped.correlations.RangeWarning")
CLOSES = 1e-4  # of the heat: a hundredth of a kelvin of a rise of 100 K
TIME = np.arange(0.0, 900.0, 10.0)
INPUTS = {
    "speed_rpm": 1500.0 + 1400.0 * np.sin(TIME / 250.0),
    "v": 6.0 + 5.0 * np.sin(TIME / 150.0),
    "current_A": 10.0 + 4.0 * np.sin(TIME / 130.0),
    "torque_Nm": 2.0 + np.sin(TIME / 99.0),
    "voltage_V": 20.0 + TIME / 90.0,
    "electrical_W": 900.0 + TIME / 9.0,
    "flow": 1.5 + np.cos(TIME / 170.0),
    "turning": 8.0 * np.cos(TIME / 60.0),
}
BOUNDARIES = {"ambient": 18.0 + 3.0 * np.sin(TIME / 200.0), "inlet": 25.0, "far": 40.0}
RECORD = Record(TIME, INPUTS, BOUNDARIES, {"a": 70.0, "b": 45.0, "c": 30.0})
LINKS = {
    "G": {"G_W_K": 4.0},
    "R": {"R_K_W": 0.2},
    "h": {"h_W_m2K": 12.0},
    "G of inputs": {"G_W_K": 4.0, "of": {"input": "speed_rpm", "at": 1000.0, "exponent": 0.8}},
    **{f"natural {name}": {"natural": {"surface": name, **keys}} for name, (keys, _) in STILL.items()},
    "natural at 40 degC": {"natural": {"surface": "horizontal cylinder", "fluid_degC": 40.0, "size_m": 0.3}},
    **{f"forced {name}": {"forced": {"surface": name, "speed": "v", **keys}} for name, (keys, _) in MOVING.items()},
    "forced at 40 degC": {"forced": {"surface": "plate", "speed": "v", "fluid_degC": 40.0, "size_m": 0.5}},
    "forced water": {"forced": {"surface": "duct", "speed": "v", "coolant": "water", **MOVING["duct"][0]}},
    "forced of inputs": {"forced": {"h_W_m2K": 9.0, "of": {"input": "v", "at": 5.0, "exponent": 0.8}}},
    **{f"rotating {name}": {"rotating": {"surface": name, "diameter_mm": 200.0}} for name in ROTATING},
    **{
        f"gap {law}": {"gap": {"rotor_radius_mm": 80.0, "gap_mm": 0.7, "law": law}} for law in ("taylor", "becker-kaye")
    },
    "radiation": {"radiation": {"emissivity": 0.9, "view_factor": 0.8}},
    "joint": {"contact": {"joint": next(iter(GAPS))}},
    "pair": {"contact": {"pair": next(iter(PRESSED))}},
    "fan": {"fan": {"h_W_m2K": 40.0, "at_rpm": 1460.0}},
    "power": {"power": {"h_W_m2K": 3.0, "exponent": 0.33}},
    "table": {"table": {"difference_K": [0.0, 10.0, 60.0], "G_W_K": [1.0, 1.4, 2.0]}},
    "mixed": {
        "mixed": {
            "natural": {"surface": "vertical plate", "size_m": 0.3},
            "forced": {"surface": "plate", "size_m": 0.3, "speed": "v", "up_to_m_s": 20.0},
        }
    },
}
POWER = {"P_W": 30.0, "of": {"input": "speed_rpm", "at": 1000.0, "exponent": 1.5}}
HEATS = {
    "copper": {
        "R20_ohm": 0.2,
        "currents": ["current_A"],
        "ac": {"input": "speed_rpm", "at": 1000.0, "coefficients": [1.0, 0.0, 0.1]},
    },
    "iron": {
        "hysteresis_W": 10.0,
        "eddy_W": 4.0,
        "excess_W": 2.0,
        "speed_at": 1000.0,
        "excitation": "current_A",
        "excitation_at": 10.0,
    },
    "brush": {"drop_V": 2.0, "friction_W": 9.0, "speed_at": 1000.0},
    "ripple": {"supply_V": 48.0, "L_H": 2e-3, "switching_Hz": 4000.0, "R20_ohm": 50.0},
    "inverter": {
        "currents": ["current_A"],
        "factor": 3.0,
        "threshold_V": 1.0,
        "R_on_ohm": 0.05,
        "switching_Hz": 8e3,
        "switching_J": 1e-3,
        "reference_A": 10.0,
        "reference_V": 600.0,
        "supply_V": 560.0,
        "standby_W": 9.0,
    },
    "pwm": {"supply_V": 98.0, "L_H": 2e-4, "switching_Hz": 4000.0, "R_pulse_ohm": 2.0},
    "map": {
        "at_speed": [0, 4000],
        "at_torque": [0, 5],
        "P_W": [[1, 2], [30, 50]],
        "alpha_1_K": 0.002,
        "reference_degC": 20.0,
    },
    "measured": {
        "electrical": [{"product": ["electrical_W"]}],
        "mechanical": [{"product": ["torque_Nm", "speed_rpm"]}],
        "less": ["heat"],
    },
    **dict.fromkeys(PLAIN, POWER),
}
STREAMS = {
    "mcp": {"mcp_W_K": 3.0},
    "mcp of inputs": {"mcp_W_K": 3.0, "of": {"input": "flow", "at": 1.0, "exponent": 1.0}},
    "l_min": {"flow_l_min": 0.05, "density_kg_m3": 1000.0, "cp_J_kgK": 4000.0},
    **{key: {key: "flow", "density_kg_m3": 1.2, "cp_J_kgK": 1e5 if "l_min" in key else 3e3} for key in FLOW_INPUTS},
    "backwards": {"flow_l_min_input": "turning", "density_kg_m3": 1.2, "cp_J_kgK": 2e4, "backwards_from": "far"},
}
VARIES = {"flow_l_min_input": "turning"}
CIRCUITS = {
    "open": circuit(),
    "open, films fixed": circuit(films="fixed"),
    "open, either way": circuit(**VARIES, backwards_from="ambient"),
    "coil": circuit(
        passes=[{"wall": "housing", "width_mm": 9, "height_mm": 9, "length_m": 1.2, "coil_diameter_mm": 200}]
    ),
    "two walls": circuit(
        passes=[{"wall": {"housing": 0.6, "flange": 0.4}, "width_mm": 20, "height_mm": 6, "length_m": 1.2}]
    ),
    "open, water": circuit(coolant="water"),
    "open, by volume": circuit(coolant={"name": "propylene glycol", "volume_percent": 40.0}),
    **{
        f"closed, {name}": closed() | {"reservoir": {**closed()["reservoir"], "arrangement": name}}
        for name in ARRANGEMENTS
    },
    "closed, either way": closed(**VARIES),
}


def document(**more):
    """Three nodes in a row, heat into the first, a way out from the second."""
    return {
        "network": {"name": "n", "boundaries": ["ambient", "inlet", "far"]},
        "nodes": {"a": {"C_J_K": 300.0}, "b": {"C_J_K": 500.0}, "c": {"C_J_K": 80.0}},
        "links": {
            "ab": {"between": ["a", "b"], "G_W_K": 3.0},
            "out": {"between": ["b", "ambient"], "G_W_K": 4.0},
            "bc": {"between": ["b", "c"], "G_W_K": 2.0},
            **more.get("links", {}),
        },
        "losses": {"heat": {"kind": "constant", "at": "a", "P_W": 60.0}, **more.get("losses", {})},
        "streams": more.get("streams", {}),
    }


def linked(keys):
    own = {} if "G_W_K" in keys or "R_K_W" in keys or "G_W_K" in keys.get("table", {}) else {"area_m2": 0.2}
    return document(links={"new": {"between": ["a", "c"], **own, **keys, "prior_sd": 0.2}})


def heated(kind, keys):
    return document(losses={"new": {"kind": kind, "at": {"a": 0.3, "c": 0.7}, **keys, "prior_sd": 0.2}})


def streaming(keys):
    return document(streams={"new": {"path": ["inlet", "a", "c"], **keys, "prior_sd": 0.2}})


DOCUMENTS = {
    **{f"link {name}": linked(keys) for name, keys in LINKS.items()},
    **{f"loss {kind}": heated(kind, keys) for kind, keys in HEATS.items()},
    **{f"stream {name}": streaming(keys) for name, keys in STREAMS.items()},
}
EACH = [pytest.param(data, id=name) for name, data in DOCUMENTS.items()]


def test_every_entry_of_the_registries_has_a_case():
    assert set(MECHANISMS) <= {key for keys in LINKS.values() for key in keys}
    assert set(still_surfaces()) == {keys["natural"]["surface"] for keys in LINKS.values() if "natural" in keys}
    assert set(moving_surfaces()) == {
        keys["forced"].get("surface", "plate") for keys in LINKS.values() if "forced" in keys
    }
    assert set(HEATS) == {*LOSSES, MEASURED, *PLAIN}


@pytest.mark.parametrize("data", EACH)
def test_heat_is_conserved(data):
    """In - out - stored; what is declared carries some of it; a link's ends get and give the same at every instant."""
    net = read_network(data)
    heat = balance(net, RECORD)
    (parameter,) = net.parameters
    assert np.abs(heat.residual).max() < CLOSES
    carried = {**heat.through, **heat.injected}
    assert max(np.abs(carried[name]).max() for name, _ in parameter.targets) > 0.0
    for link in (x for x in net.links if x.name.startswith("link:new")):
        flow = np.bincount(link.rows, link.vals * np.where(link.cols == net.column("a"), 1.0, 0.0), 3)
        assert flow[net.column("a")] == -flow[net.column("c")] > 0.0
        assert flow[net.column("b")] == 0.0


@pytest.mark.parametrize("data", EACH)
def test_at_multiplier_zero_it_is_not_there(data):
    """To the bit; what a measured loss leaves out for the model goes with it."""
    net, bare = read_network(data), read_network(document())
    acts = [name for name, _ in net.parameters[0].targets] + [s.name for s in net.sources if ":less:" in s.name]
    gone = Parameter("gone", tuple((name, 1.0) for name in acts), 0.0, mapping="amplitude", neutral=0.0)
    y = simulate(net.extended(parameters=[gone]), RECORD, keep_states=True).z
    assert_array_equal(y, simulate(bare, RECORD, keep_states=True).z)


@pytest.mark.parametrize("mapping", MAPPINGS)
def test_every_mapping_has_its_tangent(mapping):
    """A factor 1.2 and its slope, of all that a parameter of each kind acts on."""
    value = {"log": 1.2, "relative": 0.2, "amplitude": 1.2, "offset": 0.2}[mapping]
    entry = {"acts_on": ["link:new", "loss:heat", "capacity:b"], "mapping": mapping, "value": value}
    net = read_network({**document(links={"new": {"between": ["a", "c"], "G_W_K": 4.0}}), "parameters": {"p": entry}})
    rows, h = [net.place(node).mean for node in net.states], 1e-3
    run = simulate(net, RECORD, None, rows, net.parameters)

    def moved(k):
        new = value * np.exp(k * h) if mapping == "log" else value + k * h
        return simulate(net, RECORD, {"p": new}, rows, steps=run.steps).y

    difference, dy = (8 * (moved(1) - moved(-1)) - moved(2) + moved(-2)) / (12 * h), run.dy[:, :, 0]
    assert np.abs(dy).max() > 1e-2
    assert_allclose(dy, difference, atol=1e-6 * np.abs(dy).max())


def circuit_record(net):
    around = {"ambient": 20.0, "inlet": 20.0 + 10.0 * np.sin(TIME / 200.0)}
    return Record(TIME, {"turning": INPUTS["turning"]}, {b: around[b] for b in net.boundaries}, 25.0)


@pytest.mark.parametrize("name", CIRCUITS)
def test_circuits_conserve_heat(name):
    closes = "reservoir" in CIRCUITS[name]
    net = circuit_network(CIRCUITS[name], closes)
    heat = balance(net, circuit_record(net))
    films = [x for x in heat.through if x.startswith("film:water")]
    assert films
    assert min(np.abs(heat.through[x]).max() for x in films) > 0.0
    assert np.abs(heat.residual).max() < CLOSES
    if closes:
        loop = sum(x for stream, x in heat.through.items() if stream.startswith("stream:"))
        assert np.abs(loop).max() < 1e-9 * heat.injected["loss:heat"].max()
