"""Air gap that carries more heat when the rotor turns."""

from dataclasses import dataclass

from lumped.laws import InputPower
from lumped.network import Network
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange
from validation.effects.sites import across_air, faces, solids

LAW = InputPower(1.0, (("speed_rpm", 1000.0, 0.5),))


def gaps(network: Network) -> list[str]:
    """Names of fluids that are an air gap, or 'rotor|stator' pairs of a declared network that a link joins."""
    fluids = [p.name for p in network.places.values() if p.kind == "fluid" and "gap" in p.name]
    known = {p.name for p in solids(network)}
    joined = [link.places for link in network.links if set(link.places) <= known]
    return fluids or ["|".join(sorted(pair)) for pair in joined if across_air(*pair)]


@dataclass(frozen=True)
class GapConvection(Effect):
    """Extra exchange across the air gap with speed: h = a (n / 1000 rpm)^0.5 (W/m2/K; W/K between bare nodes)."""

    kind = "gap.convection"
    title = "air-gap convection with speed"
    unit = "W/m2/K"
    at = "1000 rpm"
    source = "Becker and Kaye 1962: Nu ~ Ta^0.48 beyond the critical Taylor number"
    isolating_test = "cool down at several speeds; rotor temperature from back-EMF or resistance"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 600.0
    confused_with = ("loss.rotor", "sensor.lag")
    needs = ("speed_rpm",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return list(dict.fromkeys(gaps(scene.network)))

    def extend(self, network: Network) -> Network:
        if "|" in self.place:
            a, b = self.place.split("|")
            link = exchange(network, self.name, a, b, LAW)
            parameter = self.parameter(link.name, scale=conductance_scale(network) / 20.0, unit="W/K")
            return with_parameter(network.extended(links=[link]), parameter)
        parts = dict.fromkeys(p.part for p in network.places.values() if p.fluid == self.place)
        wet = [face for part in parts for face in faces(network, part, self.place)]
        links = [network.surface_link(f"{self.name}:{f.name}", "film", f.name, self.place, LAW) for f in wet]
        return with_parameter(network.extended(links=links), self.parameter(*(link.name for link in links)))
