"""A mesh as fine as the wish asks for: its error at every hot spot, from a second mesh of half the element size."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from geom import Machine
from geom.disk_cache import recalled
from lumped.condensation.reduction import Recipe
from lumped.machine.bases import on_every_base
from thermoscope.caches import cache_folder
from thermoscope.case_folder.files import write_whole
from thermoscope.pipeline import Meshing, Prepared, Progress, means_network, meshed, reduced
from thermoscope.verification.crosscheck import FLOOR
from thermoscope.verification.fixed_coefficients import FixedCoefficients, rated

SHARE = 0.5  # of the wish that the mesh may use up: the rest is left to the condensation
ORDER = 2.0  # of the means and the hottest points of linear elements; windings, quadratic, converge faster
SAFETY = 1.25  # Roache's factor where the order is known (1994, J. Fluids Eng. 116, 405)
MOST_POINTS = 250_000  # of a mesh: beyond, a factorisation takes some 8 GB
MEANS = Recipe(shifts=(), random_points=0)  # enough for losses, fluids and streams


@dataclass(frozen=True)
class MeshChoice:
    """meshing : the mesh that was chosen;  percent : heated part -> error of its hot spot, in percent of its rise

    unknowns : of the field;  met : whether the wish's share is kept
    """

    meshing: Meshing
    percent: Mapping[str, float]
    unknowns: int
    met: bool

    @property
    def worst(self) -> float:
        """Percent, of the part that is furthest off."""
        return max(self.percent.values())

    def document(self) -> dict[str, Any]:
        """With the part that is furthest off."""
        part = max(self.percent, key=lambda p: self.percent[p])
        return {**asdict(self), "worst": self.worst, "worst_part": part}


def chosen_mesh(
    machine: Machine, accuracy: float, first: Meshing, progress: Progress, most_points: int = MOST_POINTS
) -> MeshChoice:
    """The coarsest of the first mesh and its refinements whose error uses up no more than SHARE of the wish.

    accuracy : percent of a part's own rise, as the wish has it, of mesh and condensation together
    It is kept by content. Where the mesh would exceed `most_points`, the finest below it is taken and `met` is False.
    """
    file = cache_folder() / f"mesh-choice-{_key(machine, accuracy, first, most_points)}.json"
    cached = recalled(file, lambda path: _read(path.read_text(encoding="utf-8")))
    if cached is None:
        cached = _looked_for(machine, SHARE * accuracy, first, progress, most_points)
        write_whole(file, json.dumps(asdict(cached)))
    return cached


def _key(machine: Machine, accuracy: float, first: Meshing, most_points: int) -> str:
    shapes = [(p.name, p.prisms, p.solid, machine.material_of(p.name)) for p in machine.parts]
    fluids = [(p.name, p.prisms) for p in machine.fluids]
    content = repr((shapes, fluids, sorted(machine.sections.items()), first, accuracy, SHARE, SAFETY, most_points))
    return hashlib.sha256(content.encode()).hexdigest()[:20]


def _read(text: str) -> MeshChoice:
    data = json.loads(text)
    return MeshChoice(**{**data, "meshing": Meshing(**data["meshing"])})


def _looked_for(machine: Machine, share: float, first: Meshing, progress: Progress, most_points: int) -> MeshChoice:
    mesh = meshed(machine, first, progress)
    point = _at_rated_point(mesh)
    hot = _hot_spots(point, mesh)
    while True:
        fine = meshed(machine, mesh.meshing.finer, partial(_report, progress))
        there = _hot_spots(point, fine)
        floor = FLOOR * max(there.values())
        percent = {p: SAFETY * _left(hot[p], there[p]) / max(there[p], floor) for p in hot}
        choice = MeshChoice(mesh.meshing, percent, mesh.field.n, max(percent.values()) <= share)
        if choice.met or len(fine.mesh.points) > most_points:
            return choice
        mesh, hot = fine, there


def _report(progress: Progress, message: str) -> None:
    progress(f"estimating the error of the mesh: {message}")


def _left(here: float, there: float) -> float:
    """Percent-making error of the coarser of two values, extrapolated from a mesh of half the element size."""
    return 100.0 * abs(there - here) / (1.0 - 0.5**ORDER)


def _at_rated_point(ready: Prepared) -> FixedCoefficients:
    machine = ready.machine
    network = on_every_base(means_network(machine, reduced(ready, MEANS)))
    return rated(machine, network, ready.films, ready.contacts)


def _hot_spots(point: FixedCoefficients, ready: Prepared) -> dict[str, float]:
    """Heated part -> its largest rise (K)."""
    T = point.of_field(ready.field)
    return {part: float(np.max(T[ready.field.blocks[part].dofs])) for part in point.watts}
