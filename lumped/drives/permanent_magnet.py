"""The permanent-magnet synchronous machine: from torque and speed to currents, with winding and magnet temperature.

v_d = R i_d - w Lq i_q,  v_q = R i_q + w (Ld i_d + psi),  T = 3/2 p (psi + (Ld - Lq) i_d) i_q   (peak dq values)
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geom.constants import ALPHA_CU, RPM

Array = NDArray[np.float64]
HALVINGS = 50  # a current to the last digit


@dataclass(frozen=True)
class PMMachine:
    """pole_pairs; R (ohm) and psi (V s) at 20 degC; Ld, Lq (H); limits: peak phase current (A), peak phase voltage (V).

    alpha_R, alpha_B : relative change of R and of the magnets' flux per K
    """

    pole_pairs: int
    R: float
    Ld: float
    Lq: float
    psi: float
    current_limit: float
    voltage_limit: float
    alpha_R: float = ALPHA_CU
    alpha_B: float = -1.1e-3

    def resistance(self, winding_degC: Array | float) -> Array:
        return self.R * (1.0 + self.alpha_R * (np.asarray(winding_degC, float) - 20.0))

    def flux(self, magnet_degC: Array | float) -> Array:
        return self.psi * (1.0 + self.alpha_B * (np.asarray(magnet_degC, float) - 20.0))

    def torque(self, i_d: Array | float, i_q: Array | float, magnet_degC: Array | float = 20.0) -> Array:
        """N m"""
        i_d = np.asarray(i_d, float)
        return 1.5 * self.pole_pairs * (self.flux(magnet_degC) + (self.Ld - self.Lq) * i_d) * np.asarray(i_q, float)

    def voltage(
        self, i_d: Array, i_q: Array, speed_rpm: Array | float, winding_degC: Array | float = 20.0,
        magnet_degC: Array | float = 20.0,
    ) -> Array:  # fmt: skip
        """Peak phase voltage (V)."""
        w = self.pole_pairs * np.abs(np.asarray(speed_rpm, float)) * RPM
        R = self.resistance(winding_degC)
        return np.hypot(R * i_d - w * self.Lq * i_q, R * i_q + w * (self.Ld * i_d + self.flux(magnet_degC)))

    def currents(
        self, torque: Array | float, speed_rpm: Array | float, winding_degC: Array | float = 20.0,
        magnet_degC: Array | float = 20.0,
    ) -> tuple[Array, Array]:  # fmt: skip
        """(i_d, i_q) (A) of the least current that gives the torque (N m) within the voltage; field weakening beyond.

        Torque above the limits is cut to what they allow (compare `torque` of the answer with what was asked).
        """
        demand, n, Tw, Tm = np.broadcast_arrays(
            *(np.asarray(x, float) for x in (torque, speed_rpm, winding_degC, magnet_degC))
        )
        size = np.abs(demand)
        peak = _bisected(lambda i: self.torque(*self._least(i, Tm), Tm) - size, np.zeros_like(size), self.current_limit)
        i_d, i_q = self._least(peak, Tm)
        over = self.voltage(i_d, i_q, n, Tw, Tm) > self.voltage_limit
        if np.any(over):
            weak_d, weak_q = self._weakened(np.minimum(size, self.torque(i_d, i_q, Tm)), i_d, n, Tw, Tm)
            i_d, i_q = np.where(over, weak_d, i_d), np.where(over, weak_q, i_q)
        return i_d, i_q * np.where(demand < 0, -1.0, 1.0)

    def _least(self, peak: Array, magnet_degC: Array) -> tuple[Array, Array]:
        """(i_d, i_q) of most torque for a current: Morimoto et al. 1990, IEEE Trans. Ind. Appl. 26, 866."""
        gap, psi = self.Lq - self.Ld, self.flux(magnet_degC)
        i_d = np.zeros_like(peak) if gap == 0.0 else (psi - np.sqrt(psi**2 + 8 * gap**2 * peak**2)) / (4 * gap)
        return i_d, np.sqrt(np.maximum(peak**2 - i_d**2, 0.0))

    def _weakened(self, size: Array, start: Array, n: Array, Tw: Array, Tm: Array) -> tuple[Array, Array]:
        """More negative i_d at the same torque until the voltage fits; then less i_q until voltage and current do."""
        floor = -min(self.current_limit, float(np.max(self.flux(Tm))) / self.Ld)

        def i_q(i_d: Array) -> Array:
            return size / (1.5 * self.pole_pairs * (self.flux(Tm) + (self.Ld - self.Lq) * i_d))

        def spare(depth: Array) -> Array:
            i_d = start - depth
            return self.voltage_limit - self.voltage(i_d, i_q(i_d), n, Tw, Tm)

        depth = _bisected(spare, np.zeros_like(size), start - floor)
        i_d = start - depth
        room = np.sqrt(np.maximum(self.current_limit**2 - i_d**2, 0.0))
        most = _bisected(lambda q: self.voltage(i_d, q, n, Tw, Tm) - self.voltage_limit, np.zeros_like(size), room)
        return i_d, np.minimum(i_q(i_d), most)


def _bisected(f: Callable[[Array], Array], low: Array, high: Array | float) -> Array:
    """Where f, rising from low to high, passes 0; an end where it does not."""
    a, b = np.array(low, float), np.broadcast_to(high, np.shape(low)).astype(float)
    for _ in range(HALVINGS):
        middle = 0.5 * (a + b)
        below = f(middle) < 0.0
        a, b = np.where(below, middle, a), np.where(below, b, middle)
    return b
