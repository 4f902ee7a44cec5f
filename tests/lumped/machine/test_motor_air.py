"""The fan's air through a forced-ventilated machine: how it divides, what it takes up, and what is left without it."""

from dataclasses import replace

import numpy as np
import pytest
from bare_networks import means_only

from geom import Machine, load_machine
from geom.description.geometry import NO_FEATURES
from geom.errors import InputError
from geom.machine_file import machine_from
from lumped.build.crosscheck import coefficients
from lumped.build.pipeline import prepared
from lumped.circuits.hydraulics import parallel_shares, pressure_drop
from lumped.integration.steady import steady
from lumped.machine.air import ways_of
from lumped.machine.films import surroundings
from lumped.model.network import Network
from lumped.transfer.properties import air
from lumped.transfer.terms_value import coefficient

WAYS = ("airgap", "air.interpolar", "air.ducts")
POINT = {"current_A": 150.0, "speed_rpm": 1000.0, "fan_flow_m3h": 138.0}


@pytest.fixture(scope="module")
def machine() -> Machine:
    return load_machine("series-dc-100kw-air")


@pytest.fixture(scope="module")
def network(machine) -> Network:
    return means_only(prepared(machine, 0.1, 36))


def rest(network: Network, **changed: float) -> np.ndarray:
    return steady(network, {**POINT, **changed}, {"ambient": 20.0}).z


def at(network: Network, z: np.ndarray, name: str) -> float:
    return float(z[network.column(name)])


def with_ducts(number: int, diameter_mm: float, **fan: float) -> Machine:
    rotor = {"ducts": number, "duct_diameter_mm": diameter_mm}
    made = machine_from({"machine": {"family": "series-dc"}, "geometry": {"rotor": rotor}}, "made")
    return replace(made, sections={"fans": {"flow_m3_h": 138.0, "gap_share": 0.1, **fan}})


def shares_of(machine: Machine) -> dict[str, float]:
    return surroundings(machine, ()).ways.rated


def test_all_ways_beside_the_gap_drop_the_same_pressure(machine):
    shares, ducts, rated = shares_of(machine), machine.features.ducts, 138.0 / 3600.0
    assert tuple(shares) == WAYS
    assert sum(shares.values()) == pytest.approx(1.0, rel=1e-12)
    assert shares["airgap"] == 0.10, "what the machine file says"
    drops = [pressure_drop(duct, shares[name] * rated, air(40.0)) for name, duct in ducts.items()]
    assert drops[0] == pytest.approx(drops[1], rel=1e-6)


def test_laminar_ducts_by_hand(machine):
    """In each of 12 ducts: Hagen and Poiseuille's 128 mu L Q / (pi d^4), 1.57 dynamic pressures at edge and exit."""
    rated, warm = 138.0 / 3600.0, air(40.0)
    each = shares_of(machine)["air.ducts"] * rated / 12
    speed = each / (np.pi * 0.010**2)
    assert speed * 0.020 / warm.nu < 2300.0
    by_hand = 128 * warm.mu * 0.188 * each / (np.pi * 0.020**4) + 1.57 * warm.rho * speed**2 / 2
    assert pressure_drop(machine.features.ducts["air.ducts"], 12 * each, warm) == pytest.approx(by_hand, rel=1e-3)


@pytest.mark.parametrize(("times", "outside"), [(0.0, 20.0), (0.3, -30.0), (4.0, 60.0)])
def test_the_split_follows_the_flow(machine, network, times, outside):
    """Equal pressure drop at every flow, friction laminar or turbulent; what leaves the ways is all that came in."""
    flow, inside = max(times * 138.0, 1e-6), air(outside + 20.0)
    left = (1.0 - 0.10) * flow / 3600.0
    split = parallel_shares([[duct] for duct in machine.features.ducts.values()], left, inside)
    carried = {
        x.name.removeprefix("stream:fan:"): coefficient(x.law, {"fan_flow_m3h": np.array(flow)}, outside, 0.0)
        for x in network.links
        if x.kind == "stream"
    }
    for way, share in zip(machine.features.ducts, split, strict=True):
        assert carried[way] / carried["air.left"] == pytest.approx(0.9 * share, rel=5e-3)
    assert sum(carried[way] for way in WAYS) == pytest.approx(carried["air.left"], rel=1e-9)


def test_without_ducts_the_rest_passes_between_the_poles():
    assert shares_of(load_machine("series-dc-100kw")) == {"airgap": 0.10, "air.interpolar": 0.90}
    assert shares_of(with_ducts(12, 10.0, gap_share=1.0)) == {"airgap": 1.0}
    machine = load_machine("pmsm-m1")
    assert ways_of(machine, surroundings(with_ducts(0, 10.0), ()).fan).rated == {"airgap": 1.0}


def test_the_air_carries_off_what_the_outer_faces_do_not(machine, network):
    """Losses = flow x rho cp x warming from ambient to the outlet + films to the surroundings."""
    z = rest(network)
    c = coefficients(network, POINT, z)
    by_air = air(20.0).rho * air(20.0).cp * 138.0 / 3600.0 * (at(network, z, "air.right") - 20.0)
    outer = [place for place in network.places.values() if place.fluid == "ambient"]
    by_faces = sum(c.films[p.name] * p.area * (float(p.mean.weights @ z[p.mean.index]) - 20.0) for p in outer)
    windage = machine.sections["losses"]["windage_W"]
    assert by_air + by_faces == pytest.approx(sum(c.watts.values()) + windage, rel=1e-6)
    assert by_air > 0.3 * (by_air + by_faces), "a machine cooled by its air"


def test_without_flow_the_streams_carry_nothing(machine, network):
    z = rest(network, fan_flow_m3h=0.0)
    T = at(network, z, "air.ducts")
    assert pytest.approx(at(network, z, "rotor.core"), abs=1e-6) == T, "air shut in by one wall takes its temperature"
    assert not coefficients(network, {**POINT, "fan_flow_m3h": 0.0}, z).streams.any()
    still = machine.features.ducts["air.ducts"]
    assert still.diameter == pytest.approx(0.020)
    assert at(network, z, "rotor.core") > at(network, rest(network), "rotor.core") + 10.0


def test_a_share_of_the_gap_beyond_one_is_refused():
    with pytest.raises(InputError, match=r"gap_share = 1.2 is not possible.*from 0 to 1"):
        shares_of(with_ducts(12, 10.0, gap_share=1.2))


def test_imported_machine_is_stirred_by_its_largest_turning_part():
    """No declared gap: the air inside still passes the walls, as fast as a share of the rotor's tip."""
    from lumped.machine.films import face_films, nominal

    machine = load_machine("pmsm-m1-no-base")
    inside = tuple(part for part in machine.fluids if part.name != "airgap")
    bare = replace(machine, fluids=inside, geometry=None, features=NO_FEATURES, sections={})
    around = surroundings(bare, ("rotor.core|shaft", "magnets|rotor.core", "bearing.left|shaft"))
    assert around.tip_radius == pytest.approx(machine.geometry.stator.bore_diameter / 2 - 1e-3)
    law = face_films("rotor.core", "air.left", around)
    still, turning = (nominal(law, {"speed_rpm": np.array([n])}) for n in (0.0, 1000.0))
    assert still == pytest.approx(15.0)
    assert turning == pytest.approx(15.0 * (1 + 0.4 * (2 * np.pi * 1000 / 60 * around.tip_radius) ** 0.9), rel=1e-3)
