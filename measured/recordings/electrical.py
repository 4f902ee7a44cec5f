"""Columns that are temperatures only after a calculation: a winding's resistance, the back-EMF of magnets.

[columns.R_winding]
quantity = "resistance"
unit = "ohm"
place = "winding.copper"                               # a mean over the winding, see the network's places
cold = { reading = 2.86, at_degC = 20.8 }
meter = { percent = 0.25, offset = 0.002, resolution = 0.002, range = [0.4, 4.0] }
coefficient_percent_K = [0.392, 0.393]                 # range of beta
after = { file = "m2-cooling.csv", time = "time_s", method = "exponentials", ambient_degC = 21.0 }

`after` are readings taken while the machine cools; what they say of the instant of switching off stands at the end of
the record. Without sigma_K the channel's uncertainty is that of the hottest reading, by the GUM.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from lumped.schemas.reader import Table
from measured.electrical.meters import OHMMETER, VOLTMETER, Meter, Range
from measured.electrical.propagation import PropagatedUncertainty, Reading
from measured.electrical.readings import COPPER, NDFEB, Magnets, Saturation, Winding
from measured.electrical.switch_off import Cooling, Extrapolated, exponentials, rule_150, semilog, semilog_at
from measured.recordings.data_table import pairs
from measured.recordings.formats import read_recording, recording

QUANTITIES = ("resistance", "back_emf")
LEAST_K = 0.1  # no meter makes a channel surer than that
METHODS: Mapping[str, Callable[[Cooling, float], Extrapolated]] = {
    "exponentials": lambda cooling, rated: exponentials(cooling),
    "150 %": lambda cooling, rated: rule_150(cooling),
    "semi-logarithmic": lambda cooling, rated: semilog_at(cooling),
    "IEC 60034-1": semilog,
}


@dataclass(frozen=True)
class After:
    """Readings after switching off: where they are, and how they are carried back."""

    file: Path
    time: str
    column: str
    worksheet: str
    method: str
    ambient: float
    rated_kW: float
    where: str

    def at_switch_off(self, winding: Winding) -> Extrapolated:
        """The winding's mean (degC) when the motor was switched off."""
        file = recording(self.file)
        table = read_recording(file, self.worksheet)
        for name in (self.time, self.column):
            if name not in table.columns:
                raise InputError(
                    f"column '{name}' is not in {self.file.name}", self.where, f"known: {', '.join(table.columns)}"
                )
        read = pairs(table, self.time, self.column, file)
        sd = winding.reading_sd(float(np.median(read[:, 1])))
        cooling = Cooling(read[:, 0], winding.temperature(read[:, 1]), self.ambient, sd)
        return METHODS[self.method](cooling, self.rated_kW)


@dataclass(frozen=True)
class Electrical:
    """How readings of one column become temperatures (degC)."""

    source: Winding | Magnets
    rpm: float
    after: After | None

    def temperature(self, values: Array) -> Array:
        """Mean temperature of the winding or of the magnets for every reading; the switch-off value at the end."""
        if isinstance(self.source, Magnets):
            return _where_read(values, lambda v: self.source.temperature(v, self.rpm))  # type: ignore[union-attr,call-arg]
        out = _where_read(values, self.source.temperature)
        if self.after is not None:
            out[-1] = self.after.at_switch_off(self.source).value
        return out

    def uncertainty(self, values: Array) -> PropagatedUncertainty:
        """Of the reading farthest from the cold one."""
        cold = self.source.cold_ohm if isinstance(self.source, Winding) else self.source.cold_V
        hottest = float(values[np.nanargmax(np.abs(values - cold))]) if np.isfinite(values).any() else cold
        return self.source.rise(hottest) if isinstance(self.source, Winding) else self.source.rise(hottest, self.rpm)

    def sigma(self, values: Array) -> float:
        """1-sigma (K) of the channel."""
        return max(self.uncertainty(values).sd, LEAST_K)


def _where_read(values: Array, temperature: Callable[[Array], Array]) -> Array:
    out = np.full(values.size, np.nan)
    finite = np.isfinite(values)
    out[finite] = temperature(values[finite])
    return out


def read_electrical(quantity: str, name: str, table: Table, folder: Path) -> Electrical:
    """The calculation that a column's table declares."""
    cold = table.table("cold")
    if not cold.data:
        raise table.error("no cold reading", "cold = { reading = ..., at_degC = ... }, taken before the test")
    reading, at = cold.number("reading"), cold.number("at_degC", of="cold.at_degC")
    rpm = cold.number("rpm", 1.0) if quantity == "back_emf" else 1.0
    cold.close()
    meter = meter_of(table, "meter", OHMMETER if quantity == "resistance" else VOLTMETER)
    coefficient = _coefficient(table, COPPER if quantity == "resistance" else NDFEB)
    if quantity == "back_emf":
        magnets = Magnets(reading, at, rpm, meter, coefficient, saturation_of(table))
        return Electrical(magnets, table.number("speed_rpm", rpm), None)
    reference = table.number("reference_degC") if "reference_degC" in table else None
    winding = Winding(reading, at, meter, coefficient, reference)
    return Electrical(winding, 0.0, _after(table, name, folder))


def meter_of(table: Table, key: str, usual: Meter) -> Meter:
    """A meter by its data sheet: one table of limits, or a list of them, one per range."""
    value = table.raw(key)
    if not value:
        return usual
    rows = value if isinstance(value, list) else [value]
    return Meter("meter", usual.unit, tuple(_range(Table(row, f"{table.where} {key}")) for row in rows))


def _range(data: Table) -> Range:
    span = data.numbers("range", [0.0, 1e12])
    if len(span) != 2 or not span[0] < span[1]:
        raise data.error(f"range = {list(span)} is not possible", "range = [lowest, highest]")
    offset = data.number("offset", 0.0)
    one = Range(*span, data.number("percent", 0.0), offset, data.number("resolution", offset))
    data.close()
    return one


def _coefficient(table: Table, usual: Reading) -> Reading:
    if "coefficient_percent_K" not in table:
        return usual
    values = table.numbers("coefficient_percent_K")
    if len(values) not in (1, 2) or any(v == 0 for v in values):
        raise table.error(f"coefficient_percent_K = {list(values)}", "one number, or [lowest, highest]")
    return Reading(usual.name, sum(values) / len(values) / 100.0, abs(values[-1] - values[0]) / 200.0)


def saturation_of(table: Table) -> Saturation | None:
    """saturation = { emf_V = [...], remanence_T = [...] }, both rising; None where it is not given."""
    data = table.table("saturation")
    if not data.data:
        return None
    curve = Saturation(data.numbers("emf_V"), data.numbers("remanence_T"))
    data.close()
    return curve


def _after(table: Table, name: str, folder: Path) -> After | None:
    data = table.table("after")
    if not data.data:
        return None
    after = After(
        folder / data.word("file"),
        data.word("time", "time_s"),
        data.word("column", name),
        data.word("worksheet", ""),
        data.word("method", "exponentials", METHODS),
        data.number("ambient_degC"),
        data.number("rated_kW", 50.0),
        data.where,
    )
    data.close()
    return after
