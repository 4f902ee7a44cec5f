"""Long work on stderr: one bar with share and time left on a terminal, one line a stage in a pipe.

How long the stages took the last time is kept in the user's cache; the first time, what they took in the shipped cases,
in `usual_stages.json`. Either is scaled by how fast this run has been so far. The share moves at the speed that ends
with the time left, so that it never stands.
"""

import json
import re
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from itertools import count
from math import ceil, exp, floor, log10
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING

from geom.errors import InputError
from geom.storage import cache_folder, write_whole
from geom.text import visible

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Task

Progress = Callable[[str], None]
FILE = "stages.json"
MOST = 200  # pieces of work that are remembered
COUNT = re.compile(r"\((\d+) of (\d+)\)$")  # at the end of a message
ALONE = re.compile(COUNT.pattern)
AGAIN = re.compile(r"step \d+: ")  # before a message: the same stages come once more
SLOW_S = 10.0  # a percent that takes longer is shown in parts, so that the share does not seem to stand
SPARE = 0.05  # of the time so far: what the share keeps for steps that nobody can foretell
QUIET_S = 15.0  # a pipe that says nothing for longer looks as if it hung
PACED_S = 0.5  # stages that took less the last time say nothing of the pace
# Stages whose cost is that of files and meshes: they say little of how long fits take, which say much of each other.
BUILDING = {"mesh", "conduction", "network", "field", "laws", "what", "error", "checking"}  # what is made once and kept
PREPARING = BUILDING | {"reading", "preparing", "estimating"}
RUNS = 1.2  # power: where a model runs in a sixth of the time, all that fits it takes a tenth (tclab beside hust-ipmsm)
PATIENCE_S = 10.0  # shorter work may say nothing of its time
WORTH_S = 2.0  # shorter work has no share and no time left
USUAL = "usual_stages.json"  # beside this file: what two cores took
_blocks = count()  # of this process: `demo` has many
_whole: "ContextVar[ProgressBar | None]" = ContextVar("whole", default=None)


@dataclass
class ProgressBar:
    """The stages of one piece of work: how long each took so far, and the last time.

    last : stage -> s of the last time, in their order;  clock : s, rising
    shortest_s : work that took less the last time has no share and no time left (s)
    block : which of several pieces of work that have one bar, 0 of a single one; the same word in two of them is two
    stages;  part : of the stage that runs, where its messages count "(3 of 200)";  piece : of it, between two counts
    counted_s : how long the stage ran up to its last count (s);  same_case : is `last` of this very one?
    loop : start of a loop in the stage (s), part of it that is done, and with the piece that runs
    share : on the line;  share_s : when
    cpu : s that this process has computed, rising;  start : clock and cpu at the first stage
    """

    last: dict[str, float]
    clock: Callable[[], float] = time.monotonic
    took: dict[str, float] = field(default_factory=dict)
    now: str = ""
    since: float = 0.0
    block: int = 0
    shortest_s: float = WORTH_S
    part: float = 0.0
    piece: float = 0.0
    counted_s: float = 0.0
    loop: tuple[float, float, float] = (0.0, 0.0, 1.0)
    share: float = 0.0
    share_s: float = 0.0
    same_case: bool = True
    cpu: Callable[[], float] = time.process_time
    start: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        self.blocks = max((int(_block(stage) or 0) for stage in self.last), default=0)
        if self.blocks and not self.same_case:  # that another case was done after the first says nothing of this one
            self._repeat_block(1)

    def enter(self, message: str) -> bool:
        """Whether another stage begins; messages that begin with the same word are of one stage.

        A count alone, "(3 of 200)", is of a loop in the stage, which takes at least as long as that loop.
        """
        if loop := ALONE.fullmatch(message):
            fraction, piece = (int(loop[1]) - 1) / int(loop[2]), 1 / int(loop[2])
            self.loop = (self.loop[0] if fraction > self.loop[1] else self.clock(), fraction, fraction + piece)
            return False
        if not (self.now or self.took):
            self.share_s = self.clock()
            self.start = (self.share_s, self.cpu())
        if AGAIN.match(message):
            self.leave()
            # The same stages once more. Beyond what came the last time, and in a first run, one more is always to come.
            self.block += 1
            more = int(self.block > self.blocks or not self.same_case)
            for number in range(self.blocks + 1, self.block + more + 1):
                self._repeat_block(number)
        word = message.split()[0].rstrip(":,") if message.split() else ""
        stage, count = f"{self.block} {word}" if self.block and word else word, COUNT.search(message)
        part = (int(count[1]) - 1) / int(count[2]) if count else 0.0
        if stage == self.now:
            if part > self.part:
                self.part, self.piece, self.counted_s = part, 1 / int(count[2]) if count else 0.0, self._here()
            return False
        self.leave()
        self.now, self.part = stage, part
        return True

    def _repeat_block(self, number: int) -> None:
        """The stages of the block before come once more."""
        before = str(number - 1 or "")
        again = [s for s in self.last if _block(s) == before and _word(s) not in PREPARING]
        last = {f"{number} {_word(s)}": self.last[s] for s in again} | self.last
        self.last = {s: last[s] for s in sorted(last, key=lambda s: int(_block(s) or 0))}

    def _here(self) -> float:
        """Time in the stage that runs (s)."""
        return self.clock() - self.since if self.now else 0.0

    def leave(self) -> None:
        """Count the time of the stage that ends."""
        instant = self.clock()
        if self.now:
            self.took[self.now] = self.took.get(self.now, 0.0) + instant - self.since
        self.since, self.now, self.part, self.counted_s, self.loop = instant, "", 0.0, 0.0, (instant, 0.0, 1.0)

    def left(self) -> tuple[float, float] | None:
        """Share done, and seconds left; None where no stage is known that is worth it.

        A stage that counts says by itself how long it takes, a loop in it at least how long. Others take as long as
        the last time, at the pace of this run; one that is late by some time goes on for as much. What comes before
        the stage that runs does not come any more. The share goes on at the speed that ends with the time left.
        """
        here = self._here()
        before, order = self.took.get(self.now, 0.0), list(self.last)
        took = {s: seconds for s, seconds in self.took.items() if s in self.last and s != self.now}
        expected = self._pace(took) * self.last.get(self.now, 0.0)
        rest = abs(expected - before - here)
        if self.part * here > 0.0:
            rest = here / self._done(here) - here
        begin, fraction, piece = self.loop
        late, share = before + here > expected, fraction or piece  # the first piece takes at least as long as so far
        if late or not self.same_case:
            rest = max(rest, (self.clock() - begin) * (1.0 - share) / share)
        if self.now in self.last and (self.part or late):
            took[self.now] = before + here + rest
        stages = [s for s in (*self.took, self.now) if s in self.last]
        after = order.index(stages[-1]) + 1 if stages else 0
        coming = [s for s in order[after:] if s not in self.took and s != self.now]
        building = [s for s in order if _word(s) in BUILDING]
        if {*building} & {*order[:after]} and not {*building} & {*self.took, self.now}:
            coming = [s for s in coming if s not in building]  # a declared network, or a machine that was kept
        later = sum(self.last[s] for s in coming)
        rest += self._pace(took) * later
        spent, instant = here + sum(self.took.values()), self.clock()
        worth = max(sum(self.last.values()), (spent + rest) * (self.part > 0.0)) >= self.shortest_s
        if not (worth and (self.now or self.took)) or self._unknown():  # a bar is drawn before its first stage
            return None
        passed, self.share_s = instant - self.share_s, instant
        slow = passed + rest + SPARE * spent * bool(self.block)
        self.share = min(self.share + (1.0 - self.share) * passed / max(slow, 1e-9), 0.99999)
        return self.share, rest

    def _unknown(self) -> bool:
        """Nothing says yet how large a case is that this computer has not seen: for some seconds nothing is said."""
        early = _word(self.now) in ("reading", "preparing", "estimating")
        building = any(_word(s) in BUILDING for s in self.took)
        return early and not building and not self.same_case and self.clock() - self.start[0] < PATIENCE_S

    def _pace(self, took: Mapping[str, float]) -> float:
        """What is still to come over what it took the last time, by the stages so far and what each took (s).

        Of this very case it is what they took over what they took then; but what was prepared then may have been kept,
        so that a second run prepares in a third of the time and fits as long as before. Of another, fits say that of
        fits, and the error of the time steps, for which the model is run, that of small cases and large ones; other
        stages say only as much as they were of its work: a long file is read forty times as long, and the yardstick
        after it takes twice as long. What others take of the computer slows all stages alike.
        """
        if self.same_case:
            usual = sum(min(self.last[s], t) if _word(s) in PREPARING else self.last[s] for s, t in took.items())
            return sum(took.values()) / usual if usual > PACED_S else 1.0
        fits = [s for s in took if _word(s) not in PREPARING]
        runs = [s for s in took if _word(s) == "estimating"]
        share = min(sum(self.last[s] for s in took) / max(sum(self.last.values()), PACED_S), 1.0)
        guides = ((fits, 1.0), (runs, RUNS), (took, share))
        stages, power = next((g for g in guides if sum(self.last[s] for s in g[0]) > PACED_S), (took, share))
        return self._quotient({s: took[s] for s in stages}, power, self._busy())

    def _quotient(self, took: Mapping[str, float], power: float, busy: float) -> float:
        """Of what stages took (s), over what they took the last time; others slow them by a factor `busy`."""
        usual = sum(self.last[s] for s in took)
        return busy * (sum(took.values()) / busy / usual) ** power if usual > PACED_S else busy

    def _busy(self) -> float:
        """How much longer than its own work this run takes, because others compute too."""
        passed, computed = self.clock() - self.start[0], self.cpu() - self.start[1]
        return max(passed / computed, 1.0) if computed > PACED_S else 1.0

    def _done(self, here: float) -> float:
        """Part of the stage, as it grows between two counts: as if the next piece took as long as those before it."""
        if not self.counted_s:
            return self.part
        return self.part + self.piece * (1.0 - exp(-(here - self.counted_s) / self.counted_s * self.part / self.piece))


def _word(stage: str) -> str:
    """Of a stage without the number of its block."""
    return stage.rpartition(" ")[2]


def _block(stage: str) -> str:
    """The number of its block; "" of the first."""
    return stage.rpartition(" ")[0]


def _line(message: str, remaining: tuple[float, float] | None) -> str:
    """The message with share and time left."""
    return f"{message} ({_remaining(remaining)})" if remaining else message


def _remaining(remaining: tuple[float, float]) -> str:
    """Share done and time left."""
    share, rest = remaining
    slow = rest / (100.0 * (1.0 - share) * SLOW_S)  # time of a percent
    fine = 10 ** min(max(ceil(log10(max(slow, 1e-9))), 0), 2)
    span = f"{rest:.0f} s" if rest < 90 else f"{rest / 60:.0f} min"
    return f"{floor(100 * fine * share) / fine:.{len(str(fine)) - 1}f} %, about {span} left"


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
    with remembering(f"{_command()} {next(_blocks)}", _case()) as stages, _display(stages) as tell:
        yield tell


@contextmanager
def one_bar(shortest_s: float = WORTH_S) -> Iterator[None]:
    """Several pieces of work, each with its `progress`, have one bar: share and time left are of all of them.

    shortest_s : what takes less has neither (s)
    """
    with remembering(_command(), _case(), shortest_s) as stages:
        token = _whole.set(stages)
        try:
            yield
        finally:
            _whole.reset(token)


@contextmanager
def remembering(command: str, case: str, shortest_s: float = WORTH_S) -> Iterator[ProgressBar]:
    """Stages that know how long they took the last time, of this very case where they can.

    command, case : whose stages these are: "explain diagnose 0", its path;  shortest_s : as of a ProgressBar (s)
    """
    # What the cache knows; nothing where it is damaged or was never written
    durations, keys = _stages_in(cache_folder() / FILE), [f"{command} {case}".rstrip(), command]
    memory = next((durations[k] for k in keys if durations.get(k)), None)
    same_case = bool(durations.get(keys[0]))
    stages = ProgressBar(memory or _usual().get(command, {}), shortest_s=shortest_s, same_case=same_case)
    try:
        yield stages
        stages.leave()
        if sum(stages.took.values()) > shortest_s:
            again = {s: t for s, t in stages.took.items() if _word(s) not in BUILDING}
            others = {k: v for k, v in durations.items() if k not in keys}
            durations = others | {keys[1]: stages.took, keys[0]: again or stages.took}
            with suppress(InputError):  # a folder that can only be read
                write_whole(cache_folder() / FILE, json.dumps(dict(list(durations.items())[-MOST:])))
    finally:
        stages.leave()


def _command() -> str:
    """The words of the command: "explain diagnose"."""
    return " ".join(word for word in sys.argv[1:3] if not word.startswith("-"))


def _case() -> str:
    """What the command is about, where it stands behind its words: "/home/me/motor"."""
    words = sys.argv[1:4]
    return "" if len(words) < 3 or any(word.startswith("-") for word in words) else str(Path(words[2]).absolute())


@contextmanager
def _display(stages: ProgressBar) -> Iterator[Progress]:
    from rich.console import Console

    from validation.threads import listening

    console = Console(stderr=True)

    def say(words: str, share: float | None) -> None:
        print(visible(words), file=sys.stderr, flush=True)

    with _bar(stages, console) if console.is_terminal else timed_lines(stages, say) as tell, listening(tell):
        yield tell


@contextmanager
def timed_lines(
    stages: ProgressBar, show: Callable[[str, float | None], None], quiet_s: float = QUIET_S
) -> Iterator[Progress]:
    """One line a stage, and one whenever there was none for a while.

    show : is given a line with its time left, and the share done where it is known
    quiet_s : the longest time without a line (s)
    """
    now, stop, spoken = [""], Event(), [stages.clock()]

    def say() -> None:
        spoken[0] = stages.clock()
        remaining = stages.left()
        show(_line(now[0], remaining), remaining and remaining[0])

    def tell(message: str) -> None:
        now[0] = now[0] if ALONE.fullmatch(message) else message
        if stages.enter(message):
            say()

    def remind() -> None:
        while not stop.wait(max(quiet_s - (stages.clock() - spoken[0]), 0.1)):
            if now[0] and stages.clock() - spoken[0] >= quiet_s:
                say()

    reminder = Thread(target=remind, daemon=True)
    reminder.start()
    try:
        yield tell
    finally:
        stop.set()
        reminder.join()


@contextmanager
def _bar(stages: ProgressBar, console: "Console") -> Iterator[Progress]:
    """A bar that moves with the clock; a message that is too long for the line is cut, its times never."""
    from rich.progress import BarColumn, Progress as Bar, ProgressColumn, TextColumn, TimeElapsedColumn
    from rich.table import Column
    from rich.text import Text

    class Left(ProgressColumn):
        """Share done and time left, now."""

        def render(self, task: "Task") -> Text:
            remaining = stages.left()
            if remaining:
                bar.update(task.id, total=1.0, completed=remaining[0])
            return Text(_remaining(remaining) if remaining else "", no_wrap=True)

    message_column = Column(ratio=1, no_wrap=True, overflow="ellipsis")
    times = Column(no_wrap=True, min_width=len(_remaining((0.9999, 3600.0))))
    with Bar(
        TextColumn("{task.description}", table_column=message_column, markup=False),
        BarColumn(10),
        Left(times),
        TimeElapsedColumn(Column(no_wrap=True, min_width=7)),
        console=console,
        transient=True,
        expand=True,
    ) as bar:
        task = bar.add_task("", total=None)

        def tell(message: str) -> None:
            stages.enter(message)
            if not ALONE.fullmatch(message):
                bar.update(task, description=visible(message))

        yield tell


def _usual() -> dict[str, dict[str, float]]:
    return _stages_in(Path(__file__).with_name(USUAL))


def _stages_in(file: Path) -> dict[str, dict[str, float]]:
    with suppress(OSError, ValueError, TypeError, AttributeError):
        document = json.loads(file.read_text(encoding="utf-8"))
        return {str(k): {str(s): float(t) for s, t in v.items()} for k, v in document.items()}
    return {}
