"""One table of results: terminal, pages, workbooks, JSON and DataFrames show the same one."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from html import escape
from typing import Any, ClassVar

from geom.errors import MissingDependency

MOST_ROWS = 30  # of a table in a notebook


@dataclass(frozen=True)
class Table:
    """columns : in the order they are shown;  rows : most important first;  marked : words that make a row stand out

    keep : columns that a narrow medium leaves out last, after the first one
    folded : the column that is never left out, and the first to be broken into lines
    """

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Any]]
    marked: Sequence[str] = ()
    keep: Sequence[str] = ()
    folded: str = ""

    @classmethod
    def of(
        cls,
        title: str,
        records: Iterable[Any],
        columns: str,
        marked: Sequence[str] = (),
        **computed: Callable[[Any], Any],
    ) -> "Table":
        """A row per record, which is a mapping or an object.

        columns : "NAME=KEY | *NAME=KEY.KEY | NAME": a star keeps a column, without a key the name is one; what a record
            lacks is None;  computed : key -> the value from the record, for what no record holds
        """
        pairs = [column.strip().partition("=")[::2] for column in columns.split("|")]
        names = [name.removeprefix("*") for name, _ in pairs]
        keys = [key or name for name, (_, key) in zip(names, pairs, strict=True)]
        rows = [[computed[key](r) if key in computed else value_at(r, key) for key in keys] for r in records]
        return cls(title, names, rows, marked, [n for n, (name, _) in zip(names, pairs, strict=True) if n != name])

    def documents(self) -> list[dict[str, Any]]:
        """For JSON: each row by the names of its columns."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    def frame(self) -> Any:
        """A pandas.DataFrame, the title in its attrs. Raises MissingDependency where pandas is not installed."""
        try:
            import pandas
        except ModuleNotFoundError:
            raise MissingDependency("a table for further work needs another package: `pip install pandas`") from None
        frame = pandas.DataFrame(self.documents(), columns=list(self.columns))
        frame.attrs["title"] = self.title
        return frame

    def html(self) -> str:
        """For a notebook: its first rows, the marked ones strong."""
        head = "".join(f"<th>{escape(name)}</th>" for name in self.columns)
        lines = [[cell(value) for value in row] for row in self.rows[:MOST_ROWS]]
        cells = [
            "".join(f"<t{'h' if any(c in self.marked for c in line) else 'd'}>{escape(c)}" for c in line)
            for line in lines
        ]
        body = "".join(f"<tr>{line}" for line in cells)
        more = len(self.rows) - len(lines)
        left = f"<p>... and {more} more: to_frame() has all</p>" if more else ""
        return f"<p>{escape(self.title)}</p><table><tr>{head}</tr>{body}</table>{left}"


class TableResult:
    """A result that shows itself in a notebook by its tables, and gives the first as a DataFrame."""

    def tables(self) -> tuple[Table, ...]:
        """What it says, the most important first."""
        raise NotImplementedError

    def to_frame(self) -> Any:
        """The first table that has rows, as a pandas.DataFrame. Raises MissingDependency without pandas."""
        every = self.tables()
        return next((t for t in every if t.rows), every[0]).frame()

    def _repr_html_(self) -> str:
        head = f"<p><b>{escape(repr(self).splitlines()[0])}</b></p>"
        return head + "".join(t.html() for t in self.tables() if t.rows)


class TableRow:
    """A row of a table.  properties : of it, that its document has behind all fields"""

    properties: ClassVar[tuple[str, ...]] = ()

    def document(self) -> dict[str, Any]:
        """For JSON: every field, then the properties that it names."""
        return select_fields(self, *vars(self), *self.properties)


def select_fields(result: object, *names: str) -> dict[str, Any]:
    """Attributes of a result by name, for JSON: rows in them as their documents, tuples as lists."""

    def plain(value: Any) -> Any:
        if hasattr(value, "document"):
            return value.document()
        return [plain(v) for v in value] if isinstance(value, tuple | list) else value

    return {name: plain(getattr(result, name)) for name in names}


def value_at(holder: object, path: str) -> Any:
    """What an object or mapping has under "KEY" or "KEY.KEY"; None where it has none."""

    def inner(here: Any, key: str) -> Any:
        return here.get(key) if isinstance(here, Mapping) else getattr(here, key, None)

    return reduce(inner, path.split("."), holder)


def cell(value: Any) -> str:
    """A value as a terminal shows it: numbers to three digits, and no exponent below a million."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return "-"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        if 1000 <= abs(value) < 1e6:
            return f"{value:.0f}"
        return f"{value:.2f}" if 0.1 <= abs(value) < 1000 else f"{value:.3g}"
    if isinstance(value, list | tuple):
        return ", ".join(cell(v) for v in value)
    return str(value)


def unit_suffix(unit: str) -> str:
    """A unit as it stands behind a number, with a blank; nothing of a number without one."""
    return "" if unit == "1" else f" {unit}"


def percent(probability: float) -> str:
    """A probability as every page, list and picture says it: "> 99 %", "97 %", "< 1 %"."""
    if probability >= 0.995:
        return "> 99 %"
    return f"{100 * probability:.0f} %" if probability >= 0.005 else "< 1 %"


def with_interval(value: float | None, low: float | None, high: float | None) -> str:
    """A value with its interval: three digits tell what an interval leaves sure."""
    one, *two = (f"{x:.3g}" if x is not None and math.isfinite(x) else "-" for x in (value, low, high))
    return f"{one} ({' ... '.join(two)})"
