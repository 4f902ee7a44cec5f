"""A steady colour for every material, the same in CAD files and drawings."""

import colorsys
import csv
import hashlib
from pathlib import Path

with Path(__file__).with_name("palette.csv").open(encoding="utf-8", newline="") as _file:
    _, *_rows = csv.reader(_file)
_COLOURS = {word: (float(red), float(green), float(blue)) for word, red, green, blue in _rows}


def colour(material: str) -> tuple[float, float, float]:
    """Red, green, blue (0 to 1): copper is copper, what is not listed gets a pale hue from its name."""
    for word, rgb in _COLOURS.items():
        if word in material:
            return rgb
    hue = int(hashlib.sha256(material.encode()).hexdigest()[:4], 16) / 65535
    return colorsys.hsv_to_rgb(hue, 0.15, 0.75)
