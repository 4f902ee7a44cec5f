"""Films of a permanent-magnet machine without housing: laminations, end-caps, base and foot face the room."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from simulated.physics import films
from simulated.physics.conduction import Body, Face
from simulated.physics.draws import Draws
from simulated.physics.losses import RPM
from simulated.physics.surfaces import Conditions

Array = NDArray[np.float64]
Index = NDArray[np.int64]
TURNING = ("shaft", "rotor.core", "magnets")
CELLS = ("air.left", "airgap", "air.right")


@dataclass(frozen=True)
class PmFilms:
    """factors : multiplier by part outside, by air space inside;  emissivity : of the machine's body and of the base

    diameter : of the body (m);  rotor_radius, gap (m)
    """

    factors: dict[str, float]
    emissivity: float
    base_emissivity: float
    diameter: float
    rotor_radius: float
    gap: float

    def coefficient(self, part: str, fluid: str, T: Array, T_fluid: Array | float, now: Conditions) -> Array:
        """h (W/m2/K) at every node of a face, for its temperatures T (degC)."""
        if fluid == "ambient":
            glow = films.radiation(T, now.ambient, self.base_emissivity if part == "base" else self.emissivity)
            return self.factors[part] * self._outside(part, T, now) + glow
        return self.factors[fluid] * self._inside(part, fluid, float(np.mean(T_fluid)), now) * np.ones_like(T)

    def _outside(self, part: str, T: Array, now: Conditions) -> Array:
        dT, mean = T - now.ambient, (T + now.ambient) / 2
        if part == "shaft":
            return films.turning_shaft(now.rpm * RPM, mean, 0.05)
        if part in ("base", "foot"):
            return films.natural_third(dT, mean, 0.10)
        if part == "stator.core":
            return films.natural_third(dT, mean, 0.125)
        return films.natural_plate(dT, mean, self.diameter)

    def _inside(self, part: str, fluid: str, T: float, now: Conditions) -> float:
        tip = now.rpm * RPM * self.rotor_radius
        if fluid == "airgap":
            return films.annulus(now.rpm * RPM, T, self.rotor_radius, self.gap)
        return films.end_space((1.0 if part in TURNING else 0.3) * tip)


@dataclass(frozen=True)
class ClosedAir:
    """Three spaces of air without capacity and without exchange between them."""

    size: int = len(CELLS)

    def cells(self, face: Face, body: Body) -> Index:
        return np.full(len(face.nodes), CELLS.index(face.fluid))

    def advection(self) -> tuple[Array, Array]:
        return np.zeros((self.size, self.size)), np.zeros(self.size)


def draw(draws: Draws, geometry: object, base: str) -> PmFilms:
    """base : "none", "plate" or "bench"; the same draws for every machine, each base with its own emissivity."""
    g: object = geometry
    body = ("stator.core", "endcap.left", "endcap.right", "bearing.left", "bearing.right", "shaft")
    common = draws.around("natural.body", 1.0, 0.15)
    factors = {part: common * draws.around(f"natural.{part}", 1.0, 0.04) for part in (*body, "foot")}
    factors |= {fluid: draws.around(f"film.{fluid}", 1.0, 0.2) for fluid in CELLS}
    factors["base"] = draws.around(f"natural.base.{base}", 1.0, 0.15) if base != "none" else 1.0
    nominal = {"none": 0.1, "plate": 0.03, "bench": 0.10}[base]
    bare = draws.around(f"emissivity.base.{base}", nominal, 0.3) if base != "none" else nominal
    return PmFilms(
        factors,
        min(draws.around("emissivity.body", 0.85, 0.06), 0.95),
        bare,
        g.stator.outer_diameter,  # type: ignore[attr-defined]
        g.stator.bore_diameter / 2 - g.stator.air_gap,
        g.stator.air_gap,  # type: ignore[attr-defined]
    )
