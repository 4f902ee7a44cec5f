"""Heat that leaves along the shaft."""

import math
from dataclasses import dataclass

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import ambient, boundaries, turning, with_role
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import exchange

STEEL_W_M_K, STEEL_J_M3_K = 50.0, 3.6e6  # carbon steel, within 3 % of the table of materials
THICK, SHORT = 0.4, 1.0  # most of a rotor's diameter that a shaft has, least length of it in its own diameters


def shafts(network: Network) -> list[str]:
    """What is the shaft; without one the rotor's iron or what else turns, for the shaft belongs to it."""
    return with_role(network, Role.SHAFT) or with_role(network, Role.ROTOR) or turning(network)


def heat_sink(network: Network) -> str | None:
    """Where the heat goes: the driven machine where its temperature is read, else the air."""
    return next(iter(boundaries(network, Role.DRIVEN_MACHINE)), ambient(network))


def stub(capacity: float) -> float:
    """Conductance (W/K) of the stoutest shaft for a rotor of some heat capacity (J/K): all steel, as long as wide."""
    rotor = (4.0 / math.pi * capacity / STEEL_J_M3_K) ** (1.0 / 3.0)
    return STEEL_W_M_K * math.pi / 4.0 * THICK * rotor / SHORT


@dataclass(frozen=True)
class ShaftConduction(Effect):
    """Conduction through shaft and coupling into the driven machine, or one as cold as air: q = a (T - T_driven)."""

    kind = "conduction.shaft"
    title = "conduction through shaft and coupling"
    sits = "a part with role shaft, or the end of the axle, and something beyond it"
    unit = "W/K"
    source = "one-dimensional conduction k A / L; steel shaft of 30 mm, 100 mm long: 0.35 W/K"
    isolating_test = "uncouple, or put an insulating disc between the coupling's halves"
    typical = (0.1, 2.0)
    prior_sd = 0.4
    high = 1.0
    confused_with = ("convection.rotation", "bearing.friction")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return shafts(scene.network) if heat_sink(scene.network) else []

    def extend(self, network: Network) -> Network:
        link = exchange(network, self.name, self.place, str(heat_sink(network)), Fixed(1.0))
        most = stub(float(network.C[network.places[self.place].states[0]]))
        return with_parameter(network.extended(links=[link]), self.parameter(link.name, scale=most))
