"""lumped: how does the whole machine warm up?"""

from lumped.audit import Audit, audit
from lumped.balance import Balance, balance
from lumped.build import bare_network, node_link, node_source, stream
from lumped.coupled import Coupled, coupled
from lumped.declared import load_circuits, load_network
from lumped.ensemble import dask_cluster, ensemble
from lumped.multipliers import multipliers
from lumped.network import Link, Network, Parameter, Place, Recovery, Row, Source
from lumped.simulate import Record, Run, simulate
from lumped.steady import Steady, steady

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
