"""What a diagnosis says: the seven verdicts, and the rows of its tables."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from geom.errors import InputError
from geom.table import Table, TableResult, TableRow, percent, select_fields
from geom.text import table
from validation.tables import candidates_table, diagnosis_tables

if TYPE_CHECKING:
    from validation.bases.which_base import BaseDeviance
    from validation.inference.contradiction import Contradiction
    from validation.inference.missing_heat import MissingHeat

Verdict = Literal["adequate", "named", "group", "several", "outside", "absorbed", "data"]
Decided = Literal["named", "group", "no", "cannot-tell"]
Pair = tuple[float, float]

# Of the document of a diagnosis, in its order
FIRST_FIELDS: tuple[str, ...] = ("verdict", "words", "preliminary", "named", "groups", "candidates", "cannot_see")
FIRST_FIELDS += ("where", "next_tests", "next_sensors", "odds", "explanations", "p_nothing", "events", "remainder")
FIRST_FIELDS += ("doubts", "question", "contradiction", "checks", "without", "only")
MOST_ODDS, LEAST_PROBABILITY = 5, 0.005  # explanations of a diagnosis that is printed, and from which probability


@dataclass(frozen=True)
class Candidate(TableResult):
    """One effect that may be missing.

    score : log evidence against nothing missing (nats);  threshold : from which it is more probable than nothing
    probability : that it is among what is missing
    explained : share of the residual's sum of squares it removes
    rmse_K, holdout_rmse_K : (before, after) on the tests used and on the held-out ones, where it was refitted
    tests : (name, before, after, held out) of each test, error (K) without and with it, where it was refitted
    absorbed : share of its trace that the calibration takes;  twin : the calibrated parameter that does the same
    words : what it is, where and when;  note : the record that speaks against it
    """

    effect: str
    score: float
    threshold: float
    value: float
    unit: str
    ci95: Pair
    decision: Decided
    explained: float | None = None
    rmse_K: Pair | None = None
    holdout_rmse_K: Pair | None = None
    confused_with: tuple[str, ...] = ()
    absorbed: float = 0.0
    smallest_detectable: float = float("inf")
    twin: str | None = None
    title: str = ""
    words: str = ""
    isolating_test: str = ""
    note: str = ""
    probability: float = 0.0
    tests: tuple[tuple[str, float, float, bool], ...] = ()

    def tables(self) -> tuple[Table, ...]:
        """The row that a diagnosis shows of it."""
        return (candidates_table([self.document()]),)

    def document(self) -> dict:
        special = ("value", "unit", "ci95", "rmse_K", "holdout_rmse_K", "tests")
        out = select_fields(self, *(k for k in vars(self) if k not in special))
        out["amplitude"] = {"value": self.value, "unit": self.unit, "ci95": list(self.ci95)}
        out["rmse_K"], out["holdout_rmse_K"] = _pair(self.rmse_K), _pair(self.holdout_rmse_K)
        out["tests"] = [dict(zip(("test", "before", "after", "held_out"), t, strict=True)) for t in self.tests]
        return out


def _pair(pair: Pair | None) -> dict | None:
    return None if pair is None else {"before": pair[0], "after": pair[1]}


@dataclass(frozen=True)
class DetectionLimit(TableRow):
    """An effect that these tests could not have shown unless it were larger than this."""

    effect: str
    words: str
    smallest_detectable: float
    unit: str
    absorbed_by: str | None = None


@dataclass(frozen=True)
class CurrentLevel(TableRow):
    """input : a current;  level_A : at which it is held, else its rms;  share_of_rms : of the record at hand"""

    input: str
    level_A: float
    share_of_rms: float


@dataclass(frozen=True)
class Experiment:
    """What would separate hypotheses: "test", a candidate test, or "place", a further thermocouple in the same tests.

    separates : pairs;  predicted_gain : the deviance by which (20 is decisive);  hours : what it costs
    currents : of a candidate test;  current_factor : by which they were brought down so that nothing gets too hot
    """

    kind: Literal["test", "place"]
    name: str
    separates: tuple[str, ...]
    predicted_gain: float
    hours: float
    why: str = ""
    currents: tuple[CurrentLevel, ...] = ()
    current_factor: float = 1.0

    def document(self) -> dict:
        """JSON: what is to be done stands under its kind."""
        return {self.kind: self.name, **select_fields(self, *(k for k in vars(self) if k not in ("kind", "name")))}


@dataclass(frozen=True)
class Odds(TableRow):
    """The probability of one hypothesis: "nothing", "kind@place", "kind@place + kind@place", "heat@place".

    log_evidence : over that of nothing (nats), None for "others"
    tests : those a condition held in;  begin_s, end_s : when, if it held once and for a while
    faults : those of the effects that are sure whatever else is, such as a frozen sensor
    """

    hypothesis: str
    effects: tuple[str, ...]
    probability: float
    log_evidence: float | None = None
    tests: tuple[str, ...] = ()
    begin_s: float | None = None
    end_s: float | None = None
    faults: tuple[str, ...] = ()

    @property
    def causes(self) -> tuple[str, ...]:
        """The effects without plain faults of sensors, which no model could have."""
        return tuple(name for name in self.effects if name not in self.faults)


@dataclass(frozen=True)
class Explanation:
    """All hypotheses with one leading cause. Those of a diagnosis hold every hypothesis once, and sum to one.

    cause : an effect, "heat@place", "nothing" or "others";  words : the same in plain words
    probability : of them all;  alone : of the cause by itself;  partners : (cause, words, probability) of what is
        there as well where this one is, most probable first
    """

    cause: str
    words: str
    probability: float
    alone: float = 0.0
    partners: tuple[tuple[str, str, float], ...] = ()

    def document(self) -> dict:
        """JSON of the explanation."""
        partners = [dict(zip(("cause", "words", "probability"), p, strict=True)) for p in self.partners]
        return {**vars(self), "partners": partners}


@dataclass(frozen=True)
class Question(TableRow):
    """A yes-or-no question that needs no test.

    about : what `answer` takes;  yes : probability of yes;  nats : information expected of an answer
    """

    about: str
    words: str
    yes: float
    nats: float


@dataclass(frozen=True)
class PossibleEvent(TableRow):
    """Something that may have been different for a while.  spans : {"test", "begin_s", "end_s"}

    probability : of all that it may have been;  effect : the most probable of these, its value refitted where it was
    """

    event: str
    words: str
    spans: tuple[dict, ...]
    probability: float
    effect: str
    title: str
    value: float
    unit: str


@dataclass(frozen=True)
class Check(TableRow):
    """Something that a verdict claims, held against its own numbers.

    kind : "record" (far from the model), "tests" (contradict each other), "doubts" (forgive too much), "persistence" or
    "free network" (predict better), "refit" (is worse in most tests);  where : of the worst;  number, limit : in `unit`
    words : what would have to differ
    """

    properties = ("contradicts",)
    kind: str
    where: str
    number: float
    limit: float
    unit: str
    words: str

    @property
    def contradicts(self) -> bool:
        """Whether the verdict cannot stand beside it."""
        return self.number > self.limit


@dataclass(frozen=True)
class RecordDoubt(TableRow):
    """What the table of doubt adds up to at one record (K, one sigma).

    sum_K : of all its lines;  counted_K : after the bound on their sum;  largest : the line that is most of it
    """

    channel: str
    record: str
    sum_K: float
    counted_K: float
    largest: str


@dataclass(frozen=True)
class Remainder(TableRow):
    """A record that stays off with what is named in the model.

    error_K : rms;  model_K : how much of it the doubts of the model take away;  doubt : the one that does most of it
    effect : a second effect that would bring it to brought_K, with its probability;  test : the test that shows it
    """

    properties = ("words",)
    channel: str
    record: str
    error_K: float
    model_K: float
    doubt: str
    effect: str
    probability: float
    brought_K: float
    test: str

    @property
    def forgiven(self) -> str:
        """What the doubts of the model take, where that is most of the error."""
        if self.model_K <= 0.5 * self.error_K:
            return ""
        where = f"{self.channel} in {self.record}"
        return f"{self.model_K:.1f} of the {self.error_K:.1f} K at {where} are forgiven as {self.doubt}"

    @property
    def words(self) -> str:
        text = f"{self.channel} is still {self.error_K:.1f} K off in {self.record}"
        if self.model_K > 0.5 * self.error_K:
            text += f"; {self.model_K:.1f} K of it is within the doubts of the model, most of all {self.doubt}"
        if not self.effect:
            return f"{text}; no second effect explains it."
        return (
            f"{text}; {self.effect} would bring it to {self.brought_K:.1f} K (odds {percent(self.probability)}). "
            f"To tell: {self.test}."
        )


@dataclass(frozen=True)
class Diagnosis(TableResult):
    """The answer. named : the effects to add, best first (one per group); words : the verdict in a sentence.

    bases : every base that a test may have stood on, where the network knows several
    odds : every hypothesis that carries weight, most probable first, summing to one;  p_nothing : of nothing missing
    explanations : the same by leading cause, as it is shown
    events : when something may have been different for a while, most probable first
    remainder : what is still off with what is named in the model
    doubts : what the table of doubt adds up to at each record, the largest first
    contradiction : what would have to differ between the tests
    question : what to ask the user, where an answer would tell more than a guess
    checks : what the verdict was held against; what contradicts one has changed it
    without, only : what the user left out of the question, see Scope
    stated_odds : effect, factor and reason of odds that differ in this case
    preliminary : the search was stopped at its first odds
    small_network_K : channel -> what the small network that was run is off from the case's own; empty where that was
    """

    verdict: Verdict
    words: str
    named: tuple[str, ...]
    groups: tuple[tuple[str, ...], ...]
    candidates: tuple[Candidate, ...]
    cannot_see: tuple[DetectionLimit, ...]
    where: "tuple[MissingHeat, ...]"
    next_tests: tuple[Experiment, ...]
    rmse_K: float
    floor_K: float
    threshold: float
    pulls: tuple[tuple[str, float, float], ...] = ()
    cosine: dict[str, dict[str, float]] = field(default_factory=dict)
    next_sensors: tuple[Experiment, ...] = ()
    bases: "tuple[BaseDeviance, ...]" = ()
    odds: tuple[Odds, ...] = ()
    explanations: tuple[Explanation, ...] = ()
    p_nothing: float = 1.0
    events: tuple[PossibleEvent, ...] = ()
    remainder: tuple[Remainder, ...] = ()
    doubts: tuple[RecordDoubt, ...] = ()
    contradiction: "Contradiction | None" = None
    question: Question | None = None
    checks: tuple[Check, ...] = ()
    without: tuple[str, ...] = ()
    only: tuple[str, ...] = ()
    stated_odds: tuple[tuple[str, float, str], ...] = ()
    preliminary: bool = False
    small_network_K: Mapping[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        likely = [x for x in self.explanations if x.probability > LEAST_PROBABILITY] or self.explanations[:1]
        rows = [[x.words, percent(x.probability)] for x in likely[:MOST_ODDS]]
        return f"{self.words[:1].upper()}{self.words[1:]}\n{table(['explanation', 'probability'], rows)}"

    def tables(self) -> tuple[Table, ...]:
        """Hypotheses, candidates, events, contradictions, what would decide, and what cannot be seen."""
        return diagnosis_tables(self.document())

    @property
    def best(self) -> str:
        """The effect to add first, "kind@place". Raises InputError where none is named: the verdict says why."""
        if not self.named:
            raise InputError(f"no effect is named: {self.words}", f"verdict '{self.verdict}'")
        return self.named[0]

    def document(self) -> dict:
        return {
            **select_fields(self, *FIRST_FIELDS),
            "stated_odds": [dict(zip(("effect", "factor", "reason"), o, strict=True)) for o in self.stated_odds],
            **select_fields(self, "rmse_K", "floor_K", "threshold"),
            "pulls": [{"parameter": n, "value": v, "prior_deviations": p} for n, v, p in self.pulls],
            "confusion": self.cosine,
            **select_fields(self, "bases"),
        }
