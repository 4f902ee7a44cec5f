"""The permanent-magnet synchronous machine: from torque and speed to currents, with winding and magnet temperature.

v_d = R i_d - w Lq i_q,  v_q = R i_q + w (Ld i_d + psi),  T = 3/2 p (psi + (Ld - Lq) i_d) i_q   (peak dq values)
"""

from dataclasses import dataclass

import numpy as np

from geom.arrays import Array, Mask, Number
from geom.constants import ALPHA_CU, RPM
from lumped.drives.limits import bisected, highest

TINY = 1e-30  # in place of 0 ohm and 0 V/A, where no voltage limits a current
EDGE = 1e-9  # of a current or voltage limit: what counts as kept


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

    def resistance(self, winding_degC: Number) -> Array:
        return self.R * (1.0 + self.alpha_R * (np.asarray(winding_degC, float) - 20.0))

    def flux(self, magnet_degC: Number) -> Array:
        return self.psi * (1.0 + self.alpha_B * (np.asarray(magnet_degC, float) - 20.0))

    def torque(self, i_d: Number, i_q: Number, magnet_degC: Number = 20.0) -> Array:
        """N m"""
        i_d = np.asarray(i_d, float)
        return 1.5 * self.pole_pairs * (self.flux(magnet_degC) + (self.Ld - self.Lq) * i_d) * np.asarray(i_q, float)

    def voltages(
        self, i_d: Array, i_q: Array, speed_rpm: Number, winding_degC: Number = 20.0, magnet_degC: Number = 20.0
    ) -> tuple[Array, Array]:
        """(v_d, v_q) peak phase voltage (V); a speed has its sign."""
        w, R = self.pole_pairs * np.asarray(speed_rpm, float) * RPM, self.resistance(winding_degC)
        return R * i_d - w * self.Lq * i_q, R * i_q + w * (self.Ld * i_d + self.flux(magnet_degC))

    def voltage(self, i_d: Array, i_q: Array, *at: Number) -> Array:
        """Peak phase voltage (V);  at : speed and temperatures as of `voltages`."""
        return np.hypot(*self.voltages(i_d, i_q, *at))

    def power(self, i_d: Array, i_q: Array, *at: Number) -> Array:
        """Electrical power taken (W); negative where the machine generates.  at : speed and temperatures."""
        v_d, v_q = self.voltages(i_d, i_q, *at)
        return 1.5 * (v_d * i_d + v_q * i_q)

    def currents(
        self, torque: Number, speed_rpm: Number, winding_degC: Number = 20.0, magnet_degC: Number = 20.0
    ) -> tuple[Array, Array]:
        """(i_d, i_q) (A) of the least current that gives the torque (N m) within current and voltage limit.

        Most torque per ampere, then a weakened field; a torque beyond the limits is cut to the most that they allow,
        at the current limit or, beyond, at the most torque per volt. Where the voltage cannot be kept at any current,
        it is the current of least voltage. Compare `torque` of the answer with what was asked.
        """
        demand, n, Tw, Tm = (
            np.atleast_1d(x)
            for x in np.broadcast_arrays(
                *(np.asarray(x, float) for x in (torque, speed_rpm, winding_degC, magnet_degC))
            )
        )
        # A machine that brakes is one that drives with its resistance negative: i_q and v_d change sign together.
        brakes = demand * n < 0.0
        w, R = self.pole_pairs * np.abs(n) * RPM, np.where(brakes, -1.0, 1.0) * self.resistance(Tw)
        target = np.abs(demand) / (1.5 * self.pole_pairs)
        region = _Region(self, w, R, self.flux(Tm), 1.0)
        i_d = region.least(target)
        i_q = target / region.gain(i_d)
        bounded = ~region.allows(i_d, i_q)
        if np.any(bounded):
            i_d[bounded], i_q[bounded] = _limited(region.only(bounded), target[bounded])
        shape = np.broadcast_shapes(*(np.shape(x) for x in (torque, speed_rpm, winding_degC, magnet_degC)))
        return i_d.reshape(shape), (i_q * np.where(np.where(demand == 0.0, n, demand) < 0.0, -1.0, 1.0)).reshape(shape)


@dataclass(frozen=True)
class _Region:
    """Currents that both limits allow, over i_d; w (rad/s), R (ohm), psi (V s): (n,).

    side : 1 where psi + (Ld - Lq) i_d > 0; -1 beyond, where torque wants the other sign of i_q. Currents i_q are in the
    direction of the torque on either side.
    """

    machine: PMMachine
    w: Array
    R: Array
    psi: Array
    side: float

    def only(self, mask: Mask) -> "_Region":
        return _Region(self.machine, self.w[mask], self.R[mask], self.psi[mask], self.side)

    def other(self) -> "_Region":
        """The same limits on the other side, where i_q has the other sign: as with -R."""
        return _Region(self.machine, self.w, -self.R, self.psi, -self.side)

    def gain(self, i_d: Array) -> Array:
        """Torque over i_q, without 3/2 p (V s)."""
        return self.side * (self.psi + (self.machine.Ld - self.machine.Lq) * i_d)

    def span(self) -> tuple[Array, Array]:
        """i_d (n,) from and to: gain positive, inside current circle and voltage ellipse; crossed where nothing is."""
        m, w, R, psi = self.machine, self.w, self.R, self.psi
        gap = m.Ld - m.Lq
        a = w**2 * m.Lq**2 + R**2 + TINY
        square = (w**2 * m.Ld * m.Lq + R**2) ** 2 + TINY
        half = w**2 * psi * (a * m.Ld - R**2 * gap)
        rest = a * (w**2 * psi**2 - m.voltage_limit**2) - R**2 * w**2 * psi**2
        root = half**2 - square * rest
        reach = np.sqrt(np.maximum(root, 0.0))
        low = np.maximum((-half - reach) / square, -m.current_limit)
        high = np.minimum((-half + reach) / square, m.current_limit)
        if gap * self.side > 0.0:
            low = np.maximum(low, -psi / gap)
        elif gap != 0.0:
            high = np.minimum(high, -psi / gap)
        if gap == 0.0 and self.side < 0.0:
            low = high + 1.0
        return np.where(root < 0.0, high + 1.0, low), high

    def bounds(self, i_d: Array) -> tuple[Array, Array]:
        """i_q from and to at an i_d."""
        m, w, R = self.machine, self.w, self.R
        a = w**2 * m.Lq**2 + R**2 + TINY
        b = R * w * (self.psi + (m.Ld - m.Lq) * i_d)
        c = R**2 * i_d**2 + w**2 * (m.Ld * i_d + self.psi) ** 2 - m.voltage_limit**2
        reach, room = np.sqrt(np.maximum(b**2 - a * c, 0.0)), np.sqrt(np.maximum(m.current_limit**2 - i_d**2, 0.0))
        return np.maximum((-b - reach) / a, -room), np.minimum((-b + reach) / a, room)

    def allows(self, i_d: Array, i_q: Array) -> Mask:
        m, w, R = self.machine, self.w, self.R
        V = np.hypot(R * i_d - w * m.Lq * i_q, R * i_q + w * (m.Ld * i_d + self.psi))
        return np.asarray(
            (np.hypot(i_d, i_q) <= m.current_limit * (1.0 + EDGE)) & (m.voltage_limit * (1.0 + EDGE) >= V)
        )

    def least(self, target: Array) -> Array:
        """i_d of the least current for a torque, without limits: where i_d^2 + (target / gain)^2, convex, is least."""
        slope = self.side * (self.machine.Ld - self.machine.Lq)
        if slope == 0.0:
            return np.zeros_like(target)
        zero = -self.psi * self.side / slope  # where the gain is
        away = np.abs(zero) + np.sqrt(target / abs(slope)) + TINY
        low, high = (zero, zero + 2.0 * away) if slope > 0.0 else (zero - 2.0 * away, zero)
        return bisected(lambda i_d: i_d * self.gain(i_d) ** 3 - slope * (target**2 + TINY), low, high)


def _limited(region: _Region, target: Array) -> tuple[Array, Array]:
    """(i_d, i_q) where the limits bind: of the least current for the torque, or of the most torque."""
    i_d, i_q = _on_side(region, target)
    other = region.other()
    low, high = other.span()
    if np.any(low <= high):
        far_d, far_q = _on_side(other, target)
        torque, far = (
            np.nan_to_num(r.gain(d) * q, nan=-np.inf) for r, d, q in ((region, i_d, i_q), (other, far_d, far_q))
        )
        nearly = 1.0 - EDGE
        more = (far > torque) & (torque < target * nearly)
        less = (far >= target * nearly) & (torque >= target * nearly) & (np.hypot(far_d, far_q) < np.hypot(i_d, i_q))
        i_d, i_q = np.where(more | less, far_d, i_d), np.where(more | less, -far_q, i_q)
    nowhere, m, w, R = ~np.isfinite(i_d), region.machine, region.w, region.R
    # i_d at which the voltage is least without i_q
    quietest = -(w**2) * m.Ld * region.psi / (R**2 + w**2 * m.Ld**2 + TINY)
    quietest = np.clip(quietest, -m.current_limit, m.current_limit)
    return np.where(nowhere, quietest, i_d), np.where(nowhere, 0.0, i_q)


def _on_side(region: _Region, target: Array) -> tuple[Array, Array]:
    """The same on one side; NaN where the limits allow nothing there.

    Limits make a convex region. Over i_d its upper edge is concave, and gain times a concave edge has one maximum.
    """
    low, high = region.span()
    empty = low > high
    low, high = np.where(empty, 0.0, low), np.where(empty, 0.0, high)

    def room(i_d: Array) -> Array:
        q = region.bounds(i_d)
        return q[1] - q[0]

    def spare(i_d: Array) -> Array:
        i_q, q = target / np.maximum(region.gain(i_d), TINY), region.bounds(i_d)
        return np.minimum(q[1] - i_q, i_q - q[0])

    widest = highest(room, low, high)
    empty |= room(widest) < 0.0
    first, last = bisected(room, low, widest), bisected(room, high, widest)
    best = highest(lambda i_d: region.gain(i_d) * region.bounds(i_d)[1], first, last)
    most = region.bounds(best)[1]
    easiest = highest(spare, first, last)
    within = spare(easiest) >= 0.0
    left, right = bisected(spare, first, easiest), bisected(spare, last, easiest)
    i_d = np.clip(region.least(target), left, right)
    # Beyond the most torque: that. Below the least, which a machine that brakes at high speed has: the least.
    over = ~within & (region.gain(best) * most < target)
    i_d = np.where(within, i_d, np.where(over, best, easiest))
    i_q = np.where(within, target / np.maximum(region.gain(i_d), TINY), np.where(over, most, region.bounds(i_d)[0]))
    return np.where(empty, np.nan, i_d), np.where(empty, np.nan, i_q)
