"""Long work on stderr: one bar with share and time left on a terminal, one line a stage in a pipe.

How long the stages took the last time is kept in the user's cache; until then only the time that has passed is known.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path

Progress = Callable[[str], None]
FILE = "stages.json"
MOST = 200  # pieces of work that are remembered
WORTH_S = 2.0  # shorter work has no share and no time left
_blocks = count()  # of this process: `demo` has many


@dataclass
class ProgressBar:
    """The stages of one piece of work: how long each took so far, and the last time.

    last : stage -> s of the last time, in their order;  clock : s, rising
    """

    last: dict[str, float]
    clock: Callable[[], float] = time.monotonic
    took: dict[str, float] = field(default_factory=dict)
    now: str = ""
    since: float = 0.0

    def enter(self, message: str) -> bool:
        """Whether another stage begins; messages that begin with the same word are of one stage."""
        stage = message.split()[0].rstrip(":,") if message.split() else ""
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
        """Share done and seconds left as the last time tells; None where there was none worth it."""
        total = sum(self.last.values())
        if total < WORTH_S:
            return None
        running = min(self.clock() - self.since, self.last.get(self.now, 0.0))
        done = running + sum(min(self.took.get(s, 0.0), t) if s == self.now else t
                             for s, t in self.last.items() if s in self.took)  # fmt: skip
        return min(done / total, 0.99), max(total - done, 0.0)

    def words(self, message: str) -> str:
        """The message with share and time left."""
        found = self.left()
        return message if found is None else f"{message} ({100 * found[0]:.0f} %, about {_span(found[1])} left)"


def _span(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


@contextmanager
def progress() -> Iterator[Progress]:
    """A function that says what is going on."""
    key = f"{' '.join(sys.argv[1:3])} {next(_blocks)}"
    known = _remembered()
    stages = ProgressBar(known.get(key, {}))
    try:
        with _shown(stages) as tell:
            yield tell
        stages.leave()
        if sum(stages.took.values()) > WORTH_S:
            _remember({**{k: v for k, v in known.items() if k != key}, key: stages.took})
    finally:
        stages.leave()


@contextmanager
def _shown(stages: ProgressBar) -> Iterator[Progress]:
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda message: _line(stages.words(message)) if stages.enter(message) else None
        return
    from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    with Bar(
        TextColumn("{task.description}"), BarColumn(20), TimeElapsedColumn(), console=console, transient=True
    ) as bar:
        task = bar.add_task("", total=None)

        def tell(message: str) -> None:
            stages.enter(message)
            found = stages.left()
            bar.update(
                task, description=stages.words(message), total=found and 1.0, completed=found[0] if found else 0.0
            )

        yield tell


def _line(message: str) -> None:
    print(message, file=sys.stderr, flush=True)


def _file() -> Path:
    from thermoscope.caches import cache_folder

    return cache_folder() / FILE


def _remembered() -> dict[str, dict[str, float]]:
    """What the cache knows; nothing where it is damaged or was never written."""
    with suppress(OSError, ValueError, TypeError, AttributeError):
        found = json.loads(_file().read_text(encoding="utf-8"))
        return {str(k): {str(s): float(t) for s, t in v.items()} for k, v in found.items()}
    return {}


def _remember(known: dict[str, dict[str, float]]) -> None:
    with suppress(OSError):
        file = _file()
        file.parent.mkdir(parents=True, exist_ok=True)
        newest = dict(list(known.items())[-MOST:])
        partial = file.with_name(f".{file.name}.{next(_blocks)}-{time.time_ns()}")
        partial.write_text(json.dumps(newest), encoding="utf-8")
        partial.replace(file)
