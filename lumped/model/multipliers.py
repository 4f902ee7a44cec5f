"""What the parameters do: multipliers on links, sources and capacity groups, and their derivatives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import prod

from geom.errors import InputError
from lumped.model.network import Network, Parameter

CHANNEL_OPERATORS = ("bias:", "gain:", "lag:")


def factor(parameter: Parameter, value: float) -> tuple[float, float]:
    """The multiplier a parameter stands for, and its derivative (by log(value) for mapping "log")."""
    if parameter.mapping == "relative":
        return 1.0 + value, 1.0
    if parameter.mapping == "log":
        return value, value
    return value, 1.0


def values_of(network: Network, values: Mapping[str, float] | None) -> dict[str, float]:
    """The value of every parameter: the declared one unless given."""
    declared = {p.name: p.value for p in network.parameters}
    unknown = sorted(set(values or {}) - set(declared))
    if unknown:
        raise InputError(f"unknown parameter '{unknown[0]}'", network.title, f"known: {', '.join(sorted(declared))}")
    return {**declared, **{k: float(v) for k, v in (values or {}).items()}}


def _known_targets(network: Network) -> set[str]:
    groups = {f"capacity:{g}" for g in network.capacity_group}
    return {link.name for link in network.links} | {source.name for source in network.sources} | groups


def _targets(network: Network, parameter: Parameter, known: set[str]) -> list[tuple[str, float]]:
    thermal = [(t, e) for t, e in parameter.targets if not t.startswith(CHANNEL_OPERATORS)]
    for target, _ in thermal:
        if target not in known:
            raise InputError(
                f"target '{target}' is no link, source or capacity group",
                f"parameter '{parameter.name}' of {network.title}",
                f"known: {', '.join(sorted(known))}",
            )
    return thermal


def _acting(network: Network, now: Mapping[str, float]) -> dict[str, list[tuple[str, float, float]]]:
    """Target -> what acts on it: (parameter, its factor, exponent)."""
    known = _known_targets(network)
    out: dict[str, list[tuple[str, float, float]]] = {}
    for p in network.parameters:
        f = factor(p, now[p.name])[0]
        for target, exponent in _targets(network, p, known):
            out.setdefault(target, []).append((p.name, f, exponent))
    return out


def multipliers(network: Network, values: Mapping[str, float] | None = None) -> dict[str, float]:
    """Target name -> multiplier, for every target that some parameter acts on."""
    acting = _acting(network, values_of(network, values))
    return {target: prod(f**exponent for _, f, exponent in on) for target, on in acting.items()}


def slopes(
    network: Network, values: Mapping[str, float] | None, parameters: Sequence[Parameter]
) -> list[dict[str, float]]:
    """For each parameter: target name -> d multiplier / d parameter (d log(value) for mapping "log")."""
    if not parameters:
        return []
    now = values_of(network, values)
    acting, declared = _acting(network, now), {p.name: p for p in network.parameters}
    out = []
    for parameter in parameters:
        if parameter.name not in declared:
            where = network.title
            raise InputError(f"unknown parameter '{parameter.name}'", where, "tangents are of its own parameters")
        own = declared[parameter.name]
        f, df = factor(own, now[own.name])
        moved = dict.fromkeys(target for target, _ in own.targets if target in acting)
        out.append({target: _slope(acting[target], own.name, f) * df for target in moved})
    return out


def _slope(acting: Sequence[tuple[str, float, float]], own: str, f: float) -> float:
    """Derivative of a product of powers by one of its factors."""
    exponent = sum(e for name, _, e in acting if name == own)
    return prod(g**e for name, g, e in acting if name != own) * exponent * f ** (exponent - 1.0)
