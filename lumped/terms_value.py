"""A temperature law's value outside the compiled kernel, by the kernel's own function."""

from __future__ import annotations

import numpy as np

from lumped import terms
from lumped.laws import Linear, Power, Radiation, Table, TemperatureLaw


def temperature_value(law: TemperatureLaw, hot: float, cold: float) -> float:
    """The law at two temperatures (degC)."""
    none = np.zeros(1)
    if isinstance(law, Power):
        return float(terms.law(terms.POWER, law.exponent, 0.0, none, none, hot, cold)[0])
    if isinstance(law, Radiation):
        return float(terms.law(terms.RADIATION, 0.0, 0.0, none, none, hot, cold)[0])
    if isinstance(law, Linear):
        return float(terms.law(terms.LINEAR, law.alpha, law.reference, none, none, hot, cold)[0])
    if isinstance(law, Table):
        x, y = np.array(law.difference), np.array(law.value)
        return float(terms.law(terms.TABLE, 0.0, 0.0, x, y, hot, cold)[0])
    return 1.0
