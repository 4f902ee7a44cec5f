"""Losses of a motor as sources of its network.

A machine file declares each loss as [losses.NAME], in the words of network.toml (docs/network-toml.md): kind, `at` with
shares over parts, loss zones or mean places that sum to 1, and the keys of the kind. A zone that the network does not
resolve stands for its part. Series-wound machines may give plain numbers instead, see settings.Losses.
"""

from collections.abc import Mapping

import numpy as np

from geom.description.machine import Machine
from geom.errors import InputError
from lumped.declarations.loss_tables import loss_laws
from lumped.machine.hairpin import by_part
from lumped.machine.settings import Losses, read
from lumped.machine.shapes import conducts, gap_fluid
from lumped.model.network import Network, Place, Row, Source
from lumped.model.sites import ASSUMED, ASSUMED_W
from lumped.schemas.reader import Table, suggestion
from lumped.sources.loss_laws import EDDY, PowerLoss, declared_name
from lumped.transfer.laws import InputPower, Law, Linear

Shares = Mapping[str, float]


def sources(machine: Machine, network: Network) -> list[Source]:
    """Every loss of the machine as a source; the weights of each sum to 1 over the mean nodes."""
    return [_source(network, name, kind, parts, law, probe) for name, kind, parts, law, probe in _declared(machine)]


def checked_losses(machine: Machine) -> None:
    """InputError for a table of losses that cannot be; to be asked before minutes are spent on a mesh."""
    _declared(machine)


def loss_inputs(machine: Machine) -> set[str]:
    """Names of the inputs that losses read."""
    return {name for *_, law, _ in _declared(machine) for name in law.reads}


def loss_shares(machine: Machine, network: Network) -> dict[str, dict[str, float]]:
    """Source -> share of its watts per part, zone or fluid of the network."""
    out: dict[str, dict[str, float]] = {}
    for name, _, parts, _, _ in _declared(machine):
        at = out[f"loss:{name}"] = {}
        for place, share in _spread(network, parts).items():
            at[place] = at.get(place, 0.0) + share
    return out


def loss_watts(machine: Machine, network: Network, inputs: Mapping[str, float]) -> dict[str, float]:
    """Watts per part, zone or fluid at constant inputs, resistances at their reference temperature."""
    signals = {name: np.array([float(value)]) for name, value in inputs.items()}
    out: dict[str, float] = {}
    for name, _, parts, law, _ in _declared(machine):
        for unknown in {*law.reads} - signals.keys():
            where, right = f"{machine.name} [losses.{declared_name(name)}]", suggestion(unknown, signals)
            raise InputError(f"the rated point has no input '{unknown}'", where, right)
        watts = float(np.mean(law.size(signals)))
        for place, share in _spread(network, parts).items():
            out[place] = out.get(place, 0.0) + share * watts
    return out


Loss = tuple[str, str, Shares, Law, str]


def _declared(machine: Machine) -> list[Loss]:
    section = machine.sections.get("losses", {})
    plain = not any(isinstance(value, Mapping) for value in section.values())
    if plain and machine.features.series is not None:
        losses = read(Losses, section, f"{machine.name} [losses]")
        rated = Table(machine.sections.get("ratings", {}), f"{machine.name} [ratings]")
        return _series(machine, losses, {key: rated.number(key) for key in ("current_A", "speed_rpm")})
    if not section:  # in windings by volume, or, where nothing is wound, in all parts
        heated = [part for part in machine.parts if conducts(machine, part.name)] or list(machine.parts)
        total = sum(part.volume for part in heated)
        shares = {part.name: part.volume / total for part in heated}
        return [(ASSUMED.partition(":")[2], "constant", shares, PowerLoss(((ASSUMED_W, ()),)), "")]
    where = f"{machine.name} [losses"
    tables = {name: Table(data, f"{where}.{declared_name(name)}]") for name, data in by_part(machine, section).items()}
    laws = loss_laws(tables)
    out = [_read(name, tables[name.removesuffix(EDDY)], law) for name, law in laws.items()]
    for table in tables.values():
        table.close()
    return out


def _read(name: str, table: Table, law: Law) -> Loss:
    shares = table.shares("at")
    if abs(sum(shares.values()) - 1.0) > 1e-9:
        raise table.error(f"shares of 'at' sum to {sum(shares.values()):g}", "shares that sum to 1")
    probe = table.word("temperature_of", max(shares, key=lambda place: shares[place]))
    kind = table.word("kind")
    return name, kind, shares, law, probe


def _source(network: Network, name: str, kind: str, parts: Shares, law: Law, probe: str) -> Source:
    index: list[int] = []
    weights: list[float] = []
    for place, share in _spread(network, parts).items():
        p = network.places[place]
        index += p.states.tolist()
        weights += (share * p.b).tolist()
    main = place_of(network, next(iter(parts)))
    probe_row = Row(np.array(index), np.array(weights)) if probe == "" else place_of(network, probe).mean
    return Source(f"loss:{name}", kind, main.part, np.array(index), np.array(weights), law, probe_row)


def _spread(network: Network, parts: Shares) -> dict[str, float]:
    """Shares with mean places taken apart into the parts they average."""
    out: dict[str, float] = {}
    for name, share in parts.items():
        p = place_of(network, name)
        inner = {network.states[i]: float(w) for i, w in zip(p.states, p.b)} if p.kind == "node" else {p.name: 1.0}
        for place, weight in inner.items():
            out[place] = out.get(place, 0.0) + share * weight
    return out


def place_of(network: Network, name: str) -> Place:
    """The place of this name, or the part that an unresolved zone "PART.ZONE" belongs to."""
    stem = name
    while stem not in network.places:
        if "." not in stem:
            raise InputError(f"no place '{name}'", f"{network.name} [losses]", suggestion(name, network.places))
        stem = stem.rpartition(".")[0]
    return network.places[stem]


def _series(machine: Machine, losses: Losses, rated: Mapping[str, float]) -> list[Loss]:
    """The plain numbers of a series-wound machine. rated : "current_A", "speed_rpm" """
    assert machine.features.series is not None
    has = machine.features.series
    copper = Linear(losses.temperature_coefficient_per_K, losses.reference_C)
    current = ("current_A", 1.0, 2.0)
    amps, turns = rated["current_A"], rated["speed_rpm"]
    iron_terms = (("current_A", amps, losses.iron_current_exponent), ("speed_rpm", turns, losses.iron_speed_exponent))
    spin = ("speed_rpm", turns, 1.0)
    bearing = InputPower(losses.bearing_friction_W, (spin,))
    armature = InputPower(losses.armature_resistance_mOhm * 1e-3, (current,), copper)
    winding = InputPower(losses.field_resistance_mOhm * 1e-3, (current,), copper)
    share, ends, gap = losses.iron_in_poles, losses.armature_in_end_windings, losses.windage_in_gap
    conductors = dict(zip(has.armature, (1 - ends, ends / 2, ends / 2), strict=True))
    air = {gap_fluid(machine): gap, **dict.fromkeys(machine.features.ends, (1 - gap) / 2)}
    drop, friction = InputPower(losses.brush_drop_V, (("current_A", 1.0, 1.0),)), losses.brush_friction_W
    sliding = dict.fromkeys(has.sliding, 1.0 / len(has.sliding))  # half to each side: assumed
    return [
        ("copper.armature", "copper", conductors, armature, ""),
        ("copper.field", "copper", {has.field: 1.0}, winding, ""),
        ("iron", "iron", {has.core: 1 - share, has.poles: share}, InputPower(losses.iron_W, iron_terms), ""),
        ("brush.drop", "brush", sliding, drop, ""),
        ("brush.friction", "friction", sliding, InputPower(friction, (spin,)), ""),
        *((name, "friction", {name: 1.0}, bearing, "") for name in has.bearings),
        ("windage", "windage", air, InputPower(losses.windage_W, (("speed_rpm", turns, 3.0),)), ""),
    ]
