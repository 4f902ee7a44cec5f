"""Air inside the machine that carries more heat when the rotor turns: in the gap, and in the end spaces."""

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import across_air, faces, fluids, solids, turns
from validation.effects.base import PowerLaw, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange, films, place_pair


class StirredAir(PowerLaw):
    """Films on every face of a fluid grow with speed, a in W/m2/K at its reference."""

    empirical = True
    unit = "W/m2/K"

    def extend(self, network: Network) -> Network:
        parts = dict.fromkeys(p.part for p in network.places.values() if p.fluid == self.place)
        wet = [face for part in parts for face in faces(network, part, self.place)]
        links = films(network, self.name, wet, self.place, self.law(network))
        return with_parameter(network.extended(links=links), self.parameter(*(link.name for link in links)))


class EndSpaceMixing(StirredAir):
    """Films on every face of an end space grow with speed: h = a (n / 1000 rpm)^0.9, a in W/m2/K at 1000 rpm."""

    kind = "end.mixing"
    title = "end-space air stirred by the rotor"
    sits = "a fluid with role inner air and faces on it"
    source = "Schubert 1968: h = 15 (1 + 0.4 v^0.9)"
    isolating_test = "same loss at two speeds, sensors on end winding and flange"
    typical = (5.0, 60.0)
    prior_sd = 20.0
    high = 300.0
    confused_with = ("flow", "convection")
    follows = (("speed", 1000.0, 0.9),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        wet = {p.fluid for p in scene.network.places.values() if p.kind == "surface"}
        return [f for f in fluids(scene.network, Role.INNER_AIR) if f in wet]


def gaps(network: Network) -> list[str]:
    """Fluids that are the air gap; else what turns and what stands beside it, joined by a link: 'rotor|stator'.

    Where nothing is known to turn, any two solids that a link joins.
    """
    bodies = {p.name for p in solids(network)}
    joints = [link.places for link in network.links if set(link.places) <= bodies and len(set(link.places)) == 2]
    pairs = [(a, b) if turns(network, a) else (b, a) for a, b in joints if across_air(network, a, b)]
    untold = [] if any(turns(network, name) for name in bodies) else joints
    return fluids(network, Role.AIR_GAP) or ["|".join(pair) for pair in pairs or untold]


class GapConvection(StirredAir):
    """Extra exchange across the air gap with speed: h = a (n / 1000 rpm)^0.5 (W/m2/K; W/K between bare nodes)."""

    kind = "gap.convection"
    title = "air-gap convection with speed"
    sits = "a fluid with role air gap"
    source = "Becker and Kaye 1962: Nu ~ Ta^0.48 beyond the critical Taylor number"
    isolating_test = "cool down at several speeds; rotor temperature from back-EMF or resistance"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 600.0
    confused_with = ("loss.rotor", "sensor.lag")
    follows = (("speed", 1000.0, 0.5),)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return list(dict.fromkeys(gaps(scene.network)))

    def extend(self, network: Network) -> Network:
        if "|" not in self.place:
            return super().extend(network)
        link = exchange(network, self.name, *place_pair(network, self.place), self.law(network))
        parameter = self.parameter(link.name, scale=conductance_scale(network) / 20.0, unit="W/K")
        return with_parameter(network.extended(links=[link]), parameter)
