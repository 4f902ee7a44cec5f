"""Conductances that a network lacks: into the bench, along leads and shaft, between two parts."""

import math
from abc import abstractmethod

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import ambient, boundaries, near_pairs, outside, solids, touches, turning, turns, with_role
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange, place_pair

STEEL_W_M_K, STEEL_J_M3_K = 50.0, 3.6e6  # carbon steel, within 3 % of the table of materials
THICK, SHORT = 0.4, 1.0  # most of a rotor's diameter that a shaft has, least length of it in its own diameters


class Bridge(Effect):
    """q = a (T_1 - T_2) between the means of two places, a in W/K; by one parameter where there are several pairs."""

    unit = "W/K"

    @abstractmethod
    def pairs(self, network: Network) -> list[tuple[str, str]]:
        """What it joins."""

    def scale(self, network: Network) -> float:
        """By how much its prior and upper bound are larger than those of a conductance of 1 W/K."""
        return conductance_scale(network)

    def extend(self, network: Network) -> Network:
        pairs = self.pairs(network)
        names = [self.name] if len(pairs) == 1 else [f"{self.name}:{b}" for _, b in pairs]
        links = [exchange(network, name, a, b, Fixed(1.0)) for name, (a, b) in zip(names, pairs, strict=True)]
        return with_parameter(network.extended(links=links), self.parameter(*names, scale=self.scale(network)))


class Coupling(Bridge):
    """A conductance a (W/K) between two parts near each other that are not joined in the network."""

    kind = "coupling"
    title = "thermal bridge"
    sits = "two parts near each other without a link"
    source = "conduction through bolts, leads, potting or air that the drawing does not show"
    isolating_test = "heat one of the two parts alone and watch the other"
    typical = (0.1, 5.0)
    prior_sd = 0.1
    high = 20.0
    confused_with = ("contact", "coupling")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return [f"{a}|{b}" for a, b in near_pairs(scene.network)]

    def pairs(self, network: Network) -> list[tuple[str, str]]:
        return [place_pair(network, self.place)]


class CableConduction(Bridge):
    """The leads of a winding that stands still as a long fin: q = a (T - T_ambient), a = sqrt(h P k A) (W/K)."""

    kind = "conduction.cable"
    title = "conduction along the leads"
    sits = "a standing winding, with an ambient"
    source = "Incropera, infinite fin; copper of 35 mm2 with h = 10 W/m2/K: 0.05 W/K"
    isolating_test = "wrap the leads, or read them at two distances from the machine"
    typical = (0.02, 0.5)
    prior_sd = 0.05
    high = 5.0
    confused_with = ("loss.winding", "contact")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        wound = with_role(scene.network, Role.WINDING)
        still = [place for place in wound if not turns(scene.network, place)]
        return still if ambient(scene.network) else []

    def pairs(self, network: Network) -> list[tuple[str, str]]:
        return [(self.place, str(ambient(network)))]


def free_beds(network: Network, part: str) -> list[str]:
    """Test beds that the part does not stand on yet."""
    return [b for b in boundaries(network, Role.TEST_BED) if not touches(network, part, b)]


class BenchConduction(Bridge):
    """Conduction from an outer part into the bench or base whose temperature is recorded: q = a (T - T_bench), W/K."""

    kind = "conduction.bench"
    title = "conduction into the bench"
    sits = "a standing outer part that the test bed does not hold yet"
    source = "one-dimensional conduction through the feet"
    isolating_test = "heat or insulate the bench plate (G10 spacer) and read its temperature"
    typical = (0.5, 10.0)
    high = 50.0
    confused_with = ("convection.constant",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        outer = [p for p in outside(network) or [p.name for p in solids(network)] if not turns(network, p)]
        return [p for p in outer if free_beds(network, p)]

    def pairs(self, network: Network) -> list[tuple[str, str]]:
        return [(self.place, bed) for bed in free_beds(network, self.place)]


def shafts(scene: Scene) -> list[str]:
    """What is the shaft; without one the rotor's iron or what else turns, for the shaft belongs to it.

    Where nothing is known to turn and no speed was recorded, there is none.
    """
    network, moves = scene.network, "speed" in scene.recorded
    axle = with_role(network, Role.SHAFT) or with_role(network, Role.ROTOR)
    return axle or [p for p in turning(network) if moves or turns(network, p)]


def heat_sink(network: Network) -> str | None:
    """Where the heat goes: the driven machine where its temperature is read, else the air."""
    return next(iter(boundaries(network, Role.DRIVEN_MACHINE)), ambient(network))


def stub(capacity: float) -> float:
    """Conductance (W/K) of the stoutest shaft for a rotor of some heat capacity (J/K): all steel, as long as wide."""
    rotor = (4.0 / math.pi * capacity / STEEL_J_M3_K) ** (1.0 / 3.0)
    return STEEL_W_M_K * math.pi / 4.0 * THICK * rotor / SHORT


class ShaftConduction(Bridge):
    """Conduction through shaft and coupling into the driven machine, or one as cold as air: q = a (T - T_driven)."""

    kind = "conduction.shaft"
    title = "conduction through shaft and coupling"
    sits = "a part with role shaft, or the end of the axle, and something beyond it"
    source = "one-dimensional conduction k A / L; steel shaft of 30 mm, 100 mm long: 0.35 W/K"
    isolating_test = "uncouple, or put an insulating disc between the coupling's halves"
    typical = (0.1, 2.0)
    prior_sd = 0.4
    high = 1.0
    confused_with = ("convection.rotation", "bearing.friction")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return shafts(scene) if heat_sink(scene.network) else []

    def pairs(self, network: Network) -> list[tuple[str, str]]:
        return [(self.place, str(heat_sink(network)))]

    def scale(self, network: Network) -> float:
        return stub(float(network.C[network.places[self.place].states[0]]))
