"""What may be missing from a model: one form for an effect, a set of them, an event, a law, a fault, heat, nothing.

Every hypothesis says how probable it is before a look at the readings, what its amplitudes would do to them, which
signs and sizes these have, and how the network looks with it. What follows (evidence, refits, decisions) asks no more.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp
from scipy.stats import rankdata

from geom.arrays import Array
from lumped.model.network import Network, Parameter
from measured.doubt import PRIOR, RARE, SHARPNESS, temper
from validation.effects.base import Effect
from validation.effects.during import During
from validation.effects.registry import extended
from validation.effects.time_window import Event, share
from validation.inference.columns import Linearised

if TYPE_CHECKING:
    from measured.case import Test
    from validation.calibration.calibrate import Fit

Signs = NDArray[np.int64]
Members = tuple[int, ...]
LENGTHS = 0.5  # of its length, within which repeats of one event differ: a lid is opened for the same work
RARE_TIME = 0.05  # of its tests that an event lasts at most: a few minutes of an hour; more is how the machine is
FOLLOWS = 2.5  # deviations from an input's usual level, which eight repeats have by chance once in a hundred events
WHEN_S = 30.0  # instants between which one stretch is told from another: nobody says closer when something was
REPORTED = 0.05  # posterior probability from which a hypothesis is told in the first place


class Hypothesis(Protocol):
    """What may be missing from a model.

    name : "nothing", "kind@place", "kind@place + kind@place" or "heat@place"
    log_prior : log of its probability before a look at the readings
    sign : (n_amplitude,) of its amplitudes that physics allows, 0 for both
    scale : (n_amplitude,) their usual size, one standard deviation
    """

    @property
    def name(self) -> str: ...
    @property
    def log_prior(self) -> float: ...
    @property
    def sign(self) -> Signs: ...
    @property
    def scale(self) -> Array: ...

    def columns(self, run: Linearised) -> Sequence[Array]:
        """For each segment of the run (n_reading, n_amplitude) K per unit of its amplitudes."""
        ...

    def extend(self, network: Network) -> Network:
        """The network with its physics at zero amplitude; the network itself where it is not refitted."""
        ...


@dataclass(frozen=True)
class Cause:
    """One effect: lasting, in one test or for a while, a law that is off, or a fault of the measurement.

    parameter : its amplitude, with sign, usual size and bounds on the machine at hand
    """

    effect: Effect
    parameter: Parameter
    log_prior: float

    @property
    def name(self) -> str:
        return self.effect.name

    @property
    def sign(self) -> Signs:
        return np.array([self.parameter.sign], int)

    @property
    def scale(self) -> Array:
        return np.array([self.parameter.prior_sd])

    def columns(self, run: Linearised) -> Sequence[Array]:
        return run.tangents[self.name]

    def repeats(self, tests: Sequence[Test]) -> float:
        """What it costs (nats) to say when it was again."""
        return repeats_price(tests, self.effect.event) if isinstance(self.effect, During) and self.effect.event else 0.0

    def extend(self, network: Network) -> Network:
        return extended(network, [self.effect])


@dataclass(frozen=True)
class Together:
    """A set of causes that are all there; of none of them: nothing is missing."""

    causes: tuple[Cause, ...]
    log_prior: float

    @property
    def name(self) -> str:
        return " + ".join(c.name for c in self.causes) or "nothing"

    @property
    def sign(self) -> Signs:
        return np.array([c.parameter.sign for c in self.causes], int)

    @property
    def scale(self) -> Array:
        return np.array([c.parameter.prior_sd for c in self.causes])

    def columns(self, run: Linearised) -> Sequence[Array]:
        each = [c.columns(run) for c in self.causes]
        return [np.column_stack([np.zeros((s.r.size, 0)), *(x[i] for x in each)]) for i, s in enumerate(run.parts)]

    def extend(self, network: Network) -> Network:
        return extended(network, [c.effect for c in self.causes])


@dataclass(frozen=True)
class UnknownHeat:
    """Heat of any course at one place: an amplitude (W) at each knot of a test's time, without a law to refit."""

    place: str
    log_prior: float
    scale_W: float
    knots: int

    @property
    def name(self) -> str:
        return f"heat@{self.place}"

    @property
    def sign(self) -> Signs:
        return np.zeros(self.knots, int)

    @property
    def scale(self) -> Array:
        return np.full(self.knots, self.scale_W)

    def columns(self, run: Linearised) -> Sequence[Array]:
        return run.tangents[self.name]

    def extend(self, network: Network) -> Network:
        return network


def catalogue_priors(effects: Sequence[Effect]) -> dict[str, float]:
    """Name -> log prior of each lasting effect: its class's share over kinds, its kind's over places."""
    kinds = [e.kind for e in effects]
    faults = {e.kind: e.fault for e in effects}
    weight = {k: RARE[k].share if k in RARE else 1.0 for k in faults}
    whole = {f: sum(w for k, w in weight.items() if faults[k] == f) for f in (False, True)}
    share = {k: PRIOR["fault" if faults[k] else "effect"].share * w / whole[faults[k]] for k, w in weight.items()}
    return {e.name: float(np.log(share[e.kind] / kinds.count(e.kind))) for e in effects}


def condition_prior(share: float) -> float:
    """Log prior of what held in one test or for a while.  share : of all conditions, when it held included"""
    return float(np.log(PRIOR["condition"].share * share))


def law_prior(share: float) -> float:
    """Log prior of a declared law that is off.  share : of all such laws"""
    return float(np.log(PRIOR["effect"].share * RARE["law"].share * share))


NOTHING = Together((), float(np.log(PRIOR["nothing"].share)))


@dataclass(frozen=True)
class Weighed:
    """A hypothesis of an `Evidence` with what the readings say of it.

    members : indices of its causes there, none for nothing;  heat : the place of heat of unknown cause, if that is it
    log_prior : log prior probability, the user's answers in account;  log_bayes : log evidence over that of nothing
    (nats);  fit : once refitted
    loud : log evidence under the larger noise that nothing asks for, over that of nothing under the other
    """

    members: Members = ()
    heat: str = ""
    log_prior: float = 0.0
    log_bayes: float = 0.0
    loud: float = -np.inf
    fit: Fit | None = field(default=None, compare=False)

    @property
    def nothing(self) -> bool:
        """Whether it says that nothing is missing."""
        return not self.members and not self.heat

    @property
    def nats(self) -> float:
        """Log evidence, but for a constant, averaged over what the noise may be."""
        return float(np.logaddexp(self.log_bayes, self.loud))


def evidence_temper(hypotheses: Sequence[Weighed]) -> float:
    """What divides the log evidence of all: larger where the best has much."""
    none = next((h.nats for h in hypotheses if h.nothing), 0.0)
    return temper(max(h.nats for h in hypotheses) - none)


def weights(hypotheses: Sequence[Weighed]) -> Array:
    """(n,) log posterior probabilities, but for a constant."""
    share = evidence_temper(hypotheses)
    return np.array([h.log_prior + h.nats / share for h in hypotheses])


def probabilities(hypotheses: Sequence[Weighed], sharpness: float = SHARPNESS) -> Array:
    """(n,) posterior probabilities as they are stated; they sum to one.

    sharpness : power of what prior and evidence say, 1 for that itself: what is only looked at further is not stated
    """
    x = sharpness * weights(hypotheses)
    return np.asarray(np.exp(x - logsumexp(x)))


def best_first(hypotheses: Sequence[Weighed]) -> list[Weighed]:
    """The hypotheses, most probable first."""
    return [hypotheses[int(i)] for i in np.argsort(-weights(hypotheses), kind="stable")]


def inclusion(hypotheses: Sequence[Weighed], count: int) -> Array:
    """(count,) probability that each cause is among what is missing."""
    out = np.zeros(count)
    for h, p in zip(hypotheses, probabilities(hypotheses), strict=True):
        out[list(h.members)] += p
    return out


def relative_evidence(hypotheses: Iterable[Weighed]) -> list[Weighed]:
    """The hypotheses with log evidence of which nothing has none."""
    every = list(hypotheses)
    none = next(h.nats for h in every if h.nothing)
    return [replace(h, log_bayes=h.log_bayes - none, loud=h.loud - none) for h in every]


def singles_by_member(hypotheses: Iterable[Weighed]) -> Mapping[int, Weighed]:
    """Index of a cause -> the hypothesis that it alone is missing."""
    return {h.members[0]: h for h in hypotheses if len(h.members) == 1}


def stretch_count(n: float, usual: float | None) -> float:
    """How many stretches there are among n instants; repeats of one that is as long as `usual` (in instants) last about
    as long, and begin anywhere."""
    return 0.5 * n * (n + 1) if usual is None else n * max(1.0, LENGTHS * usual)


def sample_step(test: Test) -> float:
    """Usual time between two samples (s)."""
    return float(np.median(np.diff(test.time)))


def timing_step(test: Test) -> float:
    """Time (s) between instants at which something may begin or end: rows where they are close, else WHEN_S."""
    return min(sample_step(test), WHEN_S)


def repeat_price(test: Test, usual_s: float) -> float:
    """What it costs (nats) to say when in a test a repeat was that lasts about so long (s), whatever its rows."""
    return float(np.log(stretch_count(float(np.ptp(test.time)) / WHEN_S + 1.0, usual_s / WHEN_S)))


def repeats_price(tests: Sequence[Test], occurrence: Event) -> float:
    """What it costs (nats) to say when every stretch of an event but one was; 0 where it is not rare.

    It is a part of the evidence, as what the size of an effect costs: what repeats explain is tempered, and so is this.
    """
    every = [t for t in tests for _ in occurrence.spans.get(t.name, ())][1:]
    usual = float(np.mean([b - a for a, b in occurrence.every]))
    return sum(repeat_price(t, usual) for t in every) if is_rare(tests, occurrence) else 0.0


def is_rare(tests: Sequence[Test], occurrence: Event) -> bool:
    """Is an event short, its repeats alike, and at no level of an input but by chance?  Else it is a law."""
    levels, here = dict[str, list[float]](), [t for t in tests if t.name in occurrence.spans]
    lengths, slack = [b - a for a, b in occurrence.every], 2.0 * max(timing_step(t) for t in here)
    alike = (1.0 - LENGTHS) * (max(lengths) - slack) <= (1.0 + LENGTHS) * (min(lengths) + slack)
    if not alike or sum(lengths) > RARE_TIME * sum(float(np.ptp(t.time)) for t in here):
        return False
    for t in here:
        for name, u in t.inputs.items():
            rank = rankdata(u) - 0.5 * (u.size + 1)
            mean = [rank[share(t.time, [s]) > 0].mean() for s in occurrence.spans[t.name]]
            levels.setdefault(name, []).extend(np.array(mean) / max(rank.std(), 1e-9))
    return all(abs(np.mean(x)) < FOLLOWS / np.sqrt(len(x)) for x in levels.values())
