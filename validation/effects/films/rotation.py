"""A turning part that fans the surroundings."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.model.sites import ambient, turning
from lumped.transfer.laws import InputPower, Law
from validation.effects.base import Scene
from validation.effects.films.ambient_film import AmbientFilm


@dataclass(frozen=True)
class RotationConvection(AmbientFilm):
    """Cooling of a turning part to ambient: h = a (n / 1000 rpm)^0.7 (W/m2/K; W/K at a bare node)."""

    kind = "convection.rotation"
    empirical = True
    title = "cooling of a turning part to ambient"
    sits = "a turning part, with an ambient"
    at = "1000 rpm"
    source = "rotating cylinder in still air, Nu = 0.133 Re^(2/3) Pr^(1/3) (Kays and Bjorklund 1958)"
    isolating_test = "cool down at several speeds without current"
    typical = (1.0, 60.0)
    prior_sd = 30.0
    high = 300.0
    confused_with = ("gap.convection", "loss.rotor")
    needs = ("speed",)

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return turning(scene.network) if ambient(scene.network) else []

    def law(self, network: Network) -> Law:
        return InputPower(1.0, ((network.signal("speed"), 1000.0, 0.7),))
