"""The table of doubt: everything a model and its measurement get wrong, with how much and why. One place for all of it.

The priors of a fit and the covariance of the model error are made from this one table, doubt.csv. A case may carry a
wider one (`Case.doubt`, `widened`). Deviations are one standard deviation of a normal distribution.
"""

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from geom.errors import InputError

Doubt = Mapping[str, float]


@dataclass(frozen=True)
class Line:
    """One doubt.  sd : standard deviation in `unit`;  reason : where the number comes from"""

    sd: float
    unit: str
    reason: str


@dataclass(frozen=True)
class Odds:
    """How often something is missing, before a look at the readings.  share : of all cases;  reason : why"""

    share: float
    reason: str


with Path(__file__).with_name("doubt.csv").open(encoding="utf-8", newline="") as _file:
    _ROWS = list(csv.DictReader(row for row in _file if not row.startswith("#")))  # after #: what those below are


def _lines(table: str) -> Mapping[str, Line]:
    rows = (row for row in _ROWS if row["table"] == table)
    return MappingProxyType({row["name"]: Line(float(row["number"]), row["unit"], row["reason"]) for row in rows})


def _odds(table: str) -> Mapping[str, Odds]:
    rows = (row for row in _ROWS if row["table"] == table)
    return MappingProxyType({row["name"]: Odds(float(row["number"]), row["reason"]) for row in rows})


TABLE, SHAPE = _lines("doubt"), _lines("shape")
PRIOR, RARE, TEMPER, COSTS = _odds("prior"), _odds("rare"), _odds("temper"), _odds("cost")
USUAL: Doubt = {name: line.sd for name, line in TABLE.items()}  # a dictionary, for other processes take a case along
FORM: Doubt = {name: line.sd for name, line in SHAPE.items()}
SHARPNESS = TEMPER["sharpness"].share
SIZES = (0.3, 1.0, 3.0)  # of an effect's usual size: nobody knows it better than within a decade


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


def temper(nats: float) -> float:
    """What divides all log evidence where the best explanation has so many nats more than nothing.

    An effect whose law is off by a share q leaves q^2 of its evidence to whatever looks like that; it grows with the
    effect, so the divisor does too.
    """
    return TEMPER["temper"].share + TEMPER["temper per nat"].share * max(nats, 0.0)


def nats_worth(log_odds: float) -> float:
    """Log evidence that counts as some log odds once it is tempered."""
    return TEMPER["temper"].share * log_odds / (1.0 - TEMPER["temper per nat"].share * log_odds)
