"""Small pieces of a page, and a page as PDF with whatever converter this computer has.

Everything that comes from outside is escaped.
"""

import base64
import re
import shutil
import subprocess
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.resources import files
from importlib.util import find_spec
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from geom.table import Table, cell
from viz.figures import paper
from viz.labels import minus

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIGN = re.compile(r"(?<![\w.)\]])-(?=\d)")  # of a number in words, not in a date, a range or a name


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


def plot(figure: "Figure", name: str, caption: str) -> str:
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


def table(content: Table, words: Mapping[str, str] | None = None, without: Sequence[str] = ()) -> str:
    """Numbers to the right, words to the left; rows with a marked word are strong, empty columns left out.

    words : of a code in the first column, which then stands small below them;  without : columns to leave out
    """
    rows, empty = content.rows, ("", "-", None)
    columns = [
        i
        for i, name in enumerate(content.columns)
        if name not in without and (i == 0 or any(row[i] not in empty for row in rows))
    ]
    if not rows:
        return ""
    style = [
        "" if any(isinstance(row[i], str) and row[i] not in empty for row in rows) else ' class="n"' for i in columns
    ]
    top = "".join(f"<th{s}>{escape(content.columns[i])}</th>" for i, s in zip(columns, style, strict=True))
    lines = [
        f"<tr{' class=strong' if any(cell(value) in content.marked for value in row) else ''}>"
        + "".join(f"<td{s}>{_cell(row[i], words or {})}</td>" for i, s in zip(columns, style, strict=True))
        + "</tr>"
        for row in rows
    ]
    return f'<div class="scroll"><table><thead><tr>{top}</tr></thead><tbody>{"".join(lines)}</tbody></table></div>\n'


def headed(content: Table) -> str:
    """A table under its title; nothing at all if it has no rows."""
    return f"<h3>{escape(content.title)}</h3>{table(content)}" if content.rows else ""


def cards(items: Iterable[tuple[str, str]]) -> str:
    """Large numbers with what they mean under them."""
    inner = "".join(f'<div class="card"><b>{escape(big)}</b><span>{escape(small)}</span></div>' for big, small in items)
    return f'<div class="cards">{inner}</div>\n'


def more(summary: str, *body: str, expanded: bool = False) -> str:
    return f"<details{' open' if expanded else ''}><summary>{escape(summary)}</summary>{''.join(body)}</details>\n"


def _caption(caption: str) -> str:
    return f"<figcaption>{escape(caption)}</figcaption>"


def _cell(value: Any, words: Mapping[str, str]) -> str:
    if isinstance(value, str) and value in words:
        return f'{escape(words[value])}<br><code class="code">{escape(value)}</code>'
    if isinstance(value, float) and isfinite(value):
        return minus(f"{value:.4g}" if abs(value) >= 1000 or 0 < abs(value) < 0.01 else f"{value:.3g}")
    word = cell(value).replace("->", "→").replace(" ... ", "\u00a0…\u00a0").replace(" %", "\u00a0%")
    word = SIGN.sub(minus("-"), word)
    word = word.replace("> ", ">\u00a0").replace("< ", "<\u00a0")  # odds on one line, however narrow
    if word in ("", "-"):
        return "–"
    css = {"over": "bad", "over (hot)": "bad", "over (cold)": "cold", "within": "ok"}.get(word)
    return f'<span class="{css}">{escape(word)}</span>' if css else escape(word)


BROWSERS = ("chromium", "chromium-browser", "google-chrome", "microsoft-edge")
QUIET = ["--headless", "--disable-gpu", "--no-sandbox", "--no-first-run", "--disable-extensions"]
QUIET += ["--no-pdf-header-footer"]
LONGEST_S = 180  # a browser that needs more hangs


def write_pdf(page: Path) -> Path | None:
    """Write PAGE.pdf beside an HTML page by WeasyPrint or a Chromium; None where there is neither."""
    pdf = page.with_suffix(".pdf")
    if find_spec("weasyprint") is not None:
        from weasyprint import HTML

        HTML(str(page)).write_pdf(str(pdf))
        return pdf
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    return None if browser is None else _printed(browser, page, pdf)


def _printed(browser: str, page: Path, pdf: Path) -> Path | None:
    """By a browser without a window, its profile in a folder that is thrown away; None if it fails."""
    with TemporaryDirectory() as profile:
        files = [f"--user-data-dir={profile}", f"--print-to-pdf={pdf.resolve()}", page.resolve().as_uri()]
        process = subprocess.run([browser, *QUIET, *files], capture_output=True, timeout=LONGEST_S, check=False)
    return pdf if process.returncode == 0 and pdf.is_file() else None
