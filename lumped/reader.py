"""Tables of a TOML file read key by key: what is left over is an error that names the key and what would be right."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

from geom.errors import InputError
from lumped.schema import meaning


def known(word: str, words: Iterable[str]) -> str:
    """'did you mean ...? known: ...' for an error message; a stem without its unit finds the full key."""
    names = sorted(set(words))
    with_unit = [n for n in names if n.lower().startswith(f"{word}_".lower())]
    near = with_unit or difflib.get_close_matches(word, names, n=1)
    hint = f"did you mean '{near[0]}'? " if near else ""
    return f"{hint}known: {', '.join(names)}"


class Table:
    """One table of a TOML file. Every key asked for is known; `close` refuses the others."""

    def __init__(self, data: Any, where: str) -> None:
        if not isinstance(data, Mapping):
            raise InputError(f"{data!r} is no table", where, "key = value pairs")
        self.data, self.where = data, where
        self.asked: set[str] = set()

    def __contains__(self, key: str) -> bool:
        self.asked.add(key)
        return key in self.data

    def close(self) -> None:
        """Refuse keys nobody asked for."""
        for key in self.data:
            if key not in self.asked:
                raise InputError(f"unknown key '{key}'", self.where, known(key, self.asked))

    def error(self, what: str, right: str) -> InputError:
        return InputError(what, self.where, right)

    def raw(self, key: str, default: Any = None) -> Any:
        self.asked.add(key)
        return self.data.get(key, default)

    def _needed(self, key: str, default: Any, right: str) -> Any:
        value = self.raw(key, default)
        if value is None:
            given = ", ".join(self.data) or "nothing"
            raise self.error(f"key '{key}' is missing (given: {given})", f"{key} = {right}{meaning(key)}")
        return value

    def number(self, key: str, default: float | None = None, low: float = 0.0, high: float = float("inf")) -> float:
        """A finite number between low and high (default: not negative)."""
        value = self._needed(key, default, "a number")
        if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
            raise self.error(f"{key} = {value!r} is not possible", f"a number from {low:g} to {high:g}{meaning(key)}")
        return float(value)

    def numbers(self, key: str, default: list[float] | None = None) -> tuple[float, ...]:
        value = self._needed(key, default, "[numbers]")
        if not isinstance(value, list) or not all(
            isinstance(v, int | float) and not isinstance(v, bool) for v in value
        ):
            raise self.error(f"{key} = {value!r} is not possible", "a list of numbers")
        return tuple(float(v) for v in value)

    def word(self, key: str, default: str | None = None, allowed: Iterable[str] | None = None) -> str:
        value = self._needed(key, default, "a word")
        choices = None if allowed is None else list(allowed)
        if not isinstance(value, str) or (choices is not None and value not in choices):
            right = "a word" if choices is None else known(str(value), choices)
            raise self.error(f"{key} = {value!r} is not possible", f"{right}{meaning(key)}")
        return value

    def flag(self, key: str) -> bool:
        value = self._needed(key, None, "true or false")
        if not isinstance(value, bool):
            raise self.error(f"{key} = {value!r} is not possible", f"true or false{meaning(key)}")
        return value

    def words(self, key: str, default: list[str] | None = None) -> tuple[str, ...]:
        value = self._needed(key, default, "[words]")
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise self.error(f"{key} = {value!r} is not possible", "a list of words")
        return tuple(value)

    def shares(self, key: str) -> dict[str, float]:
        """A name, or a table of name -> number."""
        value = self._needed(key, None, '"node" or { node = share, ... }')
        if isinstance(value, str):
            return {value: 1.0}
        table = Table(value, f"{self.where}.{key}")
        return {name: table.number(name, low=-1e12) for name in value}

    def table(self, key: str) -> Table:
        return Table(self.raw(key, {}), f"{self.where}.{key}" if self.where.endswith("]") else f"{self.where} [{key}]")

    def tables(self, key: str) -> dict[str, Table]:
        """The named tables under a key: [key.NAME]."""
        return {
            name: Table(data, f"{self.where} [{key}.{name}]")
            for name, data in Table(self.raw(key, {}), key).data.items()
        }

    def listed(self, key: str) -> list[Table]:
        """A list of tables, or one table."""
        value = self.raw(key, [])
        items = [value] if isinstance(value, Mapping) else value
        if not isinstance(items, list):
            raise self.error(f"{key} = {value!r} is not possible", f"{key} = [{{ ... }}, ...]")
        return [Table(item, f"{self.where} {key}[{i}]") for i, item in enumerate(items)]


def powers(table: Table, key: str = "of") -> tuple[tuple[str, float, float], ...]:
    """[{ input = ..., at = ..., exponent = ... }]: |input / at| ** exponent each."""
    out = []
    for item in table.listed(key):
        out.append((item.word("input"), item.number("at", 1.0, low=1e-12), item.number("exponent", 1.0, low=-10)))
        item.close()
    return tuple(out)
