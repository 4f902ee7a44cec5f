"""Bars and boxes whose ends have names."""

import numpy as np

from fem.matrices.grids import box


def named(centres, *choices, default=""):
    """Names by conditions on centres."""
    out = np.full(len(centres), default, dtype=object)
    for condition, name in choices:
        out[condition] = name
    return out


def bar(length, n, width=None, across=1, sides=""):
    """A bar of n cells along x (cubes where no width is given) with fluids "left", "right" and `sides` around it."""
    x, y = np.linspace(0.0, length, n + 1), np.linspace(0.0, width or across * length / n, across + 1)

    def fluid(c):
        return named(c, (c[:, 0] < 1e-9, "left"), (c[:, 0] > length - 1e-9, "right"), default=sides)

    return box(x, y, y, lambda c: named(c, default="bar"), fluid)
