"""Tables of a TOML file read key by key: what is left over is an error that names the key and what would be right."""

import difflib
from collections.abc import Iterable, Mapping
from typing import Any

from geom.description.names import most_letters, plain_name
from geom.errors import InputError
from lumped.schemas.bounds import Bounds, bounds
from lumped.schemas.schema import meaning

SHORT = 60  # characters of a wrong value that a message repeats
# Keys whose words are sentences or ways to files; all others are names.
FREE = ("description", "guesses", "source", "why", "reason", "file", "sheet", "machine", "network", "columns_of")


def suggestion(word: str, words: Iterable[str], before: str = "known") -> str:
    """'did you mean ...? known: ...' for an error message; a stem without its unit finds the full key."""
    names = sorted(set(words))
    with_unit = [n for n in names if n.lower().startswith(f"{word}_".lower())]
    near = with_unit or difflib.get_close_matches(word, names, n=1)
    hint = f"did you mean '{near[0]}'? " if near else ""
    return f"{hint}{before}: {', '.join(names)}"


def excerpt(value: Any) -> str:
    """A value as a message repeats it: one line, not longer than SHORT."""
    text = repr(value)
    return text if len(text) <= SHORT else f"{text[: SHORT - 4]} ..."


class Table:
    """One table of a TOML file. Every key asked for is known; `close` refuses the others."""

    def __init__(self, data: Any, where: str) -> None:
        if not isinstance(data, Mapping):
            raise InputError(f"{excerpt(data)} is not a table", where, "key = value pairs")
        self.data, self.where = data, where
        self.requested: set[str] = set()

    def __contains__(self, key: str) -> bool:
        self.requested.add(key)
        return key in self.data

    def close(self) -> None:
        """Refuse keys nobody asked for."""
        for key in self.data:
            if key not in self.requested:
                raise InputError(f"unknown key '{key}'", self.where, suggestion(key, self.requested))

    def error(self, what: str, right: str) -> InputError:
        return InputError(what, self.where, right)

    def raw(self, key: str, default: Any = None) -> Any:
        self.requested.add(key)
        return self.data.get(key, default)

    def _needed(self, key: str, default: Any, right: str) -> Any:
        value = self.raw(key, default)
        if value is None:
            keys = ", ".join(self.data) or "nothing"
            raise self.error(f"key '{key}' is missing (given: {keys})", f"{key} = {right}{meaning(key)}")
        return value

    def number(
        self, key: str, default: float | None = None, low: float | None = None, high: float | None = None, of: str = ""
    ) -> float:
        """A finite number within the bounds of its key (bounds.py), or of the key `of` where names are the user's.

        low, high : narrower, where this place asks for more
        """
        value = self._needed(key, default, "a number")
        return default if value is default and default is not None else self._bounded(key, value, of, low, high)

    def _bounded(self, key: str, value: Any, of: str, low: float | None = None, high: float | None = None) -> float:
        table = bounds(of or key)
        least = table.low if low is None else max(low, table.low)
        range_ = Bounds(least, table.high if high is None else min(high, table.high), table.whole)
        if not range_.hold(value):
            raise self.error(f"{key} = {excerpt(value)} is not possible", f"{range_.words}{meaning(key)}")
        return float(value)

    def numbers(self, key: str, default: list[float] | None = None, of: str = "") -> tuple[float, ...]:
        """A list of numbers, each within the bounds of the key."""
        value = self._needed(key, default, "[numbers]")
        if not isinstance(value, list):
            raise self.error(f"{key} = {excerpt(value)} is not possible", "a list of numbers")
        return tuple(self._bounded(f"{key}[{i}]", v, of or key) for i, v in enumerate(value))

    def rows(self, key: str, of: str = "") -> list[tuple[float, ...]]:
        """A list of lists of numbers."""
        value = self._needed(key, None, "[[numbers], ...]")
        if not isinstance(value, list) or not all(isinstance(row, list) for row in value):
            raise self.error(f"{key} = {excerpt(value)} is not possible", "a list of lists of numbers")
        cells = [[(f"{key}[{i}][{j}]", v) for j, v in enumerate(row)] for i, row in enumerate(value)]
        return [tuple(self._bounded(cell, v, of or key) for cell, v in row) for row in cells]

    def word(self, key: str, default: str | None = None, options: Iterable[str] | None = None) -> str:
        value = self._needed(key, default, "a word")
        choices = None if options is None else list(options)
        if not isinstance(value, str) or (choices is not None and value not in choices):
            right = "a word" if choices is None else suggestion(str(value), choices)
            raise self.error(f"{key} = {excerpt(value)} is not possible", f"{right}{meaning(key)}")
        return value if key in FREE else plain_name(value, f"{self.where} {key}", most_letters(key))

    def kind(self, key: str, default: str | None, options: Iterable[str]) -> str:
        """One of our own words; capitals do not matter."""
        value, choices = self._needed(key, default, "a word"), {word.lower(): word for word in options}
        if isinstance(value, str) and value.lower() in choices:
            return choices[value.lower()]
        return self.word(key, default, choices.values())

    def words(self, key: str, default: list[str] | None = None) -> tuple[str, ...]:
        value = self._needed(key, default, "[words]")
        if not isinstance(value, list) or not all(isinstance(v, str) for v in value):
            raise self.error(f"{key} = {excerpt(value)} is not possible", "a list of words")
        return tuple(plain_name(v, f"{self.where} {key}", most_letters(key)) for v in value)

    def members(self, key: str) -> tuple[str, ...]:
        """A list of words of which none is empty or comes twice, and that holds one at least."""
        words = self.words(key)
        again = next((w for i, w in enumerate(words) if w in words[:i] or not w.strip()), None)
        if not words or again is not None:
            what = f"names {excerpt(again)} twice" if words and again and again.strip() else "names nothing"
            raise self.error(f"{key} = {excerpt(list(words))} {what}", f"{key} = [one name or more, each once]")
        return words

    def shares(self, key: str, of: str = "shares") -> dict[str, float]:
        """A name, or a table of name -> number, each within the bounds of `of`."""
        value = self._needed(key, None, '"node" or { node = share, ... }')
        if isinstance(value, str):
            return {value: 1.0}
        table = Table(value, f"{self.where}.{key}")
        return {name: table.number(name, of=of) for name in value}

    def flag(self, key: str, default: bool | None = None) -> bool:
        """true or false; a word that says so is none."""
        value = self._needed(key, default, "true or false")
        if not isinstance(value, bool):
            right = f"true or false, without quotes{meaning(key)}"
            raise self.error(f"{key} = {excerpt(value)} is not possible", right)
        return value

    def constants(self, of: str) -> dict[str, float]:
        """All of the table as name -> number, each within the bounds of `of`."""
        return {name: self.number(name, of=of) for name in self.data}

    def table(self, key: str) -> "Table":
        return Table(self.raw(key, {}), f"{self.where}.{key}" if self.where.endswith("]") else f"{self.where} [{key}]")

    def tables(self, key: str) -> "dict[str, Table]":
        """The named tables under a key: [key.NAME]."""
        whole = Table(self.raw(key, {}), f"{self.where} [{key}]")
        return {name: Table(data, f"{self.where} [{key}.{name}]") for name, data in whole.data.items()}

    def listed(self, key: str) -> "list[Table]":
        """A list of tables, or one table."""
        value = self.raw(key, [])
        items = [value] if isinstance(value, Mapping) else value
        if not isinstance(items, list):
            raise self.error(f"{key} = {excerpt(value)} is not possible", f"{key} = [{{ ... }}, ...]")
        return [Table(item, f"{self.where} {key}[{i}]") for i, item in enumerate(items)]


def powers(table: Table, key: str = "of") -> tuple[tuple[str, float, float], ...]:
    """[{ input = ..., at = ..., exponent = ... }]: |input / at| ** exponent each."""
    out = []
    for item in table.listed(key):
        out.append((item.word("input"), item.number("at", 1.0), item.number("exponent", 1.0)))
        item.close()
    return tuple(out)
