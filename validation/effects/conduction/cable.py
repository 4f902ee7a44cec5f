"""Heat that leaves along the leads of a winding that stands still."""

from dataclasses import dataclass

from lumped.model.network import Network
from lumped.model.sites import ambient, turns, windings
from lumped.transfer.laws import Fixed
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import conductance_scale, exchange


@dataclass(frozen=True)
class CableConduction(Effect):
    """The leads as a long fin: q = a (T - T_ambient), a = sqrt(h P k A) (W/K)."""

    kind = "conduction.cable"
    title = "conduction along the leads"
    sits = "a standing winding, with an ambient"
    unit = "W/K"
    source = "Incropera, infinite fin; copper of 35 mm2 with h = 10 W/m2/K: 0.05 W/K"
    isolating_test = "wrap the leads, or read them at two distances from the machine"
    typical = (0.02, 0.5)
    prior_sd = 0.05
    high = 5.0
    confused_with = ("loss.winding", "contact")

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        still = [place for place in windings(scene.network) if not turns(scene.network, place)]
        return still if ambient(scene.network) else []

    def extend(self, network: Network) -> Network:
        link = exchange(network, self.name, self.place, str(ambient(network)), Fixed(1.0))
        return with_parameter(
            network.extended(links=[link]), self.parameter(link.name, scale=conductance_scale(network))
        )
