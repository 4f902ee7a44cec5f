"""A run of a bench that steers itself, as its journal has it: odds over bench time, set points, and where it stands."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from validation.parameters.unknowns import value_words
from viz.colours import LIGHT, Theme
from viz.data import input_title
from viz.live.curves import as_text, figure

if TYPE_CHECKING:
    import plotly.graph_objects as go

Event = Mapping[str, Any]
CAUSES = 5  # in one picture
Line = tuple[str, list[float], list[float]]  # words, minutes, per cent


def journal(file: Path) -> list[Event]:
    """The events so far, without a last line that is cut short."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return [json.loads(line) for line in lines if line.endswith("}")]


@dataclass(frozen=True)
class BenchRun:
    """events : of the journal"""

    events: Sequence[Event]

    def of(self, kind: str) -> list[Event]:
        return [e for e in self.events if e["event"] == kind]

    @cached_property
    def begin(self) -> float:
        return next((float(e["begin_s"]) for e in self.of("begin")), 0.0)

    def minutes(self, event: Event) -> float:
        return (float(event["time_s"]) - self.begin) / 60.0

    @property
    def end(self) -> float:
        """Minutes from the first row to what the journal has last."""
        return max((self.minutes(e) for e in (*self.of("odds"), *self.of("set"))), default=1.0)

    @property
    def odds(self) -> list[Line]:
        """Each cause that ever led the others, likeliest first: its odds at every look."""
        looks = self.of("odds")
        time = [self.minutes(e) for e in looks]
        each = [dict(e["odds"]) for e in looks]
        peak = {n: max(x.get(n, 0.0) for x in each) for n in dict.fromkeys(n for x in each for n in x)}
        names = sorted(peak, key=lambda n: -peak[n])[:CAUSES]
        return [(value_words(n), time, [100.0 * x.get(n, 0.0) for x in each]) for n in names]

    @property
    def set_points(self) -> list[Line]:
        """Each input as steps, in per cent of the largest that was asked for."""
        sets = self.of("set")
        time = [*(self.minutes(e) for e in sets), self.end]
        out = []
        for name in sets[0]["set_point"] if sets else ():
            level = [float(e["set_point"][name]) for e in sets]
            most = max(map(abs, level)) or 1.0
            out.append(
                (f"{input_title(name)}, 100 % = {most:g}", time, [100.0 * v / most for v in (*level, level[-1])])
            )
        return out

    @property
    def waits(self) -> bool:
        """Is the last set point still to be reached?"""
        sets = [e for e in self.events if e["event"] in ("set", "done")]
        return bool(sets) and bool(sets[-1].get("waits"))


def bench_run(run: BenchRun, *, theme: Theme = LIGHT) -> "go.Figure":
    """The odds of a live bench over bench time, and the set points beneath."""
    out = figure(theme, (0.6, 0.4))
    for row, (lines, shape) in enumerate(((run.odds, "linear"), (run.set_points, "hv")), 1):
        for name, x, y in lines:
            style = {"line_shape": shape, "hovertemplate": "%{y:.0f} %", "row": row, "col": 1}
            out.add_scatter(x=x, y=y, mode="lines", name=as_text(name), **style)
    out.add_hline(90.0, line={"color": theme.faint, "width": 1, "dash": "dash"}, row=1, col=1)
    out.update_yaxes(title="odds (%)", range=[0, 101], row=1, col=1)
    out.update_yaxes(title="set point (%)", range=[-3, 103], row=2, col=1)
    out.update_xaxes(title="time (min)", range=[0.0, run.end], row=2, col=1)
    return out
