"""The table of doubt: everything a model and its measurement get wrong, with how much and why. One place for all of it.

The priors of a fit and the covariance of the model error are made from this one table. A case may carry a wider one
(`Case.doubt`, `widened`). Deviations are one standard deviation of a normal distribution.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from geom.errors import InputError

Doubt = Mapping[str, float]


@dataclass(frozen=True)
class Line:
    """One doubt.  sd : standard deviation in `unit`;  reason : where the number comes from"""

    sd: float
    unit: str
    reason: str


TABLE: Mapping[str, Line] = MappingProxyType(
    {
        # what a fit may move
        "start": Line(0.5, "K", "a machine that stood overnight is uneven by half a kelvin"),
        "gain": Line(0.03, "1", "a thermocouple's place has another share of the rise than the node's mean"),
        "gain of stream": Line(0.1, "1", "a stream is not of one temperature: no thermometer reads its mean"),
        "gain of reading": Line(
            0.004, "1", "class 1 thermocouples (IEC 60584-1), where a node is what its sensor reads"
        ),
        "lag": Line(10.0, "s", "diffusion in the part a sensor sits in, L^2 / 2a of some centimetres of metal"),
        "boundary": Line(0.5, "K", "a thermometer of room or inlet reads one spot"),
        "clock": Line(1.0, "s", "recorders are started by hand or by a trigger"),
        "step in sample": Line(
            0.29, "sample", "an input that jumps does so anywhere between two samples: 1 / sqrt(12)"
        ),
        "input exponent": Line(0.15, "1", "scatter of published exponents of speed and flow"),
        "difference exponent": Line(0.1, "1", "scatter of published exponents of free convection"),
        "share": Line(0.15, "1", "scatter of published film sets over the bodies they are spread over"),
        "warming": Line(0.01, "1/K", "grease thins by about a per cent and kelvin"),
        # what no parameter of a fit stands for: the covariance of the model error
        "group": Line(0.1, "1", "links that share a parameter differ by what drawings and tolerances say"),
        "joint": Line(0.25, "1", "gaps of one kind of contact scatter by a factor of two: bearings 0.2 to 0.4 mm"),
        "bearing": Line(0.25, "1", "friction of two bearings of a kind differs with load, grease and seals"),
        "split": Line(0.1, "1", "how one loss divides over the nodes that carry it"),
        "load": Line(0.1, "1", "iron, magnets and bearings lose more under load than at rest: stray load losses"),
        "conductivity": Line(0.15, "1", "catalogue values of laminated and wound parts"),
        "capacity": Line(0.05, "1", "masses by drawing, heat capacities by catalogue"),
        "film exponent": Line(0.08, "1", "a coefficient taken as constant follows the temperature difference a little"),
        "bridge": Line(0.1, "1", "heat that passes beside a node's mean, of the conductance through it"),
        "core": Line(0.5, "1", "share of a node's mass behind a resistance of its own"),
        "core time": Line(30.0, "s", "time in which such a core follows: copper in a slot, iron behind teeth"),
        "placement": Line(0.08, "1", "share of the neighbours' temperatures in a reading"),
        "placement in stream": Line(0.1, "1", "a thermometer in a stream reads one streamline"),
        "total": Line(
            0.05,
            "of the largest rise",
            "all of these together at a record: what sound machines need is 2 to 4 % (hidden-effects.md)",
        ),
        "slow": Line(0.02, "1", "slow misfit as a share of the rise: 4 % at two deviations counts as a good model"),
        "misfit": Line(
            2.0, "times the slow misfit", "what a model of this kind may be wrong by is known within a factor"
        ),
        "wander": Line(0.5, "1", "share of a sensor's accuracy that wanders within a test; the rest is bias and slope"),
        "fast": Line(0.25, "1", "fast misfit as a share of the slow one"),
        "flow": Line(0.03, "1", "flow meters of a bench, in all tests and once more in each by itself"),
        "between samples": Line(
            1.0, "1", "of the mean square that a current gains if it jumps where it is drawn straight"
        ),
        "input": Line(0.02, "1", "shunts, torque flanges, voltage dividers, where the sheet says nothing"),
        "law": Line(0.15, "1", "a missing film or loss follows its correlation no better than published ones scatter"),
        # what held in one test or for a while
        "switched": Line(2.0, "of the usual size", "what is switched is larger than what a model forgets"),
        "answer": Line(0.05, "1", "share of answers that are wrong: people forget one thing in twenty"),
    }
)

USUAL: Doubt = {name: line.sd for name, line in TABLE.items()}  # a dictionary, for other processes take a case along


def widened(lines: Mapping[str, float], where: str = "[doubt]") -> Doubt:
    """The table with some lines replaced by wider ones."""
    for name, sd in lines.items():
        if name not in TABLE:
            raise InputError(f"unknown line of doubt '{name}'", where, f"known: {', '.join(TABLE)}")
        if not TABLE[name].sd <= sd < float("inf"):
            raise InputError(f"'{name}' of {sd} is no wider than usual", where, f"{TABLE[name].sd} or more")
    return {**USUAL, **lines}


def split_answers(doubt: Doubt, answers: Mapping[str, bool | float]) -> tuple[Doubt, dict[str, bool]]:
    """The table with what the user knows better of boundaries and sensors, as "boundary:NAME" and "bias:NAME" (K); and
    the answers that are yes or no."""
    sizes = {subject: float(size) for subject, size in answers.items() if not isinstance(size, bool)}
    return {**doubt, **sizes}, {about: yes for about, yes in answers.items() if isinstance(yes, bool)}


def boundary_doubt(doubt: Doubt, name: str) -> float:
    """Standard deviation (K) of a boundary's thermometer."""
    return doubt.get(f"boundary:{name}", doubt["boundary"])


@dataclass(frozen=True)
class Odds:
    """How often something is missing, before a look at the readings.  share : of all cases;  reason : why"""

    share: float
    reason: str


PRIOR: Mapping[str, Odds] = MappingProxyType(
    {
        "nothing": Odds(0.5, "half of the models that are asked about are good enough"),
        "effect": Odds(0.20, "one physical effect explains most disagreements"),
        "fault": Odds(0.08, "a sensor, a meter or a clock is at fault in one bench of ten"),
        "heat": Odds(0.05, "no catalogue is complete"),
        "condition": Odds(0.07, "a fan, lid, hose, cover or meter differed in one test or for a while"),
        "two": Odds(0.10, "where one thing was forgotten another often was"),
    }
)

# How often a kind of effect is the one that is missing, relative to the others (1).
RARE: Mapping[str, Odds] = MappingProxyType(
    {
        "sensor.swap": Odds(0.03, "plugs are marked"),
        "sensor.gain": Odds(0.3, "a wrong thermocouple type is seen at once"),
        "coupling": Odds(0.3, "two solids that touch are seldom forgotten"),
        "mass": Odds(0.3, "masses are weighed"),
        "input.factor": Odds(1.0, "wrong ranges and shunts are as frequent as sensors that are off"),
        "input.offset": Odds(0.3, "a zero is set before a test more often than a range is"),
        "law": Odds(0.3, "exponents and factors of a law are off more often than its shape"),
        "loss.factor": Odds(0.3, "calibration moves declared losses already"),
    }
)

TEMPER: Mapping[str, Odds] = MappingProxyType(
    {
        "temper": Odds(1.5, "divides log evidence: no model is quite right, so all evidence of one is too sure"),
        "temper per nat": Odds(
            0.01, "a law off by 15 % leaves 2 % of what its effect explains: no rival shall live on it"
        ),
        "sharpness": Odds(1.25, "power of the odds as stated: what is said too carefully on other kinds of machine"),
    }
)
SHARPNESS = TEMPER["sharpness"].share
SIZES = (0.3, 1.0, 3.0)  # of an effect's usual size: nobody knows it better than within a decade

# What else can move a verdict, and no case widens: how errors, heat of unknown cause and dead channels look.
SHAPE: Mapping[str, Line] = MappingProxyType(
    {
        "fast time": Line(120.0, "s", "of the fast misfit: cores and sensors follow within minutes"),
        "slow time": Line(1200.0, "s", "of the slow misfit: bodies of a motor follow within tens of minutes"),
        "times": Line(0.8, "ln", "either time is known within a factor of two"),
        "resolved": Line(0.03, "K", "a logger of 0.1 K rounds by 0.03 K (1 / sqrt(12)): no residual is surer"),
        "readings": Line(4.0, "readings", "of `resolved` that the noise of a record is worth before any is seen"),
        "heat time": Line(1200.0, "s", "heat that follows no input changes as bodies do"),
        "heat step": Line(60.0, "s", "or as fast as something is switched"),
        "heat over input": Line(
            1.0, "of an input's range", "laws of losses and films are gentle curves of their input"
        ),
        "heat size": Line(0.5, "1", "of the machine's own conductance or power, as an effect of the catalogue has it"),
        "one whole test": Line(0.4, "1", "a test is set up anew; half of what differs for once is left for stretches"),
        "several whole tests": Line(0.1, "1", "the same in two or three tests is rarer"),
        "frozen": Line(0.25, "of a record", "without one change, of a channel that resolves what its neighbours do"),
        "jump": Line(
            2.0, "times any other step", "by which a channel that stuck for less leaves the value it stuck at"
        ),
        "moving": Line(3.0, "K", "what those must move by: ten steps of a coarse logger"),
    }
)
FORM: Doubt = {name: line.sd for name, line in SHAPE.items()}

# What a statement costs; a wrong name is one.
COSTS: Mapping[str, Odds] = MappingProxyType(
    {
        "wrong": Odds(1.0, "the unit: a bench is changed for nothing"),
        "miss": Odds(0.5, "what is missed stays in the model, and its error can be seen there"),
        "abstain": Odds(0.1, "a further test for nine answers that are right at once"),
    }
)


def temper(nats: float) -> float:
    """What divides all log evidence where the best explanation has so many nats more than nothing.

    An effect whose law is off by a share q leaves q^2 of its evidence to whatever looks like that; it grows with the
    effect, so the divisor does too.
    """
    return TEMPER["temper"].share + TEMPER["temper per nat"].share * max(nats, 0.0)


def nats_worth(log_odds: float) -> float:
    """Log evidence that counts as some log odds once it is tempered."""
    return TEMPER["temper"].share * log_odds / (1.0 - TEMPER["temper per nat"].share * log_odds)


def markdown() -> str:
    """The table as docs/diagnosis.md shows it."""
    rows = [f"| {name} | {line.sd:g} {line.unit} | {line.reason} |" for name, line in TABLE.items()]
    shape = [f"| {name} | {line.sd:g} {line.unit} | {line.reason} |" for name, line in SHAPE.items()]
    odds = [f"| {name} | {100.0 * o.share:g} % | {o.reason} |" for name, o in PRIOR.items()]
    tempers = [f"| {name} | {o.share:g} | {o.reason} |" for name, o in TEMPER.items()]
    rare = [f"| {name} | x {o.share:g} | {o.reason} |" for name, o in RARE.items()]
    costs = [f"| {name} | {o.share:g} | {o.reason} |" for name, o in COSTS.items()]
    head = ["| doubt | one sigma | reason |", "|---|---|---|", *rows, ""]
    prior = ["| before the readings | share | reason |", "|---|---|---|", *odds, *rare, *tempers, ""]
    form = ["| shape | value | reason |", "|---|---|---|", *shape, ""]
    return "\n".join([*head, *form, *prior, "| statement | cost | reason |", "|---|---|---|", *costs])
