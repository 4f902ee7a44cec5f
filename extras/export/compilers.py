"""Compilers at hand, and the exported C compiled by one, held against `simulate` on the tests of the case.

gcc or clang serve this computer, zig (a wheel) this and others.
"""

import ctypes
import importlib.util
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from extras.export.c_code import RUNTIME, c_files
from extras.export.model import Model
from thermoscope import MissingDependency, Network, Record, ThermoscopeError, plugin as th, simulate

FLAGS = ("-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden")
INSTALL = "pip install ziglang (a compiler for every platform), or a gcc or clang of the system"


@dataclass(frozen=True)
class Platform:
    """Where a library runs.  fmi2, fmi3 : its folder in an FMU;  triple : its name for zig;  ending : of a library"""

    fmi2: str
    fmi3: str
    triple: str
    ending: str


PLATFORMS = (
    Platform("linux64", "x86_64-linux", "x86_64-linux-gnu.2.17", ".so"),
    Platform("win64", "x86_64-windows", "x86_64-windows-gnu", ".dll"),
    Platform("darwin64", "x86_64-darwin", "x86_64-macos", ".dylib"),
    Platform("aarch64-linux", "aarch64-linux", "aarch64-linux-gnu.2.17", ".so"),
    Platform("aarch64-darwin", "aarch64-darwin", "aarch64-macos", ".dylib"),
)
MACHINES = {"x86_64": "x86_64", "amd64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}


def here() -> Platform:
    """This computer."""
    system = {"linux": "linux", "darwin": "darwin", "win32": "windows"}.get(sys.platform, sys.platform)
    name = f"{MACHINES.get(platform.machine().lower(), platform.machine())}-{system}"
    for one in PLATFORMS:
        if one.fmi3 == name:
            return one
    raise MissingDependency(f"no code can be compiled for {name}; take --as json, or compile --as c elsewhere")


def has_zig() -> bool:
    return importlib.util.find_spec("ziglang") is not None


def compiler(target: Platform) -> list[str]:
    """The command that compiles for a platform.

    Raises MissingDependency where none is at hand.
    """
    native = target == here()
    for name in ("gcc", "clang") if native else ():
        if shutil.which(name):
            return [name]
    if has_zig():
        return [sys.executable, "-m", "ziglang", "cc", "-target", target.triple, "-s"]
    raise MissingDependency(f"no C compiler for {target.fmi3}: {INSTALL}")


def library(files: Mapping[str, str], target: Platform, extra: Sequence[str] = ()) -> bytes:
    """A shared library from C sources and headers (file name -> text)."""
    command = compiler(target)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            Path(folder, name).write_text(text, encoding="utf-8")
        out = f"model{target.ending}"
        sources = [n for n in files if Path(n).suffix == ".c"]
        process = subprocess.run(
            [*command, *FLAGS, *extra, "-o", out, *sources, "-lm"], cwd=folder, capture_output=True, text=True
        )
        if process.returncode:
            raise ThermoscopeError(f"{command[0]} for {target.fmi3} fails: {process.stderr.strip()[:500]}")
        return Path(folder, out).read_bytes()


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
