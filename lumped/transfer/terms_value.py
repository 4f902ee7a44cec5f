"""Temperature laws in ordinary NumPy, for what looks at a network from outside the compiled kernel."""

import numpy as np

from geom.constants import SIGMA, ZERO_C
from lumped.transfer import laws


def coefficient(law: laws.Law, inputs: laws.Inputs, hot: float, cold: float) -> float:
    """A law at an instant's inputs and two temperatures (degC), in all."""
    follows = law.temperature
    size = float(np.mean(follows.size(inputs))) if isinstance(follows, laws.StreamTable) else None
    return float(np.mean(law.factor(inputs))) * temperature_value(follows, hot, cold, size)


def separated(law: laws.Law) -> laws.Law:
    """A law whose factor holds all that inputs do to it: for what is linear in these; `turned` goes with it."""
    return laws.AtUsualTemperature(law) if isinstance(law.temperature, laws.StreamTable) else law


def turned(law: laws.TemperatureLaw, hot: float, cold: float) -> float:
    """The law at two temperatures (degC) over what it is at its usual ones, at the usual size of an input."""
    usual = float(law.at(law.usual, law.degC)) if isinstance(law, laws.StreamTable) else 1.0
    return temperature_value(law, hot, cold) / usual


def temperature_value(law: laws.TemperatureLaw, hot: float, cold: float, size: float | None = None) -> float:
    """The law at two temperatures (degC), and at a size of the input that it sees, if any: else at the usual one."""
    if isinstance(law, laws.StreamTable):
        return float(law.at(law.usual if size is None else size, hot + cold, hot - cold))
    if isinstance(law, laws.Power):
        return float(abs(hot - cold) ** law.exponent)
    if isinstance(law, laws.Radiation):
        h, c = hot + ZERO_C, cold + ZERO_C
        return SIGMA * (h * h + c * c) * (h + c)
    if isinstance(law, laws.Linear):
        return 1.0 + law.alpha * (hot - law.reference)
    if isinstance(law, laws.Conductivity):
        return 1.0 / (1.0 + law.alpha * (hot - law.reference))
    if isinstance(law, laws.Table):
        d = hot - cold if law.difference[0] < 0.0 else abs(hot - cold)
        return float(np.interp(d, law.difference, law.value))
    if isinstance(law, laws.FilmTable):
        return float(law.at(hot - cold, hot + cold))
    return 1.0


def loss_slope(law: laws.TemperatureLaw, T: float, inputs: laws.Inputs) -> float:
    """How a loss that counts as 1 changes per K at T (degC) and an instant's inputs; 0 of a law that no loss has."""
    if isinstance(law, laws.Linear):
        return law.alpha
    if isinstance(law, laws.Conductivity):
        return -law.alpha * temperature_value(law, T, T) ** 2
    if isinstance(law, laws.StreamTable):
        size = float(np.mean(law.size(inputs)))
        return float(law.at(size, T + 0.5) - law.at(size, T - 0.5))
    return 0.0
