"""Results that show themselves in Jupyter and marimo, each by a picture: `import thermoscope.viz.notebook`.

The rooms below know nothing of HTML, so their classes get their `_repr_html_` here, once, by that import.
"""

from __future__ import annotations

from html import escape

from geom.description.machine import Machine
from lumped.model.network import Network
from validation.comparison.compare import Comparison as Compared
from validation.inference.result import Diagnosis
from validation.revision.revise import Revision
from viz.data import Comparison
from viz.figures import candidates, curves
from viz.pages import html, words
from viz.pages.report import Report, render

MOST_ROWS = 10  # rows of a cell


def compared(c: Compared) -> str:
    """Error per sensor of every test; those beyond their uncertainty marked."""
    rows = [(t.name, t.role, s.channel, s.place, s.rmse_K, s.sigma_K, s.verdict) for t in c.tests for s in t.channels]
    return titled(c.words) + html.table(["test", "role", "sensor", "place", "rms (K)", "1σ (K)", "verdict"], rows)


def diagnosed(d: Diagnosis) -> str:
    """The verdict, and the candidates by score."""
    document = d.document()
    _, sentence = words.verdict(document, None)
    leading = document["candidates"][:MOST_ROWS]
    rows = [(c["effect"], c["score"], candidates.amplitude(c), c["decision"]) for c in leading]
    return titled(sentence) + html.table(["effect", "score", "size", "decision"], rows)


def revised(r: Revision) -> str:
    """What a step did to the error of every test."""
    rows = [(t.name, t.role, t.before, t.after) for t in r.tests]
    verdict = "accepted" if r.accepted else "not accepted"
    head = f"{r.action} {r.effect or ''}: {verdict}; {r.why}"
    return titled(head) + html.table(["test", "role", "before (K)", "after (K)"], rows)


def comparison_html(c: Comparison) -> str:
    """Measured and modelled, sensor by sensor."""
    return html.plot(curves.measured_and_model(c), f"held-{c.test.name}", f"{c.test.name} ({c.test.role})")


def machine(m: Machine) -> str:
    """Parts with their materials."""
    rows = [(p.name, p.material) for p in m.parts]
    return titled(f"{m.name}: {len(rows)} parts") + html.table(["part", "material"], rows)


def network(n: Network) -> str:
    """How large, and what may be calibrated."""
    rows = [(p.name, p.value, p.unit, p.prior_sd) for p in n.parameters[:MOST_ROWS]]
    return titled(f"{n.name}: {n.sizes}") + html.table(["parameter", "value", "unit", "prior sd"], rows)


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
