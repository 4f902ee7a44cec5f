"""Heat transfer to the ambient air that a network lacks, beside whatever cools the face already."""

from abc import abstractmethod
from dataclasses import dataclass

from lumped.model.network import Network
from lumped.model.sites import ambient, outside
from lumped.transfer.laws import Law
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import film_unit, to_fluid


@dataclass(frozen=True)
class AmbientFilm(Effect):
    """Links from every face of a part on the ambient, or one from a bare node."""

    sits = "an outer part or face, with an ambient"
    unit = "W/m2/K"

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return outside(scene.network)

    @abstractmethod
    def law(self, network: Network) -> Law:
        """Of a coefficient of 1 (W/m2/K; W/K at a bare node)."""

    def extend(self, network: Network) -> Network:
        air = str(ambient(network))
        unit, scale = self.unit_and_scale(*film_unit(network, self.place, air))
        links = to_fluid(network, self.name, self.place, air, self.law(network))
        parameter = self.parameter(*(link.name for link in links), scale=scale, unit=unit)
        return with_parameter(network.extended(links=links), parameter)

    def unit_and_scale(self, unit: str, scale: float) -> tuple[str, float]:
        """Unit and scale of its parameter, from those of a film coefficient there."""
        return unit, scale
