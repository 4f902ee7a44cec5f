"""What calibration may move in network.toml: prior_sd inside tables, and [parameters.NAME]."""

from collections.abc import Mapping
from dataclasses import replace

from lumped.model.network import Network, Parameter
from lumped.schemas.bounds import TINY
from lumped.schemas.reader import Table
from lumped.sources.loss_laws import EDDY

MAPPINGS = {  # neutral value, least, most
    "log": (1.0, 1e-3, 1e3),
    "amplitude": (0.0, -1e6, 1e6),
    "relative": (0.0, -1.0, 1e3),
    "offset": (0.0, -1e3, 1e3),
}


def read_parameters(network: Network, top: Table, nodes: Mapping[str, Table]) -> tuple[Parameter, ...]:
    """All parameters of a file."""
    tables = [_whole(_parameter(name, table), network) for name, table in top.tables("parameters").items()]
    parameters = (*_inline(network, top, nodes), *_of_circuits(network, top), *tables)
    names = [p.name for p in parameters]
    for name in (n for n in names if names.count(n) > 1):
        what = f"two parameters are called '{name}': prior_sd in a table makes one of that name"
        raise top.error(what, "prior_sd there, or [parameters.NAME] of another name")
    return tuple(replace(p, targets=(*p.targets, *_companions(network, p))) for p in parameters)


def _companions(network: Network, parameter: Parameter) -> list[tuple[str, float]]:
    """What a measured total leaves out grows with what the model injects instead."""
    pairs = [(s.name, s.name.partition(":less:")[2]) for s in network.sources if ":less:" in s.name]
    return [(remainder, e) for remainder, of in pairs for target, e in parameter.targets if target == f"loss:{of}"]


def _inline(network: Network, top: Table, nodes: Mapping[str, Table]) -> list[Parameter]:
    """One parameter for every table that carries prior_sd: the multiplier of what it declares."""
    out = []
    for section, prefix in (("links", "link"), ("streams", "stream"), ("losses", "loss")):
        for name, table in top.tables(section).items():
            if "prior_sd" in table:
                stem = f"{prefix}:{name}"
                mine = [i.name for i in network.elements if i.name == stem or i.name.startswith(f"{stem}:")]
                acts = tuple((n, 1.0) for n in mine if ":less:" not in n)
                sd, flow = table.number("prior_sd"), section == "streams"
                out.append(Parameter(f"{prefix}.{name}", acts, prior_sd=sd, flow=flow))
    for name, table in nodes.items():
        if "prior_sd" in table:
            sd = table.number("prior_sd")
            out.append(Parameter(f"capacity.{name}", ((f"capacity:{name}", 1.0),), prior_sd=sd))
    return out


def _of_circuits(network: Network, top: Table) -> list[Parameter]:
    """prior_sd scales a circuit's flow of heat, film_prior_sd all its films."""
    out = []
    for name, table in top.tables("circuits").items():
        films = tuple((x.name, 1.0) for x in network.links if x.name.startswith(f"film:{name}."))
        single, parts = f"stream:{name}", (f"stream:{name}:", f"stream:{name}.")
        streams = tuple((x.name, 1.0) for x in network.links if x.name == single or x.name.startswith(parts))
        acts = {"prior_sd": (f"circuit.{name}", streams), "film_prior_sd": (f"film.{name}", films)}
        out += [
            Parameter(*acts[key], prior_sd=table.number(key), flow=key == "prior_sd") for key in acts if key in table
        ]
    return out


def _whole(p: Parameter, network: Network) -> Parameter:
    """A film that is a sum of laws, "NAME" and "NAME:2" and so on, is moved as one; so is copper with eddy currents."""
    more = [(x.name, w) for name, w in p.targets for x in network.links if _numbered(x.name, name)]
    more += [(x.name, w) for name, w in p.targets for x in network.sources if x.name == f"{name}{EDDY}"]
    return replace(p, targets=(*p.targets, *(pair for pair in more if pair not in p.targets)))


def _numbered(name: str, film: str) -> bool:
    return name.startswith(f"{film}:") and name.removeprefix(f"{film}:").isdigit()


def _parameter(name: str, table: Table) -> Parameter:
    mapping = table.word("mapping", "log", MAPPINGS)
    neutral, low, high = MAPPINGS[mapping]
    listed = isinstance(table.raw("acts_on"), list)
    targets = dict.fromkeys(table.members("acts_on"), 1.0) if listed else table.shares("acts_on", of="acts_on")
    if not targets:
        raise table.error("acts_on = {} names nothing", 'acts_on = ["link:NAME", ...]')
    value, unit = table.number("value", neutral), table.word("unit", "1")
    low, high = table.number("low", low), table.number("high", high)
    sd, sign = table.number("prior_sd", 0.3, of="parameters.prior_sd"), int(table.number("sign", 0))
    limits = (value, unit, low, high, sd, mapping, neutral, sign)
    parameter = Parameter(name, tuple(targets.items()), *limits, table.word("source", ""), table.flag("flow", False))  # type: ignore[arg-type]
    table.close()
    return _checked(parameter, table)


def _checked(p: Parameter, table: Table) -> Parameter:
    """low < high, both positive for a factor, with the declared and the neutral value between them."""
    if p.mapping == "log" and p.low < TINY:
        raise table.error(f"low = {p.low:g} of a factor is not possible", f"a number from {TINY:g}")
    if not p.low < p.high:
        raise table.error(f"low = {p.low:g} and high = {p.high:g} leave nothing between them", "low below high")
    for key, value in (("value", p.value), ("the neutral value", p.neutral)):
        if not p.low <= value <= p.high:
            raise table.error(f"{key} = {value:g} is outside low = {p.low:g} to high = {p.high:g}", "bounds around it")
    return p
