"""A network.toml and the tests on it under other names, and in another order: nothing that is decided may change."""

import random
import re
from dataclasses import replace

from lumped.declarations.network import read_network
from lumped.model.quantities import USUAL
from measured.case import Case, Channel, Model, Test

SECTIONS = ("nodes", "surfaces", "means", "links", "streams", "losses", "parameters", "boundaries", "inputs")
SHARES = ("of", "at", "wall", "acts_on")  # tables whose keys are names
INPUTS = (
    "input",
    "currents",
    "current",
    "speed",
    "torque",
    "voltage",
    "excitation",
    "product",
    "flow_m3_h_input",
    "flow_l_min_input",
)
KEPT = ("kind", "surface", "law", "mapping", "coolant", "arrangement", "unit", "source", "role", "quantity", "name")


def names_of(data):
    """Every word of a user's own in a document of network.toml, "ambient" and "speed_rpm" among them."""
    found = dict.fromkeys(data["network"]["boundaries"])
    for section in SECTIONS:
        found |= dict.fromkeys(data.get(section, {}))
    return [*found, *(n for n in inputs_of(data) if n not in found)]


def inputs_of(node, key=""):
    if isinstance(node, dict):
        return [n for k, v in node.items() for n in inputs_of(v, k)]
    if isinstance(node, list):
        return [n for v in node for n in inputs_of(v, key)]
    return [node] if key in INPUTS and isinstance(node, str) else []


def new_words(names, seed):
    """Random words, none of which is part of another or of anything the tool says."""
    rng = random.Random(seed)
    return {n: "".join(rng.choice("bcdfghjklmnpqrstvwxz") for _ in range(9)) for n in names}


def renamed(data, words):
    """The document with other words; what each input measures is said, since its usual name is gone."""
    out = _walk(data, words, "", True)
    said = {words[n]: {"quantity": USUAL[n]} for n in inputs_of(data) if n in USUAL}
    return {**out, "inputs": {**said, **out.get("inputs", {})}}


def _walk(node, words, key, top=False):
    if isinstance(node, dict):
        own = key in SECTIONS or key in SHARES
        return {
            _word(k, words) if own else k: _walk(v, words, "" if own and key in SECTIONS else k)
            for k, v in node.items()
        }
    if isinstance(node, list):
        return [_walk(v, words, key) for v in node]
    return _word(node, words) if isinstance(node, str) and key not in KEPT else node


def _word(text, words):
    """A name, or one inside "link:NAME:natural" or "NAME.outer"."""
    if text in words:
        return words[text]
    head, _, rest = text.partition(":")
    if rest and head in ("link", "loss", "capacity", "stream"):
        best = max((n for n in words if rest == n or rest.startswith(f"{n}:")), key=len, default="")
        return f"{head}:{words[best]}{rest[len(best) :]}" if best else text
    stem = text.removesuffix(".outer")
    return f"{words[stem]}.outer" if stem in words else text


def shuffled(data, seed):
    """The document with its tables in another order."""
    rng = random.Random(seed)
    out = dict(data)
    for section in SECTIONS:
        items = list(data.get(section, {}).items())
        rng.shuffle(items)
        out |= {section: dict(items)} if items else {}
    order = list(data["network"]["boundaries"])
    rng.shuffle(order)
    return {**out, "network": {**data["network"], "boundaries": order}}


def case_of(data, tests, words=None):
    """A case on the network of a document.  tests : [(name, role, time, inputs, boundaries, {place: readings})]"""
    words = words or {}
    network = read_network(data)
    measured = {words.get(k, k): USUAL[k] for _, _, _, inputs, *_ in tests for k in inputs}  # as their sheets say
    network = replace(network, quantities=measured, signals={q: n for n, q in measured.items()})

    def test(name, role, time, inputs, boundaries, read):
        def new(table):
            return {words.get(k, k): v for k, v in table.items()}

        places = new(read)
        seen = tuple(
            Channel(words.get(f"T {a}", f"T {a}"), b, network.places[b].mean, y, 0.5, 10.0)
            for (a, y), b in zip(read.items(), places, strict=True)
        )
        return Test(words.get(name, name), role, time, new(inputs), new(boundaries), seen, 20.0)

    return Case("renamed", Model(network), tuple(test(*t) for t in tests))


def back(text, words):
    """The text with the old names in place of the new words."""
    old = {new: name for name, new in words.items()}
    return re.sub("|".join(old), lambda hit: old[hit.group()], text)
