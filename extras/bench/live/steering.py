"""A run from row to row: guards first, then odds, then the next set point; and when it stops."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from extras.bench.live.assessment import FEWEST, NOTHING, Assessment, assess
from extras.bench.live.planning import LENGTHS_MIN, MINUTE, Choice, choices, is_allowed, undetectable, unresolved
from extras.bench.live.settings import OVER, Bench, SetPoint
from extras.bench.live.store import BenchError, Row, Store
from thermoscope import plugin as th

SURE = 0.9  # probability of one name, or of nothing, from which the run ends
NEAR = 0.1  # of the largest level: a meter that reads so close to a set point says that it is obeyed
DULL, LOOKS = 0.005, 3  # nats that no set point promises however long, as often in a row: nothing decides any more
LEAST_SHARE = 0.1  # of the time so far, that a set point lasts: what minutes did not tell, minutes will not
CREDIT = 0.5  # of what a set point promised, below which it counts so much less the next time
GAIN = 0.02  # nats that the readings have to tell while patience lasts
SOONEST_MIN, AGAIN = 5.0, 1.3  # of the time so far: when it is asked what no set point would show
UNDECIDED = "no allowed set point would decide"
LEFT_NATS = 0.33  # what is not known of two when one has 90 %

Policy = Callable[[Assessment, Bench, SetPoint], Sequence[Choice]]  # what may come next, best first


@dataclass(frozen=True)
class Thought:
    """What a look at the rows gave.  choice : the next set point, None where none is due;  left_min : to the answer

    stop : why the run is over, "" while it goes on
    """

    time: float
    assessment: Assessment
    choice: Choice | None = None
    left_min: float = math.inf
    stop: str = ""


@dataclass
class Steering:
    """now : the set point;  sent : how far towards it the bench was told;  due : when the next one is chosen (s)

    promise : of the last one: its name, odds before, nats;  broken : set point -> how often it told less
    hidden : causes that no set point would show, as of `searched_min`
    last_odds : odds when the readings last told something, at `gained` (s)
    since : when `now` was asked for;  obeyed : that the meters show it, or a person said so
    """

    bench: Bench
    store: Store
    policy: Policy = choices
    now: dict[str, float] = field(default_factory=dict)
    sent: dict[str, float] = field(default_factory=dict)
    minutes: float = 0.0
    due: float = -math.inf
    since: float = -math.inf
    obeyed: bool = True
    begin: float = math.nan
    last: Row | None = None
    count: int = 0
    last_look: float = -math.inf
    dull: int = 0
    promise: tuple[str, dict[str, float], float] | None = None
    broken: dict[str, int] = field(default_factory=dict)
    hidden: Sequence[str] = ()
    searched_min: float = 0.0
    last_odds: dict[str, float] = field(default_factory=dict)
    gained: float = -math.inf
    replays: bool = True
    rate: float = math.nan

    def __post_init__(self) -> None:
        self.now = dict(self.bench.safe)
        self.sent = dict(self.now)
        self.time_of = self.bench.sheet.time
        for event in self.store.events():
            if event["event"] == "set":
                self.now, self.minutes = event["set_point"], event["minutes"]
                self.since, self.due = event["time_s"], event["time_s"] + MINUTE * event["minutes"]
                self.obeyed = not event["waits"]
            elif event["event"] == "done":
                self.obeyed, self.due = True, event["time_s"] + MINUTE * self.minutes
            self.begin = event.get("begin_s", self.begin)
        if (last := self.store.last) is not None:
            self.last, self.count = last, FEWEST
            self.sent = {n: v for n in self.now if math.isfinite(v := self._input(n, last))} or dict(self.now)

    @property
    def time(self) -> float:
        return self.last[self.time_of] if self.last else -math.inf

    def _input(self, name: str, row: Mapping[str, float]) -> float:
        c = next(c for c in self.bench.sheet.columns if c.feeds == name)
        return float(c.in_memory(np.array([row.get(c.header, math.nan)]))[0])

    def row(self, row: Row, replay: bool = False) -> list[dict[str, float]]:
        """Takes a row, on the disk first. Returns set points to send; BenchError where the bench is to be left safe."""
        t = row.get(self.time_of, math.nan)
        if replay and t <= self.time:
            return []
        if not math.isfinite(t):
            raise BenchError("a row without a time", f"column '{self.time_of}'", "seconds that rise from row to row")
        step = t - self.time
        if step <= 0.0:
            self.store.note({"event": "refused", "row": row})
            fault = "is out of order" if step > -self.bench.jump_s else "jumps back"
            what = f"time {t:g} {fault} after {self.time:g}"
            raise BenchError(what, self.store.name, "one writer, with a clock that rises")
        self.store.append(row)
        if self.last is not None and step > self.bench.jump_s:
            what, right = f"the clock jumps from {self.time:g} to {t:g} s", f"steps up to {self.bench.jump_s:g} s"
            raise BenchError(what, self.store.name, right)
        if self.last is None:
            self.begin = t
            self.store.note({"event": "begin", "begin_s": t})
        self.last, self.count, self.replays = row, self.count + 1, False
        self._check(row)
        gaps = {k: abs(self._input(k.name, row) - self.now[k.name]) for k in self.bench.knobs}
        if not self.obeyed and all(gap <= NEAR * max(k.most, 1e-9) for k, gap in gaps.items()):
            self.done()
        return self._ramp(step)

    def done(self) -> None:
        """The set point is reached: its minutes count from now."""
        if not self.obeyed:
            self.store.note({"event": "done", "time_s": self.time})
        self.obeyed, self.due = True, self.time + MINUTE * self.minutes

    def _check(self, row: Row) -> None:
        for k in self.bench.knobs:
            if (v := self._input(k.name, row)) > (1.0 + OVER) * k.most:
                raise BenchError(f"{k.name} reads {v:g}", f"[set.{k.name}]", f"{k.most:g} at most")
        for limit in self.bench.limits:
            for c in self.bench.sheet.columns:
                if c.is_temperature and c.place == limit.place:
                    T = float(c.in_memory(np.array([row.get(c.header, math.nan)]))[0])
                    if limit.most_C < T:
                        what, right = f"{c.name} reads {T:.1f} degC", f"{limit.most_C:g} degC at most"
                        raise BenchError(what, f"[limits.{limit.name}]", right)

    def _ramp(self, step: float) -> list[dict[str, float]]:
        """The next step towards the set point, no faster than each input may change."""
        if self.sent == self.now:
            return []
        step = min(step, MINUTE) if math.isfinite(step) else 1.0
        most = {k.name: k.rate_per_s * step for k in self.bench.knobs}
        self.sent = {n: v + float(np.clip(self.now[n] - v, -most[n], most[n])) for n, v in self.sent.items()}
        return [dict(self.sent)]

    @property
    def is_due(self) -> bool:
        """Is it time to look at the odds again?"""
        if self.count < FEWEST:
            return False
        return self.time - self.last_look >= self.bench.every_s or self.time >= self.due

    def think(self, case: Path) -> Thought:
        """The odds on all rows so far, and the next set point where the present one is over, or gets too hot."""
        self.store.listed()
        self.last_look = self.time
        time, elapsed = self.time, (self.time - self.begin) / MINUTE
        folder = th.load_case(case)
        assessment = assess(folder, self.store.name)
        stop = ""
        if self._named(assessment):
            assessment = assess(folder, self.store.name, quick=False)
            stop = self._named(assessment)
        if stop:
            return Thought(time, assessment, stop=stop, left_min=0.0)
        waits = not self.obeyed and time - self.since < self.bench.deaf_s
        running = waits or time < self.due
        if running and (self.now == self.bench.safe or is_allowed(assessment, self.bench, self.now)):
            return Thought(time, assessment, left_min=self._left(assessment, None))
        if self.promise and assessment.gain_over(self.promise[1]) < CREDIT * self.promise[2]:
            self.broken[self.promise[0]] = self.broken.get(self.promise[0], 0) + 1
        options = self.policy(assessment, self.bench, self.now)
        options = [c for c in options if c.minutes >= LEAST_SHARE * elapsed] or list(options)
        options.sort(key=lambda c: -c.rate * CREDIT ** self.broken.get(str(c.set_point), 0))
        choice = options[0] if options else Choice(self.bench.safe, LENGTHS_MIN[0], 0.0, {})
        self.promise = str(choice.set_point), dict(assessment.odds), choice.nats
        left = self._left(assessment, choice.rate)
        self.dull = self.dull + 1 if max((c.nats for c in options), default=0.0) < DULL else 0
        if assessment.gain_over(self.last_odds) > GAIN:
            self.last_odds, self.gained = dict(assessment.odds), time
        stale = time - self.gained > MINUTE * self.bench.patience_min
        if stale or self.dull >= LOOKS or elapsed >= self.bench.budget_min:
            stop = UNDECIDED if stale or self.dull >= LOOKS else "the time is over"
        return Thought(time, assessment, choice, left, stop)

    def _named(self, assessment: Assessment) -> str:
        cause, p = assessment.odds[0]
        if cause == NOTHING and p < SURE:
            p = self._of_what_shows(assessment, p)
        if p < SURE or cause.startswith("heat@"):
            return ""
        return "nothing is missing" if cause == NOTHING else f"{th.value_words(cause)} is missing"

    def _of_what_shows(self, assessment: Assessment, p: float) -> float:
        """That nothing is missing among all that a set point may still show: the rest keeps the odds it came with."""
        odds = dict(assessment.odds)
        elapsed = (self.time - self.begin) / MINUTE
        rest = unresolved(assessment, self.bench)
        if elapsed < SOONEST_MIN or p < SURE * (1.0 - sum(odds.get(r.lead, 0.0) for r in rest)):
            return p
        if elapsed > AGAIN * self.searched_min:  # it costs as much as ten looks, and changes as slowly as the parts
            left = self.bench.budget_min - elapsed
            self.hidden = undetectable(assessment, self.bench, self.now, rest, left)
            self.searched_min = elapsed
        return p / (1.0 - sum(odds.get(n, 0.0) for n in self.hidden))

    def _left(self, assessment: Assessment, rate: float | None) -> float:
        """Minutes to the answer, as far as information per minute goes on; to the end of the run at most."""
        self.rate = self.rate if rate is None else rate
        need = max(assessment.entropy - LEFT_NATS, 0.0)
        end = self.bench.budget_min - (self.time - self.begin) / MINUTE
        return min(need / self.rate, end) if self.rate > 0.0 else end

    def apply(self, thought: Thought) -> list[dict[str, float]]:
        """Goes on as thought. Returns set points to send."""
        stop = {"stop": thought.stop} if thought.stop else {}
        now = thought.assessment
        lists = {"odds": [list(o) for o in now.odds[:5]], "over": list(now.over), "unseen": list(now.unseen)}
        self.store.note({"event": "odds", "time_s": thought.time, **lists, "left_min": thought.left_min, **stop})
        if thought.stop:
            return self.make_safe()
        if thought.choice is None:
            return []
        return self._set(thought.choice.set_point, thought.choice.minutes, thought.choice.nats)

    def _set(self, set_point: SetPoint, minutes: float, nats: float = 0.0) -> list[dict[str, float]]:
        changed = dict(set_point) != self.now
        self.now, self.minutes, self.since = dict(set_point), minutes, self.time
        self.obeyed, self.due = not changed, self.time + MINUTE * minutes
        self._note_set(minutes=minutes, nats=nats, waits=changed)
        return self._ramp(1.0) if changed else []

    def _note_set(self, *, waits: bool, minutes: float = 0.0, nats: float = 0.0) -> None:
        more = {"minutes": minutes, "nats": nats, "waits": waits}
        self.store.note({"event": "set", "time_s": self.time, "set_point": self.now, **more})

    def make_safe(self) -> list[dict[str, float]]:
        """The safe set point at once: no ramp where there is danger."""
        self.now = self.sent = dict(self.bench.safe)
        if self.last is not None:
            self._note_set(waits=False)
        return [dict(self.now)]
