"""Temperatures that a Motor-CAD file stores, against the network of the machine imported from it.

    python benchmarks/peers/stored_temperatures.py FILE.mot [--json FILE] [--page]

The file stores a steady state and not the losses that made it. Losses in windings, stator, rotor, magnets and bearings,
none below zero, are sought that come nearest to the stored rises over the coolant's inlet, each by its logarithm. Then
every film and every contact is set free by itself, to say which would have to differ for the rest. With --page the
table goes into docs/how-to/import.md.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from geom import import_draft
from geom.arrays import Array
from geom.importing.draft import Draft
from geom.machine_file import machine_from
from lumped.build.pipeline import build
from lumped.integration.steady import steady
from lumped.machine.motor import rated_inputs
from lumped.model.network import Network
from scripts.published import ROOT, publish, table

HEATED = ("winding.copper", "stator.core", "rotor.core", "magnets", "bearing.left", "bearing.right")
BEGIN_W, LEAST_W, MOST_W = 100.0, 1e-3, 1e4  # of a loss
MOST = 20.0  # times a film or contact: as far as correlations and interfaces of machines may be off
PAGE = ROOT / "docs" / "how-to" / "import.md"
NAMES = 3  # films or contacts that are told


Model = tuple[Network, dict[str, float], dict[str, float], list[list[str]]]


def network_of(draft: Draft) -> Model:
    """The network with a loss of 1 W at every place that may be heated; its inputs; its boundaries (degC); where it
    has each stored temperature, as the mean over several places."""
    sections = draft.sections()
    sections["losses"] = {f"at-{k}": {"kind": "stray", "at": at, "P_W": 1.0} for k, at in enumerate(HEATED)}
    machine = machine_from(sections, draft.name)
    network = build(machine).network
    wide = tuple(replace(p, low=1e-9, high=1e9) for p in network.parameters)
    cooling = sections["cooling"]
    return (
        replace(network, parameters=wide),
        dict(rated_inputs(machine)),
        {"ambient": draft.readings["Ambient"], "coolant": cooling["inlet_C"]},
        [[p for p in network.places if p.partition("@")[0] == place] for place in stored_places(draft).values()],
    )


def stored_places(draft: Draft) -> dict[str, str]:
    """Stored temperature -> where the network has it, without those around the machine."""
    return {name: place for name, place in draft.places.items() if place not in draft.surroundings}


def rises(
    network: Network,
    inputs: Mapping[str, float],
    boundaries: Mapping[str, float],
    places: Sequence[Sequence[str]],
    values: Mapping[str, float],
) -> Array:
    """Rises (K) over the coolant's inlet at the places of the stored temperatures."""
    rows = [network.places[place].mean for each in places for place in each]
    y = list(steady(network, inputs, boundaries, values, rows).y)
    means = [np.mean([y.pop(0) for _ in each]) for each in places]
    return np.array(means) - boundaries["coolant"]


def nearest_losses(model: Model, stored: Array, free: Sequence[str] = ()) -> tuple[dict[str, float], Array]:
    """Losses (W), and factors of what is free besides, that come nearest to the stored rises; ours over these."""
    names = [*(f"loss.at-{k}" for k in range(len(HEATED))), *free]
    start = np.log([*(BEGIN_W for _ in HEATED), *(1.0 for _ in free)])

    def values(x: Array) -> dict[str, float]:
        return dict(zip(names, np.exp(x).tolist(), strict=True))

    def misfit(x: Array) -> Array:
        return np.log(rises(*model, values(x)) / stored)

    low = [*(LEAST_W for _ in HEATED), *(1.0 / MOST for _ in free)]
    high = [*(MOST_W for _ in HEATED), *(MOST for _ in free)]
    found = least_squares(misfit, start, bounds=(np.log(low), np.log(high)))
    return values(found.x), np.exp(found.fun)


def rms(ratio: Array) -> float:
    """How far ratios are off on the whole, as a share."""
    return float(np.sqrt(np.mean(np.log(ratio) ** 2)))


def measured(path: Path) -> dict[str, Any]:
    """Stored and own rises, the losses that were found, and what would have to differ."""
    draft = import_draft(path)
    model, readings = network_of(draft), draft.readings
    inlet = model[2]["coolant"]
    names = stored_places(draft)
    stored = np.array([readings[name] for name in names]) - inlet
    losses, ratio = nearest_losses(model, stored)
    rows = [
        {"place": name, "stored_K": float(s), "ratio": float(r)}
        for name, s, r in zip(names, stored, ratio, strict=True)
    ]
    one_free: list[tuple[float, str, float]] = []
    for p in model[0].parameters:
        if p.name.split(".")[0] in ("h", "contact"):
            found, new = nearest_losses(model, stored, [p.name])
            one_free.append((rms(new), p.name, found[p.name]))
    watts = dict(zip(HEATED, list(losses.values())[: len(HEATED)], strict=True))
    return {
        "file": path.name,
        "rows": rows,
        "losses_W": watts,
        "rms": rms(ratio),
        "one_free": [{"name": name, "factor": factor, "rms": left} for left, name, factor in sorted(one_free)],
    }


def page(result: Mapping[str, Any]) -> str:
    """Markdown: a row per stored temperature, and two sentences."""
    rows = [(f"`{r['place']}`", f"{r['stored_K']:.1f}", f"{r['ratio']:.2f}") for r in result["rows"]]
    heat = ", ".join(f"{watts:.0f} W at {place}" for place, watts in result["losses_W"].items() if watts >= 1.0)
    best = "; ".join(f"`{x['name']}` x {x['factor']:.2g} ({100 * x['rms']:.0f} %)" for x in result["one_free"][:NAMES])
    return "\n".join(
        [
            table(["stored in the file", "rise over the inlet (K)", "ours over it"], rows),
            "",
            f"Losses that come nearest: {heat}. The ratios are then off by {100 * result['rms']:.0f} % (rms).",
            f"One film or contact changed alone brings most: {best}.",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    result = measured(given.file)
    print(page(result))
    if given.json:
        given.json.write_text(json.dumps(result, indent=1))
    if given.page:
        publish(PAGE, "stored", page(result))


if __name__ == "__main__":
    main()
