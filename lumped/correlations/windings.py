"""Effective conductivities of wound and laminated parts, and the T-circuit of a hollow cylinder."""

from __future__ import annotations

import math
from dataclasses import dataclass

from lumped.correlations.info import Info, checked


def hashin_shtrikman(fill: float, k_copper: float, k_filler: float) -> tuple[float, Info]:
    """Transverse conductivity of round wires in a filler (W/m/K), lower bound.

    k = kp ((1 + v) kc + (1 - v) kp) / ((1 - v) kc + (1 + v) kp). Range: v <= 0.65 (0.6 % against a hexagonal cell
    solved in 2-D at 0.6, 9 % at 0.8). Source: Hashin and Shtrikman 1962; Simpson, Wrobel, Mellor 2013.
    """
    k = k_filler * ((1 + fill) * k_copper + (1 - fill) * k_filler) / ((1 - fill) * k_copper + (1 + fill) * k_filler)
    return k, checked("hashin_shtrikman", "Hashin & Shtrikman 1962", {"fill": fill}, {"fill": (0, 0.65)})


def along_wires(fill: float, k_copper: float, k_filler: float) -> float:
    """Conductivity along the wires (W/m/K): volume mean."""
    return fill * k_copper + (1 - fill) * k_filler


def lamination(stacking: float, k_iron: float, k_insulation: float = 0.2) -> tuple[float, float]:
    """(in the sheet, across the stack) (W/m/K): parallel and series of iron and insulation."""
    in_plane = stacking * k_iron + (1 - stacking) * k_insulation
    return in_plane, 1.0 / (stacking / k_iron + (1 - stacking) / k_insulation)


@dataclass(frozen=True)
class TCircuit:
    """Resistances (K/W) of a hollow cylinder: faces, ends (alike), star points to the mean node (negative)."""

    outer: float
    inner: float
    radial_mean: float
    end: float
    axial_mean: float


def mellor(outer_radius: float, inner_radius: float, length: float, k_radial: float, k_axial: float) -> TCircuit:
    """T-equivalent circuit, exact for the mean temperature of a uniformly heated hollow cylinder; inner_radius > 0.

    Source: Mellor, Roberts, Turner 1991, IEE Proc. B 138, 205.
    """
    d = outer_radius**2 - inner_radius**2
    log, radial = math.log(outer_radius / inner_radius), 4 * math.pi * k_radial * length
    outer = (1 - 2 * inner_radius**2 * log / d) / radial
    inner = (2 * outer_radius**2 * log / d - 1) / radial
    squares = outer_radius**2 + inner_radius**2
    mean = -(squares - 4 * outer_radius**2 * inner_radius**2 * log / d) / (2 * radial * d)
    end = length / (2 * math.pi * k_axial * d)
    return TCircuit(outer, inner, mean, end, -end / 3.0)
