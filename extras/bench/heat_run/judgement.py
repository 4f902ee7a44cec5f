"""The verdict on a heat run: which rise decides, whether the run was its duty, and one sentence."""

from importlib.metadata import version
from platform import python_version
from typing import Any

from extras.bench.heat_run.duty import Duty, duty_of, power_30_minutes
from extras.bench.heat_run.limits import DETECTORS, RESISTANCE, corrections, methods
from extras.bench.heat_run.record import HeatRun
from extras.bench.heat_run.rises import (
    SUPERPOSITION,
    Rise,
    Verdict,
    deciding,
    detector_rise,
    resistance_rises,
    superposed_rise,
)
from extras.bench.measuring.protocol import Step, checked_steps
from thermoscope import InputError, plugin as th

BY_DUTY = "constant load"  # the step of the procedure that a duty judges in its own way


def judged(run: HeatRun) -> dict[str, Any]:
    """The document of a heat run. InputError where a reading would give a wrong temperature."""
    steps = checked_steps(run.record)
    for step in (s for s in steps if s.state == "refused" and s.name != BY_DUTY):
        what, _, right = step.words.partition("; ")
        raise InputError(what, f"{run.title} [{step.name}]", right)
    duty = duty_of(run.operation, run.record.warming, run.coolant_C)
    rises = _rises(run)
    rise = deciding(rises, run.rating.standard)
    verdict, why = _verdict(rise, duty)
    return {
        "title": run.title,
        "standard": run.rating.standard,
        "class": run.rating.thermal_class,
        "verdict": verdict,
        "sentence": f"class {run.rating.thermal_class}: {_sentence(rise, verdict, why)}",
        "decides": rise.method,
        "rises": [r.document() for r in rises],
        "duty": dict(vars(duty)),
        "limits": _limits(run),
        "steps": [_measured(s, run, duty) for s in steps],
        "readings": {
            "k": run.k,
            "cold_ohm": run.record.cold and run.record.cold.ohm,
            "cold_degC": run.record.cold and run.record.cold.machine_C,
            "coolant_degC": run.record.hot and run.record.hot.ambient_C,
            "warming": [list(row) for row in run.record.warming],
            "cooling": [list(row) for row in (run.record.hot.cooling if run.record.hot else ())],
        },
        "power_30min": power_30_minutes(run.power) if run.power else None,
        "signature": {
            "record": run.key,
            **run.origin,
            "versions": {name: version(name) for name in ("thermoscope", "numpy")} | {"python": python_version()},
            "names": dict(run.names),
        },
    }


def _limits(run: HeatRun) -> list[dict[str, Any]]:
    rows = [dict(vars(row)) for row in methods(run.rating, run.k)]
    for method in (RESISTANCE, DETECTORS) if run.detectors else (RESISTANCE,):
        rows += [{**vars(row), "what": f"{method}: {row.what}"} for row in corrections(run.rating, method)]
    return rows


def _measured(step: Step, run: HeatRun, duty: Duty) -> dict[str, Any]:
    """A step with the reading itself, and the load as its duty judges it."""
    document, hot = step.document(), run.record.hot
    if step.name == BY_DUTY and duty.minutes is not None:
        return {**document, "state": "doubtful" if duty.missing else "done", "words": duty.missing or duty.words}
    if step.name == "hot resistance" and hot is not None and hot.cooling:
        seconds, ohm = hot.cooling[0]
        document["words"] = f"{ohm:g} ohm at {seconds:g} s, coolant {hot.ambient_C:.1f} degC; {step.words}"
    return document


def _rises(run: HeatRun) -> list[Rise]:
    record, rating = run.record, run.rating
    rises = [Rise(RESISTANCE, limit_K=corrections(rating, RESISTANCE)[-1].limit_K)]
    if record.cold is not None and record.hot is not None:
        rises = resistance_rises(record.cold, record.hot, record.ohmmeter, run.k, run.thermometer_K, rating, run.ways)
    hottest = th.Reading("detector", max(run.detectors), run.detector_K) if run.detectors else None
    return [
        *rises,
        detector_rise(hottest, run.coolant_C, run.thermometer_K, rating),
        superposed_rise(run.parts, rating),
    ]


def _verdict(rise: Rise, duty: Duty) -> tuple[Verdict, str]:
    """A run that is not its duty cannot pass; where it was milder than the duty, it can fail all the same."""
    if rise.rise_K is None:
        return "cannot be judged", "no rise was measured"
    if rise.limit_K is None:
        return "cannot be judged", "there is no limit to judge by"
    if duty.missing and rise.method != SUPERPOSITION and not (rise.verdict == "fails" and duty.milder):
        return "cannot be judged", duty.missing
    return rise.verdict, "the limit lies within the uncertainty" if rise.verdict == "cannot be judged" else ""


def _sentence(rise: Rise, verdict: Verdict, why: str) -> str:
    numbers = [] if rise.rise_K is None or rise.U95_K is None else [f"{rise.rise_K:.1f} ± {rise.U95_K:.1f} K"]
    value = " of ".join([*numbers, *([f"{rise.limit_K:.1f} K"] if numbers and rise.limit_K is not None else [])])
    left = abs(rise.margin_K or 0.0)
    ending = {
        "passes": f"passes with {left:.1f} K in hand after the uncertainty",
        "fails": f"fails by {left:.1f} K after the uncertainty",
    }.get(verdict, f"{verdict}: {why}")
    return ", ".join(filter(None, [value, ending]))
