"""How much of doubt is too much: sound machines asked how small the bound on its sum may be.

Of a machine with nothing missing the log evidence of the readings is worked out with the doubts of every record scaled
down to a share of the machine's largest rise. The bound is the least share that costs sound machines half a nat each;
every kind in turn is held against the bound that the others ask for.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hidden.cases import edits_of, plan, records_of
from hidden.user import case_of
from lumped.model.multipliers import parameter_values
from measured.case import Case
from measured.doubt import TABLE, USUAL
from scripts.published import add_lines, json_lines, table
from validation.calibration.calibrate import CachedSegments, Fit, InnerProduct, calibrated, minimise
from validation.calibration.model_error import ModelError, machine_rise, model_error
from validation.inference.evidence import log_evidence
from validation.noise import Noise, fit_noise
from validation.parameters.unknowns import working

SHARES = (0.1, 0.07, 0.05, 0.035, 0.025, 0.018, 0.012, 0.008, 0.005, 0.0025)
COSTS = 0.5  # nats of a sound machine: as much as if nothing were missing in half of all cases instead of 0.6
USED = TABLE["total"].sd
UNBOUNDED = 1e9
STEPS = 6  # of a fit that goes on with other doubts


def log_evidences(case: Case) -> dict[str, float]:
    """Share -> log evidence (nats) of nothing missing, under the noise that hardly any doubt leaves."""
    network, unknowns = working(case)
    tests, rise = case.usable, machine_rise(case.usable)
    fit = calibrated(network, tests, unknowns, case.model.values, 1, rough=True)
    fixed = {**parameter_values(network, case.model.values), **fit.values}
    whole = model_error(network, tests, fixed, {**USUAL, "total": UNBOUNDED})

    def go_on(fit: Fit, noise: Noise, error: ModelError) -> Fit:
        cache = CachedSegments(fit.parts, nearby=False, stale=True)
        return minimise(network, tests, unknowns, fit.theta, noise, fixed, STEPS, cache, draft=True, error=error)

    least = whole.bounded(SHARES[-1] * rise)
    for _ in range(2):
        noise = fit_noise(InnerProduct(fit.parts, fit.noise, least).explained(fit.parts, least))
        fit = go_on(fit, noise, least)
    out = {}
    for share in SHARES:
        fit = go_on(fit, noise, whole.bounded(share * rise))
        out[f"{share:g}"] = log_evidence(fit)
    return out


def run(seeds: str, skip: int, count: int, kinds: Sequence[str], file: Path) -> None:
    """Sound machines that the file does not have yet, a line each."""
    file.parent.mkdir(parents=True, exist_ok=True)
    done = {row["case"] for row in json_lines(file)}
    for label in plan(seeds, skip + count, ["nothing"], kinds)[skip:]:
        if label.case not in done:
            case = case_of(label.case, label.machine, records_of(label), edits_of(label))
            row = {"case": label.case, "kind": label.machine, "nats": log_evidences(case)}
            add_lines(file, row)


def mean_cost(cases: Sequence[Mapping[str, Any]], share: float) -> float:
    """Nats per machine that a bound costs beside the widest."""
    return float(np.mean([c["nats"][f"{SHARES[0]:g}"] - c["nats"][f"{share:g}"] for c in cases]))


def bound(cases: Sequence[Mapping[str, Any]]) -> float:
    """The least share down to which machines lose no more than COSTS each."""
    costly = [share for share in SHARES if mean_cost(cases, share) > COSTS]
    return min(share for share in SHARES if share > max(costly, default=0.0))


def markdown(cases: Sequence[Mapping[str, Any]]) -> list[str]:
    """A line per kind left out."""
    kinds = sorted({c["kind"] for c in cases})
    by_kind = {kind: [c for c in cases if c["kind"] == kind] for kind in kinds}
    asked = {kind: bound([c for c in cases if c["kind"] != kind]) for kind in kinds}
    head = ("kind left out", "sound machines", "bound that the others ask for", "nats it costs each of this kind")
    rows = ((k, len(by_kind[k]), f"{100 * x:g} %", f"{mean_cost(by_kind[k], x):.1f}") for k, x in asked.items())
    costs = ", ".join(f"{mean_cost(cases, s):.1f} at {100 * s:g} %" for s in SHARES[1:])
    return [table(head, rows), "", f"Mean cost over all kinds in nats: `{costs}`. Used: {100 * USED:g} %."]
