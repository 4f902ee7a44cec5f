"""What a torque takes: the current, and the terminal voltage of a warm machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermoscope import InputError, plugin as th

CURRENT, SPEED = "current_A", "speed_rpm"


@dataclass(frozen=True)
class Electrics:
    """current_limit (A), voltage_limit (V): of the ratings;  brush_V : drop of the brushes;  series : of such a machine

    rated : (torque N m, current A) of a machine whose flux is constant: its torque goes with the current
    """

    current_limit: float | None = None
    voltage_limit: float | None = None
    brush_V: float = 0.0
    series: th.SeriesMachine | None = None
    rated: tuple[float, float] | None = None

    def current(self, torque: float) -> float:
        """A that a torque (N m) takes."""
        if self.series is not None:
            return float(self.series.current(torque))
        if self.rated is None:
            raise InputError(
                "nothing says what current a torque takes", "--torque", "[ratings] torque_Nm and current_A"
            )
        return torque / self.rated[0] * self.rated[1]

    def torque(self, current: float) -> float | None:
        """N m that a current gives, where it is known."""
        if self.series is not None:
            return float(self.series.torque(current))
        return None if self.rated is None else current / self.rated[1] * self.rated[0]

    def voltage(self, current: float, speed_rpm: float, copper_W: float) -> float | None:
        """V = w L_af i + P_copper / i + brushes, of a series machine."""
        if self.series is None or current == 0.0:
            return None
        return self.series.L_af * th.RPM * speed_rpm * current + copper_W / current + self.brush_V

    def excess(self, inputs: Mapping[str, float], copper_W: float) -> dict[str, float]:
        """Limit -> by which share it is exceeded; negative where it is kept."""
        out, i = {}, inputs.get(CURRENT, 0.0)
        if self.current_limit is not None and CURRENT in inputs:
            out[f"current <= {self.current_limit:g} A"] = i / self.current_limit - 1.0
        V = self.voltage(i, inputs.get(SPEED, 0.0), copper_W)
        if self.voltage_limit is not None and V is not None:
            out[f"voltage <= {self.voltage_limit:g} V"] = V / self.voltage_limit - 1.0
        return out


def electrics_of(series: bool, ratings: Mapping[str, float], losses: Mapping[str, float]) -> Electrics:
    """From the sections of a machine file, as far as they say it.  series : does the field carry the current?"""
    limits, brush = (ratings.get(CURRENT), ratings.get("voltage_V")), float(losses.get("brush_drop_V", 0.0))
    needed = ("power_W", SPEED, "voltage_V", CURRENT)
    if series and all(k in ratings for k in needed):
        return Electrics(*limits, brush, th.SeriesMachine.from_ratings(*(float(ratings[k]) for k in needed)))
    rated = (ratings["torque_Nm"], ratings[CURRENT]) if "torque_Nm" in ratings and CURRENT in ratings else None
    return Electrics(limits[0], None, 0.0, None, rated)


def wanted_inputs(inputs: Mapping[str, float], torque: float | None, electrics: Electrics) -> dict[str, float]:
    """Inputs with the current that a torque takes; as they are without one."""
    if torque is None:
        return dict(inputs)
    if CURRENT not in inputs:
        raise InputError("no law reads the current", "--torque", th.suggestion(CURRENT, tuple(inputs)))
    return {**inputs, CURRENT: electrics.current(torque)}
