"""lumped: how does the whole machine warm up?"""

from lumped.declarations.network import load_circuits, load_network
from lumped.drives.coupled import Coupled, coupled
from lumped.integration.audit import Audit, audit
from lumped.integration.balance import Balance, balance
from lumped.integration.ensemble import dask_cluster, ensemble
from lumped.integration.simulate import Record, Run, simulate
from lumped.integration.steady import Steady, steady
from lumped.model.build import bare_network, node_link, node_source, stream
from lumped.model.multipliers import multipliers
from lumped.model.network import Link, Network, Parameter, Place, Recovery, Row, Source

__all__ = [
    "Audit",
    "Balance",
    "Coupled",
    "Link",
    "Network",
    "Parameter",
    "Place",
    "Record",
    "Recovery",
    "Row",
    "Run",
    "Source",
    "Steady",
    "audit",
    "balance",
    "bare_network",
    "coupled",
    "dask_cluster",
    "ensemble",
    "load_circuits",
    "load_network",
    "multipliers",
    "node_link",
    "node_source",
    "simulate",
    "steady",
    "stream",
]
