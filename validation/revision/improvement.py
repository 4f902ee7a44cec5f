"""From a model that disagrees to one that does not: diagnose, choose, add, again; with every step's errors kept."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from textwrap import shorten

import numpy as np

from geom.errors import NoSolution
from geom.table import TableRow, select_fields
from geom.text import counted
from measured.case import Case
from validation.calibration.calibrate import Progress, no_progress
from validation.comparison.compare import Comparison, errors, pooled
from validation.diagnosis import diagnose
from validation.effects import effect
from validation.effects.during import During
from validation.effects.sensors.reading_fault import SensorDelay
from validation.inference.decide import SURE
from validation.inference.result import Candidate, Diagnosis
from validation.parameters.unknowns import with_model
from validation.revision.revise import TOGETHER, TRAINING, Revision, add, calibrate
from validation.yardstick.suggestions import suggested_effects
from validation.yardstick.words import NAMES, WORTH
from validation.yardstick.yardstick import yardstick

Trial = tuple[tuple[str, ...], dict[str, float | str]]  # effects, and what speaks for them
LEAST = 0.005  # K, a rise that two digits show
LIKELY = 3  # sets tried where no name was added: each costs a fit, and the criterion decides
LINE = 60  # letters of a verdict that a line of progress has room for
MOST = 6  # effects at a time: more are a reason to look at the model


@dataclass(frozen=True)
class Step:
    """The model after one step.

    evidence : what the diagnosis said about the effect;  revision : the step that led here, None at the start
    """

    comparison: Comparison
    evidence: Mapping[str, float | str]
    revision: Revision | None = None

    @property
    def step(self) -> str:
        """ "start", "calibrate" or "add"."""
        return self.revision.action if self.revision else "start"

    @property
    def effect(self) -> str | None:
        """What was added."""
        return self.revision.effect if self.revision else None

    @property
    def left_out_K(self) -> float:
        """Error (K rms) on tests that were left out in turn; of a model from before on those a fit may use."""
        error = self.revision.left_out_K if self.revision else None
        rows = [c for t in self.comparison.tests if t.role != "hold-out" for c in t.channels]
        return pooled(rows) if error is None else error

    def document(self) -> dict:
        return {
            **select_fields(self, "step", "effect"),
            "revision": self.comparison.revision,
            "tests": [t.summary for t in self.comparison.tests],
            **select_fields(self.comparison, "rmse_K", "fitted_rmse_K"),
            "evidence": dict(self.evidence),
            "laws": dict(self.revision.laws) if self.revision else {},
        }


@dataclass(frozen=True)
class Refusal(TableRow):
    """What was tried and why it does not stand, in words."""

    effects: Sequence[str]
    what: str
    why: str

    def __str__(self) -> str:
        return f"not accepted: {self.what}, as {self.why}"


@dataclass(frozen=True)
class Improvement:
    """All stairs, the last diagnosis, and why it ended there; case : with the model of the last stair.

    plain_K : what the best plain model leaves (K rms) on tests left out in turn; NaN where none can be learnt
    refused : what was tried at the end and did not predict, and why
    """

    case: Case
    stairs: tuple[Step, ...]
    diagnosis: Diagnosis
    why: str
    plain_K: float = float("nan")
    refused: Sequence[Refusal] = ()

    @property
    def adequate(self) -> bool:
        return self.diagnosis.verdict == "adequate"

    def document(self) -> dict:
        return {
            **select_fields(self.diagnosis, "verdict", "words"),
            **select_fields(self, "adequate", "why", "refused"),
            "left_out_K": self.stairs[-1].left_out_K,
            "plain_left_out_K": self.plain_K if np.isfinite(self.plain_K) else None,
            **select_fields(self, "stairs", "diagnosis"),
        }


@dataclass(frozen=True)
class Supervisor:
    """Who decides and who remembers.

    choose : of the candidates that cannot be told apart (one or more) the name to add, or None to stop
    suggest : nobody is asked: what is not chosen hides nothing after it, and what a free network has and the model
        lacks is added where no effect of the diagnosis is left and the model predicts tests that were left out less
        well than it
    keep : told every accepted revision and the evidence for it
    """

    choose: Callable[[Diagnosis, Sequence[Candidate]], str | None]
    keep: Callable[[Revision, Mapping[str, float | str]], None] = field(default=lambda step, evidence: None)
    suggest: bool = False


def singletons(diagnosis: Diagnosis, choice: Sequence[Candidate]) -> str | None:
    """What may be added without asking: physics that stands alone or is sure; of faults what is of one test.

    Halves of the instants may say that more is missing beside it: that is no doubt of what is sure.
    """
    first = choice[0]
    alone = len(choice) == 1 and diagnosis.verdict in ("named", "several")
    least = 0.5 if alone else SURE  # beside unknown heat, too
    return first.effect if first.probability >= least and _unasked(first.effect) else None


def _unasked(name: str) -> bool:
    """May it be added by what it predicts? What a sensor or clock did in one test may; that it always reads wrong is
    asked."""
    of = effect(name)
    return not of.fault or isinstance(of, (During, SensorDelay))


def improve(
    case: Case,
    supervisor: Supervisor,
    most: int = MOST,
    progress: Progress = no_progress,
    kinds: Sequence[str] | None = None,
) -> Improvement:
    """Diagnose and add until the model is adequate, the guide says no, or an addition is not accepted.

    A model that was never calibrated is calibrated first, if that gains. What the diagnosis cannot tell is not offered.
    Whether the best plain model is reached then, or what stops it, is told at every end.
    """
    stairs = [Step(errors(case), {})]
    if not case.model.values and (first := _first_fit(case, progress)):
        case = _with_step(case, first, supervisor, {}, stairs)
    while True:
        diagnosis = diagnose(case, kinds=kinds, progress=progress)
        progress(shorten(f"step {len(stairs)}: {diagnosis.words}", LINE, placeholder=" ..."))
        if offered(diagnosis) and sum(s.effect is not None for s in stairs) >= most:
            return ended(case, stairs, diagnosis, f"{counted(most, 'effect')} at most in one run")
        refused = list[Refusal]()
        step, document, why = _added(case, supervisor, diagnosis, stairs[-1].left_out_K, refused, progress)
        if step is None:
            return replace(ended(case, stairs, diagnosis, why), refused=refused)
        case = _with_step(case, step, supervisor, document, stairs)


def _first_fit(case: Case, progress: Progress) -> Revision | None:
    """A calibration that its own tests gain by; where it spoils others, one on all tests that a fit may use, if that
    predicts what is left out. None where nothing gains."""
    progress("calibrating")
    first = calibrate(case, progress=progress)
    if not first.accepted and any(t.role != "calibrate" for t in case.usable):
        progress("calibrating on all tests")
        whole = calibrate(case, TRAINING, progress)
        first = whole if whole.accepted else first
    return first if first.worth_keeping else None


def ended(case: Case, stairs: Sequence[Step], diagnosis: Diagnosis, why: str) -> Improvement:
    """The improvement, and beside why it ended how near it came to the best plain model."""
    yard, ours, last = yardstick(replace(case, tests=case.usable)), stairs[-1].left_out_K, stairs[-1].revision
    finite = {kind: K for kind, K in yard.left_out.items() if np.isfinite(K)} if yard else {}
    if not finite:
        why = f"{why}; no plain model can be learnt from these tests, so nothing says how good a model could be"
        return Improvement(case, tuple(stairs), diagnosis, why + rise_words(stairs))
    kind, K = min(finite.items(), key=lambda x: x[1])
    plain = f"{NAMES[kind]} {K:.2f} K"
    beside = f"each test predicted from the others: this model {ours:.2f} K, {plain}"
    if last is None or last.left_out_K is None:  # nothing was left out of its fit
        beside = f"as fitted this model leaves {ours:.2f} K; each test predicted from the others, {plain}"
    why = f"{beside}; {why}" if ours > WORTH * K else f"{why}; {beside}"
    return Improvement(case, tuple(stairs), diagnosis, why + rise_words(stairs), K)


def rise_words(stairs: Sequence[Step]) -> str:
    """The steps with which the error of the held-out tests rose; "" where there is none."""
    unseen = [[c for t in s.comparison.tests if t.role == "hold-out" for c in t.channels] for s in stairs]
    each = zip(pairwise(map(pooled, unseen)), stairs[1:], strict=True) if all(unseen) else ()
    rows = [(s.effect, s.step, was, now) for (was, now), s in each if now > was + LEAST]
    texts = [f"{_statements(e.split(TOGETHER)) if e else step}: {was:.2f} -> {now:.2f} K" for e, step, was, now in rows]
    return f"; held-out tests got worse with {', '.join(texts)}" if rows else ""


def _statements(names: Iterable[str]) -> str:
    """Effects as an engineer says them."""
    return " and ".join(effect(name).statement for name in names)


def _added(
    case: Case,
    supervisor: Supervisor,
    diagnosis: Diagnosis,
    left_out: float,
    refused: list[Refusal],
    progress: Progress,
) -> tuple[Revision | None, Mapping[str, float | str], str]:
    """The first of what is missing that is chosen and accepted, and its evidence; or None, and why.

    refused : grows by what is tried and does not predict
    """
    declined = ""
    for i in range(max(len(diagnosis.groups), 1)):
        choice = offered(replace(diagnosis, groups=diagnosis.groups[i:], named=diagnosis.named[i:]))
        choice = tuple(c for c in choice if not _stands(case, c.effect))  # larger than it is: nothing to add
        if not choice:
            break
        name = supervisor.choose(diagnosis, choice)
        if name is None:
            declined = declined or f"not added: {' or '.join(c.words for c in choice)}"
            if not supervisor.suggest:
                break
            continue
        for names in dict.fromkeys((sure_set(diagnosis, name, supervisor), (name,), needed_together(diagnosis, name))):
            new = names and not any(_stands(case, one) for one in names)
            if new and (step := _accepted(add, case, names, refused, progress)):
                return step, evidence(diagnosis, next(c for c in choice if c.effect == name)), ""
    first = "" if declined or not refused else str(refused[0])
    further, document = further_step(case, supervisor, diagnosis, left_out, refused, progress)
    why = declined or first or diagnosis.words
    others = len(refused) - bool(first)
    also = f"; tried and refused: {counted(others, 'other explanation')}" if others else ""
    return further, document, why + also


def _stands(case: Case, name: str) -> bool:
    """Is an effect in the model, an event perhaps with its ends told otherwise?"""
    new, present = effect(name), [effect(e.name) for e in case.model.effects]
    return any(new.name == e.name or (isinstance(new, During) and new.repeats(e)) for e in present)


def further_step(
    case: Case,
    supervisor: Supervisor,
    diagnosis: Diagnosis,
    left_out: float,
    refused: list[Refusal],
    progress: Progress,
) -> tuple[Revision | None, Mapping[str, float | str]]:
    """What else is accepted where the diagnosis offers nothing that is; or None.

    Where plain models are better by more than a tenth: the likeliest sets, of what cannot be told apart the likelier.
    Where a free network is not worse by more than that: all that it has and the model lacks, in one step, since terms
    that need each other are worth nothing alone. Where it is better by more than that: each of them, too.

    left_out : error (K) of the model on tests left out in turn
    refused : what was tried before, which is not tried again; grows by what is
    """
    yard = yardstick(replace(case, tests=case.usable)) if supervisor.suggest else None
    if yard is None:
        return None, {}
    best, free = min(yard.left_out.values()), yard.left_out["free_network"]
    trials, before = list[Trial](), {frozenset(r.effects) for r in refused}
    if best * WORTH < left_out:
        likely = [o for o in diagnosis.odds if o.causes and all(map(_unasked, o.causes))][:LIKELY]
        trials += [(o.causes, {"probability": o.probability, "verdict": diagnosis.verdict}) for o in likely]
    if free < WORTH * left_out:
        every = suggested_effects(yard.terms, case)
        alone = [(s,) for s in every if s.effects] if free * WORTH < left_out else []
        for some in (tuple(s for s in every if s.effects), *alone):
            share = max((s.share for s in some), default=0.0)
            words = ", ".join(s.words for s in some)
            trials.append((tuple(n for s in some for n in s.effects), {"free network": words, "share": share}))
    for names, document in {names: document for names, document in trials if names}.items():
        if frozenset(names) in before or any(_stands(case, one) for one in names):
            continue
        if step := _accepted(_present, case, names, refused, progress):
            return step, document
    return None, {}


def _accepted(
    fit: Callable[[Case, Sequence[str], Progress], Revision],
    case: Case,
    names: Sequence[str],
    refused: list[Refusal],
    progress: Progress,
) -> Revision | None:
    """The step that brings some effects, if it stands; else None, and why is among what was refused."""
    try:
        step = fit(case, names, progress)
    except NoSolution:
        refused.append(Refusal(tuple(names), _statements(names), "the model runs away with it"))
        return None
    if not step.accepted:
        refused.append(Refusal(tuple(names), _statements(names), step.why))
    return step if step.accepted else None


def _present(case: Case, names: Sequence[str], progress: Progress) -> Revision:
    """Some effects added in one step, without those that are fitted to nothing beside the others."""
    step = add(case, names, progress)
    each = (step.effect or "").split(TOGETHER)
    left = [name for name, check in zip(each, step.checks, strict=False) if check.passed]
    return add(case, left, progress) if 0 < len(left) < len(names) else step


def _with_step(
    case: Case, step: Revision, supervisor: Supervisor, evidence: Mapping[str, float | str], stairs: list[Step]
) -> Case:
    supervisor.keep(step, evidence)
    stairs.append(Step(step.after, evidence, step))
    return with_model(case, step.model)


def offered(diagnosis: Diagnosis) -> tuple[Candidate, ...]:
    """The first group's candidates; none where the diagnosis cannot tell, or nothing is missing."""
    first = diagnosis.groups[0] if diagnosis.groups and diagnosis.verdict != "absorbed" else ()
    rows = [c for c in diagnosis.candidates if c.effect in first]
    return tuple(rows) if all(c.decision in ("named", "group") for c in rows) else ()


def sure_set(diagnosis: Diagnosis, name: str, supervisor: Supervisor) -> tuple[str, ...]:
    """The set of effects that is sure to be missing whole, if an effect is one of it and nobody has to be asked; ().

    Part of it, fitted alone, bends to what the others do, and what it leaves may be like nothing that is known.
    """
    if not supervisor.suggest or not diagnosis.odds or diagnosis.odds[0].probability < SURE:
        return ()
    likeliest = diagnosis.odds[0].causes
    return likeliest if name in likeliest and all(one == name or _unasked(one) for one in likeliest) else ()


def needed_together(diagnosis: Diagnosis, name: str) -> tuple[str, ...]:
    """The most probable set of effects that this one is in with others; () where there is none."""
    sets = [o for o in diagnosis.odds if len(o.causes) > 1 and name in o.causes]
    return max(sets, key=lambda o: o.probability).causes if sets else ()


def evidence(diagnosis: Diagnosis, candidate: Candidate) -> dict[str, float | str]:
    """What speaks for an effect, as the history keeps it."""
    numbers: dict[str, float | str] = {
        "probability": candidate.probability,
        "score": candidate.score,
        "threshold": candidate.threshold,
        "decision": candidate.decision,
        "verdict": diagnosis.verdict,
    }
    return numbers | ({"confused_with": ", ".join(candidate.confused_with)} if candidate.confused_with else {})
