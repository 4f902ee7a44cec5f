"""What the parameters do: multipliers on links, sources and capacity groups, and their derivatives."""

from collections.abc import Mapping, Sequence
from math import prod

from geom.errors import InputError
from lumped.model.network import Network, Parameter
from lumped.model.once import once

CHANNEL_OPERATORS = ("bias:", "gain:", "lag:")


def factor(parameter: Parameter, value: float) -> tuple[float, float]:
    """The multiplier a parameter stands for, and its derivative (by log(value) for mapping "log")."""
    if parameter.mapping == "relative":
        return 1.0 + value, 1.0
    if parameter.mapping == "log":
        return value, value
    return value, 1.0


def values_of(network: Network, values: Mapping[str, float] | None) -> dict[str, float]:
    """The value of every parameter: the declared one unless given. InputError for a value of no parameter."""
    names = {p.name for p in network.parameters}
    unknown = sorted(set(values or {}) - names)
    if unknown:
        raise InputError(f"unknown parameter '{unknown[0]}'", network.title, f"known: {', '.join(sorted(names))}")
    return parameter_values(network, values or {})


def parameter_values(network: Network, values: Mapping[str, float]) -> dict[str, float]:
    """The value of every parameter: the declared one unless given. Values of no parameter are left out."""
    return {p.name: float(values.get(p.name, p.value)) for p in network.parameters}


@once
def _acting(network: Network) -> dict[str, list[tuple[str, float]]]:
    """Target -> what acts on it: (parameter, exponent)."""
    groups = {f"capacity:{g}" for g in network.capacity_group}
    targets = {link.name for link in network.links} | {source.name for source in network.sources} | groups
    out: dict[str, list[tuple[str, float]]] = {}
    for p in network.parameters:
        for t, exponent in p.targets:
            if t.startswith(CHANNEL_OPERATORS):
                continue
            if t not in targets:
                what, where = f"target '{t}' is not a link, source or capacity group", f"parameter '{p.name}'"
                raise InputError(what, f"{where} of {network.title}", f"known: {', '.join(sorted(targets))}")
            out.setdefault(t, []).append((p.name, exponent))
    return out


def multipliers(network: Network, values: Mapping[str, float] | None = None) -> dict[str, float]:
    """Target name -> multiplier, for every target that some parameter acts on."""
    now = values_of(network, values)
    f = {p.name: factor(p, now[p.name])[0] for p in network.parameters}
    return {target: prod(f[name] ** exponent for name, exponent in on) for target, on in _acting(network).items()}


def slopes(
    network: Network, values: Mapping[str, float] | None, parameters: Sequence[Parameter]
) -> list[dict[str, float]]:
    """For each parameter: target name -> d multiplier / d parameter (d log(value) for mapping "log")."""
    if not parameters:
        return []
    now = values_of(network, values)
    acting, by_name = _acting(network), {p.name: p for p in network.parameters}
    f = {name: factor(p, now[name])[0] for name, p in by_name.items()}
    out = []
    for parameter in parameters:
        if parameter.name not in by_name:
            where = network.title
            raise InputError(f"unknown parameter '{parameter.name}'", where, "tangents are of its own parameters")
        declaration = by_name[parameter.name]
        df = factor(declaration, now[declaration.name])[1]
        targets = dict.fromkeys(target for target, _ in declaration.targets if target in acting)
        out.append({target: _slope(acting[target], f, declaration.name) * df for target in targets})
    return out


def _slope(acting: Sequence[tuple[str, float]], f: Mapping[str, float], parameter: str) -> float:
    """Derivative of a product of powers by one of its factors."""
    exponent = sum(e for name, e in acting if name == parameter)
    return prod(f[name] ** e for name, e in acting if name != parameter) * exponent * f[parameter] ** (exponent - 1.0)
