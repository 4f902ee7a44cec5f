"""A steady colour for every material, the same in CAD files and drawings."""

from __future__ import annotations

import colorsys
import hashlib

_COLOURS = {
    "field-winding": (0.78, 0.38, 0.16),
    "end-winding": (0.91, 0.58, 0.34),
    "winding": (0.85, 0.45, 0.20),
    "copper": (0.85, 0.50, 0.28),
    "commutator": (0.80, 0.55, 0.30),
    "insul": (0.95, 0.90, 0.55),
    "liner": (0.95, 0.90, 0.55),
    "resin": (0.98, 0.95, 0.75),
    "mica": (0.90, 0.82, 0.50),
    "magnet": (0.30, 0.50, 0.80),
    "electrical-steel": (0.62, 0.65, 0.69),
    "steel": (0.45, 0.50, 0.56),
    "bearing": (0.30, 0.33, 0.38),
    "aluminium": (0.84, 0.86, 0.88),
    "polyamide": (0.38, 0.40, 0.36),
    "wood": (0.78, 0.62, 0.44),
    "glycol": (0.60, 0.82, 0.93),
    "water": (0.60, 0.82, 0.93),
}


def colour(material: str) -> tuple[float, float, float]:
    """Red, green, blue (0 to 1): copper is copper, what is not listed gets a pale hue from its name."""
    for word, rgb in _COLOURS.items():
        if word in material:
            return rgb
    hue = int(hashlib.sha256(material.encode()).hexdigest()[:4], 16) / 65535
    return colorsys.hsv_to_rgb(hue, 0.15, 0.75)
