"""What is left of the continuous rating in other surroundings: warmer, higher, with warmer or less coolant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from geom.errors import InputError
from lumped.model.network import Network
from validation.rating.envelope import rated
from validation.rating.operation import Operation, air_boundaries, at_altitude, coolant_boundaries, flows
from validation.rating.points import Model

AMBIENTS = (-20.0, 0.0, 20.0, 40.0, 60.0)  # degC
ALTITUDES = (0.0, 1000.0, 2000.0, 4000.0)  # m: IEC 60034-1 rates to 1000 m
COOLANTS = (20.0, 40.0, 65.0, 80.0)  # degC
FLOWS = (0.5, 0.75, 1.0, 1.25)  # of the reference flow


@dataclass(frozen=True)
class Derated:
    """of : "ambient", "altitude", "coolant" or an input;  value : its degC, m or own unit;  load : of the reference

    load : 0 where the limit is exceeded without any
    """

    of: str
    value: float
    unit: str
    load: float


def deratings(model: Model, op: Operation, limits: Mapping[str, float]) -> list[Derated]:
    """The continuous rating over each of them, the others at the reference."""
    return [Derated(of, v, unit, _load(m, o, limits)) for of, v, unit, m, o in _surroundings(model, op)]


def _load(model: Model, op: Operation, limits: Mapping[str, float]) -> float:
    try:
        return rated(model, op, limits, "S1", None).load
    except InputError:
        return 0.0


def _surroundings(model: Model, op: Operation) -> Iterator[tuple[str, float, str, Model, Operation]]:
    network: Network = model.network
    air, coolant = air_boundaries(network), coolant_boundaries(network)
    for T in AMBIENTS if air else ():
        yield "ambient", T, "degC", model, op.moved(boundaries=dict.fromkeys(air, T))
    for height in ALTITUDES if air else ():
        yield "altitude", height, "m", replace(model, network=at_altitude(network, height)), op
    for T in COOLANTS if coolant else ():
        yield "coolant", T, "degC", model, op.moved(boundaries=dict.fromkeys(coolant, T))
    for name in flows(network, op.inputs):
        for share in FLOWS:
            yield name, share * op.inputs[name], "as recorded", model, op.moved({name: share * op.inputs[name]})
