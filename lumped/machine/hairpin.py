"""A hairpin winding in the network: the contacts that its insulation is, and its copper loss part by part."""

from collections.abc import Mapping
from typing import Any

from geom.description.machine import Machine
from geom.description.materials import material
from lumped.sources.loss_laws import IN

ONE_PIECE = 5e4  # W/m2/K: a bar and its own end turn are one piece


def insulation(machine: Machine) -> dict[str, float]:
    """Contact "a|b" -> coefficient (W/m2/K) of enamel and resin, over the faces of the layers.

    Heat goes straight from face to face of the bars, which are narrower than their layers; corners carry none.
    """
    bars = machine.features.bars
    if bars is None:
        return {}
    enamel, out, last = material("enamel").k_plane, dict[str, float](), len(bars.layers) - 1
    above = (bars.pitch - bars.height) / 2 - bars.enamel
    for k, (layer, room) in enumerate(zip(bars.layers, bars.room, strict=True)):
        mixture = machine.material_of(layer).mixture
        resin = enamel if mixture is None else mixture.k_between
        beside = (room - bars.width) / 2 - bars.enamel
        top, side = (1.0 / (bars.enamel / enamel + gap / resin) for gap in (above, beside))
        ends = (k == 0) + (k == last)  # faces to the liner at the slot's bottom and opening
        whole = 2 * bars.pitch + ends * room
        out[_pair(layer, bars.liner)] = (2 * bars.height * side + ends * bars.width * top) / whole
        if k < last:
            out[_pair(layer, bars.layers[k + 1])] = bars.width / ((room + bars.room[k + 1]) / 2) * top / 2
        out |= {_pair(layer, end): ONE_PIECE for end in bars.ends}
    return out


def _pair(a: str, b: str) -> str:
    return "|".join(sorted((a, b)))


def by_part(machine: Machine, losses: Mapping[str, Any]) -> dict[str, Any]:
    """[losses] with copper of the whole winding part by part: each heats and has resistance as it is warm itself.

    A mean place over all layers says which parts; each has resistance by its copper. AC factors by layer go to theirs.
    """
    out: dict[str, Any] = {}
    for name, table in losses.items():
        parts = _parts(machine, table) if isinstance(table, Mapping) and table.get("kind") == "copper" else []
        out |= {f"{name}{IN}{p}": entry for p, entry in _entries(machine, table, parts)} if parts else {name: table}
    return out


def _parts(machine: Machine, table: Mapping[str, Any]) -> list[str]:
    """What the place of a copper loss averages, if that is all layers."""
    place = table.get("at")
    mean = machine.sections.get("sensors", {}).get(place) if isinstance(place, str) else None
    parts = mean.get("mean_of", []) if isinstance(mean, Mapping) else []
    bars = machine.features.bars
    return list(parts) if bars is not None and set(bars.layers) <= {str(p) for p in parts} else []


def _entries(machine: Machine, table: Mapping[str, Any], parts: list[str]) -> list[tuple[str, dict[str, Any]]]:
    bars = machine.features.bars
    assert bars is not None
    copper = {part: machine.part(part).volume * (machine.part(part).filling or (1.0,))[0] for part in parts}
    R = next((key for key in ("R20_ohm", "R_ohm") if isinstance(table.get(key), (int, float))), "R20_ohm")
    out = []
    for part, volume in copper.items():
        share = volume / sum(copper.values())
        entry = {**table, "at": {part: 1.0}, **({R: table[R] * share} if R in table else {})}
        ac = table.get("ac")
        if isinstance(ac, Mapping) and ("pole_pairs" in ac or "factors" in ac):
            del entry["ac"]
            if part in bars.layers:
                entry["ac"] = _layer(machine, ac, bars.layers.index(part))
        out.append((part, entry))
    return out


def _layer(machine: Machine, ac: Mapping[str, Any], k: int) -> dict[str, Any]:
    bars = machine.features.bars
    assert bars is not None
    if "factors" in ac:
        rows = ac["factors"]
        if not isinstance(rows, list) or len(rows) != len(bars.layers):
            return dict(ac)
        return {**ac, "factors": rows[k]}
    return {**ac, "bar_height_mm": bars.height * 1e3, "porosity": bars.width / bars.slot[k], "layer": k + 1}
