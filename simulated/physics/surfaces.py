"""Which film washes which face, with the drawn multipliers and the hidden road wind."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulated.physics import films
from simulated.physics.draws import Draws
from simulated.physics.losses import RPM

Array = NDArray[np.float64]
HIDDEN_AT = "flange.right"
TURNING = ("winding.armature", "rotor", "shaft", "commutator", "slot")


@dataclass(frozen=True)
class Conditions:
    """Means over one step: current (A), its square (A2), speed (rpm), vehicle (m/s), flow (m3/h), ambient (degC)."""

    current: float
    current2: float
    rpm: float
    vehicle: float
    flow: float
    ambient: float


@dataclass(frozen=True)
class Films:
    """Drawn coefficients of all films; sizes in m and m2.

    shelter : air speed at the right flange over vehicle speed; 0 switches the hidden effect off
    factors : multiplier by part (outside) or by fluid (inside)
    """

    shelter: float
    emissivity: float
    fins_seen: float
    fins_natural: float
    factors: dict[str, float]
    diameter: float = 0.48
    rotor_radius: float = 0.145
    gap: float = 0.002
    channel_area: float = 0.035
    channel_diameter: float = 0.055
    channel_length: float = 0.2

    def coefficient(self, part: str, fluid: str, T: Array, T_fluid: Array | float, now: Conditions) -> Array:
        """h (W/m2/K) at every node of a face, for its temperatures T (degC)."""
        if fluid == "ambient":
            seen = self.fins_seen if part == "housing" else 1.0
            natural = self.factors[part] * self._natural(part, T, now)
            glow = films.radiation(T, now.ambient, self.emissivity * seen)
            wind = self.wind(now, T) if part == HIDDEN_AT else 0.0
            return films.mixed(natural, wind) + glow
        return self.factors[fluid] * self._inside(part, fluid, float(np.mean(T_fluid)), now) * np.ones_like(T)

    def wind(self, now: Conditions, T: Array) -> Array:
        """The hidden effect: road wind on the outer face of the right flange (W/m2/K)."""
        return films.blunt_face(self.shelter * now.vehicle, (T + now.ambient) / 2, self.diameter)

    def _natural(self, part: str, T: Array, now: Conditions) -> Array:
        dT, mean = T - now.ambient, (T + now.ambient) / 2
        if part == "shaft":
            return films.turning_shaft(now.rpm * RPM, mean, 0.07)
        if part == "housing":
            return self.fins_natural * films.natural_third(dT, mean, 0.13)
        if part in ("base", "feet"):
            return films.natural_third(dT, mean, 0.10)
        return films.natural_plate(dT, mean, self.diameter)

    def _inside(self, part: str, fluid: str, T: float, now: Conditions) -> float:
        tip = now.rpm * RPM * self.rotor_radius
        axial = now.flow / 3600
        if fluid == "airgap":
            return films.annulus(now.rpm * RPM, T, self.rotor_radius, self.gap)
        if fluid == "air.interpolar":
            v = np.hypot(axial / self.channel_area, 0.05 * tip)
            return films.duct(float(v), T, self.channel_diameter, self.channel_length)
        share = 1.0 if part.startswith(TURNING) else 0.45
        return films.end_space(float(np.hypot(share * tip, axial / (0.02 if fluid == "air.left" else 0.04))))


def draw(draws: Draws) -> Films:
    outside = ("flange.left", "flange.right", "housing", "base", "feet", "shaft", "bearing.left", "bearing.right")
    inside = {"air.left": 0.25, "air.right": 0.25, "airgap": 0.25, "air.interpolar": 0.25}
    factors = {part: draws.around(f"natural.{part}", 1.0, 0.15) for part in outside}
    factors |= {fluid: draws.around(f"film.{fluid}", 1.0, sd) for fluid, sd in inside.items()}
    return Films(
        draws.around("hidden.shelter", 0.55, 0.15),
        min(draws.around("emissivity", 0.85, 0.10), 0.97),
        draws.around("fins.seen", 0.5, 0.10),
        draws.around("fins.natural", 0.8, 0.10),
        factors,
    )
