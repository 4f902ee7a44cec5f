"""One page to pin on the bench: what to drive tomorrow, and what each hypothesis predicts for it."""

from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.storage import write_whole
from geom.table import Table
from validation.revision.predicted_curves import PredictedCurves
from validation.tables import currents
from viz.colours import BLUE, GREEN, LIGHT, ORANGE, PURPLE, VERMILION
from viz.data import LONG_S, POINTS, short
from viz.figures import paper
from viz.labels import end_labels
from viz.pages import html

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLANK = "\u2007" * 6  # room for a pen
DECISIVE = 2.0  # one-sigma distances from which a reading speaks for one of two


@dataclass(frozen=True)
class BenchPage:
    """driven : name of the test that the plan changes;  made : date and versions
    holding : what to hold when: name, from and to (s), value in the unit of its name
    hottest_C : the hottest reading of all tests so far (degC)
    """

    case: str
    plan: PredictedCurves
    driven: str
    holding: list[tuple[str, float, float, float]]
    provenance: str = ""
    hottest_C: float | None = None


def write_bench_page(page: BenchPage, path: str | Path) -> Path:
    """Write the page and return its path."""
    return write_whole(Path(path), render(page))


def render(page: BenchPage) -> str:
    """The page as text."""
    plan = page.plan
    head = f"<h1>{escape(page.case)}</h1>"
    head += f'<p class="verdict">Tomorrow: {escape(plan.experiment.name)}, {plan.experiment.hours:g} h</p>'
    closest = plan.closest()
    word = "decides" if closest >= DECISIVE else "does not decide"
    says = f"The two closest hypotheses come apart by {closest:.1f} of the sensors' own sigma (rms): this test {word}."
    steps = [[name, _clock(a), _clock(b), value] for name, a, b, value in page.holding]
    table = html.table(Table("", ["hold", "from", "to", "at"], [*steps, *_scaled_records(page)]))
    table += html.text(f"All else as in the record of {page.driven}, again and again until the time is over.")
    table += _currents(page)
    caption = "Predicted by each hypothesis, with the sensor's 2-sigma band; the line is where they are furthest apart."
    parts = [
        head + html.text(says) + _careful(page),
        html.section("Drive", table),
        html.section("What to expect", html.plot(predicted(plan), "predicted", caption), _decisive(plan)),
        f"<footer>{escape(page.provenance)}</footer>" if page.provenance else "",
    ]
    return html.page(f"thermoscope: {plan.experiment.name}", parts)


def _scaled_records(page: BenchPage) -> list[list[Any]]:
    """Currents that go as they were recorded, but smaller."""
    plan, listed = page.plan, {name for name, *_ in page.holding}
    factor, end = plan.experiment.current_factor, _clock(plan.test.time[-1] - plan.test.time[0])
    scaled = [c.input for c in plan.currents if c.input not in listed] if factor < 1.0 else []
    return [[name, _clock(0.0), end, f"{factor:.2f} of the record"] for name in scaled]


def _currents(page: BenchPage) -> str:
    """What the currents amount to, and why they are no larger."""
    levels = currents([c.document() for c in page.plan.currents])
    factor = page.plan.experiment.current_factor
    says = [f"Currents: {levels}."] if levels else []
    if factor < 1.0:
        says += [
            f"They are {factor:.2f} of what this test would have: the machine gets no hotter than in the tests so far."
        ]
    return html.text(" ".join(says)) if says else ""


def _careful(page: BenchPage) -> str:
    """A warning where a sensor would read more than any has read: nobody knows yet what bears it."""
    peaks = {c.name: max(float(y[c.name].max()) for y in page.plan.curves.values()) for c in page.plan.test.channels}
    name = max(peaks, key=lambda channel: peaks[channel])
    if page.hottest_C is None or peaks[name] <= page.hottest_C:
        return ""
    says = f"Careful: {short(name)} would reach {peaks[name]:.0f} °C; no test has read more than"
    return html.text(f"{says} {page.hottest_C:.0f} °C. Stop before anything gets too hot.")


def _decisive(plan: PredictedCurves) -> str:
    """Temperatures by hypothesis where they are furthest apart; a column to write into."""
    at = plan.decisive()
    channels = sorted(plan.test.channels, key=lambda c: -plan.spread_K(c.name))[: 2 * SENSORS]
    rows: list[list[Any]] = [
        [short(c.name), *(f"{y[c.name][at]:6.1f}".replace(" ", "\u2007") for y in plan.curves.values()), BLANK]
        for c in channels
    ]
    return f"<h3>At {_clock(plan.test.time[at] - plan.test.time[0])} (°C)</h3>" + html.table(
        Table("", ["sensor", *plan.curves, "read"], rows)
    )


def _clock(second: float) -> str:
    return f"{second / 60:.0f} min"


COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE)
SENSORS = 4  # panels that a page holds side by side


@paper.styled
def predicted(plan: PredictedCurves, *, sensors: int = SENSORS, png: str | Path | None = None) -> "Figure":
    """One panel per sensor, those first that tell most: a line per hypothesis with the sensor's own 2-sigma band."""
    channels = sorted(plan.test.channels, key=lambda c: -plan.spread_K(c.name))[:sensors]
    time = np.asarray(plan.test.time, float)
    unit, unit_s = ("min", 60.0) if time[-1] - time[0] < LONG_S else ("h", 3600.0)
    at = plan.decisive()
    thin = slice(None, None, max(1, -(-len(time) // POINTS)))
    t = (time - time[0])[thin] / unit_s
    words = "", f"time ({unit})", "temperature (°C)"
    figure, axes = paper.panels(len(channels), 2, (4.3, 2.6), *words)
    for ax, channel in zip(axes, channels, strict=False):
        for colour, curves in zip(COLOURS, plan.curves.values(), strict=False):
            y, band = curves[channel.name][thin], 2 * float(np.hypot(channel.sigma_K, channel.model_K))
            ax.fill_between(t, y - band, y + band, color=colour, alpha=0.15, lw=0)
            ax.plot(t, y, color=colour)
        spread_K = np.ptp([curves[channel.name] for curves in plan.curves.values()], axis=0).max()
        ax.set_title(f"{short(channel.name)}: up to {spread_K:.1f} K apart")
        ax.margins(x=0)
        ax.axvline((time[at] - time[0]) / unit_s, color=LIGHT.ink, lw=0.8, ls=":")
        ends = [float(curves[channel.name][-1]) for curves in plan.curves.values()][: len(COLOURS)]
        end_labels(ax, ends, [f"{end:.1f}" for end in ends], COLOURS)
    names = list(plan.curves)[: len(COLOURS)]
    style: dict[str, Any] = {"loc": "outside upper left", "ncols": 2, "frameon": False, "labelcolor": "linecolor"}
    figure.legend(axes[0].get_lines()[: len(names)], names, handlelength=1.2, fontsize=8.5, **style)
    return paper.save(figure, png)
