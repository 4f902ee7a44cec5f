"""What the formulas of a model get wrong: exponents of inputs and of the temperature difference, shares of one film.

No correlation has the right exponent for one machine. A fit that may not move them presses their error into whatever
else it may move. So every film and loss brings, as nuisances with narrow priors, an exponent for each input its law
follows, one for the temperature difference of free convection, and the share of each part that one film is spread over.
They are neutral at zero (shares at one). An effect that was added brings its exponents along as well.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array
from lumped.integration.curve import ROUNDING
from lumped.model.network import Link, Network, Parameter, Source
from lumped.transfer.laws import (
    CONSTANT,
    FilmTable,
    Inputs,
    Law,
    Linear,
    Power,
    Table,
    TemperatureLaw,
    WithTemperature,
    Wrapped,
)
from lumped.transfer.ranges import within_silence
from measured.doubt import USUAL, Doubt
from validation.effects.base import with_parameter
from validation.effects.build import copy_elements

REFERENCE_RISE_K = 40.0  # a usual rise: there an exponent moves no coefficient
REFERENCE_DEGC = 40.0  # a usual temperature of a bearing
# K, each about twice the last: the logarithm of a rise is nearly straight between two.
KNOTS = (0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0)
FARTHEST = np.log(10.0)  # of a rise over the reference: beyond a decade nothing is known of an exponent
EXACT_LOSSES = ("copper", "measured")  # losses whose law is not in doubt


GREASE = Linear(1.0, REFERENCE_DEGC + 1.0)  # T - REFERENCE_DEGC: friction falls as the grease warms


@dataclass(frozen=True)
class ExponentError(Wrapped):
    """d law / d exponent of one input: law * ln(law(u) / law(reference)) with the other inputs at their reference.

    reference : level of each input at which the law is right
    """

    input: str
    reference: Mapping[str, float]

    def __hash__(self) -> int:
        return hash((self.base, self.input))  # a mapping has none

    @property
    def at_work(self) -> bool:
        """Is the law anything at the reference? One of a flow that turned round is nothing while it runs forwards."""
        return bool(np.any(self.base.size({k: np.array([v]) for k, v in self.reference.items()})))

    def factor(self, inputs: Inputs) -> Array | float:
        now = np.abs(np.asarray(inputs[self.input], float))
        level = {k: np.full_like(now, v) for k, v in self.reference.items()}
        at = np.abs(np.asarray(self.base.size({**level, self.input: now}), float))
        right = np.abs(np.asarray(self.base.size(level), float))
        log_ratio = np.log(np.maximum(at, 1e-12 * right) / right)
        follows = np.abs(log_ratio) > ROUNDING  # the chord of a straight law does not
        return np.asarray(self.base.factor(inputs) * np.clip(follows * log_ratio, -FARTHEST, FARTHEST))


def exponent_derivative(law: TemperatureLaw) -> Table | FilmTable:
    """law(dT) ln(dT / REFERENCE_RISE_K) as a table."""
    if isinstance(law, FilmTable):
        films = np.reshape(law.value, (-1, len(law.difference)))
        return replace(law, value=tuple((films * _turn(np.array(law.difference))).ravel()))
    if isinstance(law, Power):
        knots: Array = np.array(KNOTS)
        value = np.maximum(knots, 0.0 if law.exponent > 0.0 else 1.0) ** law.exponent  # none where the law has none
    else:
        assert isinstance(law, Table)
        knots, value = np.array(law.difference), np.array(law.value)
    return Table(tuple(knots), tuple(value * _turn(knots)))


def _turn(difference: Array) -> Array:
    return np.log(np.clip(difference / REFERENCE_RISE_K, 0.1, 10.0))


def with_model_form(
    network: Network,
    level: Mapping[str, float],
    values: Mapping[str, int],
    parameters: Collection[str] = (),
    added: Collection[str] = (),
    doubt: Doubt = USUAL,
) -> tuple[Network, tuple[str, ...]]:
    """The network with its form nuisances, and their names.

    level : input -> where the laws are right;  values : input -> how many values it takes, see `value_counts`
    parameters : names of those of the model: an exponent that was fitted stays, whatever is recorded now
    added : effects that are in the model: their laws are no truer than the model's own
    """
    before, first = {p.name for p in network.parameters}, first_of(network)
    for p in network.parameters:
        if p.mapping == "log" or p.name in added:
            links = [x for x in network.links if first.get(x.name) == p.name]
            films = [x for x in links if p.name in added or is_film(network, x)]
            losses = [x for x in network.sources if first.get(x.name) == p.name and x.kind not in EXACT_LOSSES]
            gaps = () if p.name in added else (x for x in links if is_gap(network, x))
            follow: list[Link | Source] = [*films, *gaps, *losses]
            laws = [x.law for x in follow]
            for name in dict.fromkeys(r for law in laws for r in law.reads if r in level):
                if f"{p.name}^{name}" in parameters or tells_exponent(laws, name, values, level):
                    network = _with_input(network, p.name, name, follow, level, doubt)
            network = _with_difference(network, p.name, films, doubt)
            network = _with_warming(network, p.name, losses, doubt)
            if p.name not in added:
                network = replace(network, parameters=(*network.parameters, *shares(p.name, films, doubt)))
    return network, tuple(p.name for p in network.parameters if p.name not in before)


def tells_exponent(laws: Sequence[Law], name: str, values: Mapping[str, int], level: Mapping[str, float]) -> bool:
    """Does an input take more than two values, and no other that multiplies it in one of the laws just two?"""
    switches = {n for n, count in values.items() if count == 2 and n != name}
    pairs = [(law, other) for law in laws if name in law.reads for other in switches.intersection(law.reads)]
    return values.get(name, 0) > 2 and not any(is_product(law, name, other, level) for law, other in pairs)


def is_product(law: Law, one: str, other: str, level: Mapping[str, float]) -> bool:
    """Is a law a function of one input times a function of another: f(a, b) f(c, d) = f(a, d) f(c, b)?"""
    if not set(law.reads) <= set(level):
        return False

    def at(share: float, other_share: float) -> float:
        now = {n: np.array([level[n]]) for n in law.reads}
        now |= {one: share * now[one], other: other_share * now[other]}
        return float(np.asarray(law.factor(now)).flat[0])

    with within_silence():  # half of a level may lie outside what a correlation knows
        straight, across = at(1.0, 1.0) * at(0.5, 0.5), at(1.0, 0.5) * at(0.5, 1.0)
    return bool(np.isclose(straight, across, rtol=1e-6))


def first_of(network: Network) -> dict[str, str]:
    """For each target the first parameter that acts on it."""
    first: dict[str, str] = {}
    for p in network.parameters:
        for target, _ in p.targets:
            first.setdefault(target, p.name)
    return first


def is_film(network: Network, link: Link) -> bool:
    return link.kind == "film" or (link.kind == "link" and bool(set(link.places) & set(network.boundaries)))


def is_gap(network: Network, link: Link) -> bool:
    """Is it declared between two bodies, and follows an input?"""
    return link.kind == "link" and bool(link.law.reads) and not is_film(network, link)


def _with_input(
    network: Network, parent: str, name: str, follow: Sequence[Link | Source], level: Mapping[str, float], doubt: Doubt
) -> Network:
    """The exponent of one input in all laws of a parameter that follow it."""
    copies: dict[str, tuple[Link | Source, Law]] = {}
    for x in follow:
        if name in x.law.reads and set(x.law.reads) <= set(level):
            law = ExponentError(x.law, name, {k: level[k] for k in x.law.reads})
            copies |= {f"{x.name}^{name}": (x, law)} if law.at_work else {}
    return _with_copies(network, f"{parent}^{name}", copies, doubt["input exponent"])


def _with_difference(network: Network, parent: str, films: Sequence[Link], doubt: Doubt) -> Network:
    """The exponent of the temperature difference in the films of free convection."""
    free = [x for x in films if isinstance(x.law.temperature, (Power, Table, FilmTable))]
    copies = {f"{x.name}^dT": (x, WithTemperature(x.law, exponent_derivative(x.law.temperature))) for x in free}
    return _with_copies(network, f"{parent}^dT", copies, doubt["difference exponent"])


def _with_warming(network: Network, parent: str, losses: Sequence[Source], doubt: Doubt) -> Network:
    """The slope with temperature of friction."""
    greased = [x for x in losses if x.kind == "friction" and x.law.temperature == CONSTANT]
    copies = {f"{x.name}^T": (x, WithTemperature(x.law, GREASE)) for x in greased}
    return _with_copies(network, f"{parent}^T", copies, doubt["warming"], "1/K")


def _with_copies(
    network: Network, name: str, copies: Mapping[str, tuple[Link | Source, Law]], sd: float, unit: str = "1"
) -> Network:
    """With copies of links or losses that one parameter of the form moves."""
    if not copies:
        return network
    acts, why = tuple((copy, 1.0) for copy in copies), "scatter of published exponents"
    new = Parameter(
        name,
        acts,
        value=0.0,
        unit=unit,
        low=-2.5 * sd,
        high=2.5 * sd,
        prior_sd=sd,
        mapping="amplitude",
        neutral=0.0,
        source=why,
    )
    return with_parameter(copy_elements(network, copies), new)


def shares(parent: str, films: Sequence[Link], doubt: Doubt = USUAL) -> Iterator[Parameter]:
    """The part of each body in a film that several share."""
    by_body: dict[str, list[str]] = {}
    for link in films:
        by_body.setdefault(link.places[0], []).append(link.name)
    if len(by_body) < 2:
        return
    for body, names in by_body.items():
        acts, why = tuple((n, 1.0) for n in names), "scatter of published film sets"
        yield Parameter(f"{parent}:{body}", acts, low=0.5, high=2.0, prior_sd=doubt["share"], source=why)
