"""Colours, chosen once: few, safe for colour-blind readers, light enough that shading and edges stay visible.

Colour scales span the data and are marked at round numbers.
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from geom.description.roles import Identity, Role

if TYPE_CHECKING:
    from matplotlib.colors import LinearSegmentedColormap

# Okabe & Ito 2008, the colour-blind safe set
BLUE, ORANGE, GREEN, VERMILION = "#0072B2", "#E69F00", "#009E73", "#D55E00"
SKY, PURPLE, YELLOW = "#56B4E9", "#CC79A7", "#F0E442"
# of Okabe & Ito's hues, dark enough for white letters on them (contrast 4.5 and more, WCAG 2.2 AA)
VERDICT = {"within": "#00795A", "hot": "#B34700", "cold": BLUE, "unknown": "#5B6470"}


@dataclass(frozen=True)
class Theme:
    """Colours of paper and ink."""

    paper: str
    ink: str
    faint: str


LIGHT = Theme("#ffffff", "#1f2933", "#9aa5b1")
DARK = Theme("#14181d", "#e6e9ed", "#66707c")


def rgb(colour: str) -> tuple[int, ...]:
    """'#rrggbb' as numbers from 0 to 255."""
    return tuple(int(colour[i : i + 2], 16) for i in (1, 3, 5))


@lru_cache(maxsize=1)
def heat() -> "LinearSegmentedColormap":
    """Blue through magenta to yellow; lightness rises evenly from 0.47 to 0.93 (OKLab), so nothing turns black."""
    from matplotlib.colors import LinearSegmentedColormap

    s = np.linspace(0.0, 1.0, 33)
    hue = np.deg2rad(np.interp(s, [0, 0.25, 0.5, 0.75, 1], [265, 315, 360 + 10, 360 + 52, 360 + 100]))
    chroma = np.interp(s, [0, 0.3, 0.6, 0.8, 1], [0.15, 0.19, 0.18, 0.16, 0.14])
    rgb = _oklab_to_srgb(0.47 + 0.46 * s, chroma * np.cos(hue), chroma * np.sin(hue))
    return LinearSegmentedColormap.from_list("thermoscope.heat", [tuple(c) for c in rgb], N=256)


@lru_cache(maxsize=1)
def power() -> "LinearSegmentedColormap":
    """Pale sand to dark red, lightness falling evenly from 0.86 to 0.36 (OKLab): heat that flows."""
    from matplotlib.colors import LinearSegmentedColormap

    s = np.linspace(0.0, 1.0, 33)
    hue, chroma = np.deg2rad(np.interp(s, [0, 0.5, 1], [80, 55, 30])), np.interp(s, [0, 0.5, 1], [0.09, 0.15, 0.14])
    rgb = _oklab_to_srgb(0.86 - 0.5 * s, chroma * np.cos(hue), chroma * np.sin(hue))
    return LinearSegmentedColormap.from_list("thermoscope.power", [tuple(c) for c in rgb], N=256)


@lru_cache(maxsize=1)
def missing() -> "LinearSegmentedColormap":
    """Blue through light grey to vermilion: too little, nothing, too much."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("thermoscope.missing", [BLUE, "#E4E8EC", VERMILION], N=255)


def _oklab_to_srgb(L: Array, a: Array, b: Array) -> Array:
    """OKLab to sRGB in 0..1, clipped to the gamut (Ottosson 2020)."""
    long = L + 0.3963377774 * a + 0.2158037573 * b
    medium = L - 0.1055613458 * a - 0.0638541728 * b
    short = L - 0.0894841775 * a - 1.2914855480 * b
    matrix = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    linear = np.clip(matrix @ np.stack([long, medium, short]) ** 3, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055).T


_OF_ROLE = {
    Role.WINDING: "#C77B4A",
    Role.INSULATION: "#E3C565",
    Role.COMMUTATOR: "#B08D57",
    Role.ROTOR: "#7C8FA6",
    Role.CAGE: "#7C8FA6",
    Role.MAGNET: "#7C8FA6",
    Role.FAN: "#7C8FA6",
    Role.IRON: "#98A7B8",
    Role.SHAFT: "#5B6B7B",
    Role.BEARING: "#5B6B7B",
    Role.HOUSING: "#B9C6C9",
    Role.END_SHIELD: "#A7B9AE",
    Role.FOOT: "#8B8F94",
    Role.BASE: "#8B8F94",
    Role.BRUSH: "#4A4F55",
}


def part_colours(parts: Iterable[str], identities: Mapping[str, Identity]) -> dict[str, str]:
    """A muted colour per part by what it is: copper for windings, steel for iron, aluminium for the shell."""
    roles = {part: identities[part].role if part in identities else None for part in parts}
    return {part: _OF_ROLE.get(role, "#A9A9B8") if role else "#A9A9B8" for part, role in roles.items()}


INTERVALS = 8  # between marks at most: few enough to read
FINE = 10  # parts of an interval to which the ends are widened: a scale from 12 to 93 wastes nothing, and says both
LEAST = 0.8  # K or W: a uniform field has two ends 0.1 apart


def step_of(span: float) -> float:
    """The smallest of 1, 2 and 5 times a power of ten that covers a span in at most eight steps."""
    rough = max(span, LEAST) / INTERVALS
    power = 10.0 ** math.floor(math.log10(rough))
    return next(round(n * power, 12) for n in (1, 2, 5, 10) if n * power >= rough * (1 - 1e-9))


def rounded(low: float, high: float) -> tuple[float, float]:
    """The range widened to whole tenths of the steps between its marks; one that is round already stays as it is."""
    while True:
        fine = step_of(high - low) / FINE
        first = math.floor(low / fine + 1e-6)
        last = max(math.ceil(high / fine - 1e-6), first + 1)
        ends = round(first * fine, 12), round(last * fine, 12)
        if ends == (low, high):
            return ends
        low, high = ends


def marks(low: float, high: float) -> list[float]:
    """Both ends of a rounded range, and the round numbers between that are half a step or more from them."""
    step = step_of(high - low)
    first, last = math.ceil(low / step + 0.5 - 1e-9), math.floor(high / step - 0.5 + 1e-9)
    return [low, *(round(i * step, 12) for i in range(first, last + 1)), high]


def decimals(low: float, high: float) -> int:
    """Digits after the point that all marks of a rounded range need."""
    every, most = marks(low, high), max(0, -math.floor(math.log10(step_of(high - low) / FINE) + 1e-9))
    return next((n for n in range(most) if all(abs(round(m, n) - m) < 1e-9 for m in every)), most)
