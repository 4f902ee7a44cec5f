"""The page that a test house signs: verdict, rises, what was measured when, limits with their clauses, names."""

from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermoscope import plugin as th

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Document = Mapping[str, Any]
TONES = {"passes": "good", "fails": "warn"}
BLANK = "\u2007" * 12  # room for a pen
CLAUSES = (
    "Clauses are headings of IEC 60034-1, which could not be read here: check them in your edition. Numbers of its "
    "tables are left out, and so are clauses of IEC 60349, IEC 60034-29 or ISO 21782. Expanded uncertainties, 95 %."
)
COMPACT = """<style>main { max-width: 70rem; padding-top: 1.2rem; } h2 { margin-top: 1.4rem; font-size: 1.1rem; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(24rem, 100%), 1fr)); gap: 0 2rem; }
.two > * { min-width: 0; } .two figure svg { width: 100%; } figcaption::after { content: "" !important; }
td:first-child { min-width: 9rem; } td:last-child { min-width: 8rem; } td.n:last-child { min-width: 0; }
@media print { html, body { font-size: 7.5pt; } main { padding: 0; } .verdict, p { max-width: none; }
.two { grid-template-columns: 1fr 1fr; } figure, .scroll, p { margin: .2rem 0; } h2, h3 { margin: .6rem 0 .1rem; }
table { font-size: 6.5pt; line-height: 1.4; } td, th { padding: .05rem .4rem .05rem 0; overflow-wrap: normal; }
footer { margin: 0; } }
@page { size: A4; margin: 10mm; }</style>"""


def tables(document: Document) -> dict[str, th.Table]:
    """Every table of the page, by the name it has in the CSV."""
    columns = "method | *rise (K)=rise_K | *± 95 % (K)=U95_K | *limit (K)=limit_K | in hand (K)=margin_K | *verdict"
    columns += " | degC=temperature_degC | s after off=at_s | how"
    steps = "step=name | when | *state | found=words"
    duty, power = document["duty"], document["power_30min"]
    rows = {
        f"duty {duty['name']}": duty["missing"] or duty["words"],
        "run under load": _with(duty["minutes"], "min"),
        "steady since": _with(duty["steady_min"], "min"),
        "drift at the end": _with(duty["drift_K_h"], "K/h"),
        "95 % of the rise after": _with(duty["tau95_min"], "min"),
        "still to come": _with(duty["rest_K"], "K"),
        "30-minute power (UNECE R85 5.3.2; ISO 21782)": power and _power(power),
    }
    signed = document["signature"]
    signature = [
        ["numbers and names of the record", signed["record"]],
        ["case, test, revision", ", ".join(signed[n] for n in ("case", "test", "revision") if n in signed)],
        ["files and model of the case", signed.get("key", "")],
        ["versions", ", ".join(f"{name} {number}" for name, number in signed["versions"].items())],
        *([name, value or BLANK] for name, value in signed["names"].items()),
    ]
    return {
        "rises": th.Table.of("Rises over the coolant", document["rises"], columns, ["fails"]),
        "duty": th.Table(
            "Duty and steady state", ["what", "found"], [[k, v or ""] for k, v in rows.items()], (), ["found"]
        ),
        "limits": th.Table.of(
            "Limits and corrections", document["limits"], "what | clause | effect | limit (K)=limit_K"
        ),
        "steps": th.Table.of(
            "What was measured when", document["steps"], steps, state=lambda step: step["state"].replace("to do", "")
        ),
        "signature": th.Table("Signed", ["what", "value"], signature),
    }


def _with(value: float | None, unit: str) -> str:
    return "" if value is None else f"{round(value, 1) + 0.0:.1f} {unit}"  # no zero has a sign


def _power(power: Document) -> str:
    words = "valid" if power["valid"] else "not valid: 5 % are allowed"
    return f"{power['power_kW']:.2f} kW, off its start by {power['largest_change_percent']:.1f} % at most, {words}"


def page(document: Document) -> str:
    """The page as text; what was not measured is blank."""
    every, tone = tables(document), TONES.get(document["verdict"], "info")
    head = f"{COMPACT}<h1>Heat run by {escape(document['standard'])}: {escape(document['title'])}</h1>"
    head += f'<p class="verdict"><span class="{tone}">{escape(document["sentence"])}</span></p>'
    readings, figures = document["readings"], ""
    if len(readings["warming"]) > 1:
        figures += th.html.plot(_warming(document), "warming", "Temperature under load; a line where it became steady.")
    if readings["cooling"]:
        figures += th.html.plot(
            _cooling(document), "cooling", "After switching off, and the ways back to that instant."
        )
    narrow = "".join(f"<div>{th.html.headed(every[name])}</div>" for name in ("duty", "signature"))
    return th.html.page(
        f"heat run: {document['title']}",
        [
            head,
            th.html.section(every["rises"].title, th.html.table(every["rises"])),
            f'<div class="two">{figures}</div>',
            th.html.section(every["limits"].title, th.html.table(every["limits"]), th.html.text(CLAUSES)),
            th.html.section(every["steps"].title, th.html.table(every["steps"])),
            f'<div class="two">{narrow}</div>',
            f"<footer>{escape(th.provenance())}</footer>",
        ],
    )


@th.paper.styled
def _warming(document: Document) -> "Figure":
    figure, (ax,) = th.paper.subplots(4.6, 1.7)
    minutes, T = np.array(document["readings"]["warming"], float).T
    ax.plot(minutes, T, color=th.BLUE, lw=1.2)
    if (since := document["duty"]["steady_min"]) is not None:
        ax.axvline(since, color=th.LIGHT.ink, ls=":", lw=1.0)
    ax.set(xlabel="min under load", ylabel="degC")
    return figure


@th.paper.styled
def _cooling(document: Document) -> "Figure":
    """Readings as temperatures by the cold one, and every way's value at the instant it stands for."""
    figure, (ax,) = th.paper.subplots(4.6, 1.7)
    seconds, ohm = np.array(document["readings"]["cooling"], float).T
    ways = [r for r in document["rises"] if r["at_s"] is not None]
    ax.plot(seconds, ohm, color=th.BLUE, marker=".", ms=3, lw=0.0)
    cold, t1 = document["readings"]["cold_ohm"], document["readings"]["cold_degC"]
    k = document["readings"]["k"]
    for way, marker in zip(ways, "osD^v", strict=False):
        y = cold * (k + way["temperature_degC"]) / (k + t1)
        ax.plot(way["at_s"], y, marker, mfc="none", color=th.LIGHT.ink, ms=5, label=way["method"].partition(", ")[2])
    ax.legend(fontsize=7, frameon=False)
    ax.set(xlabel="s after switching off", ylabel="ohm")
    return figure


def csv_rows(document: Document) -> list[list[Any]]:
    """Every number of the page: table, row, column, value, empty where nothing was measured."""
    rows = [["table", "row", "column", "value"], ["verdict", "", "sentence", document["sentence"]]]
    for name, table in tables(document).items():
        for i, row in enumerate(table.rows):
            cells = zip(table.columns, row, strict=True)
            rows += [[name, str(i + 1), c, "" if v is None or v == BLANK else v] for c, v in cells]
    return rows


def write_report(document: Document, folder: Path, stem: str) -> list[Path]:
    """STEM.json, .csv, .html and, where something prints it, .pdf."""
    import json

    text = json.dumps(th.plain(document), indent=2, ensure_ascii=False) + "\n"
    content = {".json": text, ".csv": th.csv_lines(csv_rows(document)), ".html": page(document)}
    paths = [th.write_whole(folder / f"{stem}{ending}", words) for ending, words in content.items()]
    pdf = th.write_pdf(paths[-1])
    return [*paths, *([pdf] if pdf else [])]
