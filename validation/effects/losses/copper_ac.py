"""Eddy currents and proximity in the conductors."""

from dataclasses import dataclass

from geom.description.roles import Role
from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import heat, power_scale
from validation.effects.sites import heated, role, windings


@dataclass(frozen=True)
class AcCopper(Effect):
    """P = a (n / 1000 rpm)^2 (I / 100 A)^2, a the loss (W) at 1000 rpm and 100 A."""

    kind = "copper.ac"
    empirical = True
    title = "AC copper loss"
    sits = "a winding with copper loss"
    unit = "W"
    at = "1000 rpm and 100 A"
    source = "Dowell 1966, low-frequency limit, P ~ f^2 I^2"
    isolating_test = "DC against AC at the same current"
    typical = (5.0, 300.0)
    prior_sd = 0.5
    high = 20.0
    confused_with = ("copper.feedback", "iron")
    needs = ("speed", "current")

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        """Windings that carry a copper loss; a cage has no strands (its own is the load-dependent loss of a rotor)."""
        loaded = heated(scene.network, "copper", windings(scene.network))
        return [p for p in loaded if role(scene.network, p) is not Role.CAGE]

    def extend(self, network: Network) -> Network:
        source = heat(
            network,
            self.name,
            "copper.ac",
            self.place,
            InputPower(1.0, ((network.signal("speed"), 1000.0, 2.0), (network.signal("current"), 100.0, 2.0))),
        )
        network = network.extended(sources=[source])
        return with_parameter(network, self.parameter(source.name, scale=power_scale(network)))
