"""Where a function of one current is largest, or passes 0, for many operating points at once."""

from collections.abc import Callable

import numpy as np

from geom.arrays import Array

HALVINGS = 50  # a current to the last digit
GOLDEN, SHRINKS = 0.5 * (5.0**0.5 - 1.0), 40  # golden section: the place of a maximum to half the digits


def highest(f: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Where f, with one maximum between low and high, has it: golden section."""
    a, b = low, high
    left, right = b - GOLDEN * (b - a), a + GOLDEN * (b - a)
    f_left, f_right = f(left), f(right)
    for _ in range(SHRINKS):
        rises = f_left < f_right
        a, b = np.where(rises, left, a), np.where(rises, b, right)
        left, right = np.where(rises, right, b - GOLDEN * (b - a)), np.where(rises, a + GOLDEN * (b - a), left)
        value = np.where(rises, f_right, f_left)
        f_new = f(np.where(rises, right, left))
        f_left, f_right = np.where(rises, value, f_new), np.where(rises, f_new, value)
    middle = 0.5 * (a + b)
    return np.asarray(np.where(f(low) > f(middle), low, np.where(f(high) > f(middle), high, middle)))


def bisected(f: Callable[[Array], Array], low: Array, high: Array) -> Array:
    """Where f, rising from low to high, passes 0, on the side where it is not below; an end where it does not."""
    a, b = np.asarray(low, float), np.asarray(high, float)
    whole = f(a) >= 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (a + b)
        below = f(middle) < 0.0
        a, b = np.where(below, middle, a), np.where(below, b, middle)
    return np.where(whole, low, b)
