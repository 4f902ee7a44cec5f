"""Small pieces of a page. Everything that comes from outside is escaped."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from viz.figures import paper
from viz.labels import minus

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Cell = str | float | int | None


def page(title: str, body: Iterable[str]) -> str:
    """A whole page that needs nothing but itself."""
    css = files("viz.pages").joinpath("page.css").read_text(encoding="utf-8")
    wide = '<meta name="viewport" content="width=device-width, initial-scale=1">'
    head = f'<meta charset="utf-8">{wide}<title>{escape(title)}</title><style>{css}</style>'
    inner = f"<head>{head}</head>\n<body><main>{''.join(body)}</main></body>"
    return f'<!doctype html>\n<html lang="en">{inner}</html>\n'


def section(title: str, *body: str) -> str:
    """A headed section; nothing at all if it has no body."""
    inner = "".join(body)
    return f"<section><h2>{escape(title)}</h2>{inner}</section>\n" if inner else ""


def text(*paragraphs: str) -> str:
    return "".join(f"<p>{escape(p)}</p>" for p in paragraphs if p)


def plot(figure: Figure, name: str, caption: str) -> str:
    """A figure as inline SVG; its ids start with `name`, which must differ from plot to plot."""
    label = escape(caption, quote=True)
    return f'<figure role="img" aria-label="{label}">{paper.svg(figure, name)}{_caption(caption)}</figure>\n'


def picture(png: str | Path | bytes, caption: str) -> str:
    """A PNG, carried inside the page."""
    data = png if isinstance(png, bytes) else Path(png).read_bytes()
    source = "data:image/png;base64," + base64.b64encode(data).decode("ascii")
    return f'<figure><img alt="{escape(caption, quote=True)}" src="{source}">{_caption(caption)}</figure>\n'


def inner_page(page: str, title: str) -> str:
    """A whole page in a frame, carried inside this one; begun when it comes into sight, it sees nothing of this one."""
    inside = f'sandbox="allow-scripts" loading="lazy" title="{escape(title, quote=True)}"'
    return f'<iframe {inside} srcdoc="{escape(page, quote=True)}"></iframe>{_caption(title)}\n'


def table(headers: Sequence[str], rows: Iterable[Sequence[Cell]], strong: Sequence[bool] = ()) -> str:
    """Numbers to the right, words to the left; '' and None are shown as a dash."""
    body = [list(row) for row in rows]
    if not body:
        return ""
    numeric = [
        all(isinstance(row[i], float | int) or row[i] in (None, "") for row in body) for i in range(len(headers))
    ]
    top = "".join(f"<th{_n(n)}>{escape(h)}</th>" for h, n in zip(headers, numeric, strict=True))
    lines = [
        f"<tr{' class=strong' if i < len(strong) and strong[i] else ''}>"
        + "".join(f"<td{_n(n)}>{_cell(v)}</td>" for v, n in zip(row, numeric, strict=True))
        + "</tr>"
        for i, row in enumerate(body)
    ]
    return f'<div class="scroll"><table><thead><tr>{top}</tr></thead><tbody>{"".join(lines)}</tbody></table></div>\n'


def cards(items: Iterable[tuple[str, str]]) -> str:
    """Large numbers with what they mean under them."""
    inner = "".join(f'<div class="card"><b>{escape(big)}</b><span>{escape(small)}</span></div>' for big, small in items)
    return f'<div class="cards">{inner}</div>\n'


def more(summary: str, *body: str, expanded: bool = False) -> str:
    return f"<details{' open' if expanded else ''}><summary>{escape(summary)}</summary>{''.join(body)}</details>\n"


def _caption(caption: str) -> str:
    return f"<figcaption>{escape(caption)}</figcaption>"


def _n(numeric: bool) -> str:
    return ' class="n"' if numeric else ""


def _cell(value: Cell) -> str:
    if value is None or value == "":
        return "–"
    if isinstance(value, float):
        if not isfinite(value):
            return "–"
        return minus(f"{value:.4g}" if abs(value) >= 1000 or 0 < abs(value) < 0.01 else f"{value:.3g}")
    css = {"over": "bad", "within": "ok"}.get(str(value))
    return f'<span class="{css}">{escape(str(value))}</span>' if css else escape(str(value))
