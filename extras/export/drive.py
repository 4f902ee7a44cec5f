"""The exported C, compiled for this computer and held against `simulate` on the tests of the case."""

from __future__ import annotations

import ctypes
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from extras.export.c_code import RUNTIME, c_files
from extras.export.compilers import here, library
from extras.export.model import Model
from thermoscope import Network, Record, ThermoscopeError, plugin as th, simulate

AGREES_K = 0.05  # largest difference to the simulation


class Compiled:
    """A model's C code, ready to run over records."""

    def __init__(self, model: Model, extra: Sequence[str] = ()) -> None:
        self.model = model
        files = {**c_files(model), "thermal_run.c": (RUNTIME / "thermal_run.c").read_text(encoding="utf-8")}
        with tempfile.TemporaryDirectory() as folder:  # the loader keeps the file open where it has to
            file = Path(folder) / f"model{here().ending}"
            file.write_bytes(library(files, here(), extra))
            self.code = ctypes.CDLL(str(file))

    def run(self, time: th.Array, u: th.Array, x0: th.Array) -> th.Array:
        """(n_time, n_output) degC from signals u (n_time, n_signal) and first states (n_state,)."""
        y = np.empty((time.size, len(self.model.outputs)))
        arrays = [np.ascontiguousarray(a, float) for a in (time, u, x0)]
        pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in (*arrays, y)]
        if self.code.thermal_run(ctypes.c_int(time.size), *pointers):
            raise ThermoscopeError(f"the exported code of '{self.model.name}' finds no step")
        return y


def signals_of(model: Model, record: Record) -> th.Array:
    """(n_time, n_signal)"""
    signals: Mapping[str, th.Array | float] = {**record.inputs, **record.boundaries}
    return np.column_stack(
        [np.broadcast_to(np.asarray(signals[s.name], float), record.time.shape) for s in model.signals]
    )


def sampled(record: Record) -> Record:
    """The record as the code is given it: inputs at its samples, straight between them, nothing finer."""
    return replace(record, inputs={name: np.asarray(u, float) for name, u in record.inputs.items()})


def difference(code: Compiled, network: Network, record: Record, values: Mapping[str, float]) -> float:
    """Largest difference (K) between the code and the simulation over a record."""
    model = code.model
    run = simulate(network, record, values, [o.row for o in model.outputs])
    y = code.run(record.time, signals_of(model, record), th.initial_state(network, record.initial))
    return float(np.abs(y - run.y).max())
