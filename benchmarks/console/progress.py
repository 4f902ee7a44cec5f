"""How true the time left is: commands on a terminal of 80 columns, the first time on a computer and the second.

    python benchmarks/console/progress.py [--only CASE ...] [--commands COMMAND ...] [--json FILE] [--page] [--usual]
    python benchmarks/console/progress.py --builds FILE

Every shipped case by default, and the four commands that may take long; the first run builds what comes from a machine.
After a fifth of the work: the time left as it was shown over what it was then (wanted: 0.5 to 2). The longest time for
which the share stood still, and whether every line kept its times. Work that is done in SHORT_S shows nothing.
--json FILE keeps the rows of earlier runs for other cases and commands; --page puts all of them into the docs. --usual
writes what the stages of the first runs took, the median over the cases, into what a new computer starts with.
--builds does the same for `model build` by the rows of benchmarks/condensed/builds.py.
"""

import json
import os
import pty
import re
import select
import shutil
import struct
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise, product
from pathlib import Path
from statistics import median

from scripts.published import benchmark_parser, publish, table, write_json
from thermoscope.console.progress_bar import PREPARING

ROOT = Path(__file__).resolve().parents[2]
USUAL = ROOT / "thermoscope" / "console" / "usual_stages.json"
CASES = tuple(sorted(file.parent.name for file in (ROOT / "cases").glob("*/case.toml")))
OF_CASES = {"compare": "test", "calibrate": "model", "diagnose": "explain", "improve": "explain"}
ALONE = {"improve": ["--yes"]}  # without which a command asks
COMMANDS = {**OF_CASES, "build": "model"}  # build: --only names machines
COLUMNS, SHORT_S, FIFTH, STOOD_S = 80, 10.0, 0.2, 20.0
CONTROL = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
LINE = re.compile(r"([\d.]+) %, about (\d+) (s|min) left")


@dataclass(frozen=True)
class Row:
    """ratio : time left as shown over as it was, after a fifth of the work;  stood_s : longest without a new share"""

    command: str
    case: str
    run: str
    took_s: float
    ratio: float | None
    stood_s: float | None
    widest: int


def shown(command: list[str], environment: dict[str, str]) -> Iterator[tuple[float, str]]:
    """Seconds since the start, and the lines as a terminal gets them."""
    import fcntl
    import termios

    pid, terminal = pty.fork()
    if pid == 0:
        os.execvpe(command[0], command, environment)
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))
    begin = time.monotonic()
    while True:
        select.select([terminal], [], [])
        try:
            text = os.read(terminal, 2**16).decode(errors="replace")
        except OSError:  # how a terminal says that nobody writes any more
            break
        for line in CONTROL.sub("\r", text).replace("\n", "\r").split("\r"):
            yield time.monotonic() - begin, line
    os.waitpid(pid, 0)


def measured(name: str, case: str, run: str, cache: str) -> Row:
    """One command, on a copy of a shipped case; or the build of a machine of the library."""
    copy = Path(cache) / case
    if name in OF_CASES:
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(ROOT / "cases" / case, copy, ignore=shutil.ignore_patterns("out"))
    subject = [str(copy)] if name in OF_CASES else [case, "--out", str(copy)]
    command = [sys.executable, "-m", "thermoscope", COMMANDS[name], name, *subject, *ALONE.get(name, [])]
    lines = list(shown(command, {**os.environ, "THERMOSCOPE_CACHE": cache, "TERM": "xterm"}))
    took, widest = lines[-1][0], max(len(line) for _, line in lines)
    found = [(t, m) for t, line in lines if (m := LINE.search(line))]
    later = [(t, float(m[2]) * (60.0 if m[3] == "min" else 1.0)) for t, m in found if t >= FIFTH * took]
    if not later or took < SHORT_S:
        return Row(name, case, run, took, None, None, widest)
    changes = [t for (_, a), (t, b) in pairwise(found) if a[1] != b[1]]
    stood = max(b - a for a, b in pairwise([found[0][0], *changes, took]))
    return Row(name, case, run, took, later[0][1] / (took - later[0][0]), stood, widest)


def verdict(rows: Sequence[Row]) -> str:
    """How many of the runs that take long are as wanted."""
    long = [row for row in rows if row.ratio is not None and row.stood_s is not None]
    good = sum(0.5 <= (row.ratio or 0.0) <= 2.0 and (row.stood_s or 0.0) <= STOOD_S for row in long)
    return f"{good} of {len(long)} runs of {SHORT_S:.0f} s or more: within a factor two, stood at most {STOOD_S:.0f} s"


def runs_table(rows: Sequence[Row]) -> str:
    """Of the docs."""
    long = (
        (r.command, r.case, r.run, f"{r.took_s:.0f}", f"{r.ratio:.2f}", f"{r.stood_s:.0f}")
        for r in rows
        if r.ratio is not None
    )
    found = table(["command", "case", "run", "took (s)", "said over true", "stood (s)"], long)
    short = sorted({f"{r.command} {r.case} ({r.run})" for r in rows if r.ratio is None})
    return "\n".join([found, "", f"{verdict(rows)}.", *([f"Shorter: {', '.join(short)}."] if short else [])])


def usual(stages: Sequence[dict[str, float]]) -> dict[str, float]:
    """The median of each stage over the cases that have it (s), in the order in which the longest list has them.

    Where some cases come to a further step, "1 looking", one like the first is foretold: how many come nobody knows,
    and what they took in other cases says less of a case than its own first step.
    """
    longest = sorted(stages, key=len, reverse=True)
    words = dict.fromkeys(w for t in longest for w in t)
    once = {word: round(median(t[word] for t in stages if word in t), 1) for word in words if not word[0].isdigit()}
    again = {f"1 {word}": took for word, took in once.items() if word not in PREPARING}
    return once | ({"1 step": 0.0} | again if len(once) < len(words) else {})


def alone(row: dict[str, float]) -> float:
    """Of the time that a build took, what it would have taken without others on the computer; 1 where it had it all."""
    return min(row["cpu_s"] / row["wall_s"], 1.0)


def keep_usual(took: dict[str, list[dict[str, float]]]) -> None:
    """Write what the stages of commands usually take.  took : command -> its stages in several runs (s)"""
    again = {f"{COMMANDS[name]} {name} 0": usual(stages) for name, stages in took.items()}
    USUAL.write_text(json.dumps(json.loads(USUAL.read_text()) | again, indent=1), encoding="utf-8")


def main() -> None:
    """A row per case and run."""
    parser = benchmark_parser(__doc__)
    parser.add_argument("--only", nargs="+", default=CASES)
    parser.add_argument("--commands", nargs="+", default=OF_CASES, choices=COMMANDS)
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--usual", action="store_true")
    parser.add_argument("--builds", type=Path)
    options = parser.parse_args()
    if options.builds:
        builds = json.loads(options.builds.read_text())
        keep_usual({"build": [{s: t * alone(row) for s, t in row["stages"].items()} for row in builds]})
        return
    rows = (
        [Row(**row) for row in json.loads(options.json.read_text())] if options.json and options.json.exists() else []
    )
    took: dict[str, list[dict[str, float]]] = {}
    for command, case in product(options.commands, options.only):
        rows = [row for row in rows if (row.command, row.case) != (command, case)]
        with tempfile.TemporaryDirectory() as cache:
            rows.append(measured(command, case, "first", cache))
            file = Path(cache) / "stages.json"
            document = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
            took.setdefault(command, []).append(dict(document.get(f"{COMMANDS[command]} {command} 0", {})))
            rows.append(measured(command, case, "second", cache))
        for row in rows[-2:]:
            told = "short" if row.ratio is None else f"{row.ratio:5.2f} of what was left, stood {row.stood_s:.0f} s"
            print(
                f"{command:9s} {row.case:13s} {row.run:7s} {row.took_s:6.1f} s  {told}, {row.widest} columns",
                flush=True,
            )
    print(verdict(rows))
    if options.usual:
        keep_usual(took)
    write_json(options.json, [asdict(row) for row in rows])
    if options.page:
        publish(ROOT / "docs" / "benchmarks.md", "progress", runs_table(rows))


if __name__ == "__main__":
    main()
