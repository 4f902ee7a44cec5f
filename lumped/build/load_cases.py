"""What a network is checked with while it is built: the rated losses and fluids of the machine, and draws."""

import numpy as np

from fem.solvers.solve import coupled, film_columns
from geom import Machine
from geom.arrays import Numbers
from lumped.build.crosscheck import coefficients, fluid_nodes
from lumped.build.pipeline import means_network
from lumped.condensation.linear import linear, unit_load
from lumped.condensation.reduction import Reduction
from lumped.condensation.reduction_error import LoadCases, random_load_cases
from lumped.machine.air import INTAKE_USUAL_C
from lumped.machine.films import surroundings
from lumped.machine.loss_sources import loss_watts
from lumped.machine.motor import rated_inputs
from lumped.model.network import Array, Network


def load_cases(machine: Machine, reduction: Reduction) -> LoadCases:
    """The losses of the rated point with its fluids, and variations of them, as the guard applies them."""
    whole = means_network(machine, reduction)
    rated = rated_watts(machine, whole)
    return random_load_cases(
        list(reduction.zones), list(reduction.washing), rated, fluid_rises(machine, reduction, whole, rated)
    )


def rated_watts(machine: Machine, network: Network) -> Numbers:
    """Watts per part or zone at the rated point, windings at their reference temperature."""
    return loss_watts(machine, network, rated_inputs(machine))


def rated_streams(machine: Machine, network: Network) -> Array:
    """The streams' matrix (W/K) among the fluids at the rated point, for coolant and air as warm as films are usually.

    Temperatures are rises there, so a stream can not look at them.
    """
    cooling = surroundings(machine, ()).cooling
    z = np.full(network.size, INTAKE_USUAL_C if cooling is None else cooling.usual_C)
    z[network.column("ambient")] = INTAKE_USUAL_C
    return coefficients(network, rated_inputs(machine), z).streams


def fluid_rises(machine: Machine, reduction: Reduction, network: Network, rated: Numbers) -> dict[str, float]:
    """fluid -> K over the surroundings at the rated losses and the reduction's coefficients, as a network has it."""
    fluids, zones = fluid_nodes(network), list(reduction.zones)
    system = linear(network, reduction.films, reduction.contacts)
    load = sum(rated.get(zone, 0.0) * unit_load(network, zone, system.solid) for zone in zones)
    columns = [list(system.fluid).index(network.column(name)) for name in fluids]
    G = film_columns(reduction.field, reduction.films, fluids)[1] + rated_streams(machine, network)
    fluid_losses = np.array([[rated.get(fluid, 0.0)] for fluid in fluids])
    inverse = np.linalg.inv(system.A)
    _, u = coupled(lambda y: inverse @ y, np.reshape(load, (-1, 1)), system.B[:, columns], G, fluid_losses)
    return dict(zip(fluids, u[:, 0].tolist(), strict=True))
