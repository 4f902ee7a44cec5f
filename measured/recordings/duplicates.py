"""What a sheet may say only once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import TYPE_CHECKING

from geom.errors import InputError
from lumped.transfer.laws import CLOCK

if TYPE_CHECKING:
    from measured.recordings.sheet import Sheet


def twice(names: Iterable[str]) -> list[str]:
    """The names that come more than once."""
    return [name for name, count in Counter(names).items() if count > 1]


def declared_once(sheet: Sheet) -> None:
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
