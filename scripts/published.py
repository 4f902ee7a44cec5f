"""Put the tables of measured error into the pages that show them, between their markers.

    thermoscope demo --json out/demo.json
    python examples/hust.py --out out/hust
    python examples/tclab.py --out out/tclab
    python -m scripts.published [--demo out/demo.json] [--hust out/hust] [--tclab out/tclab]

The front page and the page of hust-ipmsm take theirs from one run, so they cannot disagree.
"""

import argparse
import datetime
import json
import os
import platform
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TextIO

ROOT = Path(__file__).parents[1]
FRONT, HUST = ROOT / "README.md", ROOT / "cases" / "hust-ipmsm" / "README.md"
TCLAB = ROOT / "cases" / "tclab" / "README.md"


def between(text: str, marker: str, new: str) -> str:
    """The text with what stands between a marker's begin and end replaced."""
    begin, end = f"<!-- {marker}:begin -->\n", f"\n<!-- {marker}:end -->"
    before, _, rest = text.partition(begin)
    after = rest.partition(end)[2]
    if not rest or not after:
        raise SystemExit(f"no pair of markers '{marker}'")
    return f"{before}{begin}{new.strip()}{end}{after}"


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table in Markdown."""
    first = "|".join(f" {name} " if name else " " for name in head)
    lines = (f"| {' | '.join(map(str, row))} |" for row in rows)
    return "\n".join([f"|{first}|", f"|{'---|' * len(head)}", *lines])


def demo_table(stages: Sequence[Mapping[str, Any]]) -> str:
    """Rms error (K) of all sensors, a row per model; the held-out test in bold."""
    tests = stages[0]["tests"]
    bold = ["**" if t["role"] == "hold-out" else "" for t in tests]
    names = [f"{b}{t['name']}{' (held out)' if b else ''}{b}" for b, t in zip(bold, tests, strict=True)]
    cells = ([f"{b}{t['rmse_K']:.2f}{b}" for b, t in zip(bold, stage["tests"], strict=True)] for stage in stages)
    return table(["model", *names], ([stage["stage"], *row] for stage, row in zip(stages, cells, strict=True)))


def demo_time(demo: Mapping[str, Any]) -> str:
    """How long it took, on what."""
    on = f"{os.cpu_count()} cores, which may have had other work ({datetime.date.today().isoformat()})"
    return f"That run took {demo['core_s']} s of one core in all; {demo['seconds']} s on {on}."


def benchmark_parser(description: str | None) -> argparse.ArgumentParser:
    """The options of a benchmark begin with --json FILE.  description : the docstring of its file, as it stands"""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows there; - is stdout")
    return parser


def machine_arguments(description: str | None) -> argparse.Namespace:
    """MACHINE ... --json FILE --page, of a benchmark that keeps rows by machine and publishes them on a page."""
    parser = benchmark_parser(description)
    parser.add_argument("machines", nargs="*", default=[], metavar="MACHINE", help="all others' rows stay in FILE")
    parser.add_argument("--page", action="store_true", help="put the tables of FILE into docs/condensation.md")
    return parser.parse_args()


def kept_rows(given: argparse.Namespace) -> list[dict[str, Any]]:
    """Rows of an earlier run that are not measured again.  given : as `machine_arguments` reads them"""
    rows = json.loads(given.json.read_text())["rows"] if given.json and given.json.exists() else []
    return [row for row in rows if row["machine"] not in given.machines]


def measured_row(
    case: str, measure: str, unit: str, ours: float, peer: float | None = None, peer_name: str | None = None
) -> dict[str, Any]:
    """A row of a benchmark; ratio is ours over the peer's, or over what is wanted."""
    against = {"peer": peer, "peer_name": peer_name, "ratio": ours / peer if peer else None}
    return {"case": case, "measure": measure, "unit": unit, "ours": ours, **against, "n": None, "ci95": None}


def print_rows(rows: Iterable[Mapping[str, Any]], to: TextIO | None = None) -> None:
    """Rows of a benchmark, one a line; to : stdout if it is not given."""
    for r in rows:
        peer = f"   {r['peer_name']} {r['peer']:.4g}   ratio {r['ratio']:.3g}" if r["peer"] else ""
        print(f"{r['case']:36} {r['measure']:36} {r['ours']:12.6g} {r['unit']}{peer}", file=to, flush=True)


def cpu_s() -> float:
    """CPU time of this process and of those that it started and that ended (s)."""
    import resource

    both = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(u.ru_utime + u.ru_stime for u in both)


def timed(run: Callable[[], Any], repeats: int = 1) -> tuple[float, float, Any]:
    """Least wall and least CPU seconds over the repeats, those of processes that it started too; the last result."""
    seconds, out = [], None
    for _ in range(repeats):
        wall, cpu = time.perf_counter(), cpu_s()
        out = run()
        seconds.append((time.perf_counter() - wall, cpu_s() - cpu))
    walls, cpus = zip(*seconds, strict=True)
    return min(walls), min(cpus), out


def json_lines(file: Path) -> list[dict[str, Any]]:
    """Rows of a run that may go on: a line of JSON each; none where there is no file yet."""
    return [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []


def add_lines(file: Path, *rows: Mapping[str, Any]) -> None:
    """Further rows at the end of such a file."""
    with file.open("a") as out:
        out.writelines(f"{json.dumps(row)}\n" for row in rows)


def write_rows(file: Path | None, benchmark: str, rows: Sequence[Mapping[str, Any]], **more: Any) -> None:
    """The rows of a benchmark with its name, this computer and the date, as `write_json` writes them."""
    computer = f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"
    head = {"benchmark": benchmark, "computer": computer, "date": datetime.date.today().isoformat(), **more}
    write_json(file, {**head, "rows": rows})


def write_json(file: Path | None, document: Any) -> None:
    """What a benchmark found; "-" is stdout, None nowhere."""
    text = json.dumps(document, indent=1)
    if str(file) == "-":
        print(text)
    elif file:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


def publish(page: Path, marker: str, table: str) -> None:
    page.write_text(between(page.read_text(encoding="utf-8"), marker, table), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--demo", type=Path, help="what thermoscope demo --json wrote")
    parser.add_argument("--hust", type=Path, help="folder that examples/hust.py wrote to")
    parser.add_argument("--tclab", type=Path, help="folder that examples/tclab.py wrote to")
    options = parser.parse_args()
    if options.demo:
        demo = json.loads(options.demo.read_text(encoding="utf-8"))
        publish(FRONT, "demo-rows", demo_table(demo["stages"]))
        publish(FRONT, "demo-time", demo_time(demo))
    if options.hust:
        publish(FRONT, "hust-rows", (options.hust / "front-page.md").read_text(encoding="utf-8"))
        publish(HUST, "hust-tables", (options.hust / "table.md").read_text(encoding="utf-8"))
    if options.tclab:
        publish(TCLAB, "tclab-tables", (options.tclab / "table.md").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
