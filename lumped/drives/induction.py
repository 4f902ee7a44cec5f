"""The cage induction machine: from torque and speed to slip, currents and losses, with winding and cage temperature.

The equivalent circuit at constant speed, its phasors turned so that the cage's flux lies along d (peak values):

    psi = Lm i_d,   slip w_s = Rr i_q / (Lr i_d),   w = p Omega + w_s,   T = 3/2 p (Lm^2 / Lr) i_d i_q
    v_d = Rs i_d - w (Ls - Lm^2 / Lr) i_q,   v_q = Rs i_q + w Ls i_d,   cage current = (Lm / Lr) i_q
"""

from dataclasses import dataclass

import numpy as np

from geom.arrays import Array, Ints, Number
from geom.constants import ALPHA_CU, RPM
from lumped.drives.limits import bisected, highest

ALPHA_AL = 1.0 / 245.0  # 1/K at 20 degC, cast aluminium: 1 / (225 + 20), IEC 60034-2-1
RATIOS = 1e-6, 1e3  # i_q / i_d: from no load to far beyond pull-out, which lies below 1 / leakage factor
STEPS = 64  # of the ratio, a third of it each, and closer where the field stands still: in between is one maximum
NEAR, SEPARATION = np.geomspace(1e-3, 1.0, 30), 0.7  # of a logarithm; maxima are further apart
TINY = 1e-30  # V or N m, in place of none at all


@dataclass(frozen=True)
class InductionMachine:
    """pole_pairs; Rs, Rr (ohm) at 20 degC, Ls_leak, Lr_leak, Lm (H): of the equivalent circuit, per phase, cage as seen
    from the stator; magnetising (A): peak phase current that makes the rated flux; limits: peak phase current (A),
    peak phase voltage (V); alpha_s, alpha_r : relative change of Rs and Rr per K
    """

    pole_pairs: int
    Rs: float
    Rr: float
    Ls_leak: float
    Lr_leak: float
    Lm: float
    magnetising: float
    current_limit: float
    voltage_limit: float
    alpha_s: float = ALPHA_CU
    alpha_r: float = ALPHA_AL

    def stator_resistance(self, winding_degC: Number) -> Array:
        return self.Rs * (1.0 + self.alpha_s * (np.asarray(winding_degC, float) - 20.0))

    def cage_resistance(self, cage_degC: Number) -> Array:
        return self.Rr * (1.0 + self.alpha_r * (np.asarray(cage_degC, float) - 20.0))

    @property
    def coupling(self) -> float:
        """Cage current over i_q."""
        return self.Lm / (self.Lm + self.Lr_leak)

    def torque(self, i_d: Number, i_q: Number) -> Array:
        """N m"""
        return 1.5 * self.pole_pairs * self.Lm * self.coupling * np.asarray(i_d, float) * np.asarray(i_q, float)

    def slip_speed(self, i_d: Array, i_q: Array, cage_degC: Number) -> Array:
        """Of the stator's field against the rotor (rad/s, electrical)."""
        return self.cage_resistance(cage_degC) * i_q / ((self.Lm + self.Lr_leak) * i_d)

    def operation(
        self, i_d: Array, i_q: Array, speed_rpm: Number, winding_degC: Number = 20.0, cage_degC: Number = 20.0
    ) -> "Operation":
        """What the machine does at two currents and a speed."""
        turning, slip = self.pole_pairs * np.asarray(speed_rpm, float) * RPM, self.slip_speed(i_d, i_q, cage_degC)
        w, Rs, Ls = turning + slip, self.stator_resistance(winding_degC), self.Lm + self.Ls_leak
        v_d = Rs * i_d - w * (Ls - self.Lm * self.coupling) * i_q
        v_q = Rs * i_q + w * Ls * i_d
        cage = self.coupling * np.abs(i_q)
        share = np.divide(slip, w, out=np.full(np.shape(w), np.nan), where=w != 0.0)
        currents, volts = (np.asarray(i_d), np.asarray(i_q)), np.hypot(v_d, v_q)
        power, stator = 1.5 * (v_d * i_d + v_q * i_q), 1.5 * Rs * (i_d**2 + i_q**2)
        rotor, frequency = 1.5 * self.cage_resistance(cage_degC) * cage**2, w / (2.0 * np.pi)
        return Operation(*currents, self.torque(i_d, i_q), volts, frequency, share, cage, power, stator, rotor)

    def currents(
        self, torque: Number, speed_rpm: Number, winding_degC: Number = 20.0, cage_degC: Number = 20.0
    ) -> tuple[Array, Array]:
        """(i_d, i_q) (A) for the torque (N m) at the rated flux; at as much of it as current and voltage allow beyond.

        A torque beyond the limits is cut to the most that they allow, the pull-out torque where the voltage binds:
        compare `torque` of the answer with what was asked.
        """
        demand, n, Tw, Tc = (
            np.asarray(x, float) for x in np.broadcast_arrays(torque, speed_rpm, winding_degC, cage_degC)
        )
        sign, target = np.where(demand < 0.0, -1.0, 1.0), np.abs(demand)

        def most(ratio: Array) -> Array:
            """Largest i_d at a ratio i_q / i_d: slip does not change with it, so that voltages grow in proportion."""
            one = self.operation(np.ones_like(ratio), sign * ratio, n, Tw, Tc)
            volts = self.voltage_limit / np.maximum(one.voltage, TINY)
            amperes = self.current_limit / np.hypot(1.0, ratio)
            return np.minimum(np.minimum(volts, amperes), self.magnetising)

        def rough(x: Array) -> Array:
            """Torque at a logarithm of the ratio."""
            return self.torque(most(np.exp(x)), np.exp(x) * most(np.exp(x)))

        # A machine that brakes can have two maxima, the second close to where its field stands still.
        still = self.slip_speed(np.ones(n.shape), np.ones(n.shape), Tc) / np.maximum(
            np.abs(n) * self.pole_pairs * RPM, TINY
        )
        near = np.concatenate([-NEAR, [0.0], NEAR])
        usual = np.linspace(np.log(RATIOS[0]), np.log(RATIOS[1]), STEPS)
        steps = np.sort([*(np.full(n.shape, x) for x in usual), *(x - np.log(still) for x in near)], axis=0)
        torques = np.array([rough(x) for x in steps])

        def at(k: Ints) -> Array:
            return np.take_along_axis(steps, np.clip(k, 0, len(steps) - 1)[None], 0)[0]

        def summit(k: Ints) -> tuple[Array, Array]:
            """The maximum beside a step, and its place."""
            x = highest(lambda x: np.log(np.maximum(rough(x), TINY)), at(k - 1), at(k + 1))
            return rough(x), x

        reach = torques >= target
        one = np.argmax(torques, axis=0)
        two = np.argmax(np.where(np.abs(steps - at(one)) > SEPARATION, torques, -np.inf), axis=0)
        (most_one, x_one), (most_two, x_two) = summit(one), summit(two)
        second = most_two > most_one
        index = np.where(reach.any(axis=0), np.argmax(reach, axis=0), np.where(second, two, one))
        first = np.where(reach.any(axis=0), at(index), np.where(second, x_two, x_one))
        start = np.where(index > 0, np.exp(at(index - 1)), 0.0)
        ratio = bisected(lambda x: self.torque(most(x), x * most(x)) - target, start, np.exp(first))
        return most(ratio), sign * ratio * most(ratio)


@dataclass(frozen=True)
class Operation:
    """i_d, i_q, cage: peak currents (A), torque (N m), voltage: peak phase (V), frequency (Hz), slip: NaN at 0 Hz

    power: electrical (W) = torque times speed + stator_W + cage_W
    """

    i_d: Array
    i_q: Array
    torque: Array
    voltage: Array
    frequency: Array
    slip: Array
    cage: Array
    power: Array
    stator_W: Array
    cage_W: Array
