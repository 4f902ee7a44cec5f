"""Inputs that are switched, not sampled, such as a fan on and off: instants, and what holds from then on."""

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from lumped.schemas.bounds import bounds
from lumped.schemas.reader import Table, excerpt
from measured.recordings.data_table import as_number, is_missing, numbers

WORDS = {"on": 1.0, "off": 0.0}


@dataclass(frozen=True)
class Events:
    """at_s (n,) from the start of the recording, rising, the first at 0;  value (n,) from then on."""

    at_s: Array
    value: Array

    def mean(self, grid: Array, start_s: float = 0.0) -> Array:
        """(n_time,) mean of the input around each instant, exactly; start_s : where the test was cropped."""
        half = 0.5 * float(grid[1] - grid[0])
        low = np.maximum(grid - half, grid[0]) + start_s
        high = np.minimum(grid + half, grid[-1]) + start_s
        return (self._integral(high) - self._integral(low)) / (high - low)

    def _integral(self, t: Array) -> Array:
        """From the first event to each instant."""
        sums = np.concatenate([[0.0], np.cumsum(self.value[:-1] * np.diff(self.at_s))])
        i = np.searchsorted(self.at_s, t, side="right") - 1
        return np.asarray(sums[i] + self.value[i] * (t - self.at_s[i]))


def read_events(name: str, table: Table, folder: Path) -> Events:
    """[events.NAME] with at_s and value, or with a file of columns time_s and NAME."""
    if "file" in table:
        path = folder / table.word("file")
        table.close()
        return _checked(*_of_file(path, name), str(path))
    at, values = table.numbers("at_s"), table.raw("value")
    table.close()
    if not isinstance(values, list) or len(values) != len(at):
        raise table.error(
            f"at_s has {len(at)} instants, value is {excerpt(values)}",
            'value = ["off", "on", ...] or numbers, one for each instant',
        )
    return _checked(list(at), [_value(v, table.where) for v in values], table.where)


def _value(word: Any, where: str) -> float:
    number = WORDS.get(word.strip().lower()) if isinstance(word, str) else word
    if number is None or not bounds("inputs").hold(number):
        raise InputError(
            f"{excerpt(word)} is not a state of an input", where, f'"on", "off", or {bounds("inputs").words}'
        )
    return float(number)


def _of_file(path: Path, name: str) -> tuple[list[float], list[float]]:
    """Instants and values of a CSV; rows without a value for this input are those of other inputs."""
    from measured.recordings.formats import read_recording, recording

    table = read_recording(recording(path), least=1)
    table.require(("time_s", name), str(path))
    rows = [(t, v) for t, v in zip(numbers(table, "time_s", path), table[name], strict=True) if not is_missing(v)]
    return [float(t) for t, _ in rows], [
        _value(v if (plain := as_number(v)) is None else plain, str(path)) for _, v in rows
    ]


def _checked(at: list[float], values: list[float], where: str) -> Events:
    if not at or at[0] != 0.0:
        raise InputError(
            "the first event is not at the start, so what held before it is unknown",
            where,
            "at_s = [0, ...] with the state at the start",
        )
    if not all(b > a for a, b in itertools.pairwise(at)):
        raise InputError("events do not follow each other in time", where, "at_s that rises, a time for each")
    return Events(np.array(at), np.array(values))
