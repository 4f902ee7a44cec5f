"""A run of the bench: rows from the source to the steering, odds worked out beside, set points back."""

import queue
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

from extras.bench.live.settings import Bench
from extras.bench.live.sources import Parser, Source
from extras.bench.live.steering import Steering, Thought
from extras.bench.live.store import BenchError
from thermoscope import InputError, plugin as th

WAKE_S = 0.2  # between two looks at a thought that goes on and at what a person typed
Tell = Callable[[str], None]


class Session:
    """drive : send set points;  tell : lines for a person;  hear : whether a person types "done" on stdin"""

    def __init__(self, steering: Steering, source: Source, case: Path, drive: bool, tell: Tell, hear: bool) -> None:
        if drive and source.send is None:
            raise InputError("set points cannot go to a file", "--drive", "a pipe, tcp://HOST:PORT or mqtt://HOST")
        self.steering, self.source, self.case, self.drive, self.tell = steering, source, case, drive, tell
        self.parser = Parser(source.where, list(steering.store.header))
        self.thinking: Future[Thought] | None = None
        self.typed: queue.Queue[str] = queue.Queue()
        self.thought: Thought | None = None
        steering.store.note({"event": "run", "drive": drive})
        steering.store.hears_done()  # what an earlier run was told
        if hear and not drive:
            threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        with suppress(OSError, ValueError):  # nobody is there to type
            for line in sys.stdin:
                self.typed.put(line.strip())

    @property
    def bench(self) -> Bench:
        return self.steering.bench

    def run(self) -> str:
        """Why it ended. A fault is raised once the bench is set safe."""
        with ThreadPoolExecutor(1) as pool:
            try:
                return self._run(pool)
            except BaseException as fault:  # whatever it is, the bench comes first
                self._safe()
                self.steering.store.note({"event": "fault", "what": str(fault)})
                if isinstance(fault, OSError):
                    right = "a line that lasts; the rows so far are kept"
                    raise BenchError(f"is gone: {fault}", self.source.where, right) from None
                raise

    def _safe(self) -> None:
        try:
            self._out(self.steering.make_safe())
        except OSError:  # the line is gone: nothing can be sent any more
            self.tell("the bench cannot be reached: set it safe by hand")

    def _run(self, pool: ThreadPoolExecutor) -> str:
        heard, over = time.monotonic(), False
        while True:
            try:
                line = self.source.line(WAKE_S)
            except queue.Empty:
                if time.monotonic() - heard > self.bench.silence_s and self.source.send is None:
                    over = True  # a file that grows no more
                elif time.monotonic() - heard > self.bench.silence_s:
                    what = f"no row for {self.bench.silence_s:g} s"
                    raise BenchError(what, self.source.where, "a bench that goes on") from None
                line = ""
            over = over or line is None
            if line and (row := self.parser.row(line)) is not None:
                heard = time.monotonic()
                self._out(self.steering.row(row, replay=self.steering.replays))
            typed = not self.typed.empty() and self.typed.get() == "done"
            if typed or (not self.drive and self.steering.store.hears_done()):
                self.steering.done()
            if self.thinking is not None and (self.thinking.done() or over):
                thought, self.thinking = self.thinking.result(), None
                self.thought = thought
                self.tell(words(thought))
                sent = self.steering.apply(thought)
                if not self.drive and thought.choice and not thought.stop:
                    rate = {k.name: k.rate_per_s for k in self.steering.bench.knobs}
                    goal = (f"{n} = {v:g} (at most {rate[n]:g} per s)" for n, v in self.steering.now.items())
                    self.tell(f"set {', '.join(goal)}, then type done")
                self._out(sent)
                if thought.stop:
                    return thought.stop
            if self.thinking is None and self.steering.is_due:
                self.thinking = pool.submit(self.steering.think, self.case)
            elif over and self.thinking is None:
                self._safe()
                return "the rows are at their end"

    def _out(self, sent: list[dict[str, float]]) -> None:
        for set_point in sent:
            if self.drive:
                self.source.set(set_point)


def words(thought: Thought) -> str:
    """A look at the odds in one line."""
    odds = ", ".join(f"{th.value_words(name)} {p:.0%}" for name, p in thought.assessment.odds[:3])
    out = [f"{thought.time / 60.0:6.1f} min  {odds}"]
    if thought.assessment.over:
        out.append(f"sensors over: {', '.join(thought.assessment.over)}")
    if thought.assessment.unseen:
        out.append(f"cannot see yet: {', '.join(map(th.value_words, thought.assessment.unseen[:3]))}")
    if not thought.stop:
        out.append(f"about {thought.left_min:.0f} min left")
    return "; ".join(out)
