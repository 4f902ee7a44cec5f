"""Losses and conductances that a free network needs, and that neither what is declared nor the catalogue has."""

from __future__ import annotations

from collections.abc import Sequence
from math import comb, log

import numpy as np

from lumped.model.network import Network
from measured.case import Case
from measured.doubt import PRIOR
from validation.effects.base import Effect
from validation.effects.input_terms import InputConductance, InputLoss, InputTerm, factor_words
from validation.inference.evidence import Evidence
from validation.yardstick.first_network import may_heat, may_stir
from validation.yardstick.free_network import Powers, link_powers, loss_powers, power_words
from validation.yardstick.suggestions import term_elements
from validation.yardstick.terms import Term
from validation.yardstick.yardstick import POWERS, free_network_terms

KINDS: tuple[tuple[str, type[InputTerm]], ...] = (("loss", InputLoss), ("link", InputConductance))


def network_terms(case: Case, evidence: Evidence, kinds: Sequence[str] | None = None) -> dict[Effect, float]:
    """Effects that add what the free network needs, each with its log prior.

    That of a kind is shared over all places and all that these might follow, as if nothing had been looked at.

    kinds : only these
    """
    classes = {element: cls for element, cls in KINDS if kinds is None or cls.kind in kinds}
    if not classes:
        return {}
    network, sizes = evidence.fit.network, _largest(case)
    usual = PRIOR["effect"].share / len({e.kind for e in evidence.effects if not e.fault})
    places = {c.place for t in case.usable for c in t.channels} - set(network.boundaries)
    ends = {"loss": len(places), "link": comb(len(places), 2) + len(places) * len(network.boundaries)}
    forms = {element: possible_forms(network, list(sizes), element) for element in classes}
    out: dict[Effect, float] = {}
    for term in free_network_terms(case):
        form = next((f for f in forms.get(term.kind, ()) if power_words(f) == term.input), None)
        if form is None or term.place not in places or _is_there(evidence, term, {name for name, _ in form}):
            continue
        factors = factor_words((name, sizes[name], p) for name, p in form)
        alike = sum(len(f) == len(form) for f in forms[term.kind])  # products together share as single inputs do
        where = sorted({term.place, term.other} - {""}, key=lambda end: (end in network.boundaries, end))
        out[classes[term.kind]("|".join([*where, factors]))] = log(usual / (2 * alike * ends[term.kind]))
    return out


def possible_forms(network: Network, inputs: Sequence[str], element: str) -> list[Powers]:
    """What a loss or a link may follow, as the free network has it.  element : "loss" | "link" """
    every, may = (loss_powers(inputs), may_heat) if element == "loss" else (link_powers(inputs, max(POWERS)), may_stir)
    return [form for form in every if form and may([network.measures(name) for name, _ in form])]


def _largest(case: Case) -> dict[str, float]:
    """Input that every test records -> its largest size, to two digits."""
    tests = case.usable
    names = [n for n in tests[0].inputs if all(n in t.inputs for t in tests)] if tests else []
    sizes = {n: float(f"{max(np.max(np.abs(t.inputs[n])) for t in tests):.2g}") for n in names}
    return {n: size for n, size in sizes.items() if size > 0.0}


def _is_there(evidence: Evidence, term: Term, inputs: set[str]) -> bool:
    """Does what is declared there follow the inputs, or an effect of the catalogue just these?"""
    reads, more = (
        [set(x.law.reads) for x in term_elements(network, term)] for network in (evidence.fit.network, evidence.network)
    )
    return any(inputs <= law for law in reads) or inputs in more
