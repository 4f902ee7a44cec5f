"""What the pictures are drawn from, besides meshes and result documents."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from measured.case import Channel, Test
from viz.colours import BLUE, LIGHT, ORANGE, VERDICT

LONG_S = 5 * 3600.0  # beyond 300 min an axis reads better in hours
LATE = "labels: measured minus model, mean of the last fifth"  # of `sensors`
POINTS = 700  # a line of a page is some 700 pixels wide


@dataclass(frozen=True)
class Sensor:
    """A thermocouple on the machine.

    xyz : position (m);  residual_K : measured - modelled, None where only the position is known
    limit_K : the largest error that counts as agreement, see validation.comparison.uncertainty
    rmse_K : error of the whole test, which decides; None where only one instant is shown
    """

    name: str
    xyz: tuple[float, float, float]
    residual_K: float | None = None
    limit_K: float = 1.0
    rmse_K: float | None = None

    @property
    def weight(self) -> float:
        """Its residual over its uncertainty; -1 where there is none."""
        has_residual = self.residual_K is not None and np.isfinite(self.residual_K)
        return abs(self.residual_K) / self.limit_K if has_residual and self.residual_K is not None else -1.0

    @property
    def verdict(self) -> str:
        """unknown, within, hot (measured above the model) or cold."""
        if self.residual_K is None or not np.isfinite(self.residual_K):
            return "unknown"
        if (abs(self.residual_K) if self.rmse_K is None else self.rmse_K) <= self.limit_K:
            return "within"
        return "hot" if self.residual_K > 0 else "cold"

    @property
    def colour(self) -> str:
        """Of its verdict: the same in pictures, curves, lists, the viewer, the report and the workbench."""
        return VERDICT[self.verdict]


@dataclass(frozen=True)
class Curve:
    """A line over a test, whatever draws it.  y : (n_time,);  ink : in the colour of writing;  dashed : of before"""

    name: str
    y: Array
    colour: str
    ink: bool = False
    dashed: bool = False


@dataclass(frozen=True)
class Comparison:
    """One test held against a model.

    model : channel name -> (n_time,) degC;  before : the same of an earlier revision, if it is to be shown
    limits : channel name -> the largest error that counts as agreement (K), as `compare` has it
    events : when something was, or may have been, different, from and to (s)
    """

    test: Test
    model: Mapping[str, Array]
    limits: Mapping[str, float]
    before: Mapping[str, Array] | None = None
    events: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        missing = [c.name for c in self.test.channels if c.name not in self.model]
        if missing:
            raise InputError(f"no model curve for {', '.join(missing)}", f"test '{self.test.name}'", "one per channel")

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Those that were read at least once."""
        return tuple(c for c in self.test.channels if np.isfinite(c.y).any())

    @property
    def clock(self) -> tuple[Array, str]:
        """Time since the start in minutes, or in hours for a long test, and the unit."""
        seconds = np.asarray(self.test.time, float)
        return (seconds / 60.0, "min") if seconds[-1] - seconds[0] < LONG_S else (seconds / 3600.0, "h")

    @property
    def thin(self) -> slice:
        """Every so many points that a line keeps at most POINTS of them: a page needs no more."""
        return slice(None, None, max(1, -(-len(self.test.time) // POINTS)))

    def residual(self, channel: Channel) -> Array:
        """Measured - modelled (K), NaN where nothing was read."""
        return np.asarray(channel.y, float) - np.asarray(self.model[channel.name], float)

    def temperatures(self, channel: Channel) -> list[Curve]:
        """What was read (degC), the model before its last step if there was one, and the model."""
        read = Curve("measured ± limit", np.asarray(channel.y, float), LIGHT.ink, ink=True)
        earlier = (
            [] if self.before is None else [Curve("earlier model", self.before[channel.name], ORANGE, dashed=True)]
        )
        return [read, *earlier, Curve("model", np.asarray(self.model[channel.name], float), BLUE)]

    def residuals(self, channel: Channel) -> list[Curve]:
        """Measured - modelled (K): of the model before its last step if there was one, and of the model."""
        read, *models = self.temperatures(channel)
        words = {"earlier model": "earlier residual", "model": "residual"}
        return [replace(m, name=words[m.name], y=read.y - m.y) for m in models]

    def residual_curve(self, channel: Channel) -> Curve:
        """Measured - modelled (K) in the colour of the sensor."""
        return Curve(short(channel.name), self.residual(channel), self.sensor(channel).colour)

    def sensor(self, channel: Channel, xyz: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Sensor:
        """The channel as its dot shows it, at a place (m)."""
        residual = self.residual(channel)
        return Sensor(channel.name, xyz, late_mean(residual), self.limit_K(channel), self.rmse(channel))

    def limit_K(self, channel: Channel) -> float:
        """The largest error of a sensor that counts as agreement (K)."""
        return self.limits[channel.name]

    def rmse(self, channel: Channel) -> float:
        return float(np.sqrt(np.nanmean(self.residual(channel) ** 2)))


def short(channel: str) -> str:
    """A column's name without what the axis says already: 'T_flange_right_degC' -> 'flange right'."""
    return channel.removeprefix("T_").removesuffix("_degC").removesuffix("_C").replace("_", " ")


UNITS = {"rpm": "1/min", "mps": "m/s", "m3h": "m³/h", "l_min": "l/min", "Nm": "N m", "percent": "%", "degC": "°C"}
UNITS |= {unit: unit for unit in ("A", "W", "V", "Hz")}  # what an input's name may end in


def stem_and_unit(name: str) -> tuple[str, str]:
    """An input's name in two: 'vehicle_speed_mps' -> 'vehicle speed', 'm/s'; without a unit that is known, ""."""
    stems = {unit: name.removesuffix(f"_{end}") for end, unit in UNITS.items()}
    unit, stem = min(stems.items(), key=lambda x: len(x[1]))
    return stem.replace("_", " "), unit * (stem != name)


def input_title(name: str) -> str:
    """An input's name with its unit as an axis has it: 'vehicle_speed_mps' -> 'vehicle speed (m/s)'."""
    stem, unit = stem_and_unit(name)
    return f"{stem} ({unit})" if unit else stem


def late_mean(residual: Array) -> float | None:
    """Mean (K) of the last fifth of a test, where the machine is warm; None where nothing was read then."""
    late = residual[int(0.8 * len(residual)) :]
    return float(np.nanmean(late)) if np.isfinite(late).any() else None


def sensors(comparison: Comparison, positions: Mapping[str, Sequence[float]]) -> tuple[Sensor, ...]:
    """Sensors of a test at their positions (m) with the mean residual of its last fifth, where the machine is warm."""
    mine = [(c, positions[c.name]) for c in comparison.channels if c.name in positions]
    return tuple(comparison.sensor(c, (x, y, z)) for c, (x, y, z) in mine)
