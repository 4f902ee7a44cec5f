"""How a machine is operated while it is rated: which inputs carry the load, which the speed, what lies around it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from thermoscope import InputError, Network, plugin as th

MOVING = ("speed", *th.FLOWS)  # what moves air


@dataclass(frozen=True)
class Operation:
    """The point at which load counts as 1.

    inputs : all that the laws read;  loads : those of them that the load multiplies;  speed : its input, if any
    boundaries : degC;  warm : the load from whose rest short times begin; None: cold, at the mean of what is around
    """

    inputs: Mapping[str, float]
    loads: tuple[str, ...]
    speed: str | None
    boundaries: Mapping[str, float]
    warm: float | None = None

    @property
    def main(self) -> str:
        """The input in which a rating is given: the largest of those that carry the load."""
        return max(self.loads, key=lambda n: abs(self.inputs[n]))

    def at(self, load: float | th.Array, speed: float | None = None) -> dict[str, th.Array | float]:
        """Inputs at a load (1 is the reference) and a speed (its unit; the reference where None)."""
        out: dict[str, th.Array | float] = {n: load * u if n in self.loads else u for n, u in self.inputs.items()}
        return out if speed is None or self.speed is None else {**out, self.speed: speed}

    def moved(
        self, inputs: Mapping[str, float] | None = None, boundaries: Mapping[str, float] | None = None
    ) -> "Operation":
        """With some inputs and boundaries at other values."""
        return replace(
            self, inputs={**self.inputs, **(inputs or {})}, boundaries={**self.boundaries, **(boundaries or {})}
        )


def operation(
    network: Network, point: Mapping[str, float], fixed: Mapping[str, float], carry: Sequence[str] = ()
) -> Operation:
    """At a point, see `Reference.load_point`; `fixed` goes before.

    point : value of inputs and boundaries (degC)
    carry : inputs that the load multiplies; without any, those that measure one of LOADS

    Raises InputError where nothing says what an input is, or nothing carries a load.
    """
    reads = dict.fromkeys(n for x in network.elements for n in x.law.reads if n != th.CLOCK)
    for name in fixed:
        if name not in (*reads, *network.boundaries):
            right = th.suggestion(name, (*reads, *network.boundaries))
            raise InputError(f"'{name}' is not an input or boundary of the model", "--at", right)
    for name in carry:
        if name not in reads:
            raise InputError(f"'{name}' is not an input of the model", "--load", th.suggestion(name, tuple(reads)))
    loads = tuple(carry) or tuple(n for n in reads if network.measures(n) in th.LOADS)
    if not loads:
        right = f"an input that measures {' or '.join(th.LOADS)}, or --load INPUT, one of {', '.join(reads)}"
        raise InputError("no input carries the load", f"network '{network.name}'", right)
    point = {**point, **fixed}
    inputs = {n: v for n, v in point.items() if n in reads}
    for name in reads:
        if name not in inputs:
            raise InputError(f"nothing says what '{name}' is", "--at", f"--at {name}=VALUE")
    if not any(inputs[n] for n in loads):
        raise InputError("the load is zero", "--at", f"--at {loads[0]}=VALUE")
    for name in network.boundaries:
        if name not in point:
            raise InputError(f"nothing says how warm '{name}' is", "--at", f"--at {name}=DEGC")
    speed = network.signal("speed")
    return Operation(inputs, loads, speed if speed in reads else None, {b: float(point[b]) for b in network.boundaries})


def air_boundaries(network: Network) -> tuple[str, ...]:
    """Boundaries that are air around the machine; the coolant's otherwise."""
    return tuple(b for b in network.boundaries if network.identities[b].role is not th.Role.COOLANT)


def coolant_boundaries(network: Network) -> tuple[str, ...]:
    return tuple(b for b in network.boundaries if network.identities[b].role is th.Role.COOLANT)


def flows(network: Network, inputs: Mapping[str, float]) -> tuple[str, ...]:
    """Inputs that are a flow of air or liquid, or a share of one."""
    return tuple(n for n in inputs if network.measures(n) in set(th.FLOWS) - {"vehicle_speed"})


def at_altitude(network: Network, altitude_m: float) -> Network:
    """The network in thinner air, at the same temperatures (lumped.transfer.thin_air).

    Conduction, radiation and liquids stay as they are.
    """
    rho, wet = th.density(altitude_m), set(coolant_boundaries(network))
    return replace(network, links=tuple(_thinner(network, x, rho, wet) for x in network.links))


def _thinner(network: Network, link: th.Link, rho: float, wet: set[str]) -> th.Link:
    spaces = {p.name for p in network.places.values() if p.kind == "fluid"}
    fluids = {n for n in link.places if n in network.boundaries or n in spaces}
    liquid = bool(fluids & wet) or any(network.measures(r) == th.LIQUID for r in link.law.reads)
    if not fluids or liquid or isinstance(link.law.temperature, th.Radiation):
        return link
    moving = [name for name in link.law.reads if network.measures(name) in MOVING]
    thin = th.thin_stream(link.law, rho) if link.kind == "stream" else th.thin_film(link.law, rho, moving)
    return replace(link, law=thin)
