"""Losses that come with an inverter: its own, and what the ripple of its pulses makes in stator and rotor."""

from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import CONSTANT, Array, Inputs, Law, TemperatureLaw
from lumped.transfer.ranges import out_of_range

LARGEST = 2.0 / 3.0**0.5  # modulation at which the phases' common voltage has no room left


@dataclass(frozen=True)
class InverterLoss(Law):
    """Standby + conduction + switching of a two-level inverter of three legs (W), sinusoidal current of peak I.

    standby (W) + 3 (V0 2 I / pi + R I^2 / 2) + 3 f E (2 I / pi) / I_ref * Vdc / V_ref

    currents: inputs (A), I^2 = factor / 1.5 sum of their squares (factor as for copper: 1.5 peak dq, 3 rms of a phase)
    threshold: V0 (V), resistance: R (ohm), of one switch, its diode taken alike;  frequency: f (Hz);  supply: Vdc (V)
    energy: E (J) of turning on, off and of the diode's recovery, at I_ref (A) and V_ref (V)
    Source: Mohan, Undeland, Robbins 2003; energies in proportion to current and voltage, as data sheets have them.
    """

    currents: tuple[str, ...]
    factor_: float
    threshold: float
    resistance: float
    frequency: float
    energy: float
    at_current: float
    at_voltage: float
    supply: float
    standby: float = 0.0
    temperature: TemperatureLaw = CONSTANT

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.currents

    def factor(self, inputs: Inputs) -> Array | float:
        square = self.factor_ / 1.5 * sum(np.asarray(inputs[name], float) ** 2 for name in self.currents)
        mean = 2.0 / np.pi * np.sqrt(square)  # of the rectified current
        conduction = self.threshold * mean + self.resistance * square / 2.0
        switching = self.frequency * self.energy * mean / self.at_current * self.supply / self.at_voltage
        return self.standby + 3.0 * (conduction + switching)


@dataclass(frozen=True)
class PulseLoss(Law):
    """3 R dI^2 (W), dI^2 = (Vdc / (L f))^2 (3/2 M^2 - 4 sqrt3/pi M^3 + (27/16 - 81 sqrt3/(64 pi)) M^4) / 576.

    dI: rms of the ripple of a phase (A) with space-vector pulses, M = 2 V / Vdc; V: input, peak of the phase voltage
    (V). supply: Vdc (V); frequency: f (Hz); L (H) of a phase for the ripple: leakages, or subtransient; R (ohm): of
    what the loss heats, at the frequency of the pulses, as seen from the stator: of winding, cage, magnets or core.
    Source: Holmes and Lipo 2003, Pulse Width Modulation for Power Converters, ch. 6.
    """

    voltage: str
    supply: float
    L: float
    frequency: float
    R: float
    temperature: TemperatureLaw = CONSTANT

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.voltage,)

    def factor(self, inputs: Inputs) -> Array | float:
        M = 2.0 * np.abs(np.asarray(inputs[self.voltage], float)) / self.supply
        if np.any(LARGEST < M):
            highest = f"{self.voltage} = {0.5 * self.supply * float(np.max(M)):.4g}"
            out_of_range(f"pulses of an inverter: {highest} V above {0.5 * self.supply * LARGEST:.4g} V of its supply")
        M = np.minimum(M, LARGEST)
        root = 3.0**0.5
        share = 1.5 * M**2 - 4.0 * root / np.pi * M**3 + (27.0 / 16.0 - 81.0 * root / (64.0 * np.pi)) * M**4
        return 3.0 * self.R * (self.supply / (self.L * self.frequency)) ** 2 * share / 576.0
