"""The model as it stands, run for pictures: readings per sensor, temperature fields, and the steps that led there."""

import json
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from geom.constants import NORMAL_95
from geom.disk_cache import recalled, store
from geom.storage import cache_folder
from lumped.condensation.recovery import Shapes
from lumped.integration.simulate import Run, simulate
from lumped.machine.bases import unused
from lumped.model.network import Network, Row
from lumped.model.once import once
from measured.case import Case, Channel, Test
from measured.doubt import split_answers
from measured.sensors.operators import of_measurement
from thermoscope.case_folder.content import result_key
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import History, Revision
from validation.comparison.compare import physical
from validation.comparison.predict import heat_model, predict, record
from validation.effects import effect
from validation.effects.during import During
from validation.parameters.unknowns import effects_of, scene_of, standing, to_value, value_words, working
from validation.threads import side_by_side

if TYPE_CHECKING:
    from viz.data import Comparison
    from viz.rendering.nodes import SplitMesh

ORDER = {"hold-out": 0, "validate": 1, "calibrate": 2}  # of tests by what they tell of a model
HOT = "hottest point of "
RANGE_FRAMES = 25  # of a test: between two of them a machine moves by less than colours are rounded
BLIND = 0.9  # an interval this wide, compared with the one expected before, taught nothing


def by_interest(folder: Folder) -> list[Test]:
    """Tests with the never-used ones first."""
    return sorted(folder.case.tests, key=lambda test: ORDER[test.role])


def at_revision(folder: Folder, revision: Revision) -> Case:
    """The case with the model of a revision; asked again it is the same one, with all that is known of it."""
    for other, case in _of_revisions(folder):
        if other == revision:
            return case
    model = folder.history.model(folder.case.model.network, revision)
    doubt, answers = split_answers(folder.settings.doubt, revision.answers)
    _of_revisions(folder).append((revision, replace(folder.case, model=model, doubt=doubt, answers=answers)))
    return _of_revisions(folder)[-1][1]


@once
def _of_revisions(folder: Folder) -> list[tuple[Revision, Case]]:
    return []


def before_last(folder: Folder) -> Case | None:
    """The case before the last step; None when there was none."""
    steps = folder.history.revisions
    return at_revision(folder, steps[-2] if len(steps) > 1 else Revision(0, "calibrate")) if steps else None


def readings(case: Case, test: Test) -> dict[str, Array]:
    """Channel -> (n_time,) degC, what its sensor would read; sensors' fitted biases are left out."""
    y = predict(standing(case), test, physical(case)).y
    return {channel.name: y[:, j] for j, channel in enumerate(test.channels)}


def ends(case: Case, test: Test, names: Sequence[str]) -> list[float]:
    """Mean temperatures (degC) of places at the end of a test, by the model of a case."""
    network, values = heat_model(standing(case), case.model.values)
    rows = mean_rows(network)
    return simulate(network, record(test, {}), values, [rows[n] for n in names]).y[-1].tolist()


def comparison_of(folder: Folder, test: Test, limits: Mapping[str, float] | None = None) -> "Comparison":
    """A test against the model, and against the model before its last step.

    limits : channel -> the largest error that counts as agreement (K); None to have them worked out
    """
    earlier = _before_last(folder)
    before = None if earlier is None else _readings(earlier, test)
    agreement = folder.limits(test) if limits is None else limits
    return replace(current_comparison(folder, test), limits=agreement, before=before)


def current_comparison(folder: Folder, test: Test) -> "Comparison":
    """A test against the model as it is, without what counts as agreement."""
    from viz.data import Comparison

    return Comparison(test, _readings(folder, test), {}, None, accepted(folder.case, test))


def _readings(folder: Folder, test: Test) -> dict[str, Array]:
    """As `readings`, from an earlier command where it compared this very model."""
    if folder.stored is None:
        return readings(folder.case, test)
    return {c.name: folder.stored.readings[test.name][:, j] for j, c in enumerate(test.channels)}


@once
def _before_last(folder: Folder) -> Folder | None:
    """The folder of that case, as it was: with the history that it had."""
    case = before_last(folder)
    if case is None:
        return None
    return replace(folder, case=case, history=History(folder.history.revisions[:-1]))


def accepted(case: Case, test: Test) -> tuple[tuple[float, float], ...]:
    """When something was different in a test, by the model's effects: from and to (s)."""
    events = [effect.event for effect in effects_of(case) if isinstance(effect, During) and effect.event]
    return tuple(span for event in events for span in event.spans.get(test.name, ()))


def nodes_of(folder: Folder, test: Test) -> "SplitMesh":
    """The mesh to draw in a test: of several bases what the machine stands on."""
    from viz.rendering.nodes import split

    assert folder.built is not None
    return split(folder.built.mesh, unused(folder.built.machine, test.inputs))


def fields(case: Case, test: Test, nodes: "SplitMesh", frames: int) -> tuple[Array, Array]:
    """Times (n,) s and temperatures (n, n_nodes) degC on the parts' own nodes; the network needs a recovery."""
    network, run = _run(case, test)
    rows = np.unique(np.linspace(run.time.size - 1, 0, frames).astype(int))
    states = np.asarray(run.z)[rows, : len(network.states)]
    return run.time[rows], np.ascontiguousarray(network.on_parts(nodes.parts, states.T).T)


def instant_words(test: Test, time: float) -> str:
    """Which test and which instant (s) a picture shows."""
    return f"{test.name} at {time / 60:.0f} min"


def temperature_range(folder: Folder, nodes: "SplitMesh") -> tuple[float, float]:
    """Coldest and hottest temperature (degC) of all tests, with the model now and before its last step.

    Pictures, films, recordings, viewer and workbench of a case take their colours from it, so that they compare.
    Kept by content: every one of them asks for it.
    """
    file = _range_file(folder)
    cached = recalled(file, _range_in)
    if cached is not None:
        return cached
    runs = [(of.case, test) for of in _now_and_before(folder) for test in of.case.tests]
    every = side_by_side(lambda run: fields(*run, nodes, RANGE_FRAMES)[1], runs)
    low, high = min(float(T.min()) for T in every), max(float(T.max()) for T in every)
    store(file, json.dumps([low, high]))
    return low, high


def stored_range(folder: Folder) -> tuple[float, float] | None:
    """The same (degC) where it is known already, else that of the model before; None where neither is."""
    of_all = (recalled(_range_file(of), _range_in) for of in _now_and_before(folder))
    return next((limits for limits in of_all if limits is not None), None)


def _now_and_before(folder: Folder) -> list[Folder]:
    return [of for of in (folder, _before_last(folder)) if of is not None]


def _range_file(folder: Folder) -> Path:
    return cache_folder() / f"range-{'-'.join(map(result_key, _now_and_before(folder)))}.json"


def _range_in(file: Path) -> tuple[float, float]:
    low, high = json.loads(file.read_text(encoding="utf-8"))
    return float(low), float(high)


def _run(case: Case, test: Test) -> tuple[Network, Run]:
    """A run of a case's model with all its states; the last two of a test are remembered: now, and a step before."""
    network, values = heat_model(standing(case), case.model.values)
    for of, at, run in tuple(_last_runs(test)):
        if of is network and at == values:
            return network, run
    run = simulate(network, record(test, {}), values, keep_states=True)
    _last_runs(test).append((network, values, run))
    return network, run


@once
def _last_runs(test: Test) -> deque[tuple[Network, dict[str, float], Run]]:
    return deque(maxlen=2)


def steps(folder: Folder) -> list[dict[str, Any]]:
    """The revisions as pictures and the report want them: number, action, effect, the step in words, tests."""
    roles = {t.name: t.role for t in folder.case.tests}
    return [
        {
            "number": r.number,
            "action": r.action,
            "effect": r.effect,
            "effects": list(r.effects),
            "words": step_words(folder.case, r),
            "why": r.why,
            "tests": [
                {"name": name, "role": roles[name], "rmse_K": {"before": before, "after": after}}
                for name, (before, after) in r.rmse_K.items()
                if name in roles
            ],
        }
        for r in folder.history.revisions
    ]


def added_words(case: Case, names: Iterable[str]) -> str:
    """Effects as an engineer says them: "forced convection by vehicle wind at flange.right"."""
    return " and ".join(effect(name, scene_of(case)).statement for name in names)


def step_words(case: Case, step: Revision) -> str:
    """What a step added or removed, as an engineer says it; what else it did."""
    from validation.revision.revise import TOGETHER

    if step.action in ("add", "remove"):
        return "remove " * (step.action == "remove") + added_words(case, step.effect.split(TOGETHER))
    return f"{step.action} {step.effect or ''}".strip()


def finding_words(folder: Folder, errors: Mapping[str, Any]) -> str:
    """In one sentence what the last addition found, what it did to the error, and the largest that it leaves.

    The error before is that of the calibrated model without it on the same tests: the held-out ones, else all. What was
    added before it stands behind that, with the error from which all together came.
    errors : a `compare` document of the model.  Empty where nothing was added.
    """
    from validation.revision.revise import TOGETHER
    from viz.data import short

    last, added = folder.history.last, dict[str, Revision]()
    for revision in folder.history.revisions:
        for name in revision.effect.split(TOGETHER) if revision.action == "add" else ():
            added[name] = revision
    names = [name for name in added if name in last.effects]
    if not names:
        return ""
    first, step = (of((added[n] for n in names), key=lambda r: r.number) for of in (min, max))
    tests = [t for t in errors["tests"] if t["name"] in first.rmse_K.keys() & step.rmse_K.keys()]
    unseen = [t for t in tests if t["role"] == "hold-out"]
    seconds = [sum(c["seconds"] for c in t["channels"]) for t in unseen or tests]
    each = [(first.rmse_K[t["name"]][0], step.rmse_K[t["name"]][0], t["rmse_K"]) for t in unseen or tests]
    start, was, now = np.sqrt(np.average(np.square(each), axis=0, weights=seconds))
    error, test, name = max((c["rmse_K"], t["name"], c["channel"]) for t in errors["tests"] for c in t["channels"])
    limit = folder.limits(next(t for t in folder.case.tests if t.name == test))[name]
    verb, on = "Found" if now < was else "Added", "Held out" if unseen else "Error"
    words, earlier = (added_words(folder.case, [n for n in names if (added[n] is step) == it]) for it in (True, False))
    since = f"; since calibration, with {earlier}, from {start:.2f} K" if earlier else ""
    left = f"at most {error:.1f} K, {short(name)} in {test} (limit {limit:.1f})"
    return f"{verb}: {words}. {on} {was:.2f} -> {now:.2f} K{since}. Left: {left}."


def parameters(folder: Folder) -> list[dict[str, Any]]:
    """The values of the last revision with their intervals, as `calibrate` lists them, by `effects_first`."""
    last = folder.history.last
    out = []
    for p in working(folder.case)[1].parameters:
        if p.name not in last.intervals:
            continue
        low, high = (max(p.low, min(p.high, to_value(p, s * NORMAL_95 * p.prior_sd))) for s in (-1.0, 1.0))
        a, b = last.intervals[p.name]
        size = {"value": last.values[p.name], "unit": p.unit, "ci95": [a, b], "prior": [p.value, low, high]}
        kind = {"of_measurement": of_measurement(p), "identified": b - a < BLIND * (high - low)}
        out.append({"name": p.name, "words": value_words(p.name), **size, **kind})
    return sorted(out, key=effects_first)


def effects_first(p: Mapping[str, Any]) -> tuple[bool, bool, float]:
    """Sorts the effects' own sizes first, then their exponents, then what lies farthest from its prior."""
    low, high = p["prior"][1:]
    return "@" not in p["name"], "^" in p["name"], -abs(p["value"] - p["prior"][0]) / max(high - low, 1e-300)


def sensors(folder: Folder) -> dict[str, Channel]:
    """Every sensor of the case once, by its column's name."""
    return {c.name: c for test in folder.case.tests for c in test.channels}


def mean_rows(network: Network) -> dict[str, Row]:
    """The means of parts, nodes and fluids."""
    return {n: p.mean for n, p in network.places.items() if p.kind != "surface" and "#" not in n}


def hot_spots(network: Network, z: Array) -> dict[str, Row]:
    """The hottest point of every part that losses heat, at the instant when it is hottest; none without a recovery.

    z : (n_time, n_states + n_boundaries) degC of a run
    """
    parts = network.recovery.parts if isinstance(network.recovery, Shapes) else {}
    out = {}
    for name in (n for n in network.heated if n in parts):
        shape = parts[name]
        x = z[int(np.argmax(z[:, shape.states] @ (shape.weights @ shape.V))), shape.states]
        out[f"{HOT}{name}"] = Row(shape.states, shape.V[int(np.argmax(shape.V @ x))])
    return out


def named_rows(network: Network, folder: Folder) -> dict[str, Row]:
    """Named temperatures: the means of parts and nodes, then where the sensors of the case sit."""
    return mean_rows(network) | {f"sensor {name}": c.row for name, c in sensors(folder).items()}
