"""Networks of whole machines without shapes: enough for everything but temperatures, and they cost no solve."""

import numpy as np

from fem.solvers.snapshots import Basis
from geom import Machine
from lumped.build.pipeline import Prepared
from lumped.condensation.condensed import network_in
from lumped.machine.motor import boundaries, fluids, motor_network
from lumped.model.network import Network


def means_only(ready: Prepared, machine: Machine | None = None) -> Network:
    """machine : what the network is made for, if not the machine that was meshed"""
    machine, blocks = machine or ready.machine, ready.field.blocks
    none = {part: Basis(np.ones((b.n, 1)), np.zeros(0), np.zeros(0)) for part, b in blocks.items()}
    loads = {part: ready.field.load(part) for part in blocks}
    condensed = network_in(
        ready.field, none, ready.contacts, loads, frozenset(loads), fluids(machine), boundaries(machine), machine.name
    )
    return motor_network(machine, condensed)
