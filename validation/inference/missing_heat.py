"""Where and when heat is missing: a free heat input at each node in turn, as hat functions of time.

log evidence of a heat input q ~ N(0, s^2 R) of the hats at node i, nuisances projected out; 10 nats locate it. R has
heat last for a while within a test, or follow smoothly what the machine does, in all tests alike.
Source: Sarkka, Alvarez and Lawrence 2019 (latent force models); Rasmussen and Williams 2006, 4.2 and 5.4.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.linalg import block_diag
from scipy.special import logsumexp

from geom.arrays import Array, sample_columns
from lumped.model.network import Network, Parameter
from lumped.model.sites import solids
from lumped.transfer.laws import Fixed, Inputs
from measured.case import Test
from measured.doubt import FORM, PRIOR, SIZES
from measured.sensors.blocks import INSTANTS
from validation.calibration.calibrate import Fit
from validation.calibration.model_error import ModelError, nodes
from validation.comparison.linearisation import Segment, segments
from validation.effects.build import Shaped, heat, power_scale
from validation.inference.columns import Linearised
from validation.inference.hypotheses import UnknownHeat
from validation.inference.score import Gram, gram
from validation.noise import Noise
from validation.threads import side_by_side

KNOT_S = 180.0  # between knots of a heat; chosen: shorter ones cost time, and masses smooth what they would show
MEMORY_S = (FORM["heat step"], FORM["heat time"])
JITTER = 1e-6  # of the variance, so that equal knots have a factor
LOCATED = 10.0  # nats


@dataclass(frozen=True)
class MissingHeat:
    """Heat missing at one place: evidence (nats); per test its times (s), heat (W) and standard deviation (W).

    log_bayes : the same averaged over how large and how lasting such heat may be
    moves_K : the most by which it moves a reading, what is calibrated following
    """

    place: str
    evidence_nats: float
    log_bayes: float
    heat_W: dict[str, tuple[Array, Array, Array]]
    moves_K: float

    def __repr__(self) -> str:
        return f"<MissingHeat at {self.place}: {self.evidence_nats:.1f} nats, moves a reading by {self.moves_K:.2f} K>"

    def document(self) -> dict:
        series = {
            n: {"time_s": t.tolist(), "heat_W": q.tolist(), "sd_W": s.tolist()} for n, (t, q, s) in self.heat_W.items()
        }
        return {"place": self.place, "evidence_nats": self.evidence_nats, "heat": series}


@dataclass(frozen=True)
class HatFunction:
    """A hat function of time around one knot (s)."""

    at: float
    width: float

    def __call__(self, inputs: Inputs) -> Array:
        return np.maximum(0.0, 1.0 - np.abs(np.asarray(inputs["time_s"], float) - self.at) / self.width)


@dataclass(frozen=True)
class Scan:
    """What a heat input at every solid and instant would do to the readings of a calibrated model.

    hypotheses : heat of unknown cause at each place;  knots : test -> instants (s) of its hats
    run : the response to the calibrated parameters (standard deviations `sd` of their priors) and to every place's hats
    doing : (m, k) what the machine does at all knots, inputs over their ranges;  T : (m, n) temperatures of the places
    """

    hypotheses: tuple[UnknownHeat, ...]
    knots: Mapping[str, Array]
    run: Linearised
    sd: Array
    doing: Array
    T: Array

    @property
    def places(self) -> tuple[str, ...]:
        return tuple(h.place for h in self.hypotheses)

    def segments(self, residual: Sequence[Segment]) -> list[Segment]:
        """The response with another residual, that of a model calibrated further."""
        left = {(s.test, s.channel): s.r for s in residual}
        return [replace(s, r=left[s.test, s.channel]) for s in self.run.segments(self.hypotheses)]

    def read(
        self, residual: Sequence[Segment], noise: Noise, theta: Array, error: ModelError | None = None
    ) -> list[MissingHeat]:
        """Missing heat at all places, most evident first.

        Parameters: `residual` segments of a calibrated model, `noise` and `error` its own; `theta` (p,) where its
        parameters stand, from the mean of their priors.
        """
        d = error.size if error else 0
        grams = gram(self.segments(residual), noise, self.sd.size, error)
        theta, weight = np.concatenate([theta, np.zeros(d)]), np.concatenate([self.sd**-2.0, np.ones(d)])
        H = sum(g.JJ for g in grams.values()) + np.diag(weight)
        Jr = sum(g.Jr for g in grams.values()) - weight * theta
        cov = np.asarray(np.linalg.inv(H), float)
        heats = side_by_side(lambda i: self._heat(i, grams, cov, Jr), range(len(self.places)))
        return sorted(heats, key=lambda x: -x.evidence_nats)

    @cached_property
    def roots(self) -> list[Array]:
        """Cholesky factor of the heat's correlation at the knots, for each memory."""
        forms = [_correlation(list(self.knots.values()), memory) for memory in MEMORY_S]
        return [np.asarray(np.linalg.cholesky(R), float) for R in forms]

    def following(self, i: int) -> Array:
        """The same of heat at a place that is a smooth function of what the machine does and how warm the place is."""
        x = np.column_stack([self.doing, over_range(self.T[:, i : i + 1])])
        R = np.exp(-0.5 * np.sum((x[:, None, :] - x[None, :, :]) ** 2, axis=2) / FORM["heat over input"] ** 2)
        return np.asarray(np.linalg.cholesky(R + JITTER * np.eye(len(x))), float)

    def _heat(self, i: int, grams: Mapping[str, Gram], cov: Array, Jr: Array) -> MissingHeat:
        size = [len(k) for k in self.knots.values()]
        start = np.concatenate([[0], np.cumsum(size)])
        A, u = np.zeros((start[-1], start[-1])), np.zeros(start[-1])
        JZ = np.zeros((cov.shape[0], start[-1]))
        for d, name in enumerate(self.knots):
            g, rows, block = grams[name], slice(i * size[d], (i + 1) * size[d]), slice(start[d], start[d + 1])
            A[block, block], u[block], JZ[:, block] = g.ZZ[rows, rows], g.Zr[rows], g.JZ[:, rows]
        A, u = A - JZ.T @ cov @ JZ, u - JZ.T @ cov @ Jr
        usual = np.array(SIZES) * FORM["heat size"]  # as of an effect; the curve has whatever size fits it best
        sizes = self.hypotheses[i].scale_W * np.concatenate([usual, 10.0 ** np.arange(-3.0, 1.5, 0.5)])
        evidences = [_evidence(A, u, sizes, root) for root in (*self.roots, self.following(i))]
        nats, q, sd = max(evidences, key=lambda x: x[0].max())
        as_usual = [x[0][: usual.size] for x in evidences]
        best, mean = nats.max(), logsumexp(as_usual) - np.log(np.size(as_usual))
        cut = [slice(a, b) for a, b in pairwise(start)]
        heat_W = {name: (k, q[c], sd[c]) for (name, k), c in zip(self.knots.items(), cut, strict=True)}
        return MissingHeat(self.places[i], float(best), float(mean), heat_W, self._moves(i, heat_W, -cov @ JZ @ q))

    def _moves(self, i: int, heat_W: Mapping[str, tuple[Array, Array, Array]], follow: Array) -> float:
        """Largest change of a reading (K); follow : what the heat makes of the calibrated parameters."""
        p, hats = self.sd.size, self.hypotheses[i].columns(self.run)
        each = (s.J @ follow[:p] + Z @ heat_W[s.test][1] for s, Z in zip(self.run.parts, hats, strict=True))
        return max((float(np.max(np.abs(x), initial=0.0)) for x in each), default=0.0)


def is_located(evidence_nats: float) -> bool:
    """Is there more evidence than it takes to place heat?"""
    return evidence_nats > LOCATED


def missing_heat(fit: Fit, tests: Sequence[Test], knot_s: float = KNOT_S) -> list[MissingHeat]:
    """The scan of a calibrated model's residual."""
    return scan_heat(fit, tests, knot_s).read(fit.parts, fit.noise, fit.theta, fit.error)


def scan_heat(fit: Fit, tests: Sequence[Test], knot_s: float = KNOT_S) -> Scan:
    """The response to a heat input at every place and knot, about a calibrated state."""
    bodies = solids(fit.network)
    places, knots = tuple(p.name for p in bodies), {t.name: heat_knots(t, knot_s) for t in tests}
    prior = float(np.log(PRIOR["heat"].share / max(len(places), 1)))  # it may be anywhere

    def response(test: Test) -> tuple[list[Segment], Array]:
        network, hats = with_heat_inputs(fit.network, places, knots[test.name])
        T = knot_values(test, nodes(fit.network, test, fit.values, bodies), knots[test.name])
        return segments(network, [test], fit.values, (*fit.unknowns.parameters, *hats)), T

    each = side_by_side(response, tests, lambda test: len(test.time))
    p, parts = fit.theta.size, [s for some, _ in each for s in some]
    most, scale = max((k.size for k in knots.values()), default=0), power_scale(fit.network)
    hypotheses = tuple(UnknownHeat(place, prior, scale, most) for place in places)
    hats = {h.name: [_columns(s, p, i, knots[s.test].size) for s in parts] for i, h in enumerate(hypotheses)}
    run = Linearised(tuple(replace(s, J=s.J[:, :p]) for s in parts), hats)
    return Scan(hypotheses, knots, run, fit.unknowns.sd, activity(tests, knots), np.vstack([T for _, T in each]))


def _columns(s: Segment, p: int, i: int, m: int) -> Array:
    """Columns of the m hats of place i behind p calibrated parameters."""
    return s.J[:, p + i * m : p + (i + 1) * m]


def heat_knots(test: Test, knot_s: float) -> Array:
    """Every so many seconds of a test, or as many as its residual has instants to tell apart."""
    span = test.time[-1] - test.time[0]
    count = int(np.clip(round(span / knot_s) + 1, 2, INSTANTS // 2))
    return np.asarray(test.time[0] + np.linspace(0.0, span, count))


def activity(tests: Sequence[Test], knots: Mapping[str, Array]) -> Array:
    """(m, k) all inputs that every test records, at the knots of all tests, each over its range; constants left out."""
    common = [n for n in tests[0].inputs if all(n in t.inputs for t in tests)]
    rows = [
        np.column_stack([*(knot_values(t, t.inputs[n], knots[t.name]) for n in common), np.zeros(knots[t.name].size)])
        for t in tests
    ]
    return over_range(np.vstack(rows))


def knot_values(test: Test, series: Array, knots: Array) -> Array:
    """A series (n, ...) of a test at some instants."""
    return sample_columns(knots, test.time, np.reshape(np.asarray(series, float), (test.time.size, -1)))


def over_range(x: Array) -> Array:
    """Columns that vary, each from 0 to 1."""
    span = np.ptp(x, axis=0)
    return np.asarray((x[:, span > 0] - x.min(axis=0)[span > 0]) / span[span > 0])


def with_heat_inputs(network: Network, places: Sequence[str], knots: Array) -> tuple[Network, list[Parameter]]:
    """The network with a zero heat input (1 W) at every place and knot."""
    sources, hats = [], []
    for place in places:
        for at in knots:
            name = f"latent:{place}:{at:.0f}"
            law = Shaped(Fixed(1.0), HatFunction(float(at), float(knots[1] - knots[0])), also_reads=("time_s",))
            sources.append(heat(network, name, "latent", place, law))
            hats.append(Parameter(name, ((name, 1.0),), 0.0, "W", mapping="amplitude", neutral=0.0))
    network = network.extended(sources=sources)
    return replace(network, parameters=(*network.parameters, *hats)), hats


def _correlation(knots: Sequence[Array], memory: float) -> Array:
    """Correlation of the heat at the knots: exp(-|dt| / memory) within a test, none between tests."""
    return block_diag(*(np.exp(-np.abs(k[:, None] - k[None, :]) / memory) for k in knots))


def _evidence(A: Array, u: Array, sizes: Array, root: Array) -> tuple[Array, Array, Array]:
    """Log evidence of q ~ N(0, s^2 root root') for each size s, posterior mean and standard deviation of the best.

    In the eigenvectors of root' A root every size is a sum: log ev = 1/2 sum(s^2 b^2 / (1 + s^2 l) - log(1 + s^2 l)).
    """
    eigenvalues, vectors = np.linalg.eigh(root.T @ A @ root)
    basis = root @ vectors
    b, square = basis.T @ u, sizes[:, None] ** 2
    denominator = 1.0 + square * np.maximum(eigenvalues, 0.0)
    evidence = 0.5 * np.sum(square * b**2 / denominator - np.log(denominator), axis=1)
    best = int(np.argmax(evidence))
    share = square[best] / denominator[best]
    return evidence, basis @ (share * b), np.asarray(np.sqrt(basis**2 @ share))
