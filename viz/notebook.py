"""Results that show themselves in Jupyter and marimo, each by a picture: `import thermoscope.viz.notebook`.

The rooms below know nothing of HTML, so their classes get their `_repr_html_` here, once, by that import.
"""

from __future__ import annotations

from html import escape

from geom.description.machine import Machine
from geom.table import Table
from lumped.model.network import Network
from validation.comparison.compare import Comparison as Compared
from validation.inference.result import Diagnosis
from validation.revision.revise import Revision
from validation.tables import candidates_table, sensors_table
from viz.data import Comparison
from viz.figures import curves
from viz.pages import html, words
from viz.pages.report import Report, render

MOST_ROWS = 10  # rows of a cell
_CHANGES = "test=name | role | before (K)=before | after (K)=after"


def compared(c: Compared) -> str:
    """Error per sensor of every test; those beyond their uncertainty marked."""
    return titled(c.words) + html.table(sensors_table("", c.document()["tests"]))


def diagnosed(d: Diagnosis) -> str:
    """The verdict, and the candidates by score."""
    document = d.document()
    return titled(words.verdict(document, None)[1]) + html.table(candidates_table(document["candidates"][:MOST_ROWS]))


def revised(r: Revision) -> str:
    """What a step did to the error of every test."""
    verdict = "accepted" if r.accepted else "not accepted"
    return titled(f"{r.action} {r.effect or ''}: {verdict}; {r.why}") + html.table(Table.of("", r.tests, _CHANGES))


def comparison_html(c: Comparison) -> str:
    """Measured and modelled, sensor by sensor."""
    return html.plot(curves.measured_and_model(c), f"held-{c.test.name}", f"{c.test.name} ({c.test.role})")


def machine(m: Machine) -> str:
    """Parts with their materials."""
    return titled(f"{m.name}: {len(m.parts)} parts") + html.table(Table.of("", m.parts, "part=name | material"))


def network(n: Network) -> str:
    """How large, and what may be calibrated."""
    columns = "parameter=name | value | unit | prior sd=prior_sd"
    return titled(f"{n.name}: {n.sizes}") + html.table(Table.of("", n.parameters[:MOST_ROWS], columns))


def report(r: Report) -> str:
    """The whole page, in a frame of its own so that its style stays there."""
    style = "width: 100%; height: 40em; border: 0"
    return f'<iframe title="report" srcdoc="{escape(render(r), quote=True)}" style="{style}"></iframe>'


def titled(text: str) -> str:
    return f"<p><b>{escape(text)}</b></p>"


SHOWS = {
    Compared: compared,
    Diagnosis: diagnosed,
    Revision: revised,
    Comparison: comparison_html,
    Machine: machine,
    Network: network,
    Report: report,
}
for _kind, _show in SHOWS.items():
    _kind._repr_html_ = _show  # type: ignore[attr-defined]
