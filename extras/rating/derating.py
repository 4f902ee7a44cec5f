"""What is left of the continuous rating in other surroundings: warmer, higher, with warmer or less coolant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from extras.rating.envelope import Rating, rated
from extras.rating.operation import Operation, air_boundaries, at_altitude, coolant_boundaries, flows
from extras.rating.points import Model
from thermoscope import InputError, Network

AMBIENTS = (-20.0, 0.0, 20.0, 40.0, 60.0)  # degC
ALTITUDES = (0.0, 1000.0, 2000.0, 4000.0)  # m: IEC 60034-1 rates to 1000 m
COOLANTS = (20.0, 40.0, 65.0, 80.0)  # degC
FLOWS = (0.5, 0.75, 1.0, 1.25)  # of the reference flow


@dataclass(frozen=True)
class Surroundings:
    """One thing about a machine's place that is not as at the reference.

    of : "ambient", "altitude", "coolant" or an input;  value : its degC, m or own unit;  op : the operating point there
    """

    of: str
    value: float
    unit: str
    op: Operation

    def network(self, network: Network) -> Network:
        """A network that is there."""
        return at_altitude(network, self.value) if self.of == "altitude" else network


@dataclass(frozen=True)
class Derated:
    """rating : the continuous one; None where the limit is exceeded without any load"""

    where: Surroundings
    rating: Rating | None

    @property
    def load(self) -> float:
        return 0.0 if self.rating is None else self.rating.load


def deratings(model: Model, op: Operation, limits: Mapping[str, float]) -> list[Derated]:
    """The continuous rating over each of them, the others at the reference."""
    return [Derated(s, _rated(model, s, limits)) for s in surroundings(model.network, op)]


def _rated(model: Model, s: Surroundings, limits: Mapping[str, float]) -> Rating | None:
    try:
        return rated(replace(model, network=s.network(model.network)), s.op, limits, "S1", None)
    except InputError:
        return None


def surroundings(network: Network, op: Operation) -> Iterator[Surroundings]:
    """All that a network of this kind feels: air, thin air, coolant, flows."""
    air, coolant = air_boundaries(network), coolant_boundaries(network)
    for T in AMBIENTS if air else ():
        yield Surroundings("ambient", T, "degC", op.moved(boundaries=dict.fromkeys(air, T)))
    for height in ALTITUDES if air else ():
        yield Surroundings("altitude", height, "m", op)
    for T in COOLANTS if coolant else ():
        yield Surroundings("coolant", T, "degC", op.moved(boundaries=dict.fromkeys(coolant, T)))
    for name in flows(network, op.inputs):
        for share in FLOWS:
            flow = share * op.inputs[name]
            yield Surroundings(name, flow, "as recorded", op.moved({name: flow}))
