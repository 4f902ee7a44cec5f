"""One cell of a recording: a number with point or comma, an instant, a unit, or on and off."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date, datetime, time

from thermoscope.recordings.data_table import MISSING

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d+)?")
# Digits in threes: with a decimal part, in several groups, or with a sign between them that is no decimal sign.
GROUPED = re.compile(
    r"[-+]?[1-9]\d{0,2}(?:(?:\.\d{3})+,\d+|(?:,\d{3})+\.\d+|(?:\.\d{3}){2,}|(?:,\d{3}){2,}"
    r"|(?:['\u2019 \u00a0\u202f]\d{3})+(?:[.,]\d+)?)"
)
ONE_GROUP = re.compile(r"[-+]?[1-9]\d{0,2}([.,])\d{3}")
DECIMAL = re.compile(r"^[-+]?\d*([.,])\d+(?:[eE][-+]?\d+)?$")
CLOCK = re.compile(r"\d{1,3}:\d{2}(:\d{2})?([.,]\d+)?(\s?[AaPp][Mm])?")
DATE = re.compile(r"(\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{2,4})([T ].*)?")
EMPTY = MISSING | {
    "-", "--", "---", "n.a.", "no data", "nodata", "inf", "-inf", "overload", "ovld", "ovl", "ovf", "ol", "over",
    "overrange", "over range", "open", "error", "err", "bad", "bad input", "invalid", "????", "***", "****", "*****",
}  # fmt: skip
SWITCH = {"on": 1.0, "off": 0.0, "true": 1.0, "false": 0.0, "ein": 1.0, "aus": 0.0, "yes": 1.0, "no": 0.0,
          "an": 1.0, "running": 1.0, "stopped": 0.0}  # fmt: skip

# As written in headers of loggers, in lower case and without blanks -> as sheets write it.
SPELLED = {
    "°c": "degC", "degc": "degC", "deg.c": "degC", "gradc": "degC", "celsius": "degC", "℃": "degC", "c": "degC",
    "ºc": "degC", "degreec": "degC", "degreesc": "degC", "grdc": "degC",
    "°f": "degF", "degf": "degF", "fahrenheit": "degF", "k": "K", "kelvin": "K",
    "a": "A", "ma": "mA", "ka": "kA", "amp": "A", "amps": "A", "aeff": "A", "arms": "A",
    "v": "V", "mv": "mV", "kv": "kV", "volt": "V", "w": "W", "kw": "kW", "watt": "W", "watts": "W",
    "nm": "Nm", "n*m": "N*m", "n.m": "N*m", "n·m": "N*m", "n-m": "N*m", "knm": "kN*m",
    "rpm": "rpm", "r/min": "rpm", "u/min": "rpm", "1/min": "1/min", "min-1": "1/min", "min^-1": "1/min",
    "rev/min": "rpm", "upm": "rpm", "rad/s": "rad/s", "hz": "Hz", "khz": "kHz",
    "m/s": "m/s", "km/h": "km/h", "kmh": "km/h", "mps": "m/s",
    "kph": "km/h", "mph": "mph",
    "l/min": "l/min", "lpm": "l/min", "l/m": "l/min", "m3/h": "m3/h", "m³/h": "m3/h", "m^3/h": "m3/h", "m3/s": "m3/s",
    "m3h": "m3/h",
    "m³/s": "m3/s", "l/s": "l/s", "%": "%", "percent": "%", "pct": "%", "1": "1", "-": "1", "ohm": "ohm", "ω": "ohm",
    "Ω".lower(): "ohm", "mohm": "mohm", "mω": "mohm", "kohm": "kohm",
    "s": "s", "sec": "s", "secs": "s", "seconds": "s", "second": "s", "sek": "s", "ms": "ms", "min": "min",
    "sekunden": "s", "minuten": "min", "stunden": "h", "msec": "ms",
    "minutes": "min", "h": "h", "hours": "h", "hour": "h", "std": "h",
}  # fmt: skip
OTHER = frozenset({
    "bar", "mbar", "pa", "kpa", "g", "mm", "m", "kg", "var", "va", "kva", "db", "m/s2", "m/s²", "n", "kn", "rev", "°",
    "deg", "wh", "kwh", "mm:ss", "hh:mm", "hh:mm:ss", "hh:mm:ss.000", "dd.mm.yyyy", "yyyy-mm-dd",
})  # fmt: skip


def number(cell: object) -> float:
    """The number in a cell, nan where there is none; a decimal comma is a point, digits may stand in threes."""
    if isinstance(cell, bool):
        return float(cell)
    if isinstance(cell, int | float):
        return float(cell)
    text = str(cell).strip()
    if NUMBER.fullmatch(text):
        return float(text.replace(",", "."))
    return float(_ungrouped(text)) if GROUPED.fullmatch(text) else float("nan")


def _ungrouped(text: str) -> str:
    """1.234,5 and 1 234,5 and 1,234.5 -> 1234.5"""
    match = re.search(r"[.,](\d+)$", text)
    last = "" if match is None or text.count(match[0][0]) > 1 else match[0]
    return re.sub(r"[^\d+-]", "", text.removesuffix(last)) + last.replace(",", ".")


def in_thousands(columns: Sequence[Sequence[object]]) -> dict[int, list[object]]:
    """Columns whose points, or commas, stand between thousands, without them: where all others have decimal commas,
    1.500 is 1500.  columns : cells of a text file; a file with both decimal signs says nothing"""
    text = {j: [c for c in cells if isinstance(c, str)] for j, cells in enumerate(columns)}
    marked = {j: signed for j, cells in text.items() if (signed := [c for c in cells if "," in c or "." in c])}
    groups = {j: sign for j, cells in marked.items() if (sign := _grouping(cells))}
    decimals = {m[1] for j, cells in marked.items() if j not in groups for c in cells if (m := DECIMAL.search(c))}
    if len(decimals) != 1:
        return {}
    return {
        j: [c.replace(sign, "") if isinstance(c, str) else c for c in columns[j]]
        for j, sign in groups.items() if sign not in decimals
    }  # fmt: skip


def _grouping(cells: Sequence[str]) -> str:
    """The sign that stands before three digits in every cell that has one, "" if a cell says otherwise."""
    if not ONE_GROUP.fullmatch(cells[0].strip()):
        return ""  # most columns
    signs = {match[1] if (match := ONE_GROUP.fullmatch(c.strip())) else "" for c in cells}
    return signs.pop() if len(signs) == 1 else ""


def is_clock(cell: object) -> bool:
    """A time of day, or minutes and seconds."""
    return isinstance(cell, time) or bool(CLOCK.fullmatch(str(cell).strip()))


def is_date(cell: object) -> bool:
    """A date, with or without a time of day and a zone."""
    return isinstance(cell, datetime | date) or bool(DATE.fullmatch(str(cell).strip()))


def is_reading(cell: object) -> bool:
    """A number, an instant, on or off, or one of the ways to write that there is none."""
    if isinstance(cell, int | float | datetime | date | time):
        return True
    text = str(cell).strip()
    if NUMBER.fullmatch(text) or GROUPED.fullmatch(text):
        return True
    return text.lower() in EMPTY | SWITCH.keys() or is_clock(text) or is_date(text)


def unit_of(text: str) -> str:
    """A unit as sheets write it, "" where it is none that is known."""
    return SPELLED.get(text.strip().strip("[]()").replace(" ", "").lower(), "")


def is_unit(text: str) -> bool:
    """Is it a unit, also one that no column of a sheet has?"""
    return bool(unit_of(text)) or text.strip().strip("[]()").lower() in OTHER


BRACKETED = re.compile(r"^(.*?)\s*[\[(<{]([^\])>}]+)[\])>}]\s*(.*)$")
TRAILING = re.compile(r"^(.*?)(?:_|\s*/\s*|\s+in\s+|,\s*|\s+)([^\s_/]+(?:/[a-z0-9]+)?)$")


def split_unit(header: str) -> tuple[str, str]:
    """A header without its unit, and the unit: "T1 [°C]", "Speed (1/min)", "T_yoke / °C", "t in s", "speed_rpm"."""
    if (match := BRACKETED.match(header)) and is_unit(match[2]):
        return f"{match[1]} {match[3]}".strip(), unit_of(match[2])
    if (match := TRAILING.match(header)) and match[1] and _surely(match[2]):
        return match[1].strip(), unit_of(match[2])
    return header.strip(), ""


def _surely(word: str) -> bool:
    """A word that is a unit and hardly the name of a phase, a winding or a sensor (A, C, K, V, W, 1)."""
    return (bool(unit_of(word)) and (len(word) > 1 or word == "%")) or word in ("s", "A", "V", "W", "K", "C", "h")
