"""A run on the bench, as its journal in the case has it: what the page shows of it, and "done" said back to it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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
