"""thermoscope bench live CASE --follow ROWS"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from extras.bench.live.session import Session
from extras.bench.live.settings import read_bench
from extras.bench.live.sources import source_of
from extras.bench.live.steering import UNDECIDED, Steering
from extras.bench.live.store import Store
from thermoscope import InputError, plugin as th

OPEN = (UNDECIDED, "the time is over", "the rows are at their end")


def live_document(
    case: str, follow: str, test: str, drive: bool, json: str | None
) -> tuple[dict[str, Any], list[Mapping[str, Any]]]:
    """What a run on the bench ended with, and its journal; its rows are a test of the case."""
    path = th.find_case(case)
    if th.PACKAGE in path.resolve().parents:
        raise InputError("comes along, and is not written to", str(path), "a copy of its folder")
    if th.file_stem(test) != test:
        raise InputError(f"'{test}' is not a name of a file", "--test", f"a name like {th.file_stem(test)}")
    with th.progress() as tell:
        tell("reading the case")
        network = th.load_case(path, untested=True).case.model.network
    bench = read_bench(path, network)
    store = Store(path, test, bench.sheet_file)
    lines: Callable[[str], None] = (lambda line: th.notes([line])) if json == th.STDOUT or follow == "-" else th.say
    try:
        steering = Steering(bench, store)
        session = Session(steering, source_of(follow), path, drive, lines, follow != "-")
        stop = session.run()
        thought, events = session.thought, store.events()
    finally:
        store.close()
    assessment = thought.assessment if thought else None
    document = {
        "case": path.name,
        "test": test,
        "source": follow,
        "stop": stop,
        "decided": stop not in OPEN,
        "minutes": (steering.time - steering.begin) / 60.0,
        "odds": [{"cause": n, "probability": p} for n, p in (assessment.odds if assessment else ())],
        "sensors_over": list(assessment.over if assessment else ()),
        "cannot_see": list(assessment.unseen if assessment else ()),
        "set_points": [e for e in events if e["event"] == "set"],
        "file": str(store.path),
    }
    return document, events


def live_summary(document: Mapping[str, Any]) -> th.Summary:
    """How it ended, the odds, and what was set."""
    causes = [[th.percent(o["probability"]), th.value_words(o["cause"])] for o in document["odds"]]
    odds = th.Table("Odds", ["odds", "cause"], causes)
    rows = [
        [e["time_s"] / 60.0, ", ".join(f"{n} = {v:g}" for n, v in e["set_point"].items())]
        for e in document["set_points"]
    ]
    parts: list[th.Table | str] = [odds, th.Table("Set points", ["from (min)", "set point"], rows)]
    if document["sensors_over"]:
        parts.append(f"sensors over: {', '.join(document['sensors_over'])}")
    if document["cannot_see"]:
        parts.append(f"cannot see: {', '.join(map(th.value_words, document['cannot_see']))}")
    return th.Summary(
        f"{document['stop']}, after {document['minutes']:.0f} min.", parts, f"every row in {document['file']}"
    )


def live_picture(events: Sequence[Mapping[str, Any]], test: str, out: Path) -> Path:
    """Odds over time, set points beneath.  events : of the journal"""
    from extras.bench.figure import odds_over_time

    file = out / f"{test}-odds.png"
    odds_over_time(th.BenchRun(events), png=file)
    return file
