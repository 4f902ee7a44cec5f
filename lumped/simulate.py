"""Run a network over a record, with exact tangents of the discrete scheme.

    run = simulate(network, Record(time, inputs, boundaries, initial), multipliers, rows, tangents)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.network import Network, Parameter, Row

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """time (nt,) s; inputs and boundaries: name -> (nt,) or scalar; initial: degC everywhere or per place."""

    time: Array
    inputs: Mapping[str, Array]
    boundaries: Mapping[str, Array]
    initial: float | Mapping[str, float] = 20.0


@dataclass(frozen=True)
class Run:
    """time (nt,); z (nt, n_states + n_boundaries) degC if kept; y (nt, n_rows); dy (nt, n_rows, n_tangents)."""

    time: Array
    z: Array | None
    y: Array
    dy: Array | None


def simulate(
    network: Network,
    record: Record,
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tangents: Sequence[Parameter] = (),
    keep_states: bool = False,
) -> Run:
    """Integrate the network over the record.

    values : parameter name -> value; parameters of the network that are not listed stand at their declared value
    rows : linear outputs of z = [x; u] (sensors, before bias, gain and lag)
    tangents : parameters of the network with respect to which y is differentiated: d y / d value for
        mappings "amplitude", "relative" and "offset", d y / d log(value) for "log"
    """
    raise NotImplementedError
