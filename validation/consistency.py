"""What a verdict claims, held against its own numbers: a verdict that they contradict is withheld.

"Nothing is missing" is contradicted by a record far beyond its uncertainty, by tests that would need different
parameters, by doubts that take more off a record than all of them come to in sound machines, by a guess of no change
that predicts better, and, of a model that leaves more than its uncertainty, by a free network that does. A name is
contradicted by a refit that is worse in most tests.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from measured.case import Case, Test
from validation.calibration.calibrate import Fit, followed, reading_fit
from validation.calibration.model_error import machine_rise
from validation.comparison.compare import ChannelError, physical, pooled, test_error
from validation.comparison.linearisation import allowed, rmse
from validation.comparison.uncertainty import COVERAGE
from validation.inference.contradiction import Contradiction
from validation.inference.decide import Decision, Posterior
from validation.inference.result import Check, Remainder
from validation.parameters.unknowns import standing, working
from validation.yardstick.words import WORTH
from validation.yardstick.yardstick import free_network_error, persistence_error

MOST_UNCERTAINTIES = 5.0  # standard uncertainties of a sensor and a good model: what inputs leave is two or three
MOST_DEVIATIONS = 10.0  # deviations between tests: beyond what tangents are wrong by
SHOWS = 0.1  # of the readings' uncertainty: what a refit must lose in a test to be worse there


@dataclass(frozen=True)
class RecordError:
    """A sensor in one test, as it reads.  u_K : its standard uncertainty, with the misfit that a good model has"""

    test: str
    error: ChannelError
    u_K: float

    @property
    def share(self) -> float:
        """How many uncertainties it is off."""
        return self.error.rmse_K / self.u_K


def checks(
    case: Case, posterior: Posterior, choice: Decision, budget: Mapping[str, float], left: Sequence[Remainder] = ()
) -> tuple[Check, ...]:
    """What a decision claims, held against the tests that a fit may use; none where it claims neither a name nor that
    nothing is missing.

    budget : channel -> error (K) of the model's own numbers there;  left : what stays off
    """
    e, tests = posterior.evidence, posterior.evidence.tests
    if choice.verdict in ("named", "several"):
        lead = [g[0] for g in choice.groups]
        fits = [h.fit for h in posterior.hypotheses if h.fit and h.members and set(h.members) == set(lead)]
        return tuple(named_check(case, tests, e.fit, fit, [e.names[k] for k in lead]) for fit in fits[:1])
    if choice.verdict != "adequate":
        return ()
    records = least_errors(case, posterior, budget)
    every = (record_check(records, posterior.against), tests_check(posterior.against), persistence_check(case, records))
    more = doubts_check(case, left), free_network_check(case, records, e.fit)
    return tuple(c for c in (*every, *more) if c is not None)


def least_errors(case: Case, posterior: Posterior, budget: Mapping[str, float]) -> list[RecordError]:
    """Of the model as it stands, of the diagnosis's fit and of a plain one, what leaves least; the plain one, without a
    model error that takes some of the misfit, only where the others leave a record far off.

    budget : as of `checks`
    """
    e, tests = posterior.evidence, posterior.evidence.tests
    models = [values for values in (case.model.values, {**case.model.values, **e.fit.values}) if values]
    each = [record_errors(case, tests, values, budget) for values in models]
    if all(rows and rows[0].share > MOST_UNCERTAINTIES for rows in each):
        network, unknowns = working(replace(case, tests=tests))
        plain = reading_fit(network, tests, unknowns, case.model.values, [one.name for one in case.model.effects])
        rows = record_errors(case, tests, {**case.model.values, **plain.values}, budget)
        each = [rows] if rows and rows[0].share <= MOST_UNCERTAINTIES else each  # else it spreads what one record has
    return min(each, key=lambda rows: rows[0].share if rows else 0.0)


def record_errors(
    case: Case, tests: Sequence[Test], values: Mapping[str, float], budget: Mapping[str, float]
) -> list[RecordError]:
    """Every sensor in every test without what the fit put right at the sensors, the surest off first.

    values : of a fit;  budget : as of `checks`
    """
    network, thermal, out = standing(case), physical(case, values), []
    for test in tests:
        channels = {c.name: c for c in test.channels}
        for row in test_error(network, test, thermal).channels:
            parts = (row.sigma_K, allowed(channels[row.channel]), budget.get(row.channel, 0.0) / COVERAGE)
            out.append(RecordError(test.name, row, float(np.linalg.norm(parts))))
    return sorted(out, key=lambda r: -r.share)


def record_check(records: Sequence[RecordError], against: Contradiction | None) -> Check | None:
    """Of the record that is furthest from the model.  against : what would have to differ between the tests"""
    if not records:
        return None
    worst = records[0]
    far = {(r.test, r.error.channel) for r in records if r.share > MOST_UNCERTAINTIES}
    tests, channels = {r.test for r in records}, {r.error.channel for r in records}
    stands_out = against is not None and against.test == worst.test and abs(against.differences[0].sd) > MOST_DEVIATIONS
    alone = stands_out or any((t, worst.error.channel) not in far for t in tests)
    if not alone:
        differs = "the sensor, its place or the model there would have to differ"
    elif len(channels) > 1 and all((worst.test, c) in far for c in channels):
        differs = "in that test something differed that nothing here speaks of"
    else:
        differs = "in that test the sensor or its place differed"
    where, limit = f"{worst.error.channel} in {worst.test}", MOST_UNCERTAINTIES * worst.u_K
    off = f"{where} reads {worst.error.rmse_K:.1f} K from the model, {worst.share:.0f} times its uncertainty"
    words = f"{off}: nothing in the catalogue explains it; {differs}"
    return Check("record", where, worst.error.rmse_K, limit, "K", words)


def tests_check(against: Contradiction | None) -> Check | None:
    """Of the parameter that would have to differ most between tests."""
    if against is None or not against.differences:
        return None
    first = against.differences[0]
    return Check(
        "tests", f"{first.parameter} in {first.test}", abs(first.sd), MOST_DEVIATIONS, "deviations", against.words
    )


def doubts_check(case: Case, left: Sequence[Remainder]) -> Check | None:
    """Of the record that the doubts of the model take most off.  left : what stays off"""
    left = [r for r in left if r.forgiven]
    if not left:
        return None
    worst, limit = max(left, key=lambda r: r.model_K), case.doubt["total"] * machine_rise(case.usable)
    words = (
        f"{worst.forgiven}, where all doubts of a sound machine come to {limit:.1f} K: the sensor, its place or the "
        "model there would have to differ"
    )
    return Check("doubts", f"{worst.channel} in {worst.record}", worst.model_K, limit, "K", words)


def persistence_check(case: Case, records: Sequence[RecordError]) -> Check | None:
    """Of a guess of no change."""
    no_model = persistence_error(case.training())
    rows = [r for r in records if no_model and r.error.channel in no_model[1]]
    if no_model is None or not rows:
        return None
    worst, error = max(rows, key=lambda r: r.error.rmse_K), pooled([r.error for r in rows])
    where = f"{worst.error.channel} in {worst.test}"
    words = (
        f"a guess of no change predicts tests left out within {no_model[0]:.1f} K, and the model leaves {error:.1f} K "
        f"of those it was fitted to, most at {where}: what heats or cools there would have to differ"
    )
    return Check("persistence", where, error, no_model[0], "K", words)


def free_network_check(case: Case, records: Sequence[RecordError], fit: Fit) -> Check | None:
    """Of a free network, which knows nothing but heat that flows down gradients; None where the model leaves no more
    than it may be wrong by: a better guess says nothing there.

    fit : the same with its sensors as fitted, since the network learns these, too
    """
    shares = [r.share for r in records], [rmse([s]) / s.weight for s in fit.parts]
    if not all(np.mean(np.square(each)) > COVERAGE**2 for each in shares):
        return None
    free = free_network_error(case.training())
    rows = [r for r in records if free and r.error.channel in free[1]]
    if free is None or not rows:
        return None
    worst = max(rows, key=lambda r: r.error.rmse_K)
    error = min(pooled([r.error for r in rows]), rmse([s for s in fit.parts if s.channel in free[1]]))
    where = f"{worst.error.channel} in {worst.test}"
    words = (
        f"a free network predicts tests left out within {free[0]:.1f} K, and the model leaves {error:.1f} K of those "
        f"it was fitted to, most at {where}: what the readings tell of the heat there is not in it"
    )
    return Check("free network", where, error, WORTH * free[0], "K", words)


def named_check(case: Case, tests: Sequence[Test], before: Fit, after: Fit, names: Sequence[str]) -> Check:
    """Whether what is named makes tests worse: by the fits that told it, or else by those that follow the readings.

    The former leave slow errors to what a model of this kind is allowed, which may lie in any test.
    """
    check = refit_check(before, after, " + ".join(names))
    if not check.contradicts:
        return check
    effects = {*names, *(e.name for e in case.model.effects)}
    fits = [followed(fit, tests, case.model.values, effects) for fit in (before, after)]
    return refit_check(fits[0], fits[1], " + ".join(names))


def refit_check(before: Fit, after: Fit, name: str) -> Check:
    """Of the tests in which the model with what is named is worse than without, and off by more than the readings."""
    tests = list(dict.fromkeys(s.test for s in before.parts))
    worse = []
    for test in tests:
        old, new = ([s for s in fit.parts if s.test == test] for fit in (before, after))
        u = float(np.sqrt(np.mean([s.sigma_K**2 for s in old])))
        if rmse(new) > max(rmse(old) + SHOWS * u, u):
            worse.append(f"{test} {rmse(old):.2f} -> {rmse(new):.2f} K")
    words = f"with {name} no test is worse"
    if worse:
        many = f"with {name} {len(worse)} of {len(tests)} tests are worse"
        words = f"{many} ({', '.join(worse)}): in these it would have to differ"
    return Check("refit", name, len(worse), 0.5 * len(tests), "tests", words)
