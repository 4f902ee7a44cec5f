"""The parts of the tool that are installed on demand, and the one message of each where it is missing."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec

from geom.errors import MissingDependency


@dataclass(frozen=True)
class Extra:
    """packages : what it brings, as they are imported;  needed_for : what does not work without it"""

    name: str
    packages: tuple[str, ...]
    needed_for: str

    @property
    def install(self) -> str:
        return f"pip install 'thermoscope[{self.name}]'"


EXTRAS = {
    e.name: e
    for e in (
        Extra(
            "cad",
            ("cadquery", "OCP", "meshio", "pyamg", "skfem", "shapely", "trimesh"),
            "machines from a file of dimensions: solids, mesh, field",
        ),
        Extra(
            "view",
            ("aiohttp", "kaleido", "matplotlib", "PIL", "plotly", "pyvista", "vtk", "vtkmodules", "rerun", "trame"),
            "pictures, the report, the workbench",
        ),
        Extra(
            "bench",
            ("aiomqtt", "asammdf", "nptdms", "pyarrow", "SALib"),
            "recordings in TDMS, MF4 and Parquet; sensitivities of a screening; rows from an MQTT broker",
        ),
        Extra("oil", ("CoolProp",), "properties of oil"),
        Extra("optimise", ("pymoo",), "designs that trade one aim for another"),
        Extra("video", ("imageio_ffmpeg",), "films as .mp4"),
        Extra("cluster", ("distributed",), "runs on a Dask cluster"),
    )
}
SLOW = ("cadquery",)  # 1.5 s to import, and what is built already never does
# Command -> packages without which it does nothing, whatever its case.
NEEDS = {
    "build": ("cadquery", "skfem"),
    "crosscheck": ("skfem",),
    "report": ("matplotlib",),
    "render": ("matplotlib",),
    "picture": ("matplotlib",),
    "plan": ("matplotlib",),
    "serve": ("aiohttp", "trame", "plotly"),
    "optimise": ("pymoo", "plotly"),
}


def message(fault: ModuleNotFoundError) -> str:
    """What to install where an extra's package is missing; "" where it belongs to none."""
    package = (fault.name or "").partition(".")[0]
    extra = next((e for e in EXTRAS.values() if package in e.packages), None)
    return "" if extra is None else f"'{package}' is not installed: {extra.install} ({extra.needed_for})"


def required(packages: Iterable[str]) -> None:
    """Raises MissingDependency for the first package that cannot be imported: to be asked before any work."""
    for package in packages:
        try:
            there = find_spec(package) and (package in SLOW or import_module(package))
        except ImportError:
            there = None
        if there is None:
            raise MissingDependency(message(ModuleNotFoundError(name=package)))


@contextmanager
def explained() -> Iterator[None]:
    """A missing package of an extra becomes a MissingDependency that says what to install."""
    try:
        yield
    except ModuleNotFoundError as fault:
        if not message(fault):
            raise
        raise MissingDependency(message(fault)) from None
