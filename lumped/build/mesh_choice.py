"""A mesh as fine as the wish asks for: its error at every hot spot, from meshes of half the element size each way.

In the plane, across compact faces and along the axis elements are halved one at a time, since only some of it helps:
the errors of the three ways add up, and a mesh that is finer every way has eight times the elements.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np

from fem.matrices.elements import Elements
from geom import Machine
from geom.disk_cache import recalled, store
from geom.meshing.mesh import NamedMesh
from geom.storage import cache_folder
from lumped.build.crosscheck import FLOOR
from lumped.build.fixed_coefficients import FixedCoefficients, rated
from lumped.build.pipeline import Meshing, Prepared, Progress, means_network, meshed, plain_mesh, reduced
from lumped.condensation.reduction import Recipe
from lumped.machine.bases import on_every_base
from lumped.machine.shapes import wound

SHARE = 0.5  # of the wish that the mesh may use up: the rest is left to the condensation
LARGEST_SHARE = 0.75  # where nothing finer fits: the condensation can do with a quarter
ORDER = 2.0  # of the means and the hottest points of linear elements; windings, quadratic, converge faster
SAFETY = 1.25  # Roache's factor where the order is known (1994, J. Fluids Eng. 116, 405)
UNCONFIRMED = 3.0  # his factor where nothing finer confirms an order; one is assumed: left is what halving moved
SLOWEST = 0.75  # of what a halving moved, moved by the next: slower, and nothing can be foretold
ACTS = 1.25  # times the points: a halving that adds less changes next to nothing, and the next one is looked at
MOST_UNKNOWNS = 170_000  # of the mesh that is condensed: within 4 GB and 3 min on two cores
MOST_SOLVED = 250_000  # of one that is solved once, for its hot spots
SMALLEST_M = 1e-3  # triangles that no machine of these families needs
WAYS = ("size_m", "across", "axial_m")
MEANS = Recipe(shifts=(), random_points=0)  # enough for losses, fluids and streams
Kelvins = Mapping[str, float]  # heated part -> K


@dataclass(frozen=True)
class MeshChoice:
    """meshing : the mesh that was chosen;  percent : heated part -> error of its hot spot, in percent of its rise

    points, unknowns : of mesh and field;  met : whether the wish's share is kept
    """

    meshing: Meshing
    percent: Mapping[str, float]
    points: int
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
    machine: Machine, accuracy: float, first: Meshing, progress: Progress, most: int = MOST_UNKNOWNS
) -> MeshChoice:
    """The first mesh, refined the way that leaves most until its error uses up no more than SHARE of the wish.

    accuracy : percent of a part's own rise, as the wish has it, of mesh and condensation together
    No mesh of more than `most` unknowns is chosen; `met` is False where its error is more than LARGEST_SHARE of the
    wish. The choice is kept by content.
    """
    file = cache_folder() / f"mesh-choice-{_key(machine, accuracy, first, most)}.json"
    cached = recalled(file, lambda path: _read(path.read_text(encoding="utf-8")))
    if cached is None:
        cached = _looked_for(_Looks(machine, progress), accuracy, first, most)
        store(file, json.dumps(asdict(cached)))
    return cached


def _key(machine: Machine, accuracy: float, first: Meshing, most: int) -> str:
    shapes = [(p.name, p.prisms, p.solid, machine.material_of(p.name)) for p in machine.parts]
    fluids = [(p.name, p.prisms) for p in machine.fluids]
    content = repr((shapes, fluids, sorted(machine.sections.items()), first, accuracy, SHARE, SAFETY, most, WAYS))
    return hashlib.sha256(content.encode()).hexdigest()[:20]


def _read(text: str) -> MeshChoice:
    data = json.loads(text)
    return MeshChoice(**{**data, "meshing": Meshing(**data["meshing"])})


@dataclass
class _Looks:
    """Meshes of a machine that were looked at: how large they are, and how hot their parts."""

    machine: Machine
    progress: Progress
    point: FixedCoefficients | None = None
    sizes: dict[Meshing, tuple[int, int]] = field(default_factory=dict)
    rises: dict[Meshing, Kelvins] = field(default_factory=dict)

    def size(self, how: Meshing) -> tuple[int, int]:
        """Points and unknowns; nothing is assembled."""
        if how not in self.sizes:
            self.sizes[how] = size_of(self.machine, how)
        return self.sizes[how]

    def hot(self, how: Meshing) -> Kelvins:
        """Heated part -> its largest rise (K) at the rated point."""
        if how not in self.rises:
            ready = meshed(
                self.machine, how, lambda message: self.progress(f"estimating the error of the mesh: {message}")
            )
            self.point = self.point or _at_rated_point(ready)
            self.rises[how] = _hot_spots(self.point, ready)
        return self.rises[how]

    def moved(self, here: Meshing, there: Meshing) -> Kelvins:
        """How far the hot spots of two meshes are apart."""
        one, other = self.hot(here), self.hot(there)
        return {part: abs(one[part] - other[part]) for part in one}


@dataclass(frozen=True)
class _Way:
    """Halvings of one way: what each moved the hot spots by, and how many of them the mesh at hand has."""

    moves: tuple[Kelvins, ...] = ()
    level: int = 0

    @property
    def unsure(self) -> bool:
        """One more would tell more: two known halvings show the order."""
        return len(self.moves) == self.level < 2

    def left(self, part: str) -> float:
        """What the mesh at hand is off by (K), factor of safety included."""
        moves = [move[part] for move in self.moves]
        if len(moves) == 1 and self.level == 1:
            return UNCONFIRMED * moves[0]
        k = min(self.level, len(moves) - 1)
        ratio = _ratio(moves[k - 1], moves[k]) if k else 0.5**ORDER
        return SAFETY * moves[k] / (1.0 - ratio) * (ratio if self.level == len(moves) else 1.0)


def _ratio(before: float, after: float) -> float:
    """Of what two halvings in turn moved, no better than the order allows."""
    return float(np.clip(after / max(before, 1e-12), 0.5**ORDER, SLOWEST))


def _looked_for(looks: _Looks, accuracy: float, first: Meshing, most: int) -> MeshChoice:
    how, ways = _acting(looks, first), dict.fromkeys(WAYS, _Way())
    while True:
        ways = {way: _looked_further(looks, how, way, halvings) for way, halvings in ways.items()}
        percent = _percent(looks.hot(how), ways)
        worst = max(percent, key=lambda p: percent[p])
        way = _refined(looks, how, {way: halvings.left(worst) for way, halvings in ways.items()}, most)
        if way is None or percent[worst] <= SHARE * accuracy:
            return MeshChoice(how, percent, *looks.size(how), percent[worst] <= LARGEST_SHARE * accuracy)
        there, halvings = how.along(way, 0.5), ways[way]
        moves = halvings.moves if len(halvings.moves) > halvings.level else (*halvings.moves, looks.moved(how, there))
        how, ways[way] = there, _Way(moves, halvings.level + 1)


def _acting(looks: _Looks, how: Meshing) -> Meshing:
    """The first mesh with the largest triangles that are there at all: small parts have smaller ones anyway."""
    while looks.size(finer := how.along("size_m", 0.5))[0] < ACTS * looks.size(how)[0] and finer.size_m > SMALLEST_M:
        how = finer
    return how


def _looked_further(looks: _Looks, how: Meshing, way: str, halvings: _Way) -> _Way:
    """With one more halving where that tells more and can be solved; where none can be, one coarser instead."""
    if not halvings.unsure:
        return halvings
    there = how.along(way, 0.5)
    if looks.size(there)[1] <= MOST_SOLVED:
        return replace(halvings, moves=(*halvings.moves, looks.moved(how, there)))
    return halvings if halvings.moves else _Way((looks.moved(how.along(way, 2.0), how),), 1)


def _refined(looks: _Looks, how: Meshing, left: Mapping[str, float], most: int) -> str | None:
    """The way that leaves most, of those that may be halved."""
    for way in sorted(WAYS, key=lambda way: -left[way]):
        if left[way] > 0.0 and looks.size(how.along(way, 0.5))[1] <= most:
            return way
    return None


def _percent(hot: Kelvins, ways: Mapping[str, _Way]) -> dict[str, float]:
    """Of every part's own rise, of a share of the largest at least."""
    floor = FLOOR * max(hot.values())
    return {p: 100.0 * sum(halvings.left(p) for halvings in ways.values()) / max(hot[p], floor) for p in hot}


def size_of(machine: Machine, how: Meshing) -> tuple[int, int]:
    """Points and unknowns of a mesh, which stays on disk: parts have nodes of their own, windings middles of edges."""
    mesh = plain_mesh(machine, how)
    return len(mesh.points), sum(_unknowns(machine, mesh, k) for k in range(len(mesh.parts)))


def _unknowns(machine: Machine, mesh: NamedMesh, part: int) -> int:
    tets = mesh.tets[mesh.region == part]
    middles = len(Elements.on(tets, mesh.points, quadratic=True).edges) if wound(machine, mesh.parts[part]) else 0
    return len(np.unique(tets)) + middles


def _at_rated_point(ready: Prepared) -> FixedCoefficients:
    machine = ready.machine
    network = on_every_base(means_network(machine, reduced(ready, MEANS)))
    return rated(machine, network, ready.films, ready.contacts)


def _hot_spots(point: FixedCoefficients, ready: Prepared) -> dict[str, float]:
    """Heated part -> its largest rise (K)."""
    T = point.of_field(ready.field)
    return {part: float(np.max(T[ready.field.blocks[part].dofs])) for part in point.watts}
