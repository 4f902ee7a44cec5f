"""A shaft conducts what its steel can: candidates beyond that are no explanation of a cold rotor."""

import math
import tomllib

import pytest
from small_networks import MOTOR

from lumped.declarations.network import read_network
from validation.effects import Scene, kinds
from validation.effects.conduction.bridge import stub


def test_stoutest_shaft_is_k_a_over_l():
    """Rotor of 200 mm, as long: steel of 3.6 MJ/m3K; shaft of 80 mm, free for 80 mm."""
    capacity = 3.6e6 * math.pi / 4.0 * 0.2**3
    assert stub(capacity) == pytest.approx(50.0 * math.pi / 4.0 * 0.08**2 / 0.08)


def test_candidate_stops_at_the_stoutest_shaft():
    network = read_network(tomllib.loads(MOTOR))
    cls = kinds()["conduction.shaft"]
    (place,) = cls.places(Scene(network))
    (shaft,) = [p for p in cls(place).extend(network).parameters if p.name == "conduction.shaft@rotor"]
    assert shaft.high == pytest.approx(stub(3000.0))
    assert 0.0 < shaft.prior_sd < shaft.high
