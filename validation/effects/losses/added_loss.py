"""A loss that a network lacks: heat into the mean of one part."""

from dataclasses import dataclass
from typing import ClassVar

from lumped.model.network import Network
from lumped.transfer.laws import Fixed, InputPower, Law
from validation.effects.base import Effect, with_parameter
from validation.effects.build import heat, power_scale


@dataclass(frozen=True)
class AddedLoss(Effect):
    """P = a times powers of what is recorded; a is the loss (W) where each has its reference value.

    heats : the kind of loss it is ("copper", "iron", "friction", ...)
    follows : (quantity, reference value, exponent) of each; none: a constant loss
    """

    heats: ClassVar[str]
    follows: ClassVar[tuple[tuple[str, float, float], ...]] = ()
    empirical = True
    unit = "W"
    prior_sd = 0.5
    high = 20.0

    def law(self, network: Network) -> Law:
        """Of a loss of 1 W at the reference values."""
        factors = tuple((network.signal(quantity), value, n) for quantity, value, n in self.follows)
        return InputPower(1.0, factors) if factors else Fixed(1.0)

    def extend(self, network: Network) -> Network:
        source = heat(network, self.name, self.heats, self.place, self.law(network))
        parameter = self.parameter(source.name, scale=power_scale(network))
        return with_parameter(network.extended(sources=[source]), parameter)
