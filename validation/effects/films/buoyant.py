"""Natural convection on an outer face."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed, Law, Power
from validation.effects.films.ambient_film import AmbientFilm


@dataclass(frozen=True)
class BuoyantConvection(AmbientFilm):
    """h = a (|T - T_ambient| / 40 K)^(1/4), a the coefficient at 40 K (W/m2/K; W/K at a bare node)."""

    kind = "convection.buoyant"
    empirical = True
    title = "natural convection growing with the rise"
    at = "40 K"
    source = "McAdams 1954, vertical plate, laminar, Nu ~ Ra^(1/4)"
    isolating_test = "hold two loss levels to steady state: h must grow with the rise to the power 1/4"
    typical = (1.0, 8.0)
    prior_sd = 5.0
    high = 100.0
    confused_with = ("convection.constant", "radiation")

    def law(self, network: Network) -> Law:
        return Fixed(40.0**-0.25, Power(0.25))
