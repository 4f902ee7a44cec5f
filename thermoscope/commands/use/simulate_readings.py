"""What the sensors of a case would read in a simulated run: their lag, and what calibration found of bias and gain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lumped.integration.simulate import Record
from lumped.model.network import Network
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.runs import sensors

Array = NDArray[np.float64]


def readings(network: Network, folder: Folder, name: str, record: Record, T: Array) -> Array:
    """From the temperatures T (n_time, n_sensor) at the sensors, in the order of `sensors`."""
    from measured.sensors.operators import observe, setting

    if not folder.case.tests:
        return T
    channels = tuple(replace(c, y=np.full(record.time.size, np.nan)) for c in sensors(folder).values())
    air = {n: np.broadcast_to(u, record.time.shape) for n, u in record.boundaries.items()}
    run = replace(folder.case.tests[0], name=name, time=record.time, inputs={}, boundaries=air, channels=channels)
    return observe(network, run, T, setting(network.parameters, folder.case.model.values))


def short_of(record: Record, share: float = 0.01) -> dict[str, float]:
    """What the drive could not deliver: quantity -> seconds for which it missed what was wanted by more than `share`.

    Of the torque or speed wanted, against the largest wanted: too little, and, where it has no brake for it, too much.
    """
    out, step = {}, np.diff(record.time, prepend=record.time[0])
    for name, demand in record.inputs.items():
        if (actual := record.inputs.get(name.replace("_wanted", ""))) is not None and "_wanted" in name:
            missed = np.abs(demand - actual) > share * np.abs(demand).max(initial=1e-12)
            out[name.replace("_wanted", "")] = float(step @ missed)
    return {name: seconds for name, seconds in out.items() if seconds > 0.0}
