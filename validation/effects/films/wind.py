"""Wind on an outer face."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid
from validation.effects.sites import ambient, outside


@dataclass(frozen=True)
class Convection(Effect):
    """Forced convection by vehicle wind, parallel to whatever cools the face already.

    h = a (v / 10 m/s)^0.8, v the vehicle's speed (m/s), a the coefficient at 10 m/s (W/m2/K; W/K at a bare node).
    """

    kind = "convection"
    empirical = True
    title = "forced convection by vehicle wind"
    sits = "an outer part or face, with an ambient"
    unit = "W/m2/K"
    at = "10 m/s"
    source = "McAdams 1954, turbulent flat plate, Nu ~ Re^0.8"
    isolating_test = "roll at two speeds with the motor off; blow on the face and shield it"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("convection.constant", "flow", "windage", "sensor.stem")
    needs = ("vehicle_speed",)

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = film_unit(network, self.place, air)
        law = InputPower(1.0, ((network.signal("vehicle_speed"), 10.0, 0.8),))
        links = to_fluid(network, self.name, self.place, air, law)
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)
