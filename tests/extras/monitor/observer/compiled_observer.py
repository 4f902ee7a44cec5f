"""The observer's C code, compiled for this computer and run on whole records."""

import ctypes
import tempfile
from pathlib import Path

import numpy as np

from extras.export.compilers import here, library
from extras.monitor.observer_code import observer_files

RUN = Path(__file__).with_name("thermal_observer_run.c")


class CompiledObserver:
    """The observer's C code for this computer."""

    def __init__(self, of, extra=()):
        self.of = of
        sources = {**observer_files(of)}
        network = sources.pop("thermal_network.c")
        main = sources.pop("thermal_observer.c").replace('#include "thermal_network.c"', network)
        files = {**sources, "run.c": RUN.read_text(encoding="utf-8").replace('#include "thermal_observer.c"', main)}
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / f"observer{here().ending}"
            file.write_bytes(library(files, here(), extra))
            self.code = ctypes.CDLL(str(file))

    @property
    def bytes(self):
        return int(self.code.thermal_observer_bytes())

    def run(self, time, u, y):
        """Temperatures (n, outputs), missing heat (n, m) and what is dropped (n, s) from inputs and readings."""
        n = time.size
        out = [np.empty((n, k)) for k in (len(self.of.model.outputs), len(self.of.heats), len(self.of.sensors))]
        arrays = [np.ascontiguousarray(a, float) for a in (time, u, y)]
        pointers = [a.ctypes.data_as(ctypes.c_void_p) for a in (*arrays, *out)]
        assert self.code.thermal_observer_run(ctypes.c_int(n), *pointers) == 0, "finds no step"
        return out[0], out[1], out[2]
