"""Loads the model's compiled kernels, so that processes made from this one have them.

Loading takes half a second, running a node for two samples next to nothing.
"""

from __future__ import annotations

import numpy as np

from lumped.integration.record import Record
from lumped.integration.simulate import simulate
from lumped.model.build import bare_network, node_link
from lumped.transfer.laws import Fixed

_NODE = bare_network("one node", {"node": 1.0}, ("ambient",))
_COOLED = _NODE.extended([node_link(_NODE, "film", "film", "node", "ambient", Fixed(1.0))], [], ())
simulate(_COOLED, Record(np.array([0.0, 1.0]), {}, {"ambient": np.full(2, 20.0)}, 20.0), rows=[])
