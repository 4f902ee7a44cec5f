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
from thermoscope.files import write_whole
from thermoscope.pipeline import Meshing, Prepared, Progress, means_network, meshed, plain_mesh, reduced
from thermoscope.verification.crosscheck import FLOOR
from thermoscope.verification.fixed_coefficients import FixedCoefficients, rated

SHARE = 0.5  # of the wish that the mesh may use up: the rest is left to the condensation
ORDER = 2.0  # of the means and the hottest points of linear elements; windings, quadratic, converge faster
SAFETY = 1.25  # Roache's factor where the order is known (1994, J. Fluids Eng. 116, 405)
UNCONFIRMED = 3.0  # his factor where nothing finer confirms an order; one is assumed: left is what halving moved
MOST_POINTS = 250_000  # of any mesh that is solved: a field and its factors take some 8 GB there, 13 with 340,000
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
    No mesh of more than `most_points` is solved. The finest below has its error extrapolated from the mesh of twice
    the element size, at order one; `met` is False where that is too much. The choice is kept by content.
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
    coarser: dict[str, float] = {}
    while _points(machine, mesh.meshing.finer) <= most_points:
        fine = meshed(machine, mesh.meshing.finer, partial(_report, progress))
        there = _hot_spots(point, fine)
        choice = _choice(mesh, share, there, {p: _left(hot[p], there[p]) for p in hot})
        if choice.met:
            return choice
        mesh, hot, coarser = fine, there, hot
    if not coarser:
        coarser = _hot_spots(point, meshed(machine, mesh.meshing.coarser, partial(_report, progress)))
    return _choice(mesh, share, hot, {p: abs(hot[p] - coarser[p]) for p in hot}, UNCONFIRMED)


def _choice(
    mesh: Prepared, share: float, hot: Mapping[str, float], left: Mapping[str, float], safety: float = SAFETY
) -> MeshChoice:
    """hot : rise of each heated part's hot spot;  left : what the mesh is off by (K), before the factor of safety"""
    floor = FLOOR * max(hot.values())
    percent = {p: 100.0 * safety * left[p] / max(hot[p], floor) for p in hot}
    return MeshChoice(mesh.meshing, percent, mesh.field.n, max(percent.values()) <= share)


def _points(machine: Machine, how: Meshing) -> int:
    """Nothing is assembled on the mesh, which stays on disk."""
    return len(plain_mesh(machine, how).points)


def _report(progress: Progress, message: str) -> None:
    progress(f"estimating the error of the mesh: {message}")


def _left(here: float, there: float) -> float:
    """Error of the coarser of two values (K), extrapolated from a mesh of half the element size."""
    return abs(there - here) / (1.0 - 0.5**ORDER)


def _at_rated_point(ready: Prepared) -> FixedCoefficients:
    machine = ready.machine
    network = on_every_base(means_network(machine, reduced(ready, MEANS)))
    return rated(machine, network, ready.films, ready.contacts)


def _hot_spots(point: FixedCoefficients, ready: Prepared) -> dict[str, float]:
    """Heated part -> its largest rise (K)."""
    T = point.of_field(ready.field)
    return {part: float(np.max(T[ready.field.blocks[part].dofs])) for part in point.watts}
