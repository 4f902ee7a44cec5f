"""Add an effect, take it out, calibrate: a new model and a report of what it did to the error of every test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.errors import InputError
from lumped.network import Parameter
from validation.calibrate import Fit, calibrated, silent
from validation.case import AddedEffect, Case, Model, Test
from validation.compare import Comparison, compare
from validation.effects import effect
from validation.fitting import scene_of, to_value, working

Progress = Callable[[str], None]
UNSEEN = 0.9
GETS_WORSE = 1.05


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter. prior : (median, low, high) of its central 95 %; identified: the data narrowed the prior."""

    name: str
    value: float
    unit: str
    ci95: tuple[float, float]
    prior: tuple[float, float, float]
    identified: bool
    partner: str | None = None
    at_bound: bool = False

    def document(self) -> dict:
        return {**vars(self), "ci95": list(self.ci95), "prior": list(self.prior)}


@dataclass(frozen=True)
class Change:
    """Error of one test (K) before and after."""

    name: str
    role: str
    before: float
    after: float

    def document(self) -> dict:
        return {"name": self.name, "role": self.role, "rmse_K": {"before": self.before, "after": self.after}}


@dataclass(frozen=True)
class Revision:
    """What a revision did. accepted says whether the error fell where it should; the new model is given either way."""

    action: str
    effect: str | None
    model: Model
    accepted: bool
    why: str
    tests: tuple[Change, ...]
    parameters: tuple[Estimate, ...]
    before: Comparison
    after: Comparison
    converged: bool

    @property
    def revision(self) -> int:
        return self.model.revision

    def document(self) -> dict:
        return {
            "action": self.action,
            "effect": self.effect,
            "revision": self.revision,
            "accepted": self.accepted,
            "why": self.why,
            "converged": self.converged,
            "tests": [t.document() for t in self.tests],
            "parameters": [p.document() for p in self.parameters],
        }


def calibrate(
    case: Case, roles: Sequence[str] = ("calibrate",), kappa: float = 1.0, progress: Progress = silent
) -> Revision:
    """Fit the free parameters to the tests of the given roles. kappa widens the intervals (see null.py)."""
    return _revised(case, case.model, "calibrate", None, roles, kappa, progress)


def add(case: Case, name: str, kappa: float = 1.0, progress: Progress = silent) -> Revision:
    """Add effect 'kind@place' and calibrate on all tests but the held-out ones."""
    one = effect(name, scene_of(case))
    if name in {e.name for e in case.model.effects}:
        raise InputError(
            f"'{name}' is in the model already", f"case '{case.name}'", "another effect, or `remove` it first"
        )
    model = replace(case.model, effects=(*case.model.effects, AddedEffect(one.kind, one.place)))
    return _revised(case, model, "add", name, ("calibrate", "validate"), kappa, progress)


def remove(case: Case, name: str, kappa: float = 1.0, progress: Progress = silent) -> Revision:
    """Take an effect out and calibrate on all tests but the held-out ones."""
    left = tuple(e for e in case.model.effects if e.name != name)
    if len(left) == len(case.model.effects):
        known = ", ".join(e.name for e in case.model.effects) or "none"
        raise InputError(f"'{name}' is not in the model", f"case '{case.name}'", f"its effects: {known}")
    values = {k: v for k, v in case.model.values.items() if k != name}
    model = replace(case.model, effects=left, values=values)
    return _revised(case, model, "remove", name, ("calibrate", "validate"), kappa, progress)


def _revised(
    case: Case, model: Model, action: str, name: str | None, roles: Sequence[str], kappa: float, progress: Progress
) -> Revision:
    before = compare(case)
    tests = [t for t in case.tests if t.role in roles]
    if not tests:
        raise InputError(
            f"no test has the role {' or '.join(roles)}", f"case '{case.name}'", "give at least one that role"
        )
    fit = fitted(replace(case, model=model), tests, progress)
    new = replace(model, values={**model.values, **fit.values}, revision=case.model.revision + 1)
    after = compare(replace(case, model=new))
    changes = tuple(Change(b.name, b.role, b.rmse_K, a.rmse_K) for b, a in zip(before.tests, after.tests, strict=True))
    accepted, why = judge(action, changes, fit, name)
    return Revision(action, name, new, accepted, why, changes, estimates(fit, kappa), before, after, fit.converged)


def fitted(case: Case, tests: Sequence[Test], progress: Progress = silent) -> Fit:
    """The case's free parameters fitted to some tests, from where the model stands."""
    network, unknowns = working(case)
    start = dict(case.model.values)
    for e in case.model.effects:
        start.setdefault(e.name, nudge(next(p for p in unknowns.parameters if p.name == e.name)))
    return calibrated(network, tests, unknowns, start, progress=progress)


def nudge(p: Parameter) -> float:
    """A start a little inside the bounds, on the side the sign allows."""
    return float(np.clip(p.neutral + 0.3 * (p.sign or 1) * p.prior_sd, p.low, p.high))


def judge(action: str, changes: Sequence[Change], fit: Fit, name: str | None) -> tuple[bool, str]:
    """Accept what lowers the error on held-out tests, or leaves it while lowering the others'."""
    unseen = [c for c in changes if c.role == "hold-out"] or [c for c in changes if c.role == "validate"]
    seen = [c for c in changes if c not in unseen]
    was, now = mean_square(unseen, "before"), mean_square(unseen, "after")
    told = f"error on tests not fitted {was:.3g} -> {now:.3g} K" if unseen else "no held-out test"
    if action == "calibrate":
        fell = mean_square(seen or changes, "after") <= GETS_WORSE * mean_square(seen or changes, "before")
        return fell and fit.converged, told if fit.converged else f"not converged; {told}"
    if not fit.converged:
        return False, f"the calibration did not converge; {told}"
    if action == "add" and name and bool(fit.at_bound[fit.unknowns.names.index(name)]):
        return False, f"its amplitude sticks to a physical bound; {told}"
    if unseen:
        return now < was, told
    return mean_square(seen, "after") < mean_square(seen, "before"), told


def mean_square(changes: Sequence[Change], side: str) -> float:
    values = [getattr(c, side) for c in changes]
    return float(np.sqrt(np.mean(np.square(values)))) if values else float("nan")


def estimates(fit: Fit, kappa: float = 1.0) -> tuple[Estimate, ...]:
    """Values with intervals, what the data could not narrow, and with whom it trades."""
    cov, sd, u = fit.covariance, fit.sd, fit.unknowns
    corr = cov / np.outer(sd, sd)
    np.fill_diagonal(corr, 0.0)
    out = []
    for i, p in enumerate(u.parameters):
        blind = bool(sd[i] > UNSEEN * u.sd[i])
        partner = int(np.argmax(np.abs(corr[i])))
        half = 1.96 * min(kappa * sd[i], u.sd[i])
        low, high = (to_value(p, float(fit.theta[i] + s * half)) for s in (-1.0, 1.0))
        prior = tuple(float(np.clip(to_value(p, s * 1.96 * p.prior_sd), p.low, p.high)) for s in (0.0, -1.0, 1.0))
        out.append(
            Estimate(
                p.name, to_value(p, float(fit.theta[i])), p.unit, (max(low, p.low), min(high, p.high)),
                (prior[0], prior[1], prior[2]), not blind,
                u.names[partner] if abs(corr[i, partner]) > 0.7 else None, bool(fit.at_bound[i]),
            )
        )  # fmt: skip
    return tuple(out)
