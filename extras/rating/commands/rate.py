"""thermoscope use rate CASE|MACHINE: what it may carry, for how long, and how sure that is."""

import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from extras.rating.envelope import DUTIES, Lap, LimitError, Rating, rated, share_for_ever, time_to_limit, until
from extras.rating.operation import Operation
from extras.rating.points import Model
from extras.rating.request import Rated, RatingRequest, rated_model
from extras.rating.rows import derated, load_of, point, row
from thermoscope import InputError, plugin as th

POINTS = 6  # speeds of the envelope
LOADS = 8  # loads of the map
LARGEST_START = 1e7  # in amperes or newton metres: beyond any machine
WARM = 0.75  # load at rest from which an overload begins warm


def rate(
    name: Annotated[str, typer.Argument(metavar="CASE|MACHINE", help="A case, or a machine with nothing measured.")],
    limit: th.HotLimitOption = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="Input or boundary.")] = None,
    losses: Annotated[Path | None, typer.Option(metavar="CSV", help="Loss map over torque and speed.")] = None,
    voltage: Annotated[float | None, typer.Option(min=0.0, max=1e7, help="Of the map's slices.")] = None,
    overload: Annotated[float, typer.Option(min=100.1, max=1e4, help="Percent of the continuous rating.")] = 150.0,
    top: Annotated[float | None, typer.Option(min=0.0, max=1e6, metavar="RPM", help="Of the envelope.")] = None,
    load: Annotated[list[str] | None, typer.Option(metavar="INPUT", help="What the load multiplies.")] = None,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A drive cycle to repeat.")] = None,
    mapped: Annotated[bool, typer.Option("--map", help="How long at every speed and load.")] = False,
    start: Annotated[str, typer.Option(metavar="cold|LOAD", help="S2 begins cold, or at rest under a load.")] = "cold",
    bands: th.BandsOption = None,
    json: th.JsonOption = None,
) -> int:
    """What a machine may carry: S1, S2, S3, S6, 10 s, 60 s, derating, overload; with bands, beside the last model."""
    options = th.read_limits(limit or ()), read_at(at or ()), tuple(load or ())
    request = RatingRequest(*options, losses, voltage, overload / 100.0, top, cycle, mapped, read_start(start))
    if voltage is not None and losses is None:
        right = "--losses FILE.csv with a column voltage_V"
        raise InputError("is of a loss map, and none is given", "--voltage", right)
    if not request.limits:
        raise InputError("no limit is given", "--limit", "PLACE=DEGC, for example winding=155")
    with th.progress() as tell, once() as messages:
        document = rating_document(case_or_machine(name, tell), request, bands, tell)
    th.notes(messages)
    th.give(document, json, lambda: rating_summary(document))
    return 0


def holding_times(
    model: Model, op: Operation, limits: Mapping[str, float], loads: Sequence[float], speeds: Sequence[float]
) -> th.Array:
    """(n_speed, n_load) seconds from cold until a limit is reached; inf where it may stay for ever."""
    return np.array([[_time(model, op, list(limits.values()), load, n) for load in loads] for n in speeds])


def _time(model: Model, op: Operation, most: Sequence[float], load: float, speed: float) -> float:
    if np.all(model.rest(op, load, speed) < np.asarray(most)):
        return float("inf")
    return until(model, op, most, load, speed, None)


def read_at(words: Sequence[str]) -> dict[str, float]:
    """NAME=VALUE, ..."""
    return th.read_pairs(words, "--at", "operating point", "NAME=VALUE, for example speed_rpm=2000")


def read_start(word: str) -> float | None:
    """The load from whose rest S2 begins, in the unit of the input that carries it; None for "cold"."""
    if word == "cold":
        return None
    load = th.as_number(word)
    if load is None or not 0.0 <= load <= LARGEST_START:
        raise InputError(f"'{word}' is not a start", "--start", f"cold, or a load from 0 to {LARGEST_START:g}, as 120")
    return load


def is_machine(name: str) -> bool:
    """A file, or a machine that comes along where no file or folder is called so; else a case is meant."""
    return Path(name).is_file() or (not Path(name).exists() and name in th.library())


def case_or_machine(
    name: str, tell: th.Progress, check: Callable[[th.Settings], None] = lambda settings: None
) -> th.Folder:
    """A case, or a machine on its own as a case without tests; `check` is asked before anything is meshed."""
    path = Path(name)
    if not is_machine(name):
        check(th.read_settings(th.find_case(name, th.library()), untested=True))
        return th.open_case(name, tell, untested=True)
    with tempfile.TemporaryDirectory() as folder:
        machine = str(path.resolve()) if path.is_file() else name
        text = f"[case]\nname = {th.toml_value(path.stem)}\nmachine = {th.toml_value(machine)}\n"
        Path(folder, "case.toml").write_text(text, encoding="utf-8")
        check(th.read_settings(Path(folder), untested=True))
        return th.open_case(folder, tell, untested=True)


@contextmanager
def once() -> Iterator[list[str]]:
    """What correlations and maps say of their ranges: the last word of each instead of hundreds."""
    notes: list[str] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("ignore")
        warnings.simplefilter("always", th.RangeWarning)
        yield notes
    last = {w.message.subject: str(w.message) for w in caught if isinstance(w.message, th.RangeWarning)}
    notes.extend(f"{what} (a rating looks beyond what it ends at)" for what in last.values())


def rating_document(folder: th.Folder, request: RatingRequest, sure: bool | None, tell: th.Progress) -> dict[str, Any]:
    it = rated_model(folder, request)
    model, op, limits = it.model, it.op, it.limits
    tell("ratings")
    here = {form: rated(model, op, limits, form, None) for form in DUTIES}
    old = _before(folder, request, tell)
    before = {} if old is None else {form: load_of(old, form, None) for form in DUTIES}
    posterior = (
        th.posterior_of(folder, tell) if request.losses is None and th.bands_requested(model.network, sure) else None
    )
    tell("envelope over the speed")
    speeds = _speeds(folder, op, request)
    envelope = [r for form in DUTIES for n in speeds if (r := _rated_at(it, form, n))]
    if short := [n for n in speeds if n not in {r.speed for r in envelope if r.form == "S1"}]:
        th.notes([f"at {', '.join(f'{n:.4g}' for n in short)} 1/min a limit is exceeded without any load; --top RPM"])
    tell("derating")
    load, main = here["S1"].load, op.inputs[op.main]
    return {
        "case": folder.case.name,
        "revision": folder.case.model.revision,
        "limits": [{"place": p, "degC": T} for p, T in limits.items()],
        "reference": {
            "input": op.main,
            "value": main,
            "of": "Asked" if op.main in request.at else "Largest in the tests" if folder.case.tests else "Rated",
            "inputs": dict(op.inputs),
            "boundaries": dict(op.boundaries),
            "start": "cold" if request.start is None else request.start,
        },
        "ratings": [row(folder, op, r, before.get(f), posterior) for f, r in here.items()],
        "envelope": [point(folder, op, r, old, posterior) for r in envelope],
        "derating": derated(folder, it, old, load, posterior),
        "overload": _overload(it, request, load),
        "cycle": _cycle(folder, it, request, tell),
        "map": _map(it, (load, here["S2 10 s"].load), speeds, tell) if request.mapped else {},
    }


def _rated_at(it: Rated, form: str, speed: float) -> Rating | None:
    """A point of the envelope; none where a speed alone overheats the machine."""
    try:
        return rated(it.model, it.op, it.limits, form, speed)
    except LimitError:
        return None


def _before(folder: th.Folder, request: RatingRequest, tell: th.Progress) -> Rated | None:
    """The model before its last step; none without a step."""
    earlier = th.before_last(folder)
    if earlier is None:
        return None
    tell("ratings of the model before its last step")
    return rated_model(replace(folder, case=earlier), request)


def _map(it: Rated, ends: tuple[float, float], speeds: Sequence[float], tell: th.Progress) -> dict[str, Any]:
    """Seconds from cold at every speed and load, from half of what holds for ever to what holds for ten seconds."""
    if not speeds or not np.all(np.isfinite(ends)):
        raise InputError("there is no map", "--map", "a model whose losses or films know a speed, and a limit in reach")
    tell("map over load and speed")
    loads = [float(x) for x in np.geomspace(0.5 * ends[0], ends[1], LOADS)]
    seconds = holding_times(it.model, it.op, it.limits, loads, speeds)
    main = it.op.inputs[it.op.main]
    return {"speed_rpm": list(speeds), it.op.main: [main * x for x in loads], "seconds": seconds.tolist()}


def _cycle(folder: th.Folder, it: Rated, request: RatingRequest, tell: th.Progress) -> dict[str, Any]:
    """The share of a drive cycle's load that may be repeated for ever; how long all of it from cold."""
    if request.cycle is None:
        return {}

    tell(f"cycle {request.cycle}")
    network, op, model = it.model.network, it.op, it.model
    ratings = folder.built.machine.sections.get("ratings", {}) if folder.built is not None else {}
    cycle = th.load_cycle(th.find_cycle(folder.settings.path, request.cycle), network, ratings)
    th.notes(cycle.notes)
    record = cycle.record
    if cycle.drive is not None:
        model = replace(model, network=cycle.on(network))
        drive = th.coupled(model.network, record, cycle.drive, cycle.watched, model.values)
        record = replace(record, inputs=drive.inputs)
        currents = {n: float(np.mean(record.inputs[n])) for law in cycle.laws.values() for n in law.reads}
        op = replace(op, inputs={**currents, **op.inputs}, loads=tuple(dict.fromkeys((*op.loads, *currents))))
    lap, short = Lap(record, op.loads), th.short_of(record)
    th.notes(
        f"{cycle.name}: {name} misses what was wanted by more than 1 % for {seconds:.4g} s of a lap"
        for name, seconds in short.items()
    )
    share, at = share_for_ever(model, op, it.limits, lap)
    until_s = time_to_limit(model, op, it.limits, lap)
    return {"name": cycle.name, "share": share, "at": at, "until_s": until_s, "short_of_s": short}


def _speeds(folder: th.Folder, op: Operation, request: RatingRequest) -> list[float]:
    """From rest to the largest speed that was fitted or asked for; none where it carries the load itself."""
    if op.speed is None or op.speed in op.loads:
        return []
    fitted = th.standing_reference(folder.case).signals.get(op.speed)
    peaks = [abs(fitted.low), abs(fitted.high)] if fitted else []
    top = request.top_rpm or max([abs(op.inputs[op.speed]), *peaks])
    return [float(n) for n in np.linspace(0.0, top, POINTS)] if top > 0.0 else []


def _overload(it: Rated, request: RatingRequest, load: float) -> dict[str, Any]:
    """How long at a multiple of the continuous rating, from cold and from rest at three quarters of it."""
    if not np.isfinite(load):
        return {}
    most = list(it.limits.values())
    cold, warm = (until(it.model, it.op, most, request.overload * load, None, w) for w in (None, WARM * load))
    return {"percent": 100.0 * request.overload, "from_cold_s": cold, "from_warm_s": warm, "warm_percent": 100.0 * WARM}


def rating_summary(document: Mapping[str, Any]) -> th.Summary:
    """The continuous rating with its band; the other forms; cycle, map, envelope and derating."""
    first, reference = document["ratings"][0], document["reference"]
    main = reference["input"]
    sure = "" if first["ci95"] is None else f" ({first['ci95'][0]:.4g} to {first['ci95'][1]:.4g})"
    sentence = f"Continuous: {main} = {first['value']:.4g}{sure}, limited by {first['at']}{_change(first)}."
    if not np.isfinite(first["value"]):
        sentence = f"Continuous: no {main} that this model knows reaches a limit."
    elif np.isfinite(margin := 100.0 * (first["value"] / reference["value"] - 1.0)):
        more = f"{margin:.3g} % in hand" if margin >= 0.0 else f"the limit is {-margin:.3g} % below it"
        rated = f"{reference['of']} {reference['value']:.4g} {th.stem_and_unit(main)[1]}"
        sentence += f" {rated.rstrip()}: {more}."
    begin = "cold" if reference["start"] == "cold" else f"rest under {main} = {reference['start']:.4g}"
    around = {**{n: u for n, u in reference["inputs"].items() if n != main}, **reference["boundaries"]}
    at = ", ".join(f"{n} = {u:.4g}" for n, u in around.items())
    ends: dict[str, Any] = {"low": lambda r: (r["ci95"] or [None])[0], "high": lambda r: (r["ci95"] or [None])[-1]}
    heading = main.replace("|", "/").replace("=", "/")  # signs that end the name of a column
    band = f"*{heading}=value | *95 % from=low | *to=high | limited by=at | before"
    table = th.Table.of("", document["ratings"], f"form | {band} | *change (%)=change_percent", **ends)
    parts: list[th.Table | str] = [table, f"At {at}; S2 from {begin}."]
    if over := document["overload"]:
        parts.append(
            f"{over['percent']:g} % of it may last {over['from_cold_s']:.4g} s from cold, {over['from_warm_s']:.4g} s "
            f"from rest at {over['warm_percent']:g} %."
        )
    if cycle := document["cycle"]:
        parts.append(_of_cycle(cycle))
    parts += [_of_map(document["map"], main)] if document["map"] else []
    shares = []
    for d in document["derating"]:
        percent = {key: _percent(d[key]) for key in ("share", "share_before")}
        shares.append({**d, **percent, "ci95": [100.0 * s for s in d["share_ci95"] or ()]})
    elsewhere = "over=of | *value | unit | *% of it=share | *95 % from=low | *to=high | before (%)=share_before"
    parts.append(th.Table.of("Continuous rating elsewhere", shares, elsewhere, **ends))
    over_speed = f"form | *speed (1/min)=speed_rpm | {band.replace('*95', '95').replace('*to', 'to')}"
    parts.append(th.Table.of("Over the speed", document["envelope"], over_speed, **ends))
    return th.Summary(sentence, parts, "--json FILE; --limit, --at, --losses, --cycle, --map")


def _change(first: Mapping[str, Any]) -> str:
    """How much more or less than the model before its last step said."""
    change = first["change_percent"]
    if change is None:
        return ""
    return f"; {abs(change):.3g} % {'more' if change > 0.0 else 'less'} than the model before its last step said"


def _percent(share: float | None) -> float | None:
    return None if share is None else 100.0 * share


def _of_cycle(cycle: Mapping[str, Any]) -> str:
    """A sentence on a cycle."""
    until_s = cycle["until_s"]
    whole = f"all of it reaches the limit after {until_s:.4g} s" if np.isfinite(until_s) else "all of it may"
    share = f"{100.0 * cycle['share']:.4g} % of its load" if np.isfinite(cycle["share"]) else "any load"
    return f"Cycle {cycle['name']}: {share} may be repeated for ever ({cycle['at'] or 'nothing'} limits); {whole}."


def _of_map(grid: Mapping[str, Any], main: str) -> th.Table:
    """A row per load, the largest first; a column per speed."""
    rows = [
        [u, *(s[k] if np.isfinite(s[k]) else "for ever" for s in grid["seconds"])]
        for k, u in reversed(list(enumerate(grid[main])))
    ]
    return th.Table("Seconds from cold, over the speed (1/min)", [main, *(f"{n:.0f}" for n in grid["speed_rpm"])], rows)
