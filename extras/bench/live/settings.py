"""bench.toml of a case: what may be set on the bench, how fast, and what must not be crossed."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from thermoscope import InputError, Network, plugin as th

FILE = "bench.toml"
OVER = 0.05  # of its largest level, by which a meter may read more before it counts as crossed
MOST_SET_POINTS = 64  # each costs a run of the network per decision

SetPoint = Mapping[str, float]


@dataclass(frozen=True)
class Knob:
    """An input that can be set.  levels : offered;  safe : where nothing gets hotter;  rate_per_s : fastest change

    cooling : a fan or a pump, of which one at a time is changed
    """

    name: str
    levels: tuple[float, ...]
    safe: float
    rate_per_s: float
    cooling: bool

    @property
    def most(self) -> float:
        return max(*self.levels, self.safe)


@dataclass(frozen=True)
class Limit:
    """The hottest that a place may be.  hot_spot : its hottest point's rise over the mean's"""

    name: str
    place: str
    most_C: float
    hot_spot: float


@dataclass(frozen=True)
class Bench:
    """sheet : of the rows;  deaf_s : longest that a set point takes to be obeyed;  silence_s : longest without a row

    budget_min : of bench time;  patience_min : of it without any gain;  every_s : between two looks at the odds
    jump_s : largest step of the clock
    """

    sheet: th.Sheet
    sheet_file: str
    knobs: tuple[Knob, ...]
    limits: tuple[Limit, ...]
    deaf_s: float = 180.0
    silence_s: float = 30.0
    budget_min: float = 180.0
    patience_min: float = 45.0
    every_s: float = 60.0
    jump_s: float = 600.0

    @property
    def safe(self) -> dict[str, float]:
        return {k.name: k.safe for k in self.knobs}

    def set_points(self, now: SetPoint) -> list[dict[str, float]]:
        """Every set point from which at most one cooling differs from the present one."""
        every = [dict(zip((k.name for k in self.knobs), at)) for at in product(*(k.levels for k in self.knobs))]
        cooling = [k.name for k in self.knobs if k.cooling]
        return [s for s in every if sum(s[n] != now.get(n, s[n]) for n in cooling) <= 1]


def read_bench(case: Path, network: Network) -> Bench:
    """The bench of a case. InputError for what is unknown, missing or cannot be."""
    file = case / FILE
    top = th.TomlTable(
        th.read_toml(file, "the set points and limits of a bench, see docs/how-to/live-bench.md"), str(file)
    )
    sheet_file = top.word("sheet")
    knobs = tuple(_knob(n, t) for n, t in top.tables("set").items())
    limits = tuple(_limit(n, t, network) for n, t in top.tables("limits").items())
    usual = {k: getattr(Bench, k) for k in ("deaf_s", "silence_s", "budget_min", "patience_min", "every_s", "jump_s")}
    times = {k: top.number(k, v) for k, v in usual.items()}
    top.close()
    sheet = th.load_sheet(case / sheet_file)
    if not knobs or not limits:
        raise InputError("no set points or no limits", str(file), "[set.NAME] and [limits.NAME], one of each at least")
    inputs = [c.feeds for c in sheet.columns if c.feeds]
    for k in knobs:
        if k.name not in inputs:
            raise InputError(f"[set.{k.name}] is measured by no column", str(file), th.suggestion(k.name, inputs))
    bench = Bench(sheet, sheet_file, knobs, limits, **times)
    if (count := len(bench.set_points({}))) > MOST_SET_POINTS:
        raise InputError(f"{count} set points", str(file), f"levels that make {MOST_SET_POINTS} at most")
    return bench


def _knob(name: str, t: th.TomlTable) -> Knob:
    levels = t.numbers("levels")
    knob = Knob(name, levels, t.number("safe"), t.number("rate_per_s"), t.flag("cooling", False))
    t.close()
    if not levels:
        raise t.error("levels = [] is not possible", "levels = [one number or more]")
    return knob


def _limit(name: str, t: th.TomlTable, network: Network) -> Limit:
    place = t.word("place", name, [p for p in network.places if p not in network.boundaries])
    limit = Limit(name, place, t.number("most_C"), t.number("hot_spot", 1.0))
    t.close()
    return limit
