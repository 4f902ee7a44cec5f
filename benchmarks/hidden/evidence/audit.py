"""Is the log evidence of a diagnosis what an integral over all its parameters comes to?

    python benchmarks/hidden_effects.py --audit --seeds dev --count 7 --out OUT
    python benchmarks/hidden_effects.py --audit --nested --seeds dev --count 2 --kinds servo --out OUT

Of each case the most probable hypotheses that were refitted are integrated anew over calibrated parameters and
amplitudes, under the noise, model error and priors of the diagnosis: by importance sampling from the Gaussian of the
refit, which is what Laplace's integral is a guess of, and with `--nested` by nested sampling, which knows nothing of
the refit. What is held against these is `log_bayes`, the log evidence over that of nothing, under one noise for both.
Source: Skilling 2006; Speagle 2020 (dynesty).
"""

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.special import logsumexp, ndtr
from scipy.stats import norm

from geom.errors import NoSolution
from geom.one_thread import one_blas_thread
from hidden.cases import Label, edits_of, records_of
from hidden.user import case_of
from measured.doubt import SIZES
from scripts.published import add_lines, json_lines
from validation.calibration.calibrate import Fit, InnerProduct
from validation.comparison.linearisation import segments
from validation.diagnosis import infer
from validation.inference.evidence import Evidence, fitted_members, log_bayes, with_members
from validation.inference.hypotheses import Weighed, best_first, probabilities

FIVE = 5  # hypotheses of a case
GRID = 4001  # of a prior's distribution, for the nested sampler
FAR = 12.0  # deviations that this grid reaches
ALIVE = 200  # points of the nested sampler
CLOSE = 1.0  # nats: what an evidence may be off


@dataclass(frozen=True)
class Row:
    """A hypothesis of a case. dimensions : parameters integrated over;  laplace, sampled, nested : log evidence over
    that of nothing (nats);  sure : standard error of `sampled`;  effective : share of the samples that carry it"""

    case: str
    hypothesis: str
    dimensions: int
    probability: float
    laplace: float
    sampled: float
    sure: float
    effective: float
    nested: float | None = None
    cpu_s: float = 0.0


@dataclass(frozen=True)
class Integral:
    """The posterior of one hypothesis, its priors those that a Bayes factor asks for.

    scale, sign : (q,) usual size and sign of the amplitudes, which come after the p calibrated parameters
    """

    evidence: Evidence
    fit: Fit
    members: tuple[int, ...]
    scale: np.ndarray
    sign: np.ndarray

    @classmethod
    def of(cls, e: Evidence, h: Weighed) -> "Integral":
        free = e.hypothesis(fitted_members(e, h.members))
        return cls(e, h.fit if h.members and h.fit else e.fit, h.members, np.array(free.scale), np.array(free.sign))

    @cached_property
    def run(self) -> Callable[[np.ndarray], float]:
        """Log likelihood, but for what is the same for all hypotheses of a case."""
        e, fit = self.evidence, self.fit
        network, unknowns, fixed = with_members(e, self.members) if self.members else (fit.network, fit.unknowns, {})
        fixed = fixed or {q.name: q.value for q in e.network.parameters} | e.fit.values
        measure = InnerProduct(fit.parts, e.fit.noise, e.fit.error)

        def log_likelihood(theta: np.ndarray) -> float:
            try:
                return -0.5 * measure.square(segments(network, e.tests, {**fixed, **unknowns.values(theta)}, ()))
            except NoSolution:
                return -1e300

        return log_likelihood

    @property
    def sd(self) -> np.ndarray:
        """(p,) of the calibrated parameters."""
        return np.asarray(self.fit.unknowns.sd[: self.evidence.p])

    def log_prior(self, theta: np.ndarray) -> float:
        low, high = self.fit.unknowns.bounds
        if np.any((theta < low) | (theta > high)):
            return -np.inf
        p, a = self.evidence.p, theta[self.evidence.p :]
        if np.any(self.sign * a < 0.0):
            return -np.inf
        out = float(np.sum(norm.logpdf(theta[:p], scale=self.sd)))
        if a.size:  # one size of all, as nobody knows the usual size within a decade
            each = [np.sum(norm.logpdf(a, scale=f * self.scale) + np.log(2.0) * (self.sign != 0)) for f in SIZES]
            out += float(logsumexp(each) - np.log(len(SIZES)))
        return out

    def sampled(self, count: int, rng: np.random.Generator) -> tuple[float, float, float]:
        """Log evidence by importance sampling, its standard error (nats), and the share of samples that carry it."""
        fit, root = self.fit, np.linalg.cholesky(np.linalg.inv(self.fit.H))
        draws = rng.standard_normal((count, fit.theta.size))
        wide = float(np.sum(np.log(np.diag(root)))) + 0.5 * fit.theta.size * np.log(2.0 * np.pi)
        logs = np.array([self._log_weight(fit.theta + root @ z, z) for z in draws]) + wide
        w = np.exp(logs - logs.max())
        return (
            float(logsumexp(logs) - np.log(count)),
            float(w.std() / w.mean() / np.sqrt(count)),
            float(w.sum() ** 2 / (w @ w) / count),
        )

    def _log_weight(self, theta: np.ndarray, z: np.ndarray) -> float:
        prior = self.log_prior(theta)
        return prior + self.run(theta) + 0.5 * float(z @ z) if np.isfinite(prior) else -np.inf

    def nested(self, seed: int) -> float:
        """Log evidence by nested sampling; bounds and signs are part of the prior."""
        from dynesty import NestedSampler

        p, size = self.evidence.p, self.fit.theta.size
        low, high = (b[:p] / self.sd for b in self.fit.unknowns.bounds)
        x = np.linspace(-FAR, FAR, GRID) * max(SIZES)
        mixed = np.mean([ndtr(x / f) for f in SIZES], axis=0)

        def prior(u: np.ndarray) -> np.ndarray:
            out = np.empty(size)
            out[:p] = self.sd * np.clip(norm.ppf(u[:p]), low, high)
            half = np.where(self.sign == 0, u[p:], 0.5 + 0.5 * u[p:])
            side = np.where(self.sign < 0, -1.0, 1.0)
            out[p:] = side * self.scale * np.interp(half, mixed, x)
            return np.clip(out, *self.fit.unknowns.bounds)

        rng = np.random.default_rng(seed)
        sampler = NestedSampler(self.run, prior, size, nlive=ALIVE, sample="rslice", rstate=rng)
        sampler.run_nested(dlogz=0.1, print_progress=False)
        return float(sampler.results.logz[-1])


@one_blas_thread
def audited(label: Label, count: int, nested: bool) -> list[Row]:
    """The most probable refitted hypotheses of a case."""
    case = case_of(label.case, label.machine, records_of(label), edits_of(label))
    posterior = infer(case.training())
    e, rows = posterior.evidence, []
    P = dict(zip(map(id, posterior.hypotheses), probabilities(posterior.hypotheses), strict=True))
    # larger sets were fitted from the best of two, under tangents of their own
    told = [h for h in best_first(posterior.hypotheses) if h.fit and 1 <= len(h.members) <= 2][:FIVE]
    none = Integral.of(e, next(h for h in posterior.hypotheses if h.nothing))
    rng = np.random.default_rng(label.seed)
    zero, unsure, _ = none.sampled(count, rng)
    zero_nested = none.nested(label.seed) if nested else 0.0
    for h in told:
        begin, one = time.process_time(), Integral.of(e, h)
        log_z, sure, effective = one.sampled(count, rng)
        paid = float(np.sum(e.repeats[list(h.members)]))
        by_nesting = one.nested(label.seed) - zero_nested - paid if nested else None
        name, size, sampled, both = e.name(h), one.fit.theta.size, log_z - zero - paid, float(np.hypot(sure, unsure))
        seconds = time.process_time() - begin
        laplace = log_bayes(e, one.fit, h.members)
        row = Row(label.case, name, size, P[id(h)], laplace, sampled, both, effective, by_nesting, seconds)
        more = "" if by_nesting is None else f", nested {by_nesting:.1f}"
        print(f"{label.case:26s} {name:60s} {laplace:7.1f}, sampled {sampled:.1f} +- {both:.1f}{more}", flush=True)
        rows.append(row)
    return rows


def run(labels: Sequence[Label], out: Path, count: int, nested: bool) -> str:
    """Cases that the folder does not have yet, a line each; how many are within a nat, and how far off all are."""
    out.mkdir(parents=True, exist_ok=True)
    file = out / "audit.jsonl"
    rows = json_lines(file)
    done = {row["case"] for row in rows}
    for label in (label for label in labels if label.case not in done):
        new = [asdict(row) for row in audited(label, count, nested)]
        add_lines(file, *new)
        rows += new
    off = np.array([r["laplace"] - r["sampled"] for r in rows])
    words = f"{np.sum(np.abs(off) <= CLOSE)} of {off.size} within {CLOSE:g} nat; off by {np.median(off):+.2f} (median)"
    return f"{words}, {np.percentile(np.abs(off), 90):.2f} at most in nine of ten, {np.abs(off).max():.1f} the worst"
