"""thermoscope bench live CASE --follow ROWS"""

from collections.abc import Callable, Mapping
from typing import Annotated, Any

import typer

from extras.bench.live.session import Session
from extras.bench.live.settings import read_bench
from extras.bench.live.sources import source_of
from extras.bench.live.steering import UNDECIDED, Steering
from extras.bench.live.store import Store
from thermoscope import InputError, plugin as th

OPEN = (UNDECIDED, "the time is over", "the rows are at their end")


def live(
    case: th.CaseArgument,
    follow: Annotated[str, typer.Option("--follow", metavar="ROWS", help="FILE, -, tcp://HOST:PORT or mqtt://HOST.")],
    test: Annotated[str, typer.Option(metavar="NAME", help="The test of the case that the rows become.")] = "live",
    drive: Annotated[bool, typer.Option("--drive", help="Send the set points; else a person sets them.")] = False,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """A test that steers itself: rows come in, the next set point goes out, until one cause has 90 %.

    Exit code 1 if it ends without an answer.
    """
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
    th.give(document, json, lambda: live_summary(document))
    if out is not None:
        from extras.bench.figure import odds_over_time

        file = out / f"{test}-odds.png"
        odds_over_time(th.BenchRun(events), png=file)
        th.notes([f"written: {file}"])
    return 0 if document["decided"] else 1


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
