"""Faces that stand still in the air of a fan on the shaft, as totally enclosed machines are cooled.

    fan = { h_W_m2K = 40, at_rpm = 1460, exponent = 0.8, speed = "speed_rpm" }

of a link in network.toml, and of a part in [films.outer] of a machine file.
"""

from lumped.schemas.reader import Table
from lumped.transfer.laws import InputPower

EXPONENT = 0.8  # turbulent along fins and end shields (Staton and Cavagnino 2008); 0.5 laminar


def shaft_fan(table: Table) -> InputPower:
    """h = h0 |n / n0|^m (W/m2/K): the fan's air goes with the speed n (affinity), its film with Re^m."""
    h, at = table.number("h_W_m2K"), table.number("at_rpm", low=1e-9)
    exponent = table.number("exponent", EXPONENT, low=0.5, high=1.0)
    return InputPower(h, ((table.word("speed", "speed_rpm"), at, exponent),))
