"""Oil on the end windings of a machine file: what the nozzles give leaves through the end spaces, and nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from bare_networks import means_only

from geom import InputError, load_machine
from lumped.build.pipeline import prepared
from lumped.correlations.oil import sprayed_face
from lumped.integration.balance import balance
from lumped.integration.simulate import Record
from lumped.integration.steady import steady
from lumped.machine.motor import boundaries, rated_inputs
from lumped.machine.sprays import spray_of
from lumped.transfer.coolant import coolant
from lumped.transfer.terms_value import coefficient
from validation.effects import kinds
from validation.effects.base import Scene

NOZZLES = {"nozzles": 8, "nozzle_mm": 1.5, "run_mm": 60}
BOTH = {"coolant": "ATF", "flow_L_per_min": 5.0, "inlet_C": 60.0, "winding.left": NOZZLES, "winding.right": NOZZLES}
PLAIN = load_machine("ipmsm-48s8p-jacket")
AROUND = {"ambient": 25.0, "coolant": 65.0, "oil": 60.0}


def sprayed(**spray):
    return replace(PLAIN, sections={**PLAIN.sections, "spray": spray})


@pytest.fixture(scope="module")
def network():
    return means_only(prepared(sprayed(**BOTH), 0.1, 36))


def test_what_the_oil_takes_up_is_its_rise(network):
    """Watts of the films and of all other faces of both end spaces, and m cp of the oil that comes and leaves."""
    machine = sprayed(**BOTH)
    assert boundaries(machine) == ("ambient", "coolant", "oil")
    assert rated_inputs(machine)["oil_l_min"] == 5.0
    time = np.arange(0.0, 3600.0, 20.0)
    given = {name: np.full_like(time, value) for name, value in rated_inputs(machine).items()}
    given["oil_l_min"] = 5.0 + 3.0 * np.sin(time / 300.0)
    run = balance(network, Record(time, given, AROUND, 60.0))
    assert np.abs(run.residual).max() < 5e-5
    rest = steady(network, rated_inputs(machine), AROUND)
    for end in ("left", "right"):
        (stream,) = [link for link in network.links if link.name == f"stream:oil:air.{end}"]
        rise = rest[f"air.{end}"] - 60.0
        fluid = coolant("ATF")(60.0 + 0.5 * rise)
        rate = coefficient(stream.law, {"oil_l_min": np.array([5.0])}, 60.0 + 0.5 * rise, 0.0)
        assert rate == pytest.approx(2.5 / 6e4 * fluid.rho * fluid.cp, rel=2e-3)
        assert 3.0 < rise < 15.0


def test_the_film_is_that_of_its_nozzles_at_the_oil_that_it_meets(network):
    """Onto what leaves: (e^N - 1) / N times the film at the mean of both, N = h A / m cp."""
    (face,) = [p for p in network.places.values() if p.kind == "surface" and p.part == "winding.left"]
    nozzles = spray_of(sprayed(**BOTH)).faces["winding.left"]
    assert nozzles.wall == pytest.approx(face.area, rel=0.05)  # a ring
    (link,) = [x for x in network.links if x.name == f"film:{face.name}:spray"]
    for flow, T in ((2.0, 60.0), (5.0, 80.0), (8.0, 95.0)):
        fluid = coolant("ATF")(T)
        h = sprayed_face(0.5 * flow / 6e4, 8, 1.5e-3, nozzles.wall, 0.06, fluid)[0]
        N = h * nozzles.wall / (0.5 * flow / 6e4 * fluid.rho * fluid.cp)
        onto = coefficient(link.law, {"oil_l_min": np.array([flow])}, T, 0.0)
        assert onto == pytest.approx(h * np.expm1(N) / N, rel=5e-3)


def test_it_cools_and_its_nozzles_may_be_blocked(network):
    dry = means_only(prepared(PLAIN, 0.1, 36))
    hot = steady(dry, rated_inputs(PLAIN), {"ambient": 25.0, "coolant": 65.0})["winding.left"]
    assert steady(network, rated_inputs(sprayed(**BOTH)), AROUND)["winding.left"] < hot - 15.0
    scene = Scene(network, frozenset(network.inputs))
    assert kinds()["nozzles"].places(scene) == ("winding.left", "winding.right")
    assert kinds()["nozzles.all"].places(scene) == ("oil",)
    assert {p.name for p in network.parameters} >= {"h.oil", "oil.flow", "h.air.left", "coolant.flow"}
    assert kinds()["nozzles"].places(Scene(dry, frozenset(dry.inputs))) == ()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"winding.left": {"nozzles": 8}}, "nozzle_mm"),
        ({"winding.lft": NOZZLES}, "winding.lft"),
        ({"coolant": "milk"}, "ATF"),
    ],
)
def test_a_slip_is_one_message(change, words):
    with pytest.raises(InputError, match=words):
        spray_of(sprayed(**{**BOTH, **change}))


def test_no_part_under_nozzles_is_said():
    with pytest.raises(InputError, match="no part under nozzles"):
        spray_of(sprayed(coolant="ATF", flow_L_per_min=5.0))
