"""The network against the field it came from, on the same mesh, with the same coefficients: where do they differ?"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fem.matrices.assembly import FieldModel
from fem.matrices.material import CopperLoss, Radiation, Term
from fem.solvers.newton import NonlinearSolution, solve_nonlinear
from fem.solvers.solve import Fluids, Solver, Steady, steady
from geom.arrays import Numbers
from lumped.integration.steady import steady as steady_rest
from lumped.model.multipliers import multipliers
from lumped.model.network import Array, Link, Network, Source
from lumped.transfer import laws
from lumped.transfer.terms_value import coefficient, temperature_value

Shares = Mapping[str, Numbers]
FLOOR = 0.1  # of the machine's largest rise: below it a percentage of a part's own rise means nothing


@dataclass(frozen=True)
class PartCheck:
    """Mean and hottest temperature (degC) of a part in the field and in the network."""

    place: str
    fem_mean_C: float
    network_mean_C: float
    fem_max_C: float
    network_max_C: float
    mean_percent: float
    hot_percent: float
    heated: bool

    @property
    def percent_of_rise(self) -> float:
        """The larger of mean and hottest point."""
        return max(self.mean_percent, self.hot_percent)


@dataclass(frozen=True)
class LinkCheck:
    """Heat (W) through a contact, from its first part to its second, or out of a face; percent of all heat.

    parts : whose it is
    """

    link: str
    parts: tuple[str, ...]
    fem_W: float
    network_W: float
    percent_of_heat: float


@dataclass(frozen=True)
class CrossCheck:
    """parts, links : all of them;  energy_balance : |in - out| / in of the field solution

    state (n,) of the network with its boundaries; field (n,) degC
    at : what every link amounts to there;  heat : all losses (W)
    """

    parts: tuple[PartCheck, ...]
    energy_balance: float
    state: Array
    field: Array
    links: tuple[LinkCheck, ...]
    at: "Coefficients"
    heat: float

    @property
    def worst(self) -> PartCheck:
        return max(self.parts, key=lambda p: p.percent_of_rise)

    def responsible(self, part: str) -> LinkCheck | None:
        """Of the links of a part the one whose heat differs most between field and network."""
        links = [link for link in self.links if part in link.parts]
        return max(links, key=lambda link: link.percent_of_heat, default=None)


@dataclass(frozen=True)
class Coefficients:
    """What every link and source amounts to at one operating point and temperature state."""

    films: dict[str, float]
    contacts: dict[str, float]
    conductivity: dict[str, float]
    watts: dict[str, float]
    streams: Array
    inflow: Array


def steady_state(network: Network, inputs: Numbers, ambient: float) -> Array:
    """(n + n_boundary,) temperatures the network settles at (degC)."""
    return steady_rest(network, inputs, dict.fromkeys(network.boundaries, ambient)).z


def coefficients(network: Network, inputs: Numbers, z: Array, shares: Shares | None = None) -> Coefficients:
    """Film h and contact g (W/m2/K), losses (W) by place, and the streams' matrix among the fluid nodes.

    shares : source -> share of its watts per part, zone or fluid; None: by the mean nodes it heats
    """
    m = multipliers(network)
    signals = {name: np.array([float(value)]) for name, value in inputs.items()}
    films: dict[str, float] = {}
    contacts: dict[str, float] = {}
    conductivity: dict[str, float] = {}
    watts: dict[str, float] = {}
    fluids = fluid_nodes(network)
    n, ambient = len(network.states), z[len(network.states) :]
    D, s = np.zeros((len(fluids), len(fluids))), np.zeros(len(fluids))

    def value(law: laws.Law, name: str, hot: float, cold: float) -> float:
        return m.get(name, 1.0) * coefficient(law, signals, hot, cold)

    for link in network.links:
        g = value(link.law, link.name, link.hot.at(z), link.cold.at(z))
        key = link.name.split(":")[1]
        if link.kind == "film":
            films[key] = films.get(key, 0.0) + g
        elif link.kind == "contact":
            contacts[key] = contacts.get(key, 0.0) + g
        elif link.kind == "conduction":
            conductivity[key] = g
        else:
            for row, col, v in zip(link.rows, link.cols, link.vals, strict=True):
                if col < n:
                    D[fluids.index(network.states[row]), fluids.index(network.states[col])] += g * v
                else:
                    s[fluids.index(network.states[row])] -= g * v * ambient[col - n]
    for source in network.sources:
        q = value(source.law, source.name, source.probe.at(z), 0.0)
        for place, share in _heated(network, source, shares).items():
            watts[place] = watts.get(place, 0.0) + q * share
    for k, name in enumerate(fluids):
        s[k] += watts.pop(name, 0.0)
    return Coefficients(films, contacts, conductivity, watts, D, s)


def _heated(network: Network, source: Source, shares: Shares | None) -> Numbers:
    if shares is not None:
        return shares[source.name]
    out: dict[str, float] = {}
    for i, w in zip(source.index, source.weights, strict=True):
        if "#" not in network.states[i]:
            out[network.states[i]] = out.get(network.states[i], 0.0) + float(w)
    return out


def fluid_nodes(network: Network) -> tuple[str, ...]:
    return tuple(p.name for p in network.places.values() if p.kind == "fluid" and p.name in network.states)


def crosscheck(
    field: FieldModel,
    network: Network,
    inputs: Numbers,
    ambient: float = 20.0,
    solver: Solver | None = None,
    loads: Mapping[str, Array] | None = None,
    shares: Shares | None = None,
    z: Array | None = None,
) -> CrossCheck:
    """Steady state of both at one operating point, with the coefficients the network settles at.

    loads : zone -> (n,) unit loss on the field;  shares : source -> zones, see `coefficients`
    z : where the network settles, if that is known
    """
    z = steady_state(network, inputs, ambient) if z is None else z
    c = coefficients(network, inputs, z, shares=shares)
    load = sum(
        (q * (loads or {}).get(place, _uniform(field, place)) for place, q in c.watts.items()), np.zeros(field.n)
    )
    fluids = Fluids(fluid_nodes(network), c.streams, c.inflow, dict.fromkeys(network.boundaries, ambient))
    full = steady(solver or Solver(field), c.films, c.contacts, load, fluids, c.conductivity)
    parts = compared(field, network, full, z[: len(network.states)], ambient)
    u = {**dict(zip(fluids.names, full.u, strict=True)), **fluids.fixed}
    return CrossCheck(parts, full.energy_balance, z, full.T, through(field, network, full, z, u, c), c, full.injected)


def _uniform(field: FieldModel, place: str) -> Array:
    return field.load(place) if place in field.blocks else np.zeros(field.n)


def through(
    field: FieldModel, network: Network, full: Steady, z: Array, u: Numbers, c: Coefficients
) -> tuple[LinkCheck, ...]:
    """Heat through every contact and film of the field, beside the network's, largest difference first."""
    scale, out = max(full.injected, 1e-300), []

    def add(name: str, parts: tuple[str, ...], fem: float, network_W: float) -> None:
        out.append(LinkCheck(name, parts, fem, network_W, 100.0 * abs(fem - network_W) / scale))

    for link in network.links:
        if link.kind == "contact":
            key = link.name.removeprefix("contact:")
            touch, g = field.contacts[key], c.contacts[key]
            fem = g * float(touch.a.b @ full.T[touch.a.dofs] - touch.b.b @ full.T[touch.b.dofs])
            add(link.name, link.places, fem, g * touch.area * (link.hot.at(z) - link.cold.at(z)))
    for face, film in field.films.items():
        place, h, t = network.places[face], c.films.get(face, 0.0), film.trace
        fem = h * float(t.b @ full.T[t.dofs] - t.area * u[film.fluid])
        network_W = h * t.area * (place.mean.at(z) - float(z[network.column(film.fluid)]))
        add(f"film:{face}", (t.part,), fem, network_W)
    return tuple(sorted(out, key=lambda link: -link.percent_of_heat))


def compared(field: FieldModel, network: Network, full: Steady, x: Array, ambient: float) -> tuple[PartCheck, ...]:
    """Part by part; percentages are of the part's own rise, of at least a tenth of the machine's largest."""
    assert network.recovery is not None
    T = network.recovery.field(x)
    largest = float(full.T.max()) - ambient
    out = []
    for part, block in field.blocks.items():
        mean, hot = float(field.mean(part) @ full.T), float(full.T[block.dofs].max())
        network_mean, peak = float(x[network.states.index(part)]), float(T[block.dofs].max())
        mean_off = abs(network_mean - mean) / max(abs(mean - ambient), FLOOR * largest)
        hot_off = abs(peak - hot) / max(hot - ambient, FLOOR * largest)
        heated = part in network.heated
        out.append(PartCheck(part, mean, network_mean, hot, peak, 100.0 * mean_off, 100.0 * hot_off, heated))
    return tuple(out)


def with_local_laws(
    field: FieldModel,
    network: Network,
    inputs: Mapping[str, float],
    check: CrossCheck,
    shares: Shares,
    loads: Mapping[str, Array] | None = None,
    solver: Solver | None = None,
    ambient: float = 20.0,
) -> NonlinearSolution:
    """The field with radiation facet by facet and copper loss element by element; arguments as for `crosscheck`.

    A network's laws see means: radiation that of a face, copper loss that of a winding. This is the field without that
    simplification, at the same operating point, by Newton's method; the rest stays as the network settles.
    """
    signals = {name: np.array([float(value)]) for name, value in inputs.items()}
    films, watts = dict(check.at.films), dict(check.at.watts)
    terms: list[Term] = []
    for link in radiating(network):
        emissivity, face = float(np.mean(link.law.factor(signals))), link.places[0]
        hot, cold = link.hot.at(check.state), link.cold.at(check.state)
        films[face] = max(films[face] - emissivity * temperature_value(link.law.temperature, hot, cold), 0.0)
        terms.append(Radiation(face, emissivity, cold))
    for source, law in copper(network):
        rated = float(np.mean(source.law.factor(signals)))
        now = rated * temperature_value(law, source.probe.at(check.state), 0.0)
        for part, share in shares[source.name].items():
            if part in field.blocks:
                watts[part] -= now * share
                terms.append(CopperLoss(part, rated * share, law.alpha, law.reference))
    zones = {part: field.load(part) for part in field.blocks} | dict(loads or {})
    load = sum((q * zones[place] for place, q in watts.items() if place in zones), np.zeros(field.n))
    fluids = Fluids(fluid_nodes(network), check.at.streams, check.at.inflow, dict.fromkeys(network.boundaries, ambient))
    return solve_nonlinear(solver or Solver(field), films, check.at.contacts, load, fluids, terms, check.field)


def radiating(network: Network) -> list[Link]:
    return [x for x in network.links if x.kind == "film" and isinstance(x.law.temperature, laws.Radiation)]


def copper(network: Network) -> list[tuple[Source, laws.Linear]]:
    """Losses that follow their winding's temperature."""
    return [(s, s.law.temperature) for s in network.sources if isinstance(s.law.temperature, laws.Linear)]
