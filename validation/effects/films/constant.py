"""Cooling to ambient that does not depend on speed."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.transfer.laws import Fixed, Law
from validation.effects.films.ambient_film import AmbientFilm


@dataclass(frozen=True)
class ConstantConvection(AmbientFilm):
    """Extra heat transfer to ambient, constant coefficient a (W/m2/K; W/K at a bare node): mounting, cable, draught."""

    kind = "convection.constant"
    empirical = True
    title = "steady extra cooling to ambient"
    source = "Newton's law of cooling; still air 5 to 15 W/m2/K (Staton and Cavagnino 2008)"
    isolating_test = "insulate the face; cool down with and without it"
    typical = (2.0, 15.0)
    prior_sd = 10.0
    high = 200.0
    confused_with = ("radiation", "convection.buoyant", "conduction.bench", "convection")

    def law(self, network: Network) -> Law:
        return Fixed(1.0)
