"""Losses and conductances that a free network needs, and that neither what is declared nor the catalogue has."""

import re
from collections.abc import Mapping, Sequence
from math import comb, log
from typing import TYPE_CHECKING

import numpy as np

from geom.errors import InputError
from lumped.model.network import Link, Network, Source
from lumped.transfer.laws import Law
from lumped.transfer.ranges import within_silence
from measured.case import Case, Test
from measured.doubt import PRIOR
from validation.effects.base import Effect
from validation.effects.build import links_between, losses_at
from validation.effects.input_terms import InputConductance, InputLoss, InputTerm, factor_words
from validation.yardstick.free_network import Powers, link_powers, loss_powers, power_words
from validation.yardstick.terms import Term
from validation.yardstick.yardstick import POWERS, SHAPES, free_network_terms

if TYPE_CHECKING:
    from validation.inference.evidence import Evidence

KINDS: tuple[tuple[str, type[InputTerm]], ...] = (("loss", InputLoss), ("link", InputConductance))


def network_terms(case: Case, evidence: "Evidence", kinds: Sequence[str] | None = None) -> dict[Effect, float]:
    """Effects that add what the free network needs, each with its log prior.

    That of a kind is shared over all places and all that these might follow, as if nothing had been looked at.

    kinds : only these
    """
    classes = {element: cls for element, cls in KINDS if kinds is None or cls.kind in kinds}
    if not classes:
        return {}
    network, sizes = evidence.fit.network, largest_inputs(case.usable)
    usual = PRIOR["effect"].share / len({e.kind for e in evidence.effects if not e.fault})
    places = {c.place for t in case.usable for c in t.channels} - set(network.boundaries)
    ends = {"loss": len(places), "link": comb(len(places), 2) + len(places) * len(network.boundaries)}
    out: dict[Effect, float] = {}
    for term in free_network_terms(case):
        one = input_term(term, network, sizes) if term.kind in classes else None
        if one is None or term.place not in places or _is_there(evidence, term, sizes):
            continue
        forms = possible_forms(network, list(sizes), term.kind)
        alike = sum(len(f) == len(one.inputs) for f in forms)  # products together share as single inputs do
        out[one] = log(usual / (2 * alike * ends[term.kind]))
    return out


def input_term(term: Term, network: Network, sizes: Mapping[str, float]) -> InputTerm | None:
    """The effect that adds a term which follows inputs; None where it is constant or nothing physical.

    None, too, of an input whose name no effect can spell, such as one with " * " in it.

    sizes : input -> its largest size
    """
    forms = possible_forms(network, list(sizes), term.kind)
    form = next((f for f in forms if power_words(f) == term.input), None)
    if form is None:
        return None
    where = sorted({term.place, term.other} - {""}, key=lambda end: (end in network.boundaries, end))
    factors = factor_words((f.input, f.begin * sizes[f.input], sizes[f.input], f.exponent) for f in form)
    try:
        return dict(KINDS)[term.kind]("|".join([*where, factors]))
    except InputError:
        return None


def possible_forms(network: Network, inputs: Sequence[str], element: str) -> list[Powers]:
    """What a loss or a link may follow, as the free network has it.  element : "loss" | "link" """
    from validation.yardstick.first_network import may_heat, may_stir

    shapes = [*POWERS[-1], *(shape for shapes in SHAPES for shape in shapes if shape not in POWERS[-1])]
    every, may = (loss_powers(inputs), may_heat) if element == "loss" else (link_powers(inputs, shapes), may_stir)
    return [form for form in every if form and may([network.measures(f.input) for f in form])]


def largest_inputs(tests: Sequence[Test]) -> dict[str, float]:
    """Input that every test records -> its largest size, to two digits."""
    names = [n for n in tests[0].inputs if all(n in t.inputs for t in tests)] if tests else []
    sizes = {n: float(f"{max(np.max(np.abs(t.inputs[n])) for t in tests):.2g}") for n in names}
    return {n: size for n, size in sizes.items() if size > 0.0}


def _is_there(evidence: "Evidence", term: Term, sizes: Mapping[str, float]) -> bool:
    """Does what is declared there follow the inputs, or an effect of the catalogue just these?"""
    fitted, more = (term_elements(network, term) for network in (evidence.fit.network, evidence.network))
    inputs = inputs_of(term)
    return any(follows(x.law, inputs, sizes) for x in fitted) or inputs in [set(x.law.reads) for x in more]


def follows(law: Law, inputs: set[str], sizes: Mapping[str, float]) -> bool:
    """Does a law change with some inputs while all others rest?  A copper loss does so with no speed alone."""
    if not inputs <= set(law.reads):
        return False
    rest = dict.fromkeys(law.reads, np.zeros(1))
    with within_silence():
        now = law.size({**rest, **{name: np.full(1, sizes.get(name, 1.0)) for name in inputs}})
        return not inputs or not np.allclose(now, law.size(rest), rtol=1e-6, atol=0.0)


def inputs_of(term: Term) -> set[str]:
    """The names in "id_A^2 speed_rpm"."""
    return {re.split(r"[>^](?=[0-9])", word)[0] for word in term.input.split()}


def term_elements(network: Network, term: Term) -> list[Link] | list[Source]:
    """The links between the two places of a term, or the losses at its place."""
    return losses_at(network, term.place) if term.kind == "loss" else links_between(network, term.place, term.other)
