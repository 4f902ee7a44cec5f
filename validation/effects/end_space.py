"""End-space air stirred by the rotor."""

from dataclasses import dataclass

from lumped.laws import InputPower
from lumped.network import Network
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.sites import faces


@dataclass(frozen=True)
class EndSpaceMixing(Effect):
    """Films on every face of an end space grow with speed: h = a (n / 1000 rpm)^0.9, a in W/m2/K at 1000 rpm."""

    kind = "end.mixing"
    title = "end-space air stirred by the rotor"
    unit = "W/m2/K"
    at = "1000 rpm"
    source = "Schubert 1968: h = 15 (1 + 0.4 v^0.9)"
    isolating_test = "same loss at two speeds, sensors on end winding and flange"
    typical = (5.0, 60.0)
    prior_sd = 20.0
    high = 300.0
    confused_with = ("flow", "convection")
    needs = ("speed_rpm",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        places = scene.network.places.values()
        fluids = {p.fluid for p in places if p.kind == "surface"} & {p.name for p in places if p.kind == "fluid"}
        return sorted(str(f) for f in fluids if "gap" not in str(f))

    def extend(self, network: Network) -> Network:
        law = InputPower(1.0, (("speed_rpm", 1000.0, 0.9),))
        parts = dict.fromkeys(p.part for p in network.places.values() if p.fluid == self.place)
        wet = [face for part in parts for face in faces(network, part, self.place)]
        links = [network.surface_link(f"{self.name}:{f.name}", "film", f.name, self.place, law) for f in wet]
        return with_parameter(network.extended(links=links), self.parameter(*(link.name for link in links)))
