"""The field with radiation facet by facet and copper loss element by element.

A network's laws see means: radiation that of a face, copper loss that of a winding. This is the field without that
simplification, at the same operating point; the rest stays as the network settles.
"""

from collections.abc import Mapping

import numpy as np

from fem.matrices.assembly import FieldModel
from fem.matrices.material import CopperLoss, Radiation, Term
from fem.solvers.newton import NonlinearSolution, solve_nonlinear
from fem.solvers.solve import Fluids, Solver
from lumped.build.crosscheck import CrossCheck, Shares, fluid_nodes
from lumped.model.network import Array, Link, Network, Source
from lumped.transfer import laws
from lumped.transfer.terms_value import temperature_value


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
    """Newton's method from the field of a cross-check; arguments as for `crosscheck`."""
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
