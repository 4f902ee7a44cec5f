"""What a tab shows: one model, one test, one sensor, and a run on the bench. Every value from the browser is checked.

A run is shown as its journal in the case has it, and "done" is said back to it.
"""

from pathlib import Path
from typing import Any

from extras.workbench import tables as rows
from extras.workbench.appearance import Appearance, effective
from extras.workbench.machines import Bench
from thermoscope import plugin as th

LOOK_S = 2.0  # between two looks at the journal


def newest(case: Path) -> Path | None:
    """The journal that was written to last, of all runs of a case."""
    return max((case / "tests").glob("*.jsonl"), key=lambda f: f.stat().st_mtime, default=None)


def say_done(file: Path) -> None:
    """The set point is there, as a person says it to the run that writes this journal."""
    file.with_suffix(".done").touch()


def state_and_picture(file: Path, theme: th.Theme) -> tuple[dict[str, Any], dict[str, Any]] | None:
    """What the page says of a run, and the picture of it; None before its first look at the odds."""
    run = th.BenchRun(th.journal(file))
    looks, sets = run.of("odds"), run.of("set")
    if not looks:
        return None
    last, begins = looks[-1], run.of("run")
    fault = run.events[-1].get("what", "") if run.events[-1]["event"] == "fault" else ""
    state = {
        "test": file.stem,
        "minutes": f"{run.minutes(last):.0f}",
        "odds": [
            {"code": n, "cause": th.value_words(n), "p": th.percent(p), "width": round(100.0 * p, 2)}
            for n, p in last["odds"]
        ],
        "over": ", ".join(last["over"]),
        "unseen": [*map(th.value_words, last["unseen"])],
        "left": "" if last.get("stop") else f"about {last['left_min']:.0f} min left",
        "stop": fault or last.get("stop", ""),
        "fault": bool(fault),
        "set": [{"name": n, "value": f"{v:g}"} for n, v in (sets[-1]["set_point"] if sets else {}).items()],
        "asks": run.waits and not (begins and begins[-1]["drive"]),
    }
    return state, th.bench_run(run, theme=theme).to_plotly_json()


CONFUSED = 8  # names that a row holds
NOTHING: dict[str, Any] = {"data": [], "layout": {}}
START: dict[str, Any] = {  # of a tab, before anything is known
    **dict.fromkeys(("busy", "comparing", "dark", "can_undo", "has_confusion"), False),
    **dict.fromkeys(("error", "report", "viewer", "viewer_rest", "preparing", "test", "sensor", "plotly"), ""),
    **dict.fromkeys(("rms", "floor", "plain", "warning", "dragged", "made"), ""),
    **dict.fromkeys(("outcome", "verdict", "live", "drop"), None),
    **dict.fromkeys(("curve", "confusion", "live_curve"), NOTHING),
    **{name: [] for name in ("tests", "test_names", "sensors", "effects", "steps", "candidates", "imported")},
    **dict.fromkeys(("plots", "revision"), 0),
    "job": {"title": "", "message": "", "percent": None},
    "limits": {},
}


class Display:
    """The part of a tab that only looks. `server` is a trame server; the page is drawn from its state."""

    look: Appearance | None  # None until the first comparison is there

    def __init__(self, bench: Bench, server: Any) -> None:
        self.bench, self.server, self.look = bench, server, None
        self._scale = 0.0, 0.0
        self.state.update({**START, "case_name": bench.folder.case.name, "why_flat": bench.why_flat})
        self.state.test, self.state.revision = th.by_interest(bench.folder)[0].name, bench.folder.history.last.number
        self.state.test_names = [test.name for test in bench.folder.case.tests]
        self.state.change("test")(lambda **_: self.choose_test())

    @property
    def state(self) -> Any:
        return self.server.state

    @property
    def theme(self) -> th.Theme:
        return th.DARK if self.state.dark else th.LIGHT

    def model(self, history: th.History, look: Appearance) -> None:
        """Another model: its errors, curves and temperatures."""
        if self.look is None:
            self.state.test, self.state.sensor = rows.worst(look)
        self.look, self.state.limits = look, look.limits
        last, errors = history.last, look.errors
        case = self.bench.folder.case
        self.state.effects = [{"code": name, "words": th.added_words(case, [name])} for name in last.effects]
        self.state.revision, self.state.steps = last.number, rows.steps(history, case)
        self.state.can_undo = len(effective(history)) > 1
        self.state.rms, self.state.floor = f"{errors['rmse_K']:.2f}", f"{errors['floor_K']:.2f}"
        first = errors.get("yardstick", {}).get("warning"), errors.get("strained")
        self.state.warning, self.state.plain = " ".join(filter(None, first)), th.yardstick_words(errors)
        (test, sensor), scale = rows.largest(look), self._scale
        ever = [error for r in history.revisions for pair in r.rmse_K.values() for error in pair]
        self._scale = max(test, scale[0], *ever), max(sensor, scale[1])
        self.state.tests = rows.tests(look, self._scale[0], {name: a for name, (a, _) in last.rmse_K.items()})
        self.choose_test()

    def choose_test(self) -> None:
        """The sensors of the chosen test."""
        if self.look is None or self.state.test not in self.look.curves:
            return
        self.state.sensors = rows.channels(self.look, self.state.test, self._scale[1])
        self.select(self.state.sensor)

    def select(self, name: str) -> None:
        """The curves of a sensor; a name that is not a sensor of the test means the first one."""
        names = [s["name"] for s in self.state.sensors]
        if self.look is None or not names:
            return
        self.state.sensor = name if name in names else names[0]
        figure = th.sensor(self.look.curves[self.state.test], self.state.sensor, theme=self.theme)
        self.state.curve = figure.to_plotly_json()

    def next_sensor(self, step: int) -> None:
        """The one below (1) or above (-1) in the list."""
        names = [s["name"] for s in self.state.sensors] or [""]
        self.select(names[(names.index(self.state.sensor) + step) % len(names)])

    def paper(self, dark: bool, diagnosis: dict[str, Any] | None) -> None:
        """Light or dark."""
        self.state.dark = dark
        self.select(self.state.sensor)
        self.show_candidates(diagnosis)

    def show_bench(self, file: Path) -> None:
        """What runs on the bench, or ran there last."""
        if (of_run := state_and_picture(file, self.theme)) is not None:
            self.state.live, self.state.live_curve = of_run

    def show_candidates(self, diagnosis: dict[str, Any] | None) -> None:
        """The candidates of a diagnosis, or none."""
        if diagnosis is None:
            self.state.update({"verdict": None, "candidates": [], "has_confusion": False})
            return
        self.state.verdict = rows.conclusion(diagnosis)
        self.state.candidates = rows.candidates(diagnosis, {e["code"] for e in self.state.effects})
        names = [c["effect"] for c in diagnosis["candidates"] if c["effect"] in diagnosis["confusion"]][:CONFUSED]
        self.state.has_confusion = len(names) > 1
        words = {c["effect"]: c.get("words") or c["effect"] for c in diagnosis["candidates"]}
        figure = th.confusion([words[n] for n in names], th.matrix(diagnosis["confusion"], names), theme=self.theme)
        self.state.confusion = figure.to_plotly_json()
