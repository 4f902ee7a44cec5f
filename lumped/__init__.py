"""lumped: how does the whole machine warm up?

Names are loaded when they are used: a command pays for nothing else.
"""

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from lumped.declarations.network import load_circuits as load_circuits, load_network as load_network
    from lumped.drives.coupled import Coupled as Coupled, coupled as coupled
    from lumped.integration.balance import Audit as Audit, audit as audit
    from lumped.integration.balance import Balance as Balance, balance as balance
    from lumped.integration.ensemble import dask_cluster as dask_cluster, ensemble as ensemble
    from lumped.integration.simulate import Record as Record, Run as Run, simulate as simulate
    from lumped.integration.steady import Steady as Steady, steady as steady
    from lumped.model.build import bare_network as bare_network, node_link as node_link, node_source as node_source
    from lumped.model.build import stream as stream
    from lumped.model.multipliers import multipliers as multipliers
    from lumped.model.network import Link as Link, Network as Network, Parameter as Parameter, Place as Place
    from lumped.model.network import Recovery as Recovery, Row as Row, Source as Source

__getattr__, __dir__ = loaded_when_used(__name__, __file__)
