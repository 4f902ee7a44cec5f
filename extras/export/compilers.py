"""Compilers at hand: gcc or clang for this computer, zig (a wheel) for this and others."""

from __future__ import annotations

import importlib.util
import platform
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from thermoscope import MissingDependency, ThermoscopeError

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
