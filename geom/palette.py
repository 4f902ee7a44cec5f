"""A steady colour for every material, the same in CAD files and drawings."""

from __future__ import annotations

import colorsys
import hashlib

_KNOWN = {
    "winding": (0.85, 0.45, 0.2),
    "commutator": (0.80, 0.55, 0.30),
    "insul": (0.95, 0.9, 0.55),
    "liner": (0.95, 0.9, 0.55),
    "magnet": (0.35, 0.55, 0.75),
}


def colour(material: str) -> tuple[float, float, float]:
    """Red, green, blue (0 to 1): copper is copper, what is not listed gets a pale hue from its name."""
    for word, rgb in _KNOWN.items():
        if word in material:
            return rgb
    hue = int(hashlib.sha256(material.encode()).hexdigest()[:4], 16) / 65535
    return colorsys.hsv_to_rgb(hue, 0.15, 0.75)
