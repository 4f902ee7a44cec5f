"""What the parameters do: multipliers on links, sources and capacity groups, and their derivatives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from geom.errors import InputError
from lumped.network import Network, Parameter

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
        raise InputError(
            f"unknown parameter '{unknown[0]}'", f"network '{network.name}'", f"known: {', '.join(sorted(declared))}"
        )
    return {**declared, **{k: float(v) for k, v in (values or {}).items()}}


def _known_targets(network: Network) -> set[str]:
    groups = {f"capacity:{g}" for g in network.capacity_group}
    return {link.name for link in network.links} | {source.name for source in network.sources} | groups


def _targets(network: Network, parameter: Parameter, known: set[str]) -> list[tuple[str, float]]:
    kept = [(t, e) for t, e in parameter.targets if not t.startswith(CHANNEL_OPERATORS)]
    for target, _ in kept:
        if target not in known:
            raise InputError(
                f"target '{target}' is no link, source or capacity group",
                f"parameter '{parameter.name}' of network '{network.name}'",
                f"known: {', '.join(sorted(known))}",
            )
    return kept


def multipliers(network: Network, values: Mapping[str, float] | None = None) -> dict[str, float]:
    """Target name -> multiplier, for every target that some parameter acts on."""
    now, known = values_of(network, values), _known_targets(network)
    out: dict[str, float] = {}
    for p in network.parameters:
        f = factor(p, now[p.name])[0]
        for target, exponent in _targets(network, p, known):
            out[target] = out.get(target, 1.0) * f**exponent
    return out


def slopes(network: Network, values: Mapping[str, float] | None, parameter: Parameter) -> dict[str, float]:
    """Target name -> d multiplier / d parameter (d log(value) for mapping "log")."""
    now, known = values_of(network, values), _known_targets(network)
    own = network_parameter(network, parameter)
    f, df = factor(own, now[own.name])
    rest = replace(network, parameters=tuple(p for p in network.parameters if p.name != own.name))
    others = multipliers(rest, {k: v for k, v in now.items() if k != own.name})
    out: dict[str, float] = {}
    exponents: dict[str, float] = {}
    for target, exponent in _targets(network, own, known):
        exponents[target] = exponents.get(target, 0.0) + exponent
    for target, exponent in exponents.items():
        out[target] = others.get(target, 1.0) * exponent * f ** (exponent - 1.0) * df
    return out


def network_parameter(network: Network, parameter: Parameter) -> Parameter:
    """The network's own declaration of a parameter."""
    for p in network.parameters:
        if p.name == parameter.name:
            return p
    raise InputError(
        f"unknown parameter '{parameter.name}'", f"network '{network.name}'", "tangents are of its own parameters"
    )
