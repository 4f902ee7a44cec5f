"""Wind on an outer face."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import InputPower, Law
from validation.effects.films.ambient_film import AmbientFilm


@dataclass(frozen=True)
class Convection(AmbientFilm):
    """Forced convection by vehicle wind, parallel to whatever cools the face already.

    h = a (v / 10 m/s)^0.8, v the vehicle's speed (m/s), a the coefficient at 10 m/s (W/m2/K; W/K at a bare node).
    """

    kind = "convection"
    empirical = True
    title = "forced convection by vehicle wind"
    at = "10 m/s"
    source = "McAdams 1954, turbulent flat plate, Nu ~ Re^0.8"
    isolating_test = "roll at two speeds with the motor off; blow on the face and shield it"
    typical = (5.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("convection.constant", "flow", "windage", "sensor.stem")
    needs = ("vehicle_speed",)

    def law(self, network: Network) -> Law:
        return InputPower(1.0, ((network.signal("vehicle_speed"), 10.0, 0.8),))
