"""lumped: how does the whole machine warm up?"""

from lumped.balance import Balance, balance
from lumped.build import bare_network, node_link, node_source, stream
from lumped.declared import load_network
from lumped.multipliers import multipliers
from lumped.network import Link, Network, Parameter, Place, Recovery, Row, Source
from lumped.simulate import Record, Run, simulate
from lumped.steady import Steady, steady

__all__ = [
    "Balance",
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
    "balance",
    "bare_network",
    "load_network",
    "multipliers",
    "node_link",
    "node_source",
    "simulate",
    "steady",
    "stream",
]
