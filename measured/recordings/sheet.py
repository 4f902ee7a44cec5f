"""The sheet beside a recording: what each column is. tests/NAME.toml, read key by key."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.description.toml_file import read_toml
from geom.errors import InputError
from lumped.schemas.bounds import TINY
from lumped.schemas.reader import Table
from lumped.transfer.laws import CLOCK
from measured.recordings.data_table import twice
from measured.recordings.electrical import QUANTITIES as ELECTRICAL, Electrical, read_electrical
from measured.recordings.events import Events, read_events
from measured.recordings.units import QUANTITIES, checked_input, checked_unit, converted, memory_quantity, usual_sigma

FIRST = "first-readings"
MAX_GAP_S = 120.0  # over which an input is drawn straight; machines move little in two minutes
SENSORS = {"thermocouple": 0.5, "pt100": 0.3, "ntc": 0.5, "resistance": 2.0, "infrared": 2.0}  # usual 1-sigma, K


@dataclass(frozen=True)
class Column:
    """One column of the recording; `feeds` is the network input it drives, "" for a temperature.

    sigma_K, lag_s : of the sensor;  position_mm : (x, y, z) on the machine where known;  where : its table in the file
    label : its name in the recording;  electrical : how a resistance or a voltage becomes a temperature
    sigma : standard deviation in `unit`, of a sensor that does not read degC;  settings : what the sheet says of that
    """

    name: str
    quantity: str
    unit: str
    place: str
    feeds: str
    sigma_K: float
    lag_s: float
    position_mm: tuple[float, ...]
    where: str
    label: str = ""
    electrical: Electrical | None = None
    sigma: float = 0.0
    settings: Mapping[str, float] = field(default_factory=dict)

    def in_memory(self, read: Array) -> Array:
        """Readings (in `unit`) in the unit of memory, of a sensor degC."""
        return converted(read, self.quantity, self.unit, self.settings)

    def deviation_K(self, read: Array) -> float:
        """What `sigma` is in kelvin: by the slope of the sensor's curve at its readings, rms."""
        above, below = self.in_memory(read + self.sigma), self.in_memory(read - self.sigma)
        return float(np.sqrt(np.nanmean(np.square(0.5 * (above - below)))))

    @property
    def is_temperature(self) -> bool:
        return self.electrical is not None or of_temperature(self.quantity)

    @property
    def header(self) -> str:
        """The column's name in the recording."""
        return self.label or self.name


def of_temperature(quantity: str) -> bool:
    """Does such a column say how warm something is?"""
    return quantity == "temperature" or QUANTITIES[quantity].degC is not None


@dataclass(frozen=True)
class Mean:
    """A channel that averages columns, e.g. a winding from two thermocouples."""

    name: str
    of: tuple[str, ...]
    place: str
    sigma_K: float
    lag_s: float
    where: str


@dataclass(frozen=True)
class Recorder:
    """A second recording of the same test: its file, its time column, and how its clock stands to the first one's.

    shift_s : to add to its times;  align : (column here, column there) that show the same and so give the shift
    """

    file: Path
    time: str
    time_unit: str
    worksheet: str
    shift_s: float
    align: tuple[str, ...]
    limit_s: float
    where: str


@dataclass(frozen=True)
class Sheet:
    """time : column of the times, or "" when rows are `period_s` apart;  initial : degC, per place, or "first-readings"

    squares : input -> columns of which it is the root of the sum of squares, e.g. a current from its dq components
    inputs, boundaries : what stayed constant and was not recorded
    events : input -> when it was switched;  from_s, to_s : the part of the recording that is the test
    [test] filter_s, the time constant of a filter in the recorder, is added to the lag of every temperature
    """

    where: str
    time: str
    time_unit: str
    period_s: float
    description: str
    initial: float | Mapping[str, float] | str
    max_gap_s: float
    columns: tuple[Column, ...]
    means: tuple[Mean, ...] = ()
    squares: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    inputs: Mapping[str, float] = field(default_factory=dict)
    boundaries: Mapping[str, float] = field(default_factory=dict)
    worksheet: str = ""
    recorders: Mapping[str, Recorder] = field(default_factory=dict)
    events: Mapping[str, Events] = field(default_factory=dict)
    from_s: float = 0.0
    to_s: float = inf


def load_sheet(path: Path) -> Sheet:
    """A sheet; with `columns_of` its columns and means are those of another sheet in the same folder."""
    data = read_toml(path, "a sheet with [test] and [columns.NAME]")
    other = Table(data.get("test", {}), f"{path} [test]").word("columns_of", "")
    if other:
        template = read_toml(path.parent / other, f"the sheet that {path} takes its columns from")
        data = {**{key: template[key] for key in ("columns", "means", "root_sum_square") if key in template}, **data}
    return read_sheet(data, str(path), path.parent)


def read_sheet(data: Mapping[str, Any], where: str, folder: Path = Path(), head: str = "test") -> Sheet:
    """A sheet; InputError for unknown keys, forgotten units and contradictions.  head : the table of its clock"""
    top = Table(data, where)
    test, columns, means = top.table(head), top.tables("columns"), top.tables("means")
    inputs, boundaries = top.table("inputs").constants("inputs"), top.table("boundaries").constants("boundaries")
    squares, recorders, events = top.table("root_sum_square"), top.tables("recorders"), top.tables("events")
    top.close()
    period = test.number("period_s") if "period_s" in test else 0.0
    test.word("columns_of", "")
    filtered = test.number("filter_s", 0.0)
    time_unit = checked_unit("time", test.raw("time_unit", "s"), test.where)
    sheet = Sheet(
        where,
        "" if period else test.word("time"),
        time_unit,
        period,
        test.word("description", ""),
        _initial(test),
        test.number("max_gap_s", MAX_GAP_S),
        tuple(c for name, table in columns.items() if (c := _column(name, table, filtered, folder)) is not None),
        tuple(_mean(name, table, filtered) for name, table in means.items()),
        {name: squares.members(name) for name in squares.data},
        inputs,
        boundaries,
        test.word("worksheet", ""),
        {name: _recorder(table, folder) for name, table in recorders.items()},
        {name: read_events(name, table, folder) for name, table in events.items()},
        *_window(test),
    )
    test.close()
    if not sheet.columns:
        raise InputError("no columns", where, "[columns.NAME] with quantity, unit and place")
    _declared_once(sheet)
    return sheet


def _declared_once(sheet: Sheet) -> None:
    """InputError for an input fed twice, a sensor declared twice, a mean that takes a column's name."""
    inputs = [c.feeds for c in sheet.columns if c.feeds]
    if CLOCK in (*inputs, *sheet.inputs, *sheet.squares, *sheet.events):
        raise InputError(f"input '{CLOCK}' is the clock of the test itself", sheet.where, "another name for it")
    for name in twice([*inputs, *sheet.inputs, *sheet.squares, *sheet.events]):
        raise InputError(
            f"input '{name}' is fed twice", sheet.where, "one column or constant per input: use = false for the others"
        )
    for header in twice(c.header for c in sheet.columns if c.is_temperature):
        tables = " and ".join(f"[columns.{c.name}]" for c in sheet.columns if c.header == header and c.is_temperature)
        raise InputError(f"{tables} are one column, '{header}'", sheet.where, "one table per sensor")
    for name in twice([*(c.name for c in sheet.columns), *(m.name for m in sheet.means)]):
        raise InputError(f"'{name}' is a column and a mean", sheet.where, "a name of its own for the mean")


def _window(test: Table) -> tuple[float, float]:
    """From and to (s from the recording's first row)."""
    start, end = test.number("from_s", 0.0), test.number("to_s") if "to_s" in test else inf
    if start >= end:
        raise test.error(f"from_s = {start:g} is not before to_s = {end:g}", "from_s below to_s")
    return start, end


def _initial(test: Table) -> float | Mapping[str, float] | str:
    value = test.raw("initial", FIRST)
    if isinstance(value, Mapping):
        return test.shares("initial", of="initial")
    return test.word("initial", FIRST, [FIRST]) if isinstance(value, str) else test.number("initial")


def _column(name: str, table: Table, filtered: float, folder: Path) -> Column | None:
    if not table.flag("use", True):
        return None
    of = table.kind("quantity", None, QUANTITIES)
    unit, hot = checked_unit(of, table.raw("unit"), table.where), of_temperature(of) or of in ELECTRICAL
    electrical = read_electrical(of, name, table, folder) if of in ELECTRICAL else None
    kind = table.kind("sensor", "resistance" if electrical else "thermocouple", SENSORS)
    place, feeds = table.word("place", None if hot else ""), "" if hot else table.word("input", QUANTITIES[of].feeds)
    of = of if hot else memory_quantity(of, checked_input(of, feeds, table.where))
    sigma, settings = _kind_settings(of, unit, table)
    usual = 0.0 if electrical or sigma else SENSORS[kind]
    sigma_K = table.number("sigma_K") if "sigma_K" in table else usual
    lag, header = table.number("lag_s", 0.0) + filtered, table.word("column", name)
    position = table.numbers("position_mm", [])
    if len(position) not in (0, 3):
        raise table.error(f"position_mm has {len(position)} numbers", "position_mm = [x, y, z]")
    table.close()
    return Column(
        name, of, unit, place, feeds, sigma_K, lag, position, table.where, header, electrical, sigma, settings
    )


def _kind_settings(of: str, unit: str, table: Table) -> tuple[float, dict[str, float]]:
    """Standard deviation in the unit of the column, 0 where it is said in kelvin, and settings; of a sensor's kind."""
    quantity = QUANTITIES[of]
    settings = {name: table.number(name, usual) for name, usual in quantity.settings.items()}
    if quantity.degC is None or ("sigma_K" in table and "sigma" not in table):
        return 0.0, settings
    if "sigma_K" in table:
        raise table.error("sigma and sigma_K are both given", f"sigma ({unit}), or sigma_K of the temperature")
    return table.number("sigma", usual_sigma(of, unit), low=TINY), settings


def _recorder(table: Table, folder: Path) -> Recorder:
    align = table.words("align", [])
    if len(align) not in (0, 2):
        raise table.error(
            f"align = {list(align)}", "align = [a column of the test, one of this recorder that shows the same]"
        )
    recorder = Recorder(
        folder / table.word("file"),
        table.word("time", "time_s"),
        checked_unit("time", table.raw("time_unit", "s"), table.where),
        table.word("worksheet", ""),
        table.number("shift_s", 0.0),
        align,
        table.number("limit_s", 120.0),
        table.where,
    )
    table.close()
    return recorder


def _mean(name: str, table: Table, filtered: float) -> Mean:
    of, place = table.members("of"), table.word("place")
    sigma, lag = table.number("sigma_K", 0.5), table.number("lag_s", 0.0) + filtered
    table.close()
    return Mean(name, of, place, sigma, lag, table.where)
