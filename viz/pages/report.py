"""One self-contained page to hand on: verdict first, pictures, numbers with uncertainty, how to repeat it.

Plots are inline SVG and pictures inline PNG, so the page is about 1 MB, opens without a network, prints, and follows
the reader's light or dark theme. (plotly's script alone would be 4.8 MB.) Only the viewer of the machine, about 1.5 MB
more in a frame of its own, needs scripts.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from html import escape
from pathlib import Path
from typing import Any

from geom.storage import write_whole
from geom.table import Table
from validation import tables
from validation.comparison.uncertainty import RULE
from validation.parameters.unknowns import value_words
from viz.data import Comparison
from viz.figures import bands, candidates, curves, errors, paper
from viz.figures.bands import intervals
from viz.machine.missing import placed
from viz.pages import html, words

Document = Mapping[str, Any]
DETAIL = ("detectable", "log odds", "threshold")  # columns of candidates that open on a click


@dataclass(frozen=True)
class Report:
    """What the page is made from; every part but the case's name may be missing.

    comparison, diagnosis : documents of `compare` and `diagnose`; earlier : the diagnosis is of the model before its
        last step, and the verdict is that of the comparison
    history : revisions, each with number, action, effect and tests as in `add`, and the step in words
    parameters : as in `add` and `calibrate`
    curves : one Comparison per test, the most telling first
    pictures : caption -> PNG (path or bytes)
    error_budget : test -> places, as in `compare`
    viewer : the page of viz.viewer as text, to turn and play the machine in
    finding : what was added to the model and what it did, in a sentence, as `model add` prints it
    assumptions : one sentence each;  commands : what repeats the result;  made : date, versions, computer
    """

    case: str
    description: str = ""
    comparison: Document | None = None
    diagnosis: Document | None = None
    history: Sequence[Document] = ()
    parameters: Sequence[Document] = ()
    curves: Sequence[Comparison] = ()
    pictures: Mapping[str, str | Path | bytes] = field(default_factory=dict)
    assumptions: Sequence[str] = ()
    commands: Sequence[str] = ()
    provenance: str = ""
    earlier: bool = False
    error_budget: Mapping[str, Sequence[Document]] = field(default_factory=dict)
    viewer: str = ""
    finding: str = ""

    def _repr_html_(self) -> str:
        """The whole page, in a frame of its own so that its style stays there."""
        style = "width: 100%; height: 40em; border: 0"
        return f'<iframe title="report" srcdoc="{escape(render(self), quote=True)}" style="{style}"></iframe>'


def write_report(report: Report, path: str | Path) -> Path:
    """Write the page and return its path."""
    return write_whole(Path(path), render(report))


def render(report: Report) -> str:
    """The page as text."""
    parts = [_top(report), _error(report), _pictures(report), _curves(report), _missing(report), _hidden(report)]
    parts += [_values(report), _sensors(report), _numerical(report), _assumed(report), _repeat(report)]
    return html.page(f"thermoscope: {report.case}", parts)


def _top(r: Report) -> str:
    diagnosis = None if r.earlier else r.diagnosis
    tone, sentence = words.verdict(diagnosis, r.comparison)
    since = "" if diagnosis is None else sentence
    if r.finding:
        tone, sentence = "good" if r.finding.startswith("Found") else "info", r.finding.replace("->", "→")
    compared: Document = r.comparison or {}
    plain: Document = compared.get("yardstick", {})
    if plain.get("warning"):  # what no model at all does better comes first
        tone, sentence = "warn", f"{plain['warning']} {sentence}"
    head = f"<h1>thermoscope show report: {escape(r.case)}</h1>"
    head += f'<p class="verdict"><span class="{tone}">{escape(sentence)}</span></p>'
    items = []
    if r.comparison is not None:
        items.append((f"{r.comparison['rmse_K']:.2f} K", "rms error over all tests, model as it stands"))
        items.append((f"{r.comparison['floor_K']:.2f} K", "what the sensors' own uncertainty explains"))
        if best := best_plain_K(r.comparison):
            items.append((f"{best:.2f} K", "the best plain model, which knows no machine, on tests it never saw"))
    sentences = compared.get("strained", ""), plain.get("sentence", "")
    below = html.text(since * bool(r.finding), words.detail(diagnosis), *sentences, r.description)
    return head + below + (html.cards(items) if items else "")


def best_plain_K(comparison: Document) -> float | None:
    """The least error (K) that a plain model leaves; None where none could be learnt."""
    return comparison.get("yardstick", {}).get("best_K")


def _error(r: Report) -> str:
    if not r.history:
        return ""
    floor = None if r.comparison is None else float(r.comparison["floor_K"])
    plain = None if r.comparison is None else best_plain_K(r.comparison)
    last = r.history[-1]
    most = max(error for path in errors.error_paths(r.history).values() for error in path)
    # a step back to the model as declared has no errors of its own
    bars = errors.before_after(last["tests"], floor_K=floor, most_K=most) if last["tests"] else None
    title = f"Last step: {last['words']}. Tests in bold were never used."
    stairs = errors.staircase(r.history, floor_K=floor, plain_K=plain)
    return html.section(
        "The error, step by step",
        html.plot(stairs, "stairs", "Rms error of every test over the revisions of the model."),
        html.plot(bars, "bars", title) if bars else "",
        html.text(words.ending(None if r.earlier else r.diagnosis)),
    )


def _pictures(r: Report) -> str:
    viewer = html.more("Turn it, cut it, play it", html.inner_page(r.viewer, _VIEWER)) if r.viewer else ""
    return html.section("The machine", *(html.picture(png, caption) for caption, png in r.pictures.items()), viewer)


_VIEWER = "The machine in the browser's own GL: every test, turned, cut and played. It runs a script of its own."


def _curves(r: Report) -> str:
    def of_test(i: int, c: Comparison) -> str:
        name = f"{c.test.name} ({c.test.role})"
        both = html.plot(curves.residuals(c), f"residual{i}", f"{name}: measured − model per sensor.")
        both += html.plot(
            curves.measured_and_model(c), f"curves{i}", f"{name}: readings, what counts as within, and the model."
        )
        return html.more(name, both, expanded=i == 0)

    parts = paper.draw_all([partial(of_test, i, c) for i, c in enumerate(r.curves)])
    return html.section("Measured and modelled", *parts)


def _missing(r: Report) -> str:
    if r.diagnosis is None or not r.diagnosis["candidates"]:
        return ""
    d, by_score = r.diagnosis, sorted(r.diagnosis["candidates"], key=lambda c: c["score"], reverse=True)
    evidence = html.plot(candidates.scores(by_score), "scores", "Evidence; beyond the black mark it is not chance.")
    by_odds = sorted(d["candidates"], key=lambda c: c.get("probability", 0.0), reverse=True)[:12]
    table = tables.candidates_table(by_odds)
    bars = candidates.posterior(d["explanations"]) if d.get("explanations") else None
    caption = "Each leading cause and its odds; pale: with something else. Below: odds of each, alone or with others."
    texts = {c["effect"]: c["words"] for c in by_score if c.get("words")}
    parts = [
        html.plot(bars, "odds", caption) if bars else "",
        html.table(table, texts, DETAIL),
        html.more("Evidence of each by itself", evidence, html.table(table, texts)),
        html.headed(tables.events_table(d.get("events", []))),
        _contradiction(d.get("contradiction")),
    ]
    if placed(d) and d["where"][0].get("heat"):
        caption = "Heat that would have to enter (or leave, below zero) at the likeliest place, with its 2σ band."
        parts.append(html.plot(bands.missing_heat(d["where"], events=d.get("events", [])), "heat", caption))
    alike = [
        {**c, "confused_with": "; ".join(texts.get(name) or value_words(name) for name in c["confused_with"])}
        for c in by_odds
        if c["confused_with"]
    ]
    likeness = html.table(Table.of("", alike, "effect | looks like=confused_with"), texts)
    names = [c["effect"] for c in by_score[:10]]
    if d.get("confusion"):
        likely = candidates.confusion([texts.get(n, n) for n in names], candidates.matrix(d["confusion"], names))
        likeness += html.plot(likely, "confusion", "Likeness of their traces.")
    parts.append(html.more("Which of them look alike", likeness) if likeness else "")
    return html.section("What was missing before the last step" if r.earlier else "What is missing", *parts)


def _contradiction(row: Document | None) -> str:
    """Which test stands against the others, and what it would need."""
    if not row or not row["differences"]:
        return ""
    figure = html.plot(candidates.differences(row), "differences", "What would have to differ between tests.")
    head = f"<h3>Tests that contradict each other</h3>{html.text(row['words'])}"
    return f"{head}{figure}{html.more('In numbers', html.table(tables.contradiction_table(row)))}"


def _hidden(r: Report) -> str:
    """What these tests cannot see, and which test would show more."""
    if r.diagnosis is None:
        return ""
    hidden = r.diagnosis.get("cannot_see", [])
    limits = html.table(tables.limits_table(hidden), {h["effect"]: h["words"] for h in hidden if "words" in h})
    return html.section(
        "What these tests cannot see, and what would help",
        limits and html.more("Effects that could be there unseen", limits),
        html.headed(tables.offers_table(tables.offers(r.diagnosis))) or html.text(tables.undecided(r.diagnosis)),
    )


def _values(r: Report) -> str:
    """What the data fix of the model is in sight; of readings, and what they do not fix, opens on a click."""
    fixed = [p for p in r.parameters if p.get("identified", True) or "@" in p["name"]]
    model = [p for p in fixed if not p.get("of_measurement")]
    groups = {
        "values of readings, clocks and starts": [p for p in fixed if p.get("of_measurement")],
        "values that the data do not fix": [p for p in r.parameters if p not in fixed],
    }
    words = {p["name"]: p["words"] for p in r.parameters if p.get("words", p["name"]) != p["name"]}
    priors = [p for p in r.parameters if p["prior"] and not p.get("of_measurement")]
    return html.section(
        "Calibrated values",
        html.plot(intervals(priors), "sizes", "Values on the scale of what was expected of them.") if priors else "",
        html.table(tables.parameters_table("", model), words),
        *(
            html.more(f"{len(group)} {name}", html.table(tables.parameters_table("", group), words))
            for name, group in groups.items()
            if group
        ),
    )


def _sensors(r: Report) -> str:
    if r.comparison is None:
        return ""
    rule = f"<p>Error is measured − model; {RULE}.</p>"
    of_test = {c.test.name: c for c in r.curves}
    return html.section("Every sensor", rule, *(_sensors_of(t, of_test.get(t["name"])) for t in r.comparison["tests"]))


def _sensors_of(test: Document, curves_of: Comparison | None) -> str:
    """A row per sensor; what is over in the colour of its dot.  curves_of : the test's curves, where they are priors"""
    name = f"{test['name']} ({test['role']}), rms {test['rmse_K']:.2f} K"
    side = {c.name: f"over ({curves_of.sensor(c).verdict})" for c in curves_of.channels} if curves_of else {}
    rows = [{**c, "verdict": side.get(c["channel"], "over")} if c["verdict"] == "over" else c for c in test["channels"]]
    table = replace(tables.sensors_table("", [{**test, "channels": rows}]), marked=["over", *side.values()])
    return html.more(name, html.table(table, without=("test",)), expanded=test["role"] == "hold-out")


def _numerical(r: Report) -> str:
    """What mesh, condensation and time steps leave in every temperature, test by test."""
    parts = [html.more(name, html.table(tables.budget_table(places))) for name, places in r.error_budget.items()]
    return html.section(tables.budget_table([]).title, *parts)


def _assumed(r: Report) -> str:
    items = "".join(f"<li>{escape(a)}</li>" for a in r.assumptions)
    return html.section("What was assumed", f"<ul>{items}</ul>" if items else "")


def _repeat(r: Report) -> str:
    commands = f"<pre>{escape(chr(10).join(r.commands))}</pre>" if r.commands else ""
    return html.section("How to repeat this", commands) + (
        f"<footer>{escape(r.provenance)}</footer>" if r.provenance else ""
    )
