"""What a tab shows: one model, one test, one sensor, one instant. Every value from the browser is checked here."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import numpy as np

from thermoscope.case_folder.history import History
from thermoscope.workbench import revisions as ledger
from thermoscope.workbench import tables as rows
from thermoscope.workbench.appearance import Appearance
from thermoscope.workbench.application import Bench
from thermoscope.workbench.view import Stage
from viz.colours import DARK, LIGHT, Theme
from viz.figures.candidates import matrix
from viz.live.candidates import confusion
from viz.live.curves import sensor as sensor_figure

CONFUSED = 8  # names that a row holds
MOMENT_S = 0.02  # several changes of one click are drawn once
NOTHING: dict[str, Any] = {"data": [], "layout": {}}
START: dict[str, Any] = {
    "busy": False, "job": {"title": "", "message": "", "percent": None}, "error": "", "outcome": None, "report": "",
    "viewer": "",
    "tests": [], "test": "", "test_names": [], "sensors": [], "sensor": "", "curve": NOTHING, "dark": False,
    "effects": [], "revision": 0, "steps": [], "can_undo": False, "frame": 0, "frames": 0, "minute": "",
    "verdict": None, "candidates": [], "confusion": NOTHING, "has_confusion": False, "rms": "", "floor": "",
    "drop": None, "dragged": "", "made": "",
}  # fmt: skip


class Display:
    """The part of a tab that only looks. `server` is a trame server; the page is drawn from its state."""

    def __init__(self, bench: Bench, server: Any) -> None:
        self.bench, self.server, self.look = bench, server, bench.first
        self.stage: Stage | None = None
        self.push_image: Callable[[], None] = lambda: None
        self._scale = rows.largest(bench.first)
        self.state.update({**START, "case_name": bench.folder.case.name, "why_flat": bench.why_flat})
        self.state.test, self.state.sensor = rows.worst(bench.first)
        self.state.test_names = [t["name"] for t in bench.first.errors["tests"]]
        self.state.change("test")(lambda **_: self.choose_test())
        self.state.change("frame")(lambda **_: self.choose_frame())

    @property
    def state(self) -> Any:
        return self.server.state

    @property
    def theme(self) -> Theme:
        return DARK if self.state.dark else LIGHT

    def model(self, history: History, look: Appearance) -> None:
        """Another model: its errors, curves and temperatures."""
        self.look = look
        last, errors = history.last, look.errors
        self.state.viewer = ""  # of the model before
        self.state.effects, self.state.revision = list(last.effects), last.number
        self.state.steps, self.state.can_undo = rows.steps(history), len(ledger.effective(history)) > 1
        self.state.rms, self.state.floor = f"{errors['rmse_K']:.2f}", f"{errors['floor_K']:.2f}"
        (test, sensor), known = rows.largest(look), self._scale
        self._scale = max(test, known[0]), max(sensor, known[1])
        self.state.tests = rows.tests(look, self._scale[0], {name: a for name, (a, _) in last.rmse_K.items()})
        self.choose_test()

    def choose_test(self) -> None:
        """The sensors of the chosen test, and its end on the machine."""
        if self.state.test not in self.look.curves:
            return
        self.state.sensors = rows.channels(self.look, self.state.test, self._scale[1])
        if self.state.test in self.look.frames:
            self.state.frames = len(self.look.frames[self.state.test][0]) - 1
            self.state.frame = self.state.frames
        self.select(self.state.sensor)
        self.choose_frame()

    def select(self, name: str) -> None:
        """The curves of a sensor; a name that is no sensor of the test means the first one."""
        names = [s["name"] for s in self.state.sensors]
        self.state.sensor = name if name in names else names[0]
        figure = sensor_figure(self.look.curves[self.state.test], self.state.sensor, theme=self.theme)
        self.state.curve = figure.to_plotly_json()
        if self.stage is not None:
            seen = rows.placed(self.look, self.state.test, self.bench.folder.positions)
            self.stage.markers(seen, self.state.sensor)
            self.push_image()

    def next_sensor(self, step: int) -> None:
        """The one below (1) or above (-1) in the list."""
        names = [s["name"] for s in self.state.sensors]
        self.select(names[(names.index(self.state.sensor) + step) % len(names)])

    def choose_frame(self) -> None:
        """The temperatures at the chosen instant of the test."""
        if self.stage is None or self.state.test not in self.look.frames:
            return
        times, T = self.look.frames[self.state.test]
        i = int(within(self.state.frame, 0, len(times) - 1))
        self.stage.temperatures(T[i])
        self.state.minute = f"{times[i] / 60:.0f} min"
        self.push_image()

    def turn(self, azimuth: float, elevation: float, zoom: float) -> None:
        if self.stage is not None:
            self.stage.turn(azimuth, elevation, zoom)
            self.push_image()

    def first_view(self) -> None:
        if self.stage is not None:
            self.stage.reset()
            self.push_image()

    def paper(self, dark: bool, diagnosis: dict[str, Any] | None) -> None:
        """Light or dark."""
        self.state.dark = dark
        if self.stage is not None:
            self.stage.paper(dark)
        self.select(self.state.sensor)
        self.show_candidates(diagnosis)

    def show_candidates(self, diagnosis: dict[str, Any] | None) -> None:
        """The candidates of a diagnosis, or none."""
        if diagnosis is None:
            self.state.update({"verdict": None, "candidates": [], "has_confusion": False})
            return
        self.state.verdict = rows.conclusion(diagnosis)
        self.state.candidates = rows.candidates(diagnosis, tuple(self.state.effects))
        names = [c["effect"] for c in diagnosis["candidates"] if c["effect"] in diagnosis["confusion"]][:CONFUSED]
        self.state.has_confusion = len(names) > 1
        figure = confusion(names, matrix(diagnosis["confusion"], names), theme=self.theme)
        self.state.confusion = figure.to_plotly_json()


def within(value: Any, low: float, high: float) -> float:
    """A number from the browser, kept between two; `high` for what is no number."""
    number = value if isinstance(value, int | float) and np.isfinite(value) else high
    return float(np.clip(number, low, high))


def debounced(draw: Callable[[], None]) -> Callable[[], None]:
    """`draw` a moment later, once however often it is asked for: curves reach the page before the picture."""
    waiting = False

    def now() -> None:
        nonlocal waiting
        waiting = False
        draw()

    def ask() -> None:
        nonlocal waiting
        if not waiting:
            waiting = True
            asyncio.get_running_loop().call_later(MOMENT_S, now)

    return ask
