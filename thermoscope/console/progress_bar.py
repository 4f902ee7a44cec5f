"""Long work on stderr: one bar with share and time left on a terminal, one line a stage in a pipe.

How long the stages took the last time is kept in the user's cache; the first time, what they took on the computer that
`usual_stages.json` was written on. Either is scaled by how fast this run has been so far.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

from geom.text import visible

Progress = Callable[[str], None]
FILE = "stages.json"
MOST = 200  # pieces of work that are remembered
WORTH_S = 2.0  # shorter work has no share and no time left
USUAL = "usual_stages.json"  # beside this file: what two cores took
_blocks = count()  # of this process: `demo` has many
_whole: ContextVar[ProgressBar | None] = ContextVar("whole", default=None)


@dataclass
class ProgressBar:
    """The stages of one piece of work: how long each took so far, and the last time.

    last : stage -> s of the last time, in their order;  clock : s, rising
    shortest_s : work that took less the last time has no share and no time left (s)
    block : which of several pieces of work that have one bar, 0 of a single one; the same word in two of them is two
    stages
    """

    last: dict[str, float]
    clock: Callable[[], float] = time.monotonic
    took: dict[str, float] = field(default_factory=dict)
    now: str = ""
    since: float = 0.0
    block: int = 0
    shortest_s: float = WORTH_S

    def enter(self, message: str) -> bool:
        """Whether another stage begins; messages that begin with the same word are of one stage."""
        word = message.split()[0].rstrip(":,") if message.split() else ""
        stage = f"{self.block} {word}" if self.block and word else word
        if stage == self.now:
            return False
        self.leave()
        self.now = stage
        return True

    def leave(self) -> None:
        """Count the time of the stage that ends."""
        instant = self.clock()
        if self.now:
            self.took[self.now] = self.took.get(self.now, 0.0) + instant - self.since
        self.since, self.now = instant, ""

    def left(self) -> tuple[float, float] | None:
        """Share done, and seconds left at the pace so far, as the last time tells; None where there was none worth it.

        A stage that takes longer than the last time counts as done when it ends, so the share never falls.
        """
        total = sum(self.last.values())
        if total < self.shortest_s:
            return None
        here = self.clock() - self.since if self.now else 0.0
        running = min(here, self.last.get(self.now, 0.0))
        elapsed = running + sum(min(self.took.get(s, 0.0), t) if s == self.now else t
                             for s, t in self.last.items() if s in self.took)  # fmt: skip
        spent = here + sum(self.took.values())
        pace = spent / elapsed if elapsed > self.shortest_s else 1.0
        return min(elapsed / total, 0.99), max(total - elapsed, 0.0) * pace

    def words(self, message: str) -> str:
        """The message with share and time left."""
        remaining = self.left()
        return (
            message
            if remaining is None
            else f"{message} ({100 * remaining[0]:.0f} %, about {_span(remaining[1])} left)"
        )


def _span(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


@contextmanager
def progress() -> Iterator[Progress]:
    """A function that says what is going on."""
    whole = _whole.get()
    if whole is not None:
        whole.block += 1
        with _display(whole) as tell:
            yield tell
        whole.leave()
        return
    with _remembering(f"{_command()} {next(_blocks)}") as stages, _display(stages) as tell:
        yield tell


@contextmanager
def one_bar(shortest_s: float = WORTH_S) -> Iterator[None]:
    """Several pieces of work, each with its `progress`, have one bar: share and time left are of all of them.

    shortest_s : what takes less has neither (s)
    """
    with _remembering(_command(), shortest_s) as stages:
        token = _whole.set(stages)
        try:
            yield
        finally:
            _whole.reset(token)


@contextmanager
def _remembering(key: str, shortest_s: float = WORTH_S) -> Iterator[ProgressBar]:
    """Stages that know how long they took the last time; what they take now is kept for the next."""
    durations = _remembered()
    stages = ProgressBar(durations.get(key) or _usual().get(key, {}), shortest_s=shortest_s)
    try:
        yield stages
        stages.leave()
        if sum(stages.took.values()) > shortest_s:
            _remember({**{k: v for k, v in durations.items() if k != key}, key: stages.took})
    finally:
        stages.leave()


def _command() -> str:
    """The words of the command: "explain diagnose"."""
    return " ".join(word for word in sys.argv[1:3] if not word.startswith("-"))


@contextmanager
def _display(stages: ProgressBar) -> Iterator[Progress]:
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda message: _line(stages.words(message)) if stages.enter(message) else None
        return
    from rich.markup import escape
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    with Bar(
        TextColumn("{task.description}"), BarColumn(20), TimeElapsedColumn(), console=console, transient=True
    ) as bar:
        task = bar.add_task("", total=None)

        def tell(message: str) -> None:
            stages.enter(message)
            remaining = stages.left()
            bar.update(
                task,
                description=escape(visible(stages.words(message))),
                total=remaining and 1.0,
                completed=remaining[0] if remaining else 0.0,
            )

        yield tell


def _line(message: str) -> None:
    print(visible(message), file=sys.stderr, flush=True)


def _file() -> Path:
    from thermoscope.caches import cache_folder

    return cache_folder() / FILE


def _remembered() -> dict[str, dict[str, float]]:
    """What the cache knows; nothing where it is damaged or was never written."""
    return _stages_in(_file())


def _usual() -> dict[str, dict[str, float]]:
    return _stages_in(Path(__file__).with_name(USUAL))


def _stages_in(file: Path) -> dict[str, dict[str, float]]:
    with suppress(OSError, ValueError, TypeError, AttributeError):
        document = json.loads(file.read_text(encoding="utf-8"))
        return {str(k): {str(s): float(t) for s, t in v.items()} for k, v in document.items()}
    return {}


def _remember(stages: dict[str, dict[str, float]]) -> None:
    with suppress(OSError):
        file = _file()
        file.parent.mkdir(parents=True, exist_ok=True)
        newest = dict(list(stages.items())[-MOST:])
        partial = file.with_name(f".{file.name}.{time.time_ns()}")
        partial.write_text(json.dumps(newest), encoding="utf-8")
        partial.replace(file)
