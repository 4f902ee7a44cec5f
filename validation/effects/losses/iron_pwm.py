"""Core loss that the inverter adds."""

from dataclasses import dataclass

import numpy as np

from lumped.model.network import Network
from lumped.model.sites import cores, heated, turning
from lumped.transfer.laws import Fixed, Inputs, Law
from validation.effects.base import Scene
from validation.effects.build import Shaped
from validation.effects.losses.added_loss import AddedLoss

SLOWEST_HZ = 500.0  # no inverter switches more slowly; on its way from 0 a recorded frequency passes below


@dataclass(frozen=True)
class Ripple:
    """(f / 8 kHz)^-0.5 where the inverter switches, 0 where it does not.  of : the input with f (Hz)"""

    of: str

    def __call__(self, inputs: Inputs) -> np.ndarray:
        f = np.asarray(inputs[self.of], float)
        return np.where(f > 0.0, np.sqrt(8000.0 / np.maximum(f, SLOWEST_HZ)), 0.0)


@dataclass(frozen=True)
class PwmIronLoss(AddedLoss):
    """P = a (f / 8 kHz)^-0.5 while the inverter switches (f > 0), a the loss (W) at 8 kHz.

    The ripple of the flux falls as 1/f and eddy currents grow as f^2; skin effect in the sheets leaves about f^-0.5.
    """

    kind = "iron.pwm"
    title = "iron loss of the inverter's ripple"
    sits = "a part with role iron or rotor, or one with iron loss; magnets and all else that turns"
    at = "8 kHz"
    source = "Boglietti et al. 1996, iron loss under PWM: falls with the switching frequency, hardly follows the load"
    isolating_test = "no load at two switching frequencies"
    typical = (5.0, 200.0)
    confused_with = ("iron", "loss.constant")
    needs = ("frequency",)
    heats = "iron"

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        network = scene.network
        return list(dict.fromkeys([*heated(network, "iron", cores(network)), *turning(network)]))

    def law(self, network: Network) -> Law:
        switching = network.signal("frequency")
        return Shaped(Fixed(1.0), Ripple(switching), also_reads=(switching,))
