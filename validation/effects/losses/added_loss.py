"""Losses that a network lacks: heat into the mean of one part, by powers of what is recorded."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from geom.constants import ALPHA_CU
from geom.description.roles import Role
from lumped.model.network import Network
from lumped.model.sites import bearings, commutators, cores, heated, outside, role, turning, windings
from lumped.transfer.laws import Conductivity, Fixed, Inputs, Law, WithTemperature
from validation.effects.base import PowerLaw, Scene, with_parameter
from validation.effects.build import Shaped, heat, power_scale

SLOWEST_HZ = 500.0  # no inverter switches more slowly; on its way from 0 a recorded frequency passes below


def iron_parts(network: Network) -> list[str]:
    """What carries an iron loss, else what carries the field in iron."""
    return heated(network, "iron", cores(network))


def loaded_windings(network: Network) -> list[str]:
    """Windings with a copper loss, else all."""
    return heated(network, "copper", windings(network))


def stranded_windings(network: Network) -> list[str]:
    """The same but cages, which have no strands: their own is the load-dependent loss of a rotor."""
    return [p for p in loaded_windings(network) if role(network, p) is not Role.CAGE]


def turning_unwound(network: Network) -> list[str]:
    """Rotors and magnets; a winding that turns has the same law as AC copper loss."""
    wound = stranded_windings(network)
    return [p for p in turning(network) if p not in wound]


def rippled_parts(network: Network) -> list[str]:
    """What feels the inverter's ripple: iron, and all that turns."""
    return list(dict.fromkeys([*iron_parts(network), *turning(network)]))


class AddedLoss(PowerLaw):
    """P = a times powers of what is recorded, a in W.  heats : the kind of loss ("copper", "iron", "friction", ...)"""

    heats: ClassVar[str]
    empirical = True
    unit = "W"
    prior_sd = 0.5
    high = 20.0

    @staticmethod
    @abstractmethod
    def parts(network: Network) -> list[str]:
        """Where it may sit."""

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        return cls.parts(scene.network)

    def extend(self, network: Network) -> Network:
        source = heat(network, self.name, self.heats, self.place, self.law(network))
        parameter = self.parameter(source.name, scale=power_scale(network))
        return with_parameter(network.extended(sources=[source]), parameter)


class BearingFriction(AddedLoss):
    """P = a (n / 1000 rpm)^(4/3), a the loss (W) at 1000 rpm.

    Between the two parts of Palmgren's moment: what the load makes goes with n, what the grease does with n^(5/3).
    Over a factor three of speed 4/3 is a fifth off either; the grease's own power would be twice the load's.
    """

    kind = "bearing.friction"
    title = "bearing friction"
    sits = "a part with role bearing"
    source = "Palmgren 1959: power of the load ~ n, of the grease ~ n^(5/3); 4/3 is between"
    isolating_test = "back-driven spin, uncoupled; vary the grease temperature"
    typical = (5.0, 100.0)
    confused_with = ("windage", "iron")
    heats = "friction"
    follows = (("speed", 1000.0, 4.0 / 3.0),)
    parts = staticmethod(bearings)


class Windage(AddedLoss):
    """P = a (n / 1000 rpm)^3, a the loss (W) at 1000 rpm."""

    kind = "windage"
    title = "windage"
    sits = "a turning part"
    source = "Saari 1998, rotating cylinder, P ~ n^3 at constant friction factor"
    isolating_test = "spin at two gas pressures, or with the fan taken off"
    typical = (2.0, 100.0)
    confused_with = ("bearing.friction", "iron")
    heats = "windage"
    follows = (("speed", 1000.0, 3.0),)
    parts = staticmethod(turning)


class BrushDrop(AddedLoss):
    """P = a |I| / 100 A, a the loss (W) at 100 A; 2 V of drop give 200 W."""

    kind = "brush.drop"
    title = "brush contact drop"
    sits = "a part with role commutator"
    source = "carbon brushes, about 1 V per brush (IEC 60276)"
    isolating_test = "measure the drop across the brushes at standstill"
    typical = (50.0, 250.0)
    confused_with = ("brush.friction", "loss.winding")
    heats = "brush"
    follows = (("current", 100.0, 1.0),)
    parts = staticmethod(commutators)


class BrushFriction(AddedLoss):
    """P = mu p A v: a n / 1000 rpm, a the loss (W) at 1000 rpm."""

    kind = "brush.friction"
    title = "brush friction"
    sits = "a part with role commutator"
    source = "Coulomb friction, mu 0.15 to 0.3, 15 to 25 kPa"
    isolating_test = "lift the brushes and spin"
    typical = (20.0, 300.0)
    confused_with = ("brush.drop", "bearing.friction", "windage")
    heats = "brush"
    follows = (("speed", 1000.0, 1.0),)
    parts = staticmethod(commutators)


class ConstantLoss(AddedLoss):
    """P = a, a constant power (W): a heater, the sun, a neighbour, electronics on standby."""

    kind = "loss.constant"
    title = "constant heat input"
    sits = "an outer part or face"
    source = "heat balance"
    isolating_test = "record with everything switched off"
    typical = (1.0, 100.0)
    confused_with = ("ambient.offset", "sensor.bias")
    heats = "extra"
    parts = staticmethod(outside)


class WindingLoss(AddedLoss):
    """P = a (I / 100 A)^2, a the extra loss (W) at 100 A: joints, leads, a wrong resistance."""

    kind = "loss.winding"
    title = "copper loss larger than assumed"
    sits = "a winding with copper loss"
    source = "Joule's law"
    isolating_test = "four-wire resistance of the winding at a known temperature"
    typical = (10.0, 300.0)
    confused_with = ("copper.feedback", "copper.ac", "brush.drop")
    heats = "copper"
    follows = (("current", 100.0, 2.0),)
    parts = staticmethod(loaded_windings)


class AcCopper(AddedLoss):
    """Eddy currents and proximity in the conductors; they fall with the resistivity of copper, as a declared `ac` does.

    P = a (n / 1000 rpm)^2 (I / 100 A)^2 / (1 + alpha (T - 20 degC)), a the loss (W) at 1000 rpm, 100 A and 20 degC.
    """

    kind = "copper.ac"
    title = "AC copper loss"
    sits = "a winding with copper loss"
    at = "1000 rpm and 100 A and 20 degC"
    source = "Dowell 1966, low-frequency limit, P ~ f^2 I^2"
    isolating_test = "DC against AC at the same current"
    typical = (5.0, 300.0)
    confused_with = ("copper.feedback", "iron")
    heats = "copper.ac"
    follows = (("speed", 1000.0, 2.0), ("current", 100.0, 2.0))
    parts = staticmethod(stranded_windings)

    def law(self, network: Network) -> Law:
        return WithTemperature(super().law(network), Conductivity(ALPHA_CU, 20.0))


class IronLoss(AddedLoss):
    """P = a (n / 1000 rpm)^1.5, a the loss (W) at 1000 rpm, between hysteresis (1) and eddy currents (2)."""

    kind = "iron"
    title = "iron loss growing with speed"
    sits = "a part with role iron or rotor, or one with iron loss"
    source = "Steinmetz 1892, exponent 1 (hysteresis) to 2 (eddy current)"
    isolating_test = "back-driven spin without current, then with field current"
    typical = (20.0, 500.0)
    confused_with = ("bearing.friction", "windage", "copper.ac")
    heats = "iron"
    follows = (("speed", 1000.0, 1.5),)
    parts = staticmethod(iron_parts)


class MagnetLoss(AddedLoss):
    """P = a (n / 1000 rpm)^2, a the loss (W) at 1000 rpm: eddy currents by slotting and PWM harmonics."""

    kind = "loss.rotor"
    title = "loss in rotor or magnets"
    sits = "a turning part"
    source = "eddy currents in thin conductors, P ~ f^2"
    isolating_test = "spin without current and with a dummy rotor"
    typical = (5.0, 200.0)
    confused_with = ("iron", "windage", "bearing.friction")
    heats = "iron"
    follows = (("speed", 1000.0, 2.0),)
    parts = staticmethod(turning)


class RotorLoadLoss(AddedLoss):
    """P = a (n / 1000 rpm)^2 (I / 100 A)^2, a the loss (W) at 1000 rpm and 100 A."""

    kind = "loss.rotor.load"
    title = "load-dependent loss in rotor or magnets"
    sits = "a turning part that is not a wound winding"
    source = "winding harmonics of the armature field, B ~ I; eddy currents in thin conductors, P ~ (f B)^2"
    isolating_test = "same speed at two currents; rotor temperature from back-EMF"
    typical = (1.0, 50.0)
    prior_sd = 0.1
    confused_with = ("loss.rotor", "iron", "copper.ac")
    heats = "iron"
    follows = (("speed", 1000.0, 2.0), ("current", 100.0, 2.0))
    parts = staticmethod(turning_unwound)


@dataclass(frozen=True)
class Ripple:
    """(f / 8 kHz)^-0.5 where the inverter switches, 0 where it does not.  of : the input with f (Hz)"""

    of: str

    def __call__(self, inputs: Inputs) -> np.ndarray:
        f = np.asarray(inputs[self.of], float)
        return np.where(f > 0.0, np.sqrt(8000.0 / np.maximum(f, SLOWEST_HZ)), 0.0)


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
    parts = staticmethod(rippled_parts)

    def law(self, network: Network) -> Law:
        switching = network.signal("frequency")
        return Shaped(Fixed(1.0), Ripple(switching), also_reads=(switching,))
