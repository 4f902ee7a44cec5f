"""thermoscope use watch CASE --follow FILE|-: temperatures and missing heat while the machine runs."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from extras.monitor.observer import Observer, Sample
from extras.monitor.observer.learning import Design
from extras.monitor.observer.process import Process
from extras.monitor.rows.live_rows import PIPE, TOGETHER, Rows, table_of
from extras.monitor.rows.observing import chosen, designed, joined, record_of
from thermoscope import InputError, Record, plugin as th

MINUTE = 60.0


def watch(
    case: th.CaseArgument,
    follow: Annotated[str, typer.Option("--follow", metavar="FILE|-", help="A recording, or - for rows from a pipe.")],
    sensor: Annotated[list[str] | None, typer.Option(metavar="NAME", help="Use these sensors alone.")] = None,
    like: Annotated[str | None, typer.Option(metavar="TEST", help="As in this test; else the first that fits.")] = None,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Beside a running machine: all temperatures and missing heat from its sensors, and where the model fails."""
    with th.progress() as tell:
        folder = th.open_case(case, tell)
        sheets = {e.name: th.load_sheet(e.sheet) for e in folder.settings.tests}
        name, table, parts = table_of(follow, TOGETHER, sheets, folder.case.model.network, like)
        channels = {c.name: c for t in folder.case.tests if t.name == name for c in t.channels}
        here = [c for n, c in channels.items() if n in table.sensors()]
        sensors = chosen(here, sensor or (), follow)
        withheld = [c for c in here if c not in sensors]
        session = Session(folder, designed(folder, tell), sensors, withheld, json != th.STDOUT)
    with suppress(KeyboardInterrupt):
        for part in parts:
            session.take(table.rows(part))
    if session.one is None:
        raise InputError("holds no row", follow, "rows of numbers under the header")
    file = th.write_whole(watched_file(folder, follow, out), session.csv())
    head = {"case": folder.case.name, "revision": folder.case.model.revision, "source": follow, "like": name}
    document = {**head, **session.document(), "file": str(file)}
    th.give(document, json, lambda: watch_summary(document))
    return 0


def watched_file(folder: th.Folder, follow: str, out: Path | None) -> Path:
    """Where every sample is kept; beside no case that comes along."""
    shipped = th.PACKAGE in folder.settings.path.resolve().parents
    where = out or (Path("out") / folder.settings.path.name if shipped else folder.settings.out)
    return where / f"watch-{'pipe' if follow == PIPE else th.stem_of(Path(follow))}.csv"


@dataclass
class Session:
    """An observer as it goes on.  withheld : sensors that are only compared with;  loud : a line a minute on stdout"""

    folder: th.Folder
    design: Design
    sensors: list[th.Channel]
    withheld: list[th.Channel]
    loud: bool
    one: Observer | None = None
    before: Rows | None = None
    free: th.Array | None = None
    lines: list[str] = field(default_factory=list)
    hottest: dict[str, tuple[float, float]] = field(default_factory=dict)
    errors: dict[str, list[th.Array]] = field(default_factory=dict)
    last: Sample | None = None
    spoken: float = -np.inf
    start_s: float = 0.0

    def __post_init__(self) -> None:
        self.rows = th.mean_rows(self.design.process.network)
        self.plain = Process(*th.model_of(self.folder), self.design.process.bodies)

    def take(self, rows: Rows) -> None:
        if self.one is None:
            readings = np.array([rows.readings[c.name][0] for c in self.sensors])
            around = {name: float(u[0]) for name, u in rows.boundaries.items()}
            self.one, self.start_s = self.design.started(self.sensors, readings, around), float(rows.time[0])
            first = {c.place: float(rows.readings[c.name][0]) for c in (*self.sensors, *self.withheld)}
            initial_T = {place: y for place, y in first.items() if np.isfinite(y)}
            self.free = th.initial_state(self.plain.network, initial_T or self.one.filter.x.mean())
        whole = joined(self.before, rows)
        record = record_of(whole, self.folder)
        y = np.column_stack([whole.readings[c.name] for c in self.sensors])
        samples = self.one.follow(record, y)
        self.before = whole
        self._compare(rows, samples, self._open_loop(record, len(samples)))
        for sample in samples:
            temperatures = {n: sample.at(row) for n, row in self.rows.items()}
            for name, (T, _) in temperatures.items():
                if name not in self.hottest or self.hottest[name][0] < T:
                    self.hottest[name] = T, sample.time_s
            numbers = [sample.time_s, *(x for pair in temperatures.values() for x in pair)]
            numbers += [x for pair in zip(sample.heat, sample.heat_sd, strict=True) for x in pair]
            self.lines.append(",".join(f"{x:.7g}" for x in numbers))
            self.last = sample
            if self.loud and sample.time_s - self.spoken >= MINUTE - 1e-6:
                self.spoken = sample.time_s
                th.say(self._line(sample, temperatures))

    def _open_loop(self, record: Record, count: int) -> list[th.Array]:
        """States (n,) of the model as it stands, without any reading but the very first, the withheld sensors' too."""
        if not self.withheld or self.free is None:
            return []
        process = self.plain
        by, still, out = process.driven(record), np.zeros(len(process.bodies)), []
        for k in range(by.time.size - count, by.time.size):
            if k > 0:
                self.free = process.steps(by, k, self.free, still)[0]
            out.append(np.concatenate([np.asarray(self.free), by.u[k]]))
        return out

    def _compare(self, rows: Rows, samples: Sequence[Sample], free: Sequence[th.Array]) -> None:
        for c in self.withheld:
            y = rows.readings[c.name]
            estimates = np.array([s.at(c.row)[0] for s in samples])
            without = np.array([c.row.at(z) for z in free])
            both = np.column_stack([y - estimates, y - without])
            sums = self.errors.setdefault(c.name, [np.zeros(2), np.zeros(2)])
            good = np.isfinite(y)
            sums[0] += np.sum(both[good] ** 2, axis=0)
            sums[1] += float(good.sum())

    def _line(self, sample: Sample, estimates: dict[str, tuple[float, float]]) -> str:
        """One line for the terminal."""
        places = [c.place for c in self.sensors]
        places += [n for n in self.design.process.bodies if n not in places]
        temperatures = [
            f"{n} {estimates[n][0]:.1f} +- {th.NORMAL_95 * estimates[n][1]:.1f}"
            for n in dict.fromkeys(places)
            if n in estimates
        ]
        alarms = [_alarm_text(e.kind, e.where, e.amplitude, e.probability) for e in sample.open]
        return f"{sample.time_s / MINUTE:7.1f} min  {', '.join(temperatures)} degC{''.join('; ' + s for s in alarms)}"

    def csv(self) -> str:
        head = ["time_s", *(x for n in self.rows for x in (f"T {n} (degC)", f"sd T {n} (K)"))]
        head += [x for n in self.design.process.bodies for x in (f"missing heat {n} (W)", f"sd heat {n} (W)")]
        return th.csv_lines([head]) + "\n".join([*self.lines, ""])

    def document(self) -> dict[str, Any]:
        assert self.one is not None
        assert self.last is not None
        temperatures = {n: self.last.at(row) for n, row in self.rows.items()}
        states = dict(zip((c.name for c in self.sensors), self.one.states, strict=True))
        noise, last = self.design.noise, self.last
        return {
            "duration_s": last.time_s - self.start_s,
            "samples": len(self.lines),
            "process_noise": {"time_s": noise.time_s},
            "sensors": [
                {
                    "sensor": c.name,
                    "place": c.place,
                    "given": c in self.sensors,
                    "dropped": states[c.name].dropped if c.name in states else "",
                }
                for c in (*self.sensors, *self.withheld)
            ],
            "places": [
                {
                    "place": n,
                    "end_C": T,
                    "end_ci95": [T - th.NORMAL_95 * sd, T + th.NORMAL_95 * sd],
                    "max_C": self.hottest[n][0],
                    "max_at_s": self.hottest[n][1],
                }
                for n, (T, sd) in temperatures.items()
            ],
            "missing_heat": [
                {
                    "place": b,
                    "end_W": last.heat[i],
                    "end_ci95": [last.heat[i] + s * th.NORMAL_95 * last.heat_sd[i] for s in (-1.0, 1.0)],
                    "allowed_sd_W": noise.sd[i],
                }
                for i, b in enumerate(self.design.process.bodies)
            ],
            "events": [vars(e) for e in self.one.events],
            "withheld": [
                {
                    "sensor": c.name,
                    "n": int(n[0]),
                    "rmse_K": float(np.sqrt(s[0] / n[0])),
                    "open_loop_rmse_K": float(np.sqrt(s[1] / n[1])),
                }
                for c in self.withheld
                for s, n in [self.errors[c.name]]
                if n[0] > 0
            ],
        }


def _alarm_text(kind: str, where: str, amplitude: float, probability: float) -> str:
    if kind == "model":
        return f"the model fails at {where}: {amplitude:+.3g} W beyond doubt ({th.percent(probability)})"
    size = f" by {amplitude:+.2g} K" if np.isfinite(amplitude) else ""
    return f"{where} {kind}{size}"


def watch_summary(document: dict[str, Any]) -> th.Summary:
    """Where the machine stands, what was dropped, where the model failed."""
    hottest = max(document["places"], key=lambda p: p["max_C"])
    sentence = (
        f"{document['duration_s'] / MINUTE:.0f} min watched; hottest: {hottest['place']}, {hottest['max_C']:.1f} degC."
    )
    parts = [
        th.Table.of(
            "Events",
            document["events"],
            "event | from (s)=from_s | to (s)=to_s",
            event=lambda e: _alarm_text(
                e["kind"], e["where"], float("nan") if e["amplitude"] is None else e["amplitude"], e["probability"]
            ),
        ),
        th.Table.of(
            "Sensors that were not given",
            document["withheld"],
            "sensor | error (K)=rmse_K | open loop (K)=open_loop_rmse_K",
        ),
        th.Table.of(
            "",
            document["places"],
            "place | *end (degC)=end_C | *95 % (+- K)=half95 | largest (degC)=max_C",
            half95=lambda p: p["end_ci95"][1] - p["end_C"],
        ),
    ]
    return th.Summary(sentence, [p for p in parts if p.rows], f"every sample in {document['file']}")
