"""Losses (W) as functions of current, speed and temperature, with other forms than the library's."""

from dataclasses import dataclass

import numpy as np

from simulated.physics.draws import Draws

L_AF = 3.657e-3  # H: torque = L_AF I^2, from 955 N m at 511 A
RPM = np.pi / 30


@dataclass(frozen=True)
class Losses:
    """The drawn loss coefficients of one motor; resistances in ohm at 20 degC, losses in W."""

    R_armature: float
    R_field: float
    ends: tuple[float, float, float]
    brush_drop: float
    brush_friction: float
    bearing: tuple[float, float]
    windage: float
    iron: float
    iron_rotor_share: float

    def resistance(self, T_armature: float, T_field: float) -> float:
        """Armature plus field (ohm), at mean temperatures."""
        return self.R_armature * copper(T_armature) + self.R_field * copper(T_field)

    def armature(self, current2: float) -> tuple[float, ...]:
        """Slot part, left and right end winding at 20 degC; current2 is the mean square of the current (A2)."""
        return tuple(share * self.R_armature * current2 for share in self.ends)

    def brushes(self, current: float, rpm: float) -> float:
        """Contact drop, plus friction whose coefficient falls by a fifth from standstill to 10 m/s."""
        v = rpm * RPM * 0.1
        mu = (1 + 0.25 * np.exp(-v / 4)) / (1 + 0.25 * np.exp(-10.47 / 4))
        drop = self.brush_drop * abs(current) / (abs(current) + 4.0) * 1.03
        return float(drop * abs(current) + self.brush_friction * mu * rpm / 1000)

    def bearings(self, rpm: float, T_left: float, T_right: float) -> tuple[float, float]:
        """Palmgren: a load part as n, a grease part as n^(5/3) nu^(2/3), nu^(2/3) falling 2 % per K."""
        x = rpm / 1000
        left, right = (
            p * (0.4 * x + 0.6 * x ** (5 / 3) * np.exp(-0.02 * (T - 40)))
            for p, T in zip(self.bearing, (T_left, T_right))
        )
        return float(left), float(right)

    def iron_loss(self, current: float, rpm: float) -> float:
        """Bertotti: hysteresis f B^1.8, eddy f^2 B^2, excess (f B)^1.5, the sum being `iron` at 1000 rpm and 120 A.

        B follows the current with a remanence worth 50 A and Froehlich's saturation.
        """
        f, b = rpm / 1000, _flux(current) / _flux(120.0)
        return float(self.iron * (0.6 * f * b**1.8 + 0.25 * f**2 * b**2 + 0.15 * (f * b) ** 1.5))


def _flux(current: float) -> float:
    return (abs(current) + 50.0) / (abs(current) + 400.0)


def copper(T: float) -> float:
    """R / R20 of copper, with the small square term of IEC 60028's range."""
    return 1 + 3.93e-3 * (T - 20) + 2e-7 * (T - 20) ** 2


def draw(draws: Draws) -> Losses:
    ends = np.array(
        [draws.around(f"armature.{n}", v, 0.05) for n, v in (("slot", 0.5), ("left", 0.25), ("right", 0.25))]
    )
    return Losses(
        draws.around("resistance.armature_ohm", 23.5e-3, 0.03),
        draws.around("resistance.field_ohm", 15.6e-3, 0.03),
        tuple(float(e) for e in ends / ends.sum()),  # type: ignore[arg-type]
        draws.around("brush.drop_V", 2.0, 0.10),
        draws.around("brush.friction_W", 250.0, 0.15),
        (draws.around("bearing.left_W", 50.0, 0.20), draws.around("bearing.right_W", 50.0, 0.20)),
        draws.around("windage_W", 60.0, 0.20),
        draws.around("iron_W", 310.0, 0.20),
        draws.around("iron.rotor_share", 0.78, 0.05),
    )
