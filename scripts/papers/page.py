"""A page: sections with a table of numbers, a sentence on every difference, and a picture."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """One number: what, as published, as computed here, and why they differ (if they do)."""

    what: str
    published: str
    ours: str
    why: str = ""


@dataclass(frozen=True)
class Section:
    """A figure, table or equation of the paper; `table` is a free one (header first) beside the rows."""

    title: str
    words: str
    rows: tuple[Row, ...] = ()
    table: tuple[tuple[Any, ...], ...] = ()
    picture: str = ""

    def text(self) -> str:
        parts = [f"## {self.title}", self.words]
        if self.rows:
            rows = [("", "published", "here", "difference"), *((r.what, r.published, r.ours, r.why) for r in self.rows)]
            parts.append(grid(rows))
        if self.table:
            parts.append(grid(self.table))
        if self.picture:
            parts.append(f"![{self.title}](images/{self.picture})")
        return "\n\n".join(parts)


def grid(rows: Sequence[Sequence[Any]]) -> str:
    """A Markdown table, header first."""
    head, *body = [[str(c) for c in row] for row in rows]
    return "\n".join([_line(head), _line(["---"] * len(head)), *(_line(row) for row in body)])


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def page(title: str, words: str, sections: Sequence[Section]) -> str:
    made = "Written by `python -m scripts.papers`; a test computes the numbers again."
    return "\n\n".join([f"# {title}", words, made, *(s.text() for s in sections)]) + "\n"
