"""lumped: how does the whole machine warm up?

Names are loaded when they are used: a command pays for nothing else.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
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

_HOME = {
    "Audit": "lumped.integration.audit",
    "Balance": "lumped.integration.balance",
    "Coupled": "lumped.drives.coupled",
    "Link": "lumped.model.network",
    "Network": "lumped.model.network",
    "Parameter": "lumped.model.network",
    "Place": "lumped.model.network",
    "Record": "lumped.integration.simulate",
    "Recovery": "lumped.model.network",
    "Row": "lumped.model.network",
    "Run": "lumped.integration.simulate",
    "Source": "lumped.model.network",
    "Steady": "lumped.integration.steady",
    "audit": "lumped.integration.audit",
    "balance": "lumped.integration.balance",
    "bare_network": "lumped.model.build",
    "coupled": "lumped.drives.coupled",
    "dask_cluster": "lumped.integration.ensemble",
    "ensemble": "lumped.integration.ensemble",
    "load_circuits": "lumped.declarations.network",
    "load_network": "lumped.declarations.network",
    "multipliers": "lumped.model.multipliers",
    "node_link": "lumped.model.build",
    "node_source": "lumped.model.build",
    "simulate": "lumped.integration.simulate",
    "steady": "lumped.integration.steady",
    "stream": "lumped.model.build",
}
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
__getattr__, __dir__ = loaded_when_used(__name__, _HOME)
