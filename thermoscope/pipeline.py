"""From a machine to a model that can run a test: mesh, field, network, films and losses; cached by content."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fem.assembly import FieldModel, HasTensor, assemble
from fem.material import Conductivity, LoopWound
from geom import Machine, NamedMesh, build_mesh
from geom.materials import Material
from geom.shapes import evenly
from lumped.motor import boundaries, fluids, motor_network, nominal_coefficients
from lumped.network import Network
from lumped.reduction import Recipe, condense

Progress = Callable[[str], None]
SMALL = Recipe(tolerance=0.03, max_states=130)


def silent(message: str) -> None:
    """No progress."""


@dataclass(frozen=True)
class Built:
    """A machine at every stage."""

    machine: Machine
    mesh: NamedMesh
    field: FieldModel
    network: Network


def cache_folder() -> Path:
    """Where meshes and bases are kept: $THERMOSCOPE_CACHE, else a folder of the user's."""
    home = os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))
    return Path(os.environ.get("THERMOSCOPE_CACHE", Path(home) / "thermoscope"))


def field_of(machine: Machine, mesh: NamedMesh) -> FieldModel:
    """Conduction of the machine on its mesh, with the materials of its file."""
    found = {part.name: machine.material_of(part.name) for part in machine.parts}
    conductivity: dict[str, HasTensor] = {
        name: Conductivity(m.k_plane, m.k_plane, m.k_axial) for name, m in found.items()
    }
    if "winding.field" in found:
        conductivity["winding.field"] = _around_poles(machine, found["winding.field"])
    return assemble(mesh, conductivity, {name: m.rho * m.cp for name, m in found.items()})


def _around_poles(machine: Machine, copper: Material) -> LoopWound:
    """Field coils: the wire runs along the axis beside a pole and across it at the ends."""
    g = machine.geometry
    axes = tuple(float(a) for a in evenly(g.stator.poles, np.pi / 2))
    start, end = machine.part("poles").span
    half = (end - start) / 2 + g.field.insulation
    width = g.stator.body_width / 2 + g.field.insulation
    return LoopWound(copper.k_axial, copper.k_plane, axes, half, width, (start + end) / 2)


def build(
    machine: Machine, size_m: float = 0.06, segments: int = 48, recipe: Recipe = SMALL, progress: Progress = silent
) -> Built:
    """Everything from the machine file to the network, at one mesh size."""
    cache = cache_folder()
    progress("mesh")
    mesh = build_mesh(machine, size_m=size_m, segments=segments, cache=cache)
    progress(f"conduction on {len(mesh.points)} points")
    field = field_of(machine, mesh)
    films, contacts = nominal_coefficients(
        machine, {n: (p.part, p.fluid) for n, p in mesh.patches.items()}, mesh.contacts
    )
    progress("network from the field")
    condensed = condense(field, films, contacts, fluids(machine), boundaries(machine), recipe, machine.name, cache)
    return Built(machine, mesh, field, motor_network(machine, condensed))


def motor_model(machine: Machine, progress: Progress = silent) -> Network:
    """The network a case runs: the default mesh and recipe."""
    return build(machine, progress=progress).network
