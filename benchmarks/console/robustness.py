"""A process killed, and a disk that fills, at random moments of commands that write: does the case still open?

    python benchmarks/console/robustness.py [--hits 20] [--seed 0] [--json FILE]

Every trial runs one command on a fresh copy of a small case in a process of its own. It is killed (SIGKILL) at a random
moment, or as soon as a file is half written (aimed), or its disk (a small tmpfs, in a mount namespace of its own) is
filled up at a random moment. A trial hits when the command was still at work; trials go on until so many have hit.
After it the case has to open, all inputs be what they were, all earlier revisions be there, and nothing that counts lie
about. `new` makes its case beside the recordings: after it there is none, or one that opens. `serve` is the workbench
of the case with the button "Calibrate" of a tab pressed.
"""

import asyncio
import datetime
import os
import platform
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout, suppress
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "shared")]

from aiohttp import web  # noqa: E402
from small_case import small_case  # noqa: E402

from extras.workbench.machines import Bench  # noqa: E402
from extras.workbench.steps import comparing_job  # noqa: E402
from extras.workbench.tabs import Tabs  # noqa: E402
from scripts.published import benchmark_parser, write_json  # noqa: E402
from thermoscope.case_folder.folder import load_case  # noqa: E402
from thermoscope.cli import main as command_line  # noqa: E402
from thermoscope.commands.open_case import fingerprint  # noqa: E402
from thermoscope.plugin import DROP_BYTES  # noqa: E402

COMMANDS = {
    "calibrate": ("model", "calibrate", "{case}", "--anyway"),
    "add": ("model", "add", "{case}", "convection@flange", "--anyway"),
    "undo": ("model", "undo", "{case}"),
    "improve": ("explain", "improve", "{case}", "--yes", "--most", "1"),
    "new": (
        *("test", "new", "{case}/tests/stand.csv", "{case}/tests/road.csv", "--network", "{case}/network.toml"),
        *("--yes", "--out", "{case}/../made"),
    ),
}
SERVE = "serve"
MADE = "made"
MISSES = 5  # trials for every hit at most: a command may end before it is struck
SPACE = 2**23  # bytes of the disk that fills


@dataclass(frozen=True)
class Trial:
    """hit : the command was still at work when it was struck;  faults : what was wrong with the case afterwards"""

    command: str
    strike: str
    hit: bool
    written: bool
    faults: tuple[str, ...]


def started(name: str, case: Path) -> int:
    """A child that runs a command with everything loaded already; its process id."""
    child = os.fork()
    if child:
        return child
    code = 3
    try:
        with Path(os.devnull).open("w") as nowhere:
            os.dup2(nowhere.fileno(), 1)
            os.dup2(nowhere.fileno(), 2)
            code = asyncio.run(pressed(case)) if name == SERVE else ran(name, case)
    finally:
        os._exit(code)


def ran(name: str, case: Path) -> int:
    """Exit code of a command in this process."""
    sys.argv = ["thermoscope", *(word.format(case=case) for word in COMMANDS[name])]
    try:
        command_line()
    except SystemExit as end:
        return int(end.code or 0)
    return 0


async def pressed(case: Path) -> int:
    """The workbench with a tab in which "Calibrate" is pressed; 2 where the page then shows an error."""
    os.environ["TRAME_ARGS"] = "--server"
    opened = Bench(load_case(case))
    await opened.compared(comparing_job)
    tabs = Tabs(opened, DROP_BYTES.most)
    with suppress(web.HTTPFound):  # on to the tab that was made
        await tabs.new(None)  # type: ignore[arg-type]
    session = next(iter(tabs.open.values())).session
    await session.step("calibrate")
    await session.keep_anyway()
    failed = bool(session.state.error)
    await tabs.close()
    return 2 if failed else 0


def ended(child: int) -> int | None:
    """Exit status (os.waitstatus_to_exitcode) of a child that has ended, else None."""
    done, status = os.waitpid(child, os.WNOHANG)
    return os.waitstatus_to_exitcode(status) if done else None


def killed(child: int, case: Path, wait: Callable[[Path], bool], limit: float) -> bool:
    """Kill when `wait` says so or time is up; whether it was still running."""
    end = time.monotonic() + limit
    while time.monotonic() < end and not wait(case):
        if ended(child) is not None:
            return False
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return True


def half_written(case: Path) -> bool:
    folders = [folder for folder in (case, case / "out", case.parent) if folder.is_dir()]
    return any(".part" in p.name or p.name.startswith(f".{MADE}.") for folder in folders for p in folder.iterdir())


def filled(child: int, case: Path, limit: float) -> bool:
    """Fill the disk after `limit` s and wait for the end; whether the command failed by it."""
    time.sleep(limit)
    with suppress(OSError), (case.parent / "ballast").open("wb", buffering=0) as ballast:
        while True:
            ballast.write(b"\0" * 4096)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status) == 2


def state(case: Path) -> dict[str, bytes]:
    """All that the user brought."""
    files = [p for p in case.rglob("*") if p.is_file() and "out" not in p.parts and not p.name.startswith(".")]
    return {str(p.relative_to(case)): p.read_bytes() for p in files if p.name != "model.toml"}


def faults(case: Path, before: dict[str, bytes], revisions: int, print_: str) -> Iterator[str]:
    """What is wrong with a case after a strike."""
    if state(case) != before:
        yield "inputs differ"
    if fingerprint(case, "model.toml") != print_:
        yield "something lies about that counts as input"
    try:
        if len(load_case(case).history.revisions) < revisions:
            yield "revisions are lost"
    except Exception as fault:
        yield f"does not open: {fault}"
    if (made := case.parent / MADE).exists():
        try:
            if len(load_case(made).case.tests) != 2:
                yield "tests are missing from the new case"
        except Exception as fault:
            yield f"the new case does not open: {fault}"


def cleared(home: Path) -> None:
    """Nothing of a trial is left, what a killed command began neither."""
    for path in (home / "case", home / MADE, *home.glob(f".{MADE}.*")):
        shutil.rmtree(path, ignore_errors=True)


def trial(name: str, strike: str, home: Path, original: Path, rng: random.Random, usual: float) -> Trial:
    """One command on one copy, struck once."""
    case = Path(shutil.copytree(original, home / "case"))
    try:
        before, revisions, print_ = state(case), len(load_case(case).history.revisions), fingerprint(case, "model.toml")
        child = started(name, case)
        at = rng.uniform(0.0, usual)
        if strike == "full disk":
            hit = filled(child, case, at)
        elif strike == "aimed":
            hit = killed(child, case, half_written, 20.0 * usual)
        else:
            hit = killed(child, case, lambda _: False, at)
        (home / "ballast").unlink(missing_ok=True)
        wrong = tuple(faults(case, before, revisions, print_))
        written = not wrong and ((home / MADE).exists() or len(load_case(case).history.revisions) > revisions)
        return Trial(name, strike, hit, written, wrong)
    finally:
        cleared(home)


def trials(
    name: str, strike: str, home: Path, original: Path, rng: random.Random, usual: float, hits: int
) -> list[Trial]:
    """As many as it takes for so many hits."""
    done: list[Trial] = []
    while sum(t.hit for t in done) < hits and len(done) < MISSES * hits:
        done.append(trial(name, strike, home, original, rng, usual))
    return done


def usual_time(name: str, home: Path, original: Path) -> float:
    """Seconds that a command takes when nothing strikes it."""
    case = Path(shutil.copytree(original, home / "case"))
    begin = time.monotonic()
    _, status = os.waitpid(started(name, case), 0)
    took = time.monotonic() - begin
    cleared(home)
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        raise SystemExit(f"{name} fails when nothing strikes it")
    return took


def loaded(name: str, home: Path, original: Path) -> None:
    """Run a command here once: what it loads and compiles, every child has from its start."""
    if name == SERVE:  # a server of processes is of the process that started it
        return
    case = Path(shutil.copytree(original, home / "case"))
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
        ran(name, case)
    cleared(home)


@contextmanager
def disk(folder: Path) -> Iterator[bool]:
    """A small disk mounted there, where this process may mount one."""
    folder.mkdir()
    options = ["-t", "tmpfs", "-o", f"size={SPACE}", "none", str(folder)]
    mounted = subprocess.run(["mount", *options], capture_output=True).returncode == 0
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", "-l", str(folder)], check=True)


def prepared(folder: Path) -> Path:
    """A small case with one revision to lose."""
    case = small_case(folder)
    os.waitpid(started("calibrate", case), 0)
    if not load_case(case).history.revisions:
        raise SystemExit("the case could not be prepared")
    return case


def measured(hits: int, seed: int) -> list[Trial]:
    """All trials: every command, killed at random and aimed, and on a disk that fills."""
    rng, out = random.Random(seed), []
    with tempfile.TemporaryDirectory() as work, disk(Path(work) / "disk") as mounted:
        home, original = Path(work), prepared(Path(work))
        for name in (*COMMANDS, SERVE):
            loaded(name, home, original)
            usual = usual_time(name, home, original)
            strikes = {"killed": home, "aimed": home, **({"full disk": home / "disk"} if mounted else {})}
            for strike, place in strikes.items():
                done = trials(name, strike, place, original, rng, usual, hits)
                struck, wrong = sum(t.hit for t in done), sum(bool(t.faults) for t in done)
                print(f"{name:10s} {strike:10s} {len(done)} trials, {struck} hit, {wrong} left a fault", flush=True)
                out += done
        if not mounted:
            print("no disk could be mounted: run as root, or under unshare -rm")
    return out


def main() -> None:
    """Print the table; exit code 1 if any trial left a fault."""
    parser = benchmark_parser(__doc__)
    parser.add_argument("--hits", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    print(f"{platform.machine()}, Python {platform.python_version()}, {datetime.date.today()}", flush=True)
    done = measured(options.hits, options.seed)
    hits, wrong = [t for t in done if t.hit], [t for t in done if t.faults]
    print(f"{len(done)} trials, {len(hits)} hit, {len(wrong)} left a fault")
    for t in wrong:
        print(t)
    write_json(options.json, {"trials": [vars(t) for t in done]})
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
