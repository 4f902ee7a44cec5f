"""End-space air stirred by the rotor."""

from dataclasses import dataclass

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import faces, fluids
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import films


@dataclass(frozen=True)
class EndSpaceMixing(Effect):
    """Films on every face of an end space grow with speed: h = a (n / 1000 rpm)^0.9, a in W/m2/K at 1000 rpm."""

    kind = "end.mixing"
    empirical = True
    title = "end-space air stirred by the rotor"
    sits = "a fluid with role inner air and faces on it"
    unit = "W/m2/K"
    at = "1000 rpm"
    source = "Schubert 1968: h = 15 (1 + 0.4 v^0.9)"
    isolating_test = "same loss at two speeds, sensors on end winding and flange"
    typical = (5.0, 60.0)
    prior_sd = 20.0
    high = 300.0
    confused_with = ("flow", "convection")
    needs = ("speed",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        wet = {p.fluid for p in scene.network.places.values() if p.kind == "surface"}
        return [f for f in fluids(scene.network, Role.INNER_AIR) if f in wet]

    def extend(self, network: Network) -> Network:
        law = InputPower(1.0, ((network.signal("speed"), 1000.0, 0.9),))
        parts = dict.fromkeys(p.part for p in network.places.values() if p.fluid == self.place)
        wet = [face for part in parts for face in faces(network, part, self.place)]
        links = films(network, self.name, wet, self.place, law)
        return with_parameter(network.extended(links=links), self.parameter(*(link.name for link in links)))
