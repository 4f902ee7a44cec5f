"""Losses that come nearest to the steady temperatures a file stores, and which film or contact would have to differ."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from geom.arrays import Array
from geom.importing import assumptions
from geom.importing.draft import Draft
from geom.machine_file import machine_from
from lumped.build.pipeline import build
from lumped.integration.steady import steady
from lumped.machine.motor import rated_inputs
from lumped.machine.path import stem
from lumped.model.network import Network
from lumped.transfer.ranges import within_silence
from validation.parameters.unknowns import matching, value_words

BEGIN_W, LEAST_W, MOST_W = 100.0, 1e-3, 1e4  # of a loss
NEGLIGIBLE_W = 1.0  # a smaller loss is none
MOST = 20.0  # times a film or contact: as far as correlations and interfaces of machines may be off
NAMES = 3  # films or contacts that are told


@dataclass(frozen=True)
class SteadyRises:
    """Rises over the coolant's inlet, or the surroundings, of a network at rest, and what a file stores of them.

    names, stored (n,) K, places : of each stored temperature; a place of several cells is their mean
    inputs, boundaries (degC) : where it rests;  heated : what has a loss of 1 W, times `loss.at-0` and so on
    """

    network: Network
    inputs: Mapping[str, float]
    boundaries: Mapping[str, float]
    names: tuple[str, ...]
    places: tuple[tuple[str, ...], ...]
    stored: Array
    heated: tuple[str, ...] = ()

    def misfit(self, values: Mapping[str, float] | None = None) -> Array:
        """(n,) logarithms of the network's rises over the stored ones.

        values : of its parameters.  NoSolution where the machine does not come to rest
        """
        rows = [self.network.places[place].mean for each in self.places for place in each]
        with within_silence():  # what a search passes by is no result
            y = list(steady(self.network, self.inputs, self.boundaries, values, rows).y)
        means = np.array([np.mean([y.pop(0) for _ in each]) for each in self.places])
        return np.asarray(np.log(np.maximum(means - rest_degC(self.boundaries), 1e-9) / self.stored))

    def nearest(self, start: Mapping[str, float], free: Sequence[str] = ()) -> dict[str, float]:
        """The values of all losses (W), and of what is free besides, whose rises come nearest.

        start : losses to begin with;  free : films and contacts
        """
        first = {**start, **dict.fromkeys(free, 1.0)}
        limits = [*((LEAST_W, MOST_W) for _ in start), *((1.0 / MOST, MOST) for _ in free)]
        solution = least_squares(
            lambda x: self.misfit(dict(zip(first, np.exp(x).tolist(), strict=True))),
            np.clip(np.log([*first.values()]), *(inner := np.log(np.transpose(limits)) * (1.0 - 1e-9))),
            bounds=tuple(inner),
        )
        return dict(zip(first, np.exp(solution.x).tolist(), strict=True))


def rest_degC(boundaries: Mapping[str, float]) -> float:
    """What a machine without losses rests at: the coolant's inlet, or the surroundings."""
    return boundaries.get("coolant", boundaries["ambient"])


def steady_rises(draft: Draft, boundaries: Mapping[str, float], unit_losses: bool = True) -> SteadyRises:
    """The network of a draft under losses of 1 W each, or its own, and the stored temperatures that it has places of.

    Temperatures not above what the machine rests at without losses are left out.
    """
    sections, heated = draft.sections(), assumptions.heated_places(draft)
    if unit_losses:
        sections["losses"] = {f"at-{k}": {"kind": "stray", "at": at, "P_W": 1.0} for k, at in enumerate(heated)}
    machine = machine_from(sections, draft.name)
    network = build(machine).network
    wide = tuple(replace(p, low=1e-9, high=1e9) for p in network.parameters)
    places = {name: tuple(p for p in network.places if stem(p) == place) for name, place in draft.places.items()}
    above = {name: draft.readings[name] - rest_degC(boundaries) for name in places}
    names = tuple(name for name in places if places[name] and above[name] > 0.0)
    inputs = {name: value for name, value in rated_inputs(machine).items() if name in network.inputs}
    stored = np.array([above[name] for name in names])
    every = tuple(places[name] for name in names)
    return SteadyRises(replace(network, parameters=wide), inputs, boundaries, names, every, stored, heated)


def rms_ratio(misfit: Array) -> float:
    """How far ratios are off on the whole, as a share.  misfit : their logarithms"""
    return float(np.sqrt(np.mean(misfit**2)))


def nearest_losses(rises: SteadyRises) -> dict[str, Any]:
    """Losses, none below zero, whose rises come nearest to the stored ones, each by its logarithm; ours over these.

    Then every film and every contact is set free by itself, to say which would have to differ for the rest.
    """
    start = {f"loss.at-{k}": BEGIN_W for k in range(len(rises.heated))}
    losses = rises.nearest(start)
    misfit = rises.misfit(losses)
    sources = sum(watts >= NEGLIGIBLE_W for watts in losses.values())
    one_free = []
    for p in matching(rises.network, ("h.*", "contact.*")) if len(rises.names) > sources + 1 else ():  # else none tells
        values = rises.nearest(losses, [p.name])
        one_free.append((rms_ratio(rises.misfit(values)), p.name, values[p.name]))
    rows = zip(rises.names, rises.stored.tolist(), np.exp(misfit).tolist(), strict=True)
    return {
        "rows": [{"place": name, "stored_K": stored, "ratio": ratio} for name, stored, ratio in rows],
        "losses_W": dict(zip(rises.heated, losses.values(), strict=True)),
        "rms": rms_ratio(misfit),
        "one_free": [{"name": name, "factor": factor, "rms": left} for left, name, factor in sorted(one_free)],
    }


def loss_words(search: Mapping[str, Any]) -> list[str]:
    """Which losses come nearest, and what would have to differ for the rest."""
    heat = ", ".join(
        f"{watts:.0f} W at {place}" for place, watts in search["losses_W"].items() if watts >= NEGLIGIBLE_W
    )
    free = search["one_free"][:NAMES]
    best = "; ".join(f"{value_words(x['name'])} x {x['factor']:.2g} ({100 * x['rms']:.0f} %)" for x in free)
    films = f"One film or contact changed alone brings most: {best}" if best else "Too few to say more of films"
    return [f"Losses that come nearest: {heat}. Rises are then off by {100 * search['rms']:.0f} % (rms).", f"{films}."]
