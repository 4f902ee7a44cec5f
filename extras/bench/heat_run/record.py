"""The record of a heat run, as a file of its own or as a test of a case: docs/how-to/heat-run.md has all keys.

Beside its own tables it has those of `thermoscope bench protocol`: [cold], [load], [hot], [meters].
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from extras.bench.heat_run.duty import BY_LOAD, CYCLIC, DUTIES, Operation, Series
from extras.bench.heat_run.limits import CLASSES, STANDARDS, Rating
from extras.bench.heat_run.rises import K_OF, network_way, winding_of
from extras.bench.measuring.protocol import Cold, Hot, Record
from extras.bench.measuring.record_file import Pairs, record_in, timed_pairs
from thermoscope import InputError, plugin as th

FILE, SUFFIX = "heat-run.toml", ".toml"  # of a case
NAMES = ("tested", "witnessed", "approved")
LEAST_K = 1e-3  # no thermometer is surer
LAST_QUARTER = 0.75  # of a run: the coolant is the mean since then


@dataclass(frozen=True)
class HeatRun:
    """All that a heat run is judged by.  k : of the winding;  thermometer_K : limit of error

    parts : (name, sign, rise K, sd K) of a superposition;  power : (s, kW);  ways : back to switching off by a network
    origin : of a case: its name, test, revision and key
    """

    title: str
    rating: Rating
    operation: Operation
    record: Record
    k: float
    thermometer_K: float
    detectors: tuple[float, ...] = ()
    detector_K: float = 0.0
    parts: tuple[tuple[str, int, float, float], ...] = ()
    power: Series = ()
    ways: tuple[th.Extrapolated, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    origin: Mapping[str, str] = field(default_factory=dict)

    @property
    def coolant_C(self) -> float:
        return self.rating.test_C

    @property
    def key(self) -> str:
        """Of everything above: the same numbers and names have the same one."""
        return hashlib.sha256(repr(replace(self, ways=())).encode()).hexdigest()[:20]


def read_heat_run(path: Path, tell: th.Progress) -> HeatRun:
    """The heat run of a file, or of the one in a case. InputError for what is unknown, missing or cannot be."""
    file = path if path.suffix == SUFFIX else th.find_case(path) / FILE
    top = th.TomlTable(th.read_toml(file, "a record of a heat run, see docs/how-to/heat-run.md"), str(file))
    head, site, bench, limit, etd, power, names = (
        top.table(n) for n in ("heat_run", "site", "test_site", "limit", "etd", "power_30min", "names")
    )
    record, superposed = record_in(top, file), top.listed("superposition")
    top.close()
    title, case = head.word("title", file.stem), head.word("case", "")
    k = head.number("k", K_OF[head.kind("material", "copper", K_OF)], 100.0, 400.0)
    operation = _operation(head)
    ways: tuple[th.Extrapolated, ...] = ()
    origin: dict[str, str] = {}
    if case and (record.cold or record.hot or record.warming):
        raise head.error("case and [cold], [load] or [hot] are both given", "one of them")
    if case:
        record, ways, origin = _of_case(case, head, record, file, k, tell)
    thermometer_K = head.number("thermometer_K", 0.5, low=LEAST_K)
    rating = Rating(
        record.rated_kW,
        head.kind("class", None, CLASSES),
        head.kind("standard", STANDARDS[0], STANDARDS),
        operation.name,
        head.flag("fan", True),
        site.number("altitude_m", 0.0),
        bench.number("altitude_m", 0.0),
        site.number("coolant_degC", Rating.site_C),
        record.hot.ambient_C if record.hot else Rating.site_C,
        limit.number("K", low=1.0) if limit.data else None,
        limit.word("source") if limit.data else "",
    )
    run = HeatRun(
        title,
        rating,
        operation,
        record,
        k,
        thermometer_K,
        etd.numbers("degC", []),
        etd.number("limit_K", 1.0, low=LEAST_K),
        tuple(_part(part) for part in superposed),
        timed_pairs(power, file, 1.0),
        ways,
        {name: names.word(name, "") for name in NAMES},
        origin,
    )
    for table in (head, site, bench, limit, etd, power, names):
        table.close()
    return run


def _operation(head: th.TomlTable) -> Operation:
    name, keys = head.kind("duty", "S1", DUTIES), ("rated_min", "cycle_min", "test_load")
    rated, cycle, load = (head.number(key, low=1e-3) if key in head else 0.0 for key in keys)
    loads = head.rows("loads", of="load") if "loads" in head else []
    if any(len(row) != 2 or row[0] <= 0 or row[1] < 0 for row in loads) or (loads and not any(b for _, b in loads)):
        raise head.error("loads is not a list of pairs", "loads = [[minutes, load], ...]")
    by_load = BY_LOAD, loads and load, "loads and test_load"
    for duties, value, key in ((("S2",), rated, "rated_min"), (CYCLIC, cycle, "cycle_min"), by_load):
        if name in duties and not value:
            raise head.error(f"the duty {name} has no {key}", f"{key} = ...")
    return Operation(name, rated, cycle, tuple((a, b) for a, b in loads), load)


def _part(part: th.TomlTable) -> tuple[str, int, float, float]:
    sign = int(part.number("sign", 1.0))
    if sign == 0:
        raise part.error("sign = 0 is not possible", "1, or -1 for what two parts have in common")
    row = (part.word("name"), sign, part.number("rise_K"), part.number("sd_K"))
    part.close()
    return row


def _of_case(
    name: str, head: th.TomlTable, record: Record, file: Path, k: float, tell: th.Progress
) -> tuple[Record, tuple[th.Extrapolated, ...], dict[str, str]]:
    """Cold and hot resistance, load and cooling of a test, and the way back along the curve of the case's network."""
    beside = file.parent / name
    folder = th.open_case(str(beside) if beside.is_dir() else name, tell)
    tests = {t.name: t for t in folder.case.tests}
    test = tests[head.word("test", next(iter(tests)), tests)]
    sheet = th.load_sheet(next(e.sheet for e in folder.settings.tests if e.name == test.name))
    windings = {
        c.name: (c, c.electrical.source)
        for c in sheet.columns
        if c.electrical is not None and isinstance(c.electrical.source, th.Winding)
    }
    if not windings:
        raise InputError("measures no winding by its resistance", sheet.where, 'a column of quantity = "resistance"')
    column = head.word("column", next(iter(windings)), windings)
    network = folder.case.model.network
    air = test.boundaries[th.ambient(network) or network.boundaries[0]]
    cold, hot, warming = _readings(*windings[column], test, air)
    record = replace(record, cold=cold, hot=hot, warming=warming, ohmmeter=windings[column][1].meter)
    ways: tuple[th.Extrapolated, ...] = ()
    if hot.cooling:
        tell("cooling of the network")
        winding = winding_of(cold, record.ohmmeter, k)
        ways = (network_way(folder.case, test, windings[column][0].place, cold, hot, winding),)
    key, revision = th.case_key(folder), str(folder.case.model.revision)
    return record, ways, {"case": folder.case.name, "test": test.name, "revision": revision, "key": key}


def _readings(column: th.Column, winding: th.Winding, test: th.Test, air: th.Array) -> tuple[Cold, Hot, Pairs]:
    """What a sheet says of a winding: cold, after switching off (coolant of the last quarter), and (min, degC)."""
    late = test.time >= test.time[0] + LAST_QUARTER * (test.time[-1] - test.time[0])
    coolant = float(np.mean(air[late]))
    cooling: tuple[tuple[float, float], ...] = ()
    after = column.electrical.after if column.electrical else None
    if after is not None:
        file = th.recording(after.file)
        table = th.read_recording(file, after.worksheet)
        cooling = tuple((float(t), float(v)) for t, v in th.pairs(table, after.time, after.column, file))
    y = next(c.y for c in test.channels if c.name == column.name)
    read = np.isfinite(y)
    warming = tuple((float(t), float(v)) for t, v in zip(test.time[read] / 60.0, y[read], strict=True))
    cold = Cold(winding.cold_C, winding.cold_C, winding.cold_ohm)
    return cold, Hot(coolant, cooling), warming
