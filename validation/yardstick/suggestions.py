"""What a free network knows and a declared one lacks: place, law, start; in words and as effects of the catalogue."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geom.table import TableRow
from lumped.model.network import Link, Network, Source
from measured.case import Case, Test
from validation.effects import catalogue
from validation.effects.base import Interval, law_sentence
from validation.parameters.unknowns import scene_of, standing
from validation.yardstick.network_terms import follows, input_term, inputs_of, largest_inputs, term_elements
from validation.yardstick.terms import Term


@dataclass(frozen=True)
class Suggestion(TableRow):
    """Heat between two places, or put in at one, that follows inputs as nothing declared does.

    other : the link's other end, "" of a loss;  inputs : that it follows and what is declared does not
    rest, most : value where nothing turns or flows, and at the largest inputs;  unit : W/K, W; 1/s, K/s per capacity
    interval : of `most`, over the fits with one test left out
    starts : effect that adds it -> where a fit may begin; empty where no capacity is known
    effects : those of them to be added, more than one where two powers of an input are needed
    share : of all heat that the sensor exchanges
    """

    properties = ("words",)

    place: str
    other: str
    inputs: tuple[str, ...]
    rest: float
    most: float
    interval: Interval
    unit: str
    share: float
    starts: Mapping[str, float]
    effects: tuple[str, ...]

    @property
    def words(self) -> str:
        """stator to coolant: 18.5 W/K at rest, 29.9 at the largest speed_rpm [28.1, 31.2]"""
        what = f"{self.place} to {self.other}" if self.other else f"a loss at {self.place}"
        where = f"the largest {' and '.join(self.inputs)}" if self.inputs else ""
        return law_sentence(what, self.rest, self.most, self.unit, where, self.interval)


def suggested_effects(terms: Sequence[Term], case: Case) -> tuple[Suggestion, ...]:
    """Of the terms that a free network needs those that the model as it stands lacks, what carries most heat first.

    Effects sit where the case's network has places for them, as `add` wants it: a link that was added is not a place of
    its own.
    """
    network = standing(case)
    groups: dict[tuple[str, ...], list[Term]] = {}
    for term in terms:
        groups.setdefault((term.kind, *sorted({term.place, term.other or term.place})), []).append(term)
    every = (_suggestion([t for t in group if t.place == group[0].place], case, network) for group in groups.values())
    return tuple(sorted((s for s in every if s), key=lambda s: -s.share))


def _suggestion(group: Sequence[Term], case: Case, network: Network) -> Suggestion | None:
    """Of the terms between two places, or at one; None where what is declared can do the same."""
    first, sizes = group[0], largest_inputs(case.usable)
    laws = [x.law for x in term_elements(network, first)]
    lacking = [t for t in group if not any(follows(law, inputs_of(t), sizes) for law in laws)]
    if not lacking:
        return None
    inputs = tuple(dict.fromkeys(name for t in lacking for name in sorted(inputs_of(t))))
    absolute = first.unit.startswith("W")
    starts = _starts(first, set(inputs), sum(t.value for t in lacking), case, network) if absolute else {}
    terms = {one.name: t.value for t in lacking if absolute and (one := input_term(t, network, sizes))}
    return Suggestion(
        first.place,
        first.other,
        inputs,
        sum(t.value for t in group if not t.input),
        sum(t.value for t in group),
        (sum(t.low for t in group), sum(t.high for t in group)),
        first.unit,
        sum(t.share for t in lacking),
        starts or terms,
        tuple(starts)[:1] or tuple(terms),
    )


def _starts(term: Term, inputs: set[str], value: float, case: Case, network: Network) -> dict[str, float]:
    """Effects that add a law of just these inputs there, with the amplitude that makes `value` at their largest."""
    tests, out = case.usable, dict[str, float]()
    for one in catalogue(scene_of(case)):
        if one.fault or one.mapping != "amplitude":
            continue
        larger = one.extend(network)
        old = {*(x.name for x in network.links), *(x.name for x in network.sources)}
        new = [x for x in term_elements(larger, term) if x.name not in old and set(x.law.reads) == inputs]
        size = sum(_largest(x, tests) for x in new)
        if size > 0.0:
            out[one.name] = value / size
    return out


def _largest(element: Link | Source, tests: Sequence[Test]) -> float:
    """The largest conductance (W/K) or loss (W) of an element of amplitude one over some tests."""
    area = float(np.max(np.abs(element.vals))) if isinstance(element, Link) else 1.0
    sizes = [np.abs(element.law.size(t.inputs)) for t in tests if set(element.law.reads) <= set(t.inputs)]
    return area * max((float(np.max(x)) for x in sizes), default=0.0)
