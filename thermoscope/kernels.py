"""Loads the model's compiled kernels, so that processes made from this one have them; a set-up compiles them by it.

Loading takes half a second, running two nodes for eight samples next to nothing; all networks share what is compiled.
"""

import numpy as np

from lumped.integration.balance import balance
from lumped.integration.record import Record
from lumped.integration.simulate import simulate
from lumped.integration.steady import steady
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Parameter
from lumped.transfer.laws import Fixed, InputPower
from measured.sensors.operators import lag, shifted

_BARE = bare_network("two nodes", {"iron": 1.0, "skin": 0.0}, ("ambient",))
_FILM = InputPower(1.0, (("flow", 1.0, 0.8),))
_LINKS = [
    node_link(_BARE, "joint", "joint", "iron", "skin", Fixed(1.0)),
    node_link(_BARE, "film", "film", "skin", "ambient", _FILM),
]
_LOSS = node_source(_BARE, "loss", "copper", {"iron": 1.0}, InputPower(1.0, (("flow", 1.0, 2.0),)))
_TWO = _BARE.extended(_LINKS, [_LOSS], (Parameter("film", (("film", 1.0),)),))
_TIME, _AIR = np.arange(8.0), {"ambient": np.full(8, 20.0)}
_RECORD = Record(_TIME, {"flow": np.array([1.0, 1.0, 2.0, 2.0, 1.0, 3.0, 1.0, 1.0])}, _AIR, 20.0)
_READ = simulate(_TWO, _RECORD, rows=[_TWO.place("iron").mean], tangents=_TWO.parameters).y
balance(_TWO, _RECORD)
steady(_TWO, {"flow": 1.0}, {"ambient": 20.0})
lag(_TIME, shifted(_TIME, _READ, 0.5), np.ones(1))
