"""The next set point: expected information per minute, under limits that the upper band of the model must not cross.

Under each hypothesis the coming readings are normal, their mean and covariance by the tangents of the calibrated model:

    mu_h = X_h x_h,  S_h = 1 + X_h P_h X_h'        X_h : whitened columns of the coming readings, x_h, P_h : at present

What they would tell of which hypothesis holds is, from pairwise distances D of these (Bhattacharyya),

    I >= - sum_h p_h ln sum_l p_l exp(-D_hl)

Source: Kolchinsky and Tracey 2017, Estimating mixture entropy with pairwise distances, Entropy 19, 361.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.linalg import solve_triangular

from extras.bench.live.assessment import LEAST, Assessment, thinned
from extras.bench.live.settings import Bench, SetPoint
from thermoscope import plugin as th

MINUTE = 60.0
LENGTHS_MIN = (3.0, 10.0, 30.0)  # of a set point, before all is thought over again
STEP_S = 30.0  # of a planned record: sensors and windings take as long to follow
PAST, CHECKED = 40, 3  # blocks of what was read; set points that are looked at again
RIVALS = 8  # hypotheses that are told apart
# Of a usual amplitude: while its deviation is above that, a cause keeps its odds to some five per cent
UNRESOLVED = 0.8
CHANGE_MIN = 1.0  # until a set point that was asked for is there
BAND = 2.5  # standard deviations of the upper band
LIMIT = "limit: "
PLAIN_STEPS = {**th.USUAL_DOUBT, "step in sample": 0.0}  # when a set point comes is no doubt of a plan


@dataclass(frozen=True)
class Rival:
    """A hypothesis.  p : its probability;  lead : the cause it counts for;

    at : its columns among parameters, model error, causes;  mean, covariance : of these by the readings so far
    usual : amplitude of its first cause
    """

    p: float
    lead: str
    at: tuple[int, ...]
    mean: th.Array
    covariance: th.Array
    usual: float = 0.0


@dataclass(frozen=True)
class Choice:
    """A set point that the limits allow.  nats : expected of `minutes` of it;  hottest : limit -> upper band (degC)"""

    set_point: dict[str, float]
    minutes: float
    nats: float
    hottest: dict[str, float]

    @property
    def rate(self) -> float:
        """Nats per minute; to change a set point costs some as well."""
        return self.nats / (self.minutes + CHANGE_MIN)


@dataclass(frozen=True)
class Plan:
    """Some minutes of a set point.  J : whitened columns of the coming readings;  hottest : upper bands (degC)"""

    minutes: float
    J: th.Array
    hottest: dict[str, float]


def sizes(e: th.Evidence, test: th.Test, bench: Bench) -> th.Array:
    """Usual amplitude of every cause, for a loss by what all set points would make of it: little has run so far."""
    every = bench.set_points({})
    inputs = {n: np.array([s.get(n, float(u[-1])) for s in every]) for n, u in test.inputs.items()}
    now, later = (
        th.effect_sizes(e.network, e.names, t) for t in (e.tests, [replace(test, inputs=inputs, recorded=None)])
    )
    return e.scale * np.array([now.get(n, 1.0) / later.get(n, now.get(n, 1.0)) for n in e.names])


def rivals(assessment: Assessment, bench: Bench, single: Sequence[str] | None = None) -> list[Rival]:
    """The hypotheses that carry weight, with what the readings so far say of their parameters.

    single : each of these causes alone instead, whatever its weight
    """
    e = assessment.posterior.evidence
    p = th.probabilities(assessment.posterior.hypotheses)
    G, (theta, sd), scale = th.total(e.grams), th.fit_prior(e.fit), sizes(e, assessment.test, bench)
    weighty = [(float(q), h) for q, h in zip(p, assessment.posterior.hypotheses, strict=True) if not h.heat]
    if single is not None:
        weighty = [(q, h) for q, h in weighty if len(h.members) == 1 and e.names[h.members[0]] in single]
    out = []
    for q, h in sorted(weighty, key=lambda x: -x[0])[: RIVALS if single is None else None]:
        k = list(h.members)
        weight = np.concatenate([sd, scale[k]]) ** -2.0
        A = np.block([[G.JJ, G.JZ[:, k]], [G.JZ[:, k].T, G.ZZ[np.ix_(k, k)]]]) + np.diag(weight)
        covariance = np.linalg.inv(A)
        names = (*(e.names[i] for i in k), *(() if k else (e.name(h),)))
        lead = next((cause for cause, _ in assessment.odds if cause in names), names[0])
        at = (*range(theta.size), *(theta.size + i for i in k))
        b = np.concatenate([G.Jr - weight[: theta.size] * theta, G.Zr[k]])
        out.append(Rival(q, lead, at, covariance @ b, covariance, float(scale[k[0]]) if k else 0.0))
    whole = sum(r.p for r in out)
    return [replace(r, p=r.p / whole) for r in out if single is not None or r.p >= LEAST * out[0].p]


def choices(assessment: Assessment, bench: Bench, now: SetPoint) -> list[Choice]:
    """Every set point that the limits allow, most information per minute first.

    The first few are looked at again with what a model of this kind gets wrong.
    """
    assessment, some = coarse(assessment), rivals(assessment, bench)

    def ranked(set_points: Iterable[SetPoint], doubting: bool) -> list[Choice]:
        plans = ((dict(s), x) for s in set_points for x in _plans(assessment, bench, some, s, doubting))
        every = [Choice(s, x.minutes, information(x.J, some), x.hottest) for s, x in plans]
        return sorted(every, key=lambda c: -c.rate)

    out = ranked(bench.set_points(now), False)
    first = list({str(c.set_point): c.set_point for c in out}.values())[:CHECKED]
    return [*ranked(first, True), *(c for c in out if c.set_point not in first)]


def is_allowed(assessment: Assessment, bench: Bench, set_point: SetPoint) -> bool:
    """Do the limits allow the shortest time of a set point?"""
    return any(_plans(coarse(assessment), bench, rivals(assessment, bench), set_point))


def unresolved(assessment: Assessment, bench: Bench) -> list[Rival]:
    """Causes of which the readings have told next to nothing yet."""
    each = rivals(assessment, bench, assessment.unseen)
    return [r for r in each if np.sqrt(r.covariance[-1, -1]) > UNRESOLVED * r.usual]


def undetectable(
    assessment: Assessment, bench: Bench, now: SetPoint, some: Sequence[Rival], left_min: float
) -> list[str]:
    """Which causes would stay unresolved even if all the time that is left went to all allowed set points."""
    assessment, e = coarse(assessment), assessment.posterior.evidence
    q = e.p + (e.fit.error.size if e.fit.error else 0) + len(e.parameters)
    longest = [x for s in bench.set_points(now) for x in list(_plans(assessment, bench, some, s, True))[-1:]]
    gram = sum((x.J.T @ x.J for x in longest), np.zeros((q, q)))
    gram = gram * min(max(left_min, 0.0) / sum(x.minutes for x in longest), 1.0) if longest else gram

    def deviation(r: Rival) -> float:
        return float(np.sqrt(np.linalg.inv(np.linalg.inv(r.covariance) + gram[np.ix_(r.at, r.at)])[-1, -1]))

    return sorted(r.lead for r in some if deviation(r) > UNRESOLVED * r.usual)


def coarse(assessment: Assessment) -> Assessment:
    """With rows no closer than those of a plan: every set point is run from the first of them on."""
    time = assessment.test.time
    most = max(PAST, int((time[-1] - time[0]) / STEP_S))
    return replace(assessment, test=thinned(assessment.test, most))


def _plans(
    assessment: Assessment, bench: Bench, some: Sequence[Rival], set_point: SetPoint, doubting: bool = False
) -> Iterator[Plan]:
    """Of a set point, as long as the limits allow it."""
    e, begin = assessment.posterior.evidence, float(assessment.test.time[-1])
    test = planned(assessment.test, bench, set_point)
    limited, parameters = _with_limits(test, bench, assessment), (*e.fit.unknowns.parameters, *e.parameters)
    try:
        parts = th.segments(e.network, [limited], e.fit.values, parameters)
    except th.NoSolution:  # the model runs away there
        return
    read = [s for s in parts if not s.channel.startswith(LIMIT)]
    error = th.model_error(e.fit.network, [_expected(test, read)], e.fit.values, PLAIN_STEPS) if doubting else None
    bands = {s.channel[len(LIMIT) :]: _after(s, begin) for s in parts if s.channel.startswith(LIMIT)}
    q = e.p + (e.fit.error.size if e.fit.error else 0)
    cold = min(float(u[-1]) for u in assessment.test.boundaries.values())
    hottest = {x.name: _band(bands[x.name], e.p, q, some, x.hot_spot, cold) for x in bench.limits}
    coming = [_innovations(e, s, begin, error) for s in read]
    for minutes in LENGTHS_MIN:
        inside = {n: float(T[s <= minutes * MINUTE + bench.deaf_s].max()) for n, (s, T) in hottest.items()}
        if any(inside[x.name] > x.most_C for x in bench.limits):
            return
        yield Plan(minutes, np.vstack([x[time <= begin + minutes * MINUTE] for time, x in coming]), inside)


def _expected(test: th.Test, parts: Sequence[th.Segment]) -> th.Test:
    """With the readings that the model expects: what it may be wrong by is a share of their rise."""
    y = {s.channel: np.interp(test.time, s.time, -s.r) for s in parts}  # nothing is read in a plan: r = 0 - model
    return replace(test, channels=tuple(replace(c, y=y[c.name]) for c in test.channels))


def planned(test: th.Test, bench: Bench, set_point: SetPoint) -> th.Test:
    """The rows so far, then a set point for as long as any plan looks forward; all else stays where it is."""
    future = np.arange(STEP_S, LENGTHS_MIN[-1] * MINUTE + bench.deaf_s + STEP_S, STEP_S)
    n, m = future.size, test.time.size

    def on(u: th.Array, value: float | None = None) -> th.Array:
        u = np.broadcast_to(np.asarray(u, float), test.time.shape)
        return np.concatenate([u, np.full(n, u[-1] if value is None else value)])

    before = np.unique(np.linspace(0, m, PAST, endpoint=False).astype(int))
    block = np.floor(8.0 * np.log2(1.0 + future / 240.0))  # they grow as what is looked for gets slower
    return replace(
        test,
        time=np.concatenate([test.time, test.time[-1] + future]),
        inputs={k: on(u, set_point.get(k)) for k, u in test.inputs.items()},
        boundaries={k: on(u) for k, u in test.boundaries.items()},
        channels=tuple(replace(c, y=np.zeros(m + n)) for c in test.channels if np.isfinite(c.y[-20:]).any()),
        recorded=None,
        blocks=np.concatenate([before, m + np.flatnonzero(np.diff(block, prepend=-1))]),
    )


def _innovations(e: th.Evidence, s: th.Segment, begin: float, error: th.ModelError | None) -> tuple[th.Array, th.Array]:
    """Times of the coming readings of a channel, and their whitened columns given all that was read before.

    Columns: calibrated parameters, model error, causes.
    """
    d = e.fit.error.size if e.fit.error else 0
    doubts = np.zeros((s.r.size, d))
    if error and e.fit.error:  # doubts that the plan adds, such as of its own steps, are none of the fit's
        index = {name: i for i, name in enumerate(e.fit.error.names[: e.fit.error.model_columns])}
        for i, name in enumerate(error.names[: error.model_columns]):
            if name in index:
                doubts[:, index[name]] = error.of(s)[:, i]
    J = np.column_stack([s.J[:, : e.p], doubts, s.J[:, e.p :]])
    late = s.time > begin
    return s.time[late], e.fit.noise.whiten(s, J)[late]  # the whitener is triangular: later rows are given the earlier


def _with_limits(test: th.Test, bench: Bench, assessment: Assessment) -> th.Test:
    places = assessment.posterior.evidence.network.places
    still = np.zeros(test.time.size)
    more = (th.Channel(f"{LIMIT}{x.name}", x.place, places[x.place].mean, still, lag_s=0.0) for x in bench.limits)
    return replace(test, channels=(*test.channels, *more))


def _after(s: th.Segment, begin: float) -> th.Segment:
    late = s.time > begin
    return replace(s, time=s.time[late], r=s.r[late], J=s.J[late])


def _band(
    s: th.Segment, p: int, q: int, some: Sequence[Rival], hot_spot: float, cold: float
) -> tuple[th.Array, th.Array]:
    """Seconds from now, and the upper band of the hottest point under every hypothesis that carries weight."""
    upper = []
    J = np.column_stack([s.J[:, :p], np.zeros((s.r.size, q - p)), s.J[:, p:]])
    for r in some:
        X = J[:, r.at]
        mean = -s.r + X @ r.mean
        slow = th.USUAL_DOUBT["slow"] * np.abs(mean - cold)
        sd = np.sqrt(np.einsum("ij,jk,ik->i", X, r.covariance, X) + slow**2)
        upper.append(mean + BAND * sd)
    return s.time - s.time[0] + STEP_S, cold + hot_spot * (np.max(upper, axis=0) - cold)


def information(J: th.Array, some: Sequence[Rival]) -> float:
    """Expected information (nats) of readings with whitened columns J about which cause leads; a lower bound."""
    normal = []
    for r in some:
        X = J[:, r.at]
        S = np.eye(len(X)) + X @ r.covariance @ X.T
        normal.append((X @ r.mean, S, np.linalg.slogdet(S)[1]))
    D = np.zeros((len(some), len(some)))
    for (i, a), (j, b) in combinations(enumerate(normal), 2):
        if some[i].lead != some[j].lead:  # which partner a cause has is not what is asked
            L = np.linalg.cholesky(0.5 * (a[1] + b[1]))
            z = solve_triangular(L, a[0] - b[0], lower=True)
            D[i, j] = D[j, i] = 0.125 * z @ z + np.sum(np.log(np.diag(L))) - 0.25 * (a[2] + b[2])
    p = np.array([r.p for r in some])
    return float(-np.sum(p * np.log(np.exp(-D) @ p)))
