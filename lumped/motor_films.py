"""Which film washes which face of a motor, as coefficient laws by mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.end_space import end_space
from lumped.correlations.natural import churchill_chu_cylinder, churchill_chu_plate
from lumped.laws import Array, Fixed, Inputs, Law, Radiation, Table
from lumped.motor_settings import Films

ROTATING = ("winding.armature", "rotor", "shaft", "commutator", "slot")
STILL_AIR_K = tuple(np.concatenate([[0.0, 0.5], np.geomspace(1.0, 200.0, 30)]))


@dataclass(frozen=True)
class Sizes:
    """The lengths the correlations ask for (m, m2).

    housing_diameter; fin_area_ratio: finned area over its envelope (1 without fins); tip_radius: of the rotor;
    air_gap; channel_area, channel_perimeter, channel_length: the space between the poles along the axis
    """

    housing_diameter: float
    fin_area_ratio: float
    tip_radius: float
    air_gap: float
    channel_area: float
    channel_perimeter: float
    channel_length: float


@dataclass(frozen=True)
class OfSpeed(Law):
    """A film coefficient (W/m2/K) tabulated over |speed_rpm|."""

    speed_rpm: tuple[float, ...]
    h: tuple[float, ...]
    reads = ("speed_rpm",)

    def factor(self, inputs: Inputs) -> Array:
        return np.interp(np.abs(np.asarray(inputs["speed_rpm"], float)), self.speed_rpm, self.h)


@dataclass(frozen=True)
class OfFlow(Law):
    """A film coefficient (W/m2/K) tabulated over the fan's air flow (m3/h)."""

    flow_m3h: tuple[float, ...]
    h: tuple[float, ...]
    reads = ("fan_flow_m3h",)

    def factor(self, inputs: Inputs) -> Array:
        return np.interp(np.asarray(inputs["fan_flow_m3h"], float), self.flow_m3h, self.h)


def face_films(part: str, fluid: str, films: Films, sizes: Sizes) -> dict[str, Law]:
    """Mechanism -> law for one face; mechanisms act in parallel. Faces of unknown fluids get none."""
    if fluid == "ambient":
        return _outer(part, films, sizes)
    if fluid in ("air.left", "air.right"):
        moving = part.startswith(ROTATING)
        return {"": _stirred(films.moving_wall_share if moving else films.still_wall_share, films, sizes)}
    if fluid == "airgap":
        return {"": _gap(sizes)}
    if fluid == "air.interpolar":
        return {"axial": _channel(sizes), "stirred": _stirred(films.channel_wall_share, films, sizes)}
    return {}


def _outer(part: str, films: Films, sizes: Sizes) -> dict[str, Law]:
    """Still air and radiation; between fins the air is half as good and only the envelope radiates."""
    finned = part == "housing" and sizes.fin_area_ratio > 1.0
    correlation = churchill_chu_cylinder if part == "housing" else churchill_chu_plate
    h = [0.0, *(correlation(sizes.housing_diameter, 20.0 + d, 20.0)[0] for d in STILL_AIR_K[1:])]
    crowding = 0.8 if finned else 1.0
    seen = 1.0 / sizes.fin_area_ratio if finned else 1.0
    return {
        "natural": Fixed(crowding, Table(STILL_AIR_K, tuple(h))),
        "radiation": Fixed(films.emissivity * seen, Radiation()),
    }


def _stirred(share: float, films: Films, sizes: Sizes) -> Law:
    """Walls of air that the rotor stirs; `share` of its tip speed passes the wall."""
    speed = np.linspace(0.0, 3000.0, 121)
    tip = speed * 2 * np.pi / 60 * sizes.tip_radius * share
    h = end_space(tip, films.end_space_k1_W_m2K, films.end_space_k2, films.end_space_k3)[0]
    return OfSpeed(tuple(speed), tuple(np.asarray(h)))


def _gap(sizes: Sizes) -> Law:
    speed = np.linspace(0.0, 3000.0, 121)
    h = [taylor_film(n * 2 * np.pi / 60, sizes.tip_radius, sizes.air_gap)[0] for n in speed]
    return OfSpeed(tuple(speed), tuple(h))


def _channel(sizes: Sizes) -> Law:
    flow = np.linspace(0.0, 600.0, 61)
    diameter = 4 * sizes.channel_area / sizes.channel_perimeter
    h = [duct_film(q / 3600 / sizes.channel_area, diameter, sizes.channel_length)[0] for q in flow]
    return OfFlow(tuple(flow), tuple(h))


def nominal(laws: Mapping[str, Law], inputs: Inputs, difference: float = 30.0) -> float:
    """What all mechanisms add up to (W/m2/K) at an operating point, `difference` (K) above 20 degC."""
    total = 0.0
    for law in laws.values():
        value = float(np.mean(law.factor(inputs)))
        if isinstance(law.temperature, Table):
            value *= float(np.interp(difference, law.temperature.difference, law.temperature.value))
        elif isinstance(law.temperature, Radiation):
            hot, cold = 293.15 + difference, 293.15
            value *= 5.670374e-8 * (hot**2 + cold**2) * (hot + cold)
        total += value
    return total
