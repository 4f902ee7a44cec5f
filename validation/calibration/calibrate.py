"""Maximum a posteriori calibration: Levenberg-Marquardt on whitened residuals with Gaussian priors and hard bounds."""

from collections import deque
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from geom.arrays import Array, Mask
from geom.errors import NoSolution
from lumped.model.multipliers import parameter_values
from lumped.model.network import Network
from measured.case import Test
from measured.doubt import USUAL, Doubt
from validation.calibration.model_error import ModelError, model_error
from validation.comparison.linearisation import Segment, segments
from validation.noise import FOLLOWED, Noise, first_noise, fit_noise
from validation.parameters.unknowns import Unknowns, measured, sorted_unknowns

Progress = Callable[[str], None]
Keep = Callable[[Mapping[str, float]], None]
STATIONARY = 0.1  # of a posterior standard deviation
WORTH = 0.1  # nats: the error of time steps moves an objective by about as much, so that no fit can settle closer
DRAFT_STEPS, LAST_STEPS = 10, 40  # of a fit that another follows, and of one that is kept: few need more than ten
ROUGH = 1.0  # nats: a fit under a noise that is only guessed
ROBUST = 2  # times that single readings are weighed anew: a third moves nothing that two digits show
SHORTER, MORE, LESS = 0.01, 30.0, 10.0  # damping of the first shorter step; growth where that fails, fall where not
SHORTEST, STALE = 1e6, 1e3  # damping beyond which no step gains; a stale Jacobian is given up before
GAIN_RATIO = 0.5  # of the predicted gain: a Jacobian that delivers less is made anew


def no_progress(message: str) -> None:
    """No progress."""


def no_memory(values: Mapping[str, float]) -> None:
    """Nothing is kept between steps."""


@dataclass(frozen=True)
class Fit:
    """A calibrated state.

    theta : (p,) fitted coordinates;  H : (p, p) curvature of the posterior (J'Sigma^-1 J + prior);  parts : residual
    and Jacobian at theta;  gradient : largest |gradient| in units of the posterior sd (0 at the exact optimum)
    error : the model error that the noise was widened by, marginalised in H and the objective
    gain_ratio : least share of its predicted gain that a step of weight brought; 1 where the model is linear
    """

    network: Network
    unknowns: Unknowns
    theta: Array
    H: Array
    parts: tuple[Segment, ...]
    noise: Noise
    objective: float
    converged: bool
    gradient: float
    error: ModelError | None = None
    gain_ratio: float = 1.0

    @property
    def values(self) -> dict[str, float]:
        return self.unknowns.values(self.theta)

    @property
    def covariance(self) -> Array:
        return np.asarray(np.linalg.inv(self.H), float)

    @property
    def sd(self) -> Array:
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def at_bound(self) -> Mask:
        low, high = self.unknowns.bounds
        return (self.theta <= low + 1e-9) | (self.theta >= high - 1e-9)


@dataclass(frozen=True)
class CachedSegments:
    """Segments from before a fit, whose Jacobian serves as its first.

    parts : of the very state where the fit begins, or else (`nearby`) of one close by, whose residuals are made anew
    renewed : where steps fail, a Jacobian from nearby is made anew; if not, it is never
    stale : residuals are of the very state, the Jacobian may be from before the last steps
    """

    parts: Sequence[Segment]
    nearby: bool = True
    renewed: bool = False
    stale: bool = False

    @property
    def outdated(self) -> bool:
        return self.nearby and not self.renewed


def normal(parts: Sequence[Segment], noise: Noise) -> tuple[Array, Array, float]:
    """J'Sigma^-1 J, J'Sigma^-1 r and r'Sigma^-1 r, summed over segments."""
    p = parts[0].J.shape[1]
    G = np.zeros((p + 1, p + 1))
    for s in parts:
        X = noise.whiten(s, np.column_stack([s.J, s.r]))
        G += X.T @ X
    return G[:p, :p], G[:p, p], float(G[p, p])


def bounded_step(H: Array, g: Array, theta: Array, low: Array, high: Array) -> Array:
    """Minimiser of the quadratic model inside the bounds: clip the worst offender and solve again for the others."""
    new, free = theta.copy(), np.ones(theta.size, bool)
    for _ in range(theta.size + 1):
        step = np.zeros_like(theta)
        step[~free] = new[~free] - theta[~free]
        rhs = g[free] - H[np.ix_(free, ~free)] @ step[~free]
        step[free] = np.linalg.solve(H[np.ix_(free, free)], rhs)
        over = np.maximum(theta + step - high, low - theta - step)
        if not free.any() or np.max(over[free]) <= 1e-12:
            return np.clip(theta + step, low, high)
        worst = np.flatnonzero(free)[np.argmax(over[free])]
        free[worst] = False
        new[worst] = high[worst] if theta[worst] + step[worst] > high[worst] else low[worst]
    return new


def minimise(
    network: Network,
    tests: Sequence[Test],
    unknowns: Unknowns,
    theta: Array,
    noise: Noise | None = None,
    fixed: Mapping[str, float] | None = None,
    iterations: int = 12,
    cache: CachedSegments | None = None,
    draft: bool = False,
    centre: Array | None = None,
    worth: float = WORTH,
    progress: Progress = no_progress,
    keep: Keep = no_memory,
    error: ModelError | None = None,
) -> Fit:
    """Fit `unknowns` to the tests from `theta` under a given noise (by default that of uncalibrated sensors).

    iterations : steps that gain

    The Jacobian costs ten times a run, so it is held as long as steps do what it predicts, and made anew before the
    end (unless `draft`); `cache`: one to begin with; `centre`: prior mean (p,), 0 by default; `worth`: gain (nats) for
    which one more step is made; `keep` is told the values after every step, so that an interrupted fit can go on;
    `error`: the covariance of the model error, added to that of the noise.
    """
    fixed = dict(fixed or {})
    iterate = Iterate(network, tests, unknowns, fixed, theta, noise, cache, draft, centre, worth, error)
    for iteration in range(iterations):
        progress(f"calibration step {iteration + 1}, objective {iterate.objective:.4g}")
        finished = iterate.step()
        keep(unknowns.values(iterate.theta))
        if finished:
            break
    return iterate.fit()


class Iterate:
    """State of a fit between its steps."""

    def __init__(
        self,
        network: Network,
        tests: Sequence[Test],
        unknowns: Unknowns,
        fixed: dict[str, float],
        theta: Array,
        noise: Noise | None = None,
        cache: CachedSegments | None = None,
        draft: bool = False,
        centre: Array | None = None,
        worth: float = WORTH,
        error: ModelError | None = None,
    ) -> None:
        near = cache is not None and cache.nearby
        self.network, self.tests, self.unknowns, self.fixed = network, tests, unknowns, fixed
        self.outdated, self.worth = cache is not None and cache.outdated, worth
        self.draft = draft or self.outdated
        self.centre = np.zeros_like(theta) if centre is None else centre
        self.low, self.high = unknowns.bounds
        self.fresh = not (near or (cache is not None and cache.stale))
        self.weight, self.damping, self.done = unknowns.sd**-2.0, 0.0, False
        self.gain_ratio = 1.0
        self.theta = np.clip(theta, self.low, self.high)
        self.parts = self.begun(cache)
        self.noise = noise or first_noise(self.parts)
        self.error, self.measure = error, InnerProduct(self.parts, self.noise, error)
        self.weigh()

    def begun(self, cache: CachedSegments | None) -> list[Segment]:
        """Residuals and Jacobian where the fit begins."""
        if cache is None:
            return self.tangents(self.theta)
        return self.residuals(self.theta, cache.parts) if cache.nearby else list(cache.parts)

    def tangents(self, x: Array) -> list[Segment]:
        now = {**self.fixed, **self.unknowns.values(x)}
        return segments(self.network, self.tests, now, self.unknowns.parameters)

    def residuals(self, x: Array, like: Sequence[Segment]) -> list[Segment]:
        """Residuals at x with the Jacobian of other segments."""
        plain = segments(self.network, self.tests, {**self.fixed, **self.unknowns.values(x)}, ())
        return [replace(new, J=old.J) for new, old in zip(plain, like, strict=True)]

    @property
    def enough(self) -> float:
        """Gain in objective below which a step is not worth making."""
        return self.worth * (1.0 + 1e-3 * self.objective)

    def weigh(self) -> None:
        """After a new Jacobian."""
        self.white = self.measure.white([s.J for s in self.parts])
        self.A = self.measure.product(self.white, self.white)
        self.read()

    def read(self) -> None:
        """After new residuals."""
        r = self.measure.white([s.r[:, None] for s in self.parts])
        self.b = self.measure.product(self.white, r)[:, 0]
        self.objective = 0.5 * (float(self.measure.product(r, r)[0, 0]) + self.strain(self.theta))

    def strain(self, x: Array) -> float:
        """Squared distance from the prior mean, in prior deviations."""
        return float((x - self.centre) @ (self.weight * (x - self.centre)))

    def slope(self) -> tuple[Array, Array]:
        """Curvature and steepest descent of the objective."""
        return self.A + np.diag(self.weight), self.b - self.weight * (self.theta - self.centre)

    def renew(self) -> None:
        """The Jacobian where the fit stands."""
        self.parts, self.fresh = self.tangents(self.theta), True
        self.weigh()

    def step(self) -> bool:
        """One step that gains, shortened until it does; True when there is nothing more to gain."""
        while True:
            H, g = self.slope()
            new = bounded_step(H + self.damping * np.diag(np.diag(H)), g, self.theta, self.low, self.high)
            predicted = float(g @ (new - self.theta) - 0.5 * (new - self.theta) @ H @ (new - self.theta))
            if predicted < self.enough:
                return self.stop()
            gained, trial = self.evaluated(new)
            if predicted > ROUGH and trial:
                self.gain_ratio = min(self.gain_ratio, gained / predicted)
            if gained > 0.0:
                self.theta, self.parts, self.fresh = new, trial, False
                self.damping = self.damping / LESS if self.damping > SHORTER else 0.0
                if gained < GAIN_RATIO * predicted and not self.outdated:
                    self.renew()
                else:
                    self.read()
                return gained < self.enough and self.stop()
            if self.back():
                return True

    def evaluated(self, new: Array) -> tuple[float, list[Segment]]:
        """What a step would gain, and the residuals at its end; none where the machine runs away there."""
        try:
            trial = self.residuals(new, self.parts)
        except NoSolution:
            return -np.inf, []
        return self.objective - 0.5 * (self.measure.square(trial) + self.strain(new)), trial

    def stop(self) -> bool:
        """Done with a true Jacobian; otherwise look once more."""
        if not (self.fresh or self.draft):
            self.renew()
            return False
        self.done = True
        return True

    def back(self) -> bool:
        """A step that made things worse: a true Jacobian first, then a shorter step; True when it can be no shorter.

        A stale Jacobian that fails at a short step points elsewhere: another fit goes on with one of its own.
        """
        if not (self.fresh or self.outdated):
            self.renew()
        else:
            self.damping = max(MORE * self.damping, SHORTER)
        return self.damping > (STALE if self.outdated else SHORTEST)

    def fit(self) -> Fit:
        if not (self.fresh or self.draft):
            self.renew()
        H, g = self.slope()
        inside = ~((self.theta <= self.low + 1e-9) & (g < 0) | (self.theta >= self.high - 1e-9) & (g > 0))
        slack = float(np.max(np.abs(g / np.sqrt(np.diag(H)))[inside], initial=0.0))
        state = self.network, self.unknowns, self.theta, H, tuple(self.parts), self.noise, self.objective
        return Fit(*state, self.done or slack < STATIONARY, slack, self.error, self.gain_ratio)


_WHITENED: deque[tuple[Noise, ModelError, list[tuple[str, str, int]], list[Array], Any]] = deque(maxlen=8)


class InnerProduct:
    """x' S^-1 y over the instants of some segments, S = noise + model error.

    With whitened columns D of the model error, S^-1 = 1 - D (1 + D'D)^-1 D' (Woodbury).
    """

    def __init__(self, parts: Sequence[Segment], noise: Noise, error: ModelError | None) -> None:
        self.parts, self.noise = list(parts), noise
        nothing: tuple[list[Array], Any] = ([], None)
        self.D, self.factor = self.doubted(error) if error else nothing

    def doubted(self, error: ModelError) -> tuple[list[Array], Any]:
        """Whitened D, and 1 + D'D factored: once for all fits under one noise."""
        from scipy.linalg import cho_factor

        samples = [(s.test, s.channel, s.time.size) for s in self.parts]
        for noise, cached_error, of, D, factor in tuple(_WHITENED):
            if noise is self.noise and cached_error is error and of == samples:
                return D, factor
        D = self.white([error.of(s) for s in self.parts])
        factor = cho_factor(np.eye(error.size) + sum(d.T @ d for d in D))
        _WHITENED.append((self.noise, error, samples, D, factor))
        return D, factor

    def _solved(self, Y: Array) -> Array:
        from scipy.linalg import cho_solve

        return np.asarray(cho_solve(self.factor, Y))

    def white(self, columns: Sequence[Array]) -> list[Array]:
        """Columns (n, k) of each segment under its noise alone."""
        return [self.noise.whiten(s, X) for s, X in zip(self.parts, columns, strict=True)]

    def product(self, X: Sequence[Array], Y: Sequence[Array]) -> Array:
        """X' S^-1 Y of whitened columns."""
        plain = np.asarray(sum(x.T @ y for x, y in zip(X, Y, strict=True)))
        if self.factor is None:
            return plain
        return plain - self.along(X).T @ self._solved(self.along(Y))

    def along(self, X: Sequence[Array]) -> Array:
        """D' X of whitened columns."""
        return np.asarray(sum(d.T @ x for d, x in zip(self.D, X, strict=True)))

    def square(self, parts: Sequence[Segment]) -> float:
        """r' S^-1 r."""
        r = self.white([s.r[:, None] for s in parts])
        return float(self.product(r, r)[0, 0])

    def explained(self, parts: Sequence[Segment], error: ModelError | None) -> list[Segment]:
        """The segments without what the model error explains of their residuals."""
        if self.factor is None or error is None:
            return list(parts)
        d = self.doubts(parts)
        return [replace(s, r=s.r - error.of(s) @ d) for s in parts]

    def doubts(self, parts: Sequence[Segment]) -> Array:
        """(d,) deviations of the doubts that explain residuals best."""
        if self.factor is None:
            return np.zeros(0)
        return self._solved(self.along(self.white([s.r[:, None] for s in parts])))[:, 0]


def residual_noise(fit: Fit) -> Noise:
    """The noise of what a fit and its model error leave."""
    return fit_noise(InnerProduct(fit.parts, fit.noise, fit.error).explained(fit.parts, fit.error))


def calibrated(
    network: Network,
    tests: Sequence[Test],
    unknowns: Unknowns,
    values: Mapping[str, float],
    rounds: int = 2,
    progress: Progress = no_progress,
    noise: Noise | None = None,
    rough: bool = False,
    robust: bool = False,
) -> Fit:
    """The most probable parameters under the noise of what they leave, estimated `rounds` times: what a residual can
    tell is asked of them. What predicts best is `reading_fit`.

    robust : single readings that nothing explains pull no further, see `Noise.robust`; not where they are looked for

    Only the last needs a Jacobian of its own end; `rough`: nor does that, since another fit goes on from there.
    """
    fixed, theta = parameter_values(network, values), unknowns.coordinates(values)
    renewed = robust_noise if robust else fit_noise
    return _fit_in_rounds(network, tests, unknowns, theta, noise, renewed, fixed, rounds, rough, progress)


def robust_noise(parts: Sequence[Segment]) -> Noise:
    """The noise of what is left, under which single readings that nothing explains pull no further than others."""
    return fit_noise(parts).robust(parts)


def _fit_in_rounds(
    network: Network,
    tests: Sequence[Test],
    unknowns: Unknowns,
    theta: Array,
    noise: Noise | None,
    renewed: Callable[[Sequence[Segment]], Noise],
    fixed: Mapping[str, float],
    rounds: int,
    rough: bool = False,
    progress: Progress = no_progress,
    keep: Keep = no_memory,
    cache: CachedSegments | None = None,
) -> Fit:
    """A fit under a first noise, then `rounds` times under the one that `renewed` makes of what is left."""
    worth, draft = ROUGH if rounds else WORTH, rough or rounds > 0
    fit = minimise(
        *(network, tests, unknowns, theta, noise, fixed),
        cache=cache,
        draft=draft,
        worth=worth,
        progress=progress,
        keep=keep,
    )
    for i in range(rounds):
        draft = rough or i + 1 < rounds
        steps, cache = DRAFT_STEPS if draft else LAST_STEPS, CachedSegments(fit.parts, nearby=False, stale=True)
        noise = renewed(fit.parts)
        fit = minimise(
            network, tests, unknowns, fit.theta, noise, fixed, steps, cache, draft, progress=progress, keep=keep
        )
    return fit


def reading_fit(
    network: Network,
    tests: Sequence[Test],
    unknowns: Unknowns,
    values: Mapping[str, float],
    effects: Collection[str] = (),
    progress: Progress = no_progress,
    keep: Keep = no_memory,
) -> Fit:
    """The parameters by which the model follows the readings as they are: what predicts best if it is not quite true.

    A slow error that a model of this kind is allowed, or that a sensor may have by its place, does not come again as
    it was: parameters that leave it to them predict worse. So every reading counts alike by the error usual for its
    record, those that nothing explains no further than others, and sensors, boundaries and clocks have what is left.
    effects : names of what has the most probable size and is not moved: it stands for one cause, and must not take on
        what others leave
    """
    causes, machine, others = sorted_unknowns(unknowns, effects)
    fixed = parameter_values(network, {n: x for n, x in values.items() if not measured(n) or n in machine.names})
    if causes.names:
        sizes = calibrated(network, tests, unknowns, values, progress=progress, robust=True).values
        fixed |= {name: sizes[name] for name in causes.names}
    theta = machine.coordinates(values)
    fit = _fit_in_rounds(
        network, tests, machine, theta, FOLLOWED, FOLLOWED.robust, fixed, ROBUST, progress=progress, keep=keep
    )
    now = {**fixed, **fit.values}
    left = minimise(network, tests, others, np.zeros(len(others.names)), fit_noise(fit.parts), now)
    theta = unknowns.coordinates({**now, **left.values})
    whole = minimise(network, tests, unknowns, theta, fit_noise(left.parts), fixed, 0)
    return replace(whole, converged=fit.converged, gradient=fit.gradient)


def refitted(
    fit: Fit, tests: Sequence[Test], values: Mapping[str, float], effects: Collection[str] = ()
) -> dict[str, float]:
    """What `reading_fit` would find for readings that hardly differ, by the Jacobian of what it found."""
    causes, machine, others = sorted_unknowns(fit.unknowns, effects)
    now = {n: x for n, x in {**values, **fit.values}.items() if n not in others.names}

    def cache(some: Unknowns) -> CachedSegments:
        rows = [fit.unknowns.names.index(name) for name in some.names]
        return CachedSegments([replace(s, J=s.J[:, rows]) for s in fit.parts])

    def rough(some: Unknowns, noise: Noise, renewed: Callable[[Sequence[Segment]], Noise], rounds: int) -> Fit:
        theta = some.coordinates(now)
        return _fit_in_rounds(fit.network, tests, some, theta, noise, renewed, now, rounds, True, cache=cache(some))

    if causes.names:
        sizes = rough(fit.unknowns, fit.noise, robust_noise, ROBUST).values
        now |= {name: sizes[name] for name in causes.names}
    draft = rough(machine, FOLLOWED, FOLLOWED.robust, ROBUST)
    now |= draft.values
    return now | rough(others, fit_noise(draft.parts), fit_noise, 0).values


def followed(fit: Fit, tests: Sequence[Test], values: Mapping[str, float], effects: Collection[str] = ()) -> Fit:
    """What a fit had free, but for its effects, fitted to follow the readings.  values : of what is not free"""
    _, machine, others = sorted_unknowns(fit.unknowns, effects)
    free = Unknowns((*machine.parameters, *others.parameters))
    return reading_fit(fit.network, tests, free, {**values, **fit.values})


def with_model_error(
    fit: Fit,
    tests: Sequence[Test],
    values: Mapping[str, float],
    doubt: Doubt = USUAL,
    iterations: int = 0,
    draft: bool = False,
    steps_like: ModelError | None = None,
) -> Fit:
    """The fit where it stands, or gone on, with what a model of this kind gets wrong added to the noise.

    values : of what is not free.  Predictions are best by the parameters that follow the readings; how sure these are,
    and what is missing beside them, depends on the model error.  steps_like : see `model_error`
    """
    fixed = {**values, **fit.values}
    error = model_error(fit.network, tests, fixed, doubt, steps_like=steps_like)
    noise = fit_noise(InnerProduct(fit.parts, fit.noise, error).explained(fit.parts, error))
    cache = CachedSegments(fit.parts, nearby=False, stale=iterations > 0)
    model = fit.network, tests, fit.unknowns
    return minimise(*model, fit.theta, noise, fixed, iterations, cache, draft, error=error)
