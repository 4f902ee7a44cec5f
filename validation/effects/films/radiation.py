"""Radiation from an outer face."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed, Law
from lumped.transfer.laws import Radiation as FourthPower
from validation.effects.films.ambient_film import AmbientFilm


@dataclass(frozen=True)
class Radiation(AmbientFilm):
    """q = a sigma A (T^4 - T_ambient^4), a the extra effective emissivity (1; emissivity times m2 at a bare node)."""

    kind = "radiation"
    title = "thermal radiation to the surroundings"
    unit = "1"
    source = "Stefan-Boltzmann; grey body in large surroundings"
    isolating_test = "paint the face matt black or cover it with bright foil; wide range of temperature"
    typical = (0.1, 0.9)
    prior_sd = 0.5
    high = 1.0
    confused_with = ("convection.constant", "convection.buoyant")

    def law(self, network: Network) -> Law:
        return Fixed(1.0, FourthPower())

    def unit_and_scale(self, unit: str, scale: float) -> tuple[str, float]:
        """An emissivity; at a bare node times an area."""
        return ("1", 1.0) if unit == "W/m2/K" else ("m2", scale / 5.0)
