"""A mesh as fine as the wish asks for: its error at every hot spot, from meshes of half the element size each way.

In the plane, across compact faces, along the axis and towards the ends of laminated parts elements are made smaller one
at a time, since only some of it helps: the errors of the ways add up, and a mesh that is finer every way has eight
times the elements. Before that, one field of quadratic elements says along which edges they are worth an unknown.
Where smaller triangles of one part alone do what smaller ones everywhere would, it alone has them.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from fem.matrices.bends import Bends
from fem.matrices.block import renumbered
from fem.matrices.elements import Elements
from fem.solvers.bending_edges import Kelvins, bending_edges, hot_spots
from fem.solvers.two_processes import in_two_processes
from geom import Machine
from geom.disk_cache import recalled, stored
from geom.storage import cache_folder
from lumped.build.crosscheck import FLOOR
from lumped.build.fixed_coefficients import FixedCoefficients, rated
from lumped.build.pipeline import Meshing, Prepared, Progress, means_network, meshed, plain_mesh, reduced, silent
from lumped.condensation.reduction import Recipe
from lumped.machine.bases import on_every_base
from lumped.machine.shapes import laminated, wound
from lumped.model.network import Array

SHARE = 0.6  # of the wish that the mesh may use up: of 5 % the condensation, which costs less, has 2
LARGEST_SHARE = 0.75  # of a mesh beyond CHEAP, or where nothing finer fits: the condensation can do with a quarter
CHEAP = 90_000  # unknowns that are condensed within a minute of two cores
ORDER = 2.0  # of the means and the hottest points of linear elements; windings, quadratic, converge faster
SAFETY = 1.25  # Roache's factor where the order is known (1994, J. Fluids Eng. 116, 405)
UNCONFIRMED = 3.0  # his factor where nothing finer confirms an order: of what smaller triangles of one part move
SLOWEST = 0.75  # of what a halving moved, moved by the next: slower, and nothing can be foretold
ACTS = 1.25  # times the points: a halving that adds less changes next to nothing, and the next one is looked at
MOST_UNKNOWNS = 150_000  # of the mesh that is condensed: 3.9 GB, and with the choice some 4 min of a core
MOST_SOLVED = 220_000  # of one that is solved once, for its hot spots: some 10 s
MOST_BESIDE = 320_000  # of both meshes that are solved at once: about 3.3 GB
MOST_QUADRATIC = 300_000  # of the one that has quadratic elements in every part: 2.5 GB and 30 s
ROOM = 0.75  # of those: a first mesh of more leaves nothing to middles of edges and to what is refined
BEGIN = 0.5  # of those: what such a first mesh keeps, with fewer elements across slots and bars
IDLE = 0.02  # of what all ways leave: a way that leaves less is not refined
ALIKE = 0.5  # of what the worst way leaves: of such ways the cheapest is refined
STRAIGHT = 0.1  # of the wish: what edges may cost any hot spot, in sum, that are left without a middle
NOTABLE = 0.3  # percent of a hot spot that linear triangles of a part would cost: below, it is not the cause of errors
SMALLEST_M = 1e-3  # triangles that no machine of these families needs
IN_PLANE = ("size_m", "across")
WAYS = (*IN_PLANE, "axial_m")  # and, of every laminated part, towards its ends
MEANS = Recipe(max_states=0)  # enough for losses, fluids and streams


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
        """With the part that is furthest off; where elements are quadratic is left out."""
        part = max(self.percent, key=lambda p: self.percent[p])
        meshing = {key: value for key, value in vars(self.meshing).items() if key != "bends"}
        return {**vars(self), "meshing": meshing, "worst": self.worst, "worst_part": part}


def chosen_mesh(
    machine: Machine, accuracy: float, first: Meshing, progress: Progress, most: int = MOST_UNKNOWNS
) -> MeshChoice:
    """The first mesh, refined the way that leaves most until its error uses up no more than SHARE of the wish,
    LARGEST_SHARE on a mesh beyond CHEAP.

    accuracy : percent of a part's own rise, as the wish has it, of mesh and condensation together
    No mesh of more than `most` unknowns is chosen; `met` is False where its error is more than LARGEST_SHARE of the
    wish. The choice is kept by content.
    """
    file = cache_folder() / f"mesh-choice-{_key(machine, accuracy, first, most)}.npz"
    cached = recalled(file, _read)
    if cached is None:
        looks = _Looks(machine, progress, first)
        looks.first = _acting(looks, first, most)
        cached = _looked_for(looks, accuracy, most)
        _write(file, cached)
    return cached


def _key(machine: Machine, accuracy: float, first: Meshing, most: int) -> str:
    shapes = [(p.name, p.prisms, p.solid, machine.material_of(p.name)) for p in machine.parts]
    fluids = [(p.name, p.prisms) for p in machine.fluids]
    most_solved = (most, MOST_SOLVED, MOST_QUADRATIC)
    rules = (first, accuracy, most_solved, SHARE, CHEAP, SAFETY, STRAIGHT, NOTABLE, ROOM, BEGIN, IDLE, ALIKE, WAYS)
    content = repr((shapes, fluids, sorted(machine.sections.items()), rules))
    return hashlib.sha256(content.encode()).hexdigest()[:20]


def _write(file: Path, choice: MeshChoice) -> None:
    bends = choice.meshing.bends
    with stored(file) as partial:
        np.savez_compressed(partial, json.dumps(choice.document()), **(bends.parts if bends else {}))  # type: ignore[arg-type]


def _read(file: Path) -> MeshChoice:
    with np.load(file) as data:
        content, parts = json.loads(str(data["arr_0"])), {part: data[part] for part in data if part != "arr_0"}
    meshing = content["meshing"].items()
    how: dict[str, Any] = {key: tuple(value) if isinstance(value, list) else value for key, value in meshing}
    rest = {key: content[key] for key in ("percent", "points", "unknowns", "met")}
    return MeshChoice(Meshing(**how, bends=Bends(parts)), **rest)


@dataclass
class _Looks:
    """Meshes of a machine that were looked at: how large they are, and how hot their parts.

    point : the rated one, its coefficients the same on every mesh
    losses : part -> (n_heated,) percent that straight edges in its plane cost each hot spot
    every : the mesh that they are known from, quadratic wherever there is room
    """

    machine: Machine
    progress: Progress
    first: Meshing
    sizes: dict[Meshing, tuple[int, int]] = field(default_factory=dict)
    rises: dict[Meshing, Kelvins] = field(default_factory=dict)
    losses: Mapping[str, Array] = field(default_factory=dict)
    every: Meshing = field(init=False)

    def size(self, how: Meshing) -> tuple[int, int]:
        """Points and unknowns; nothing is assembled."""
        if how not in self.sizes:
            self.measure([how])
        return self.sizes[how]

    def measure(self, meshes: Iterable[Meshing]) -> None:
        """Sizes of those that are not known, in two processes where there is room."""
        new = [how for how in dict.fromkeys(meshes) if how not in self.sizes]
        self.sizes.update(zip(new, in_two_processes(partial(size_of, self.machine), new, MOST_SOLVED), strict=True))

    @cached_property
    def point(self) -> FixedCoefficients:
        return _at_rated_point(self.ready(self.first))

    def ready(self, how: Meshing) -> Prepared:
        return meshed(self.machine, how, lambda message: self.progress(f"estimating the error of the mesh: {message}"))

    def hot(self, how: Meshing) -> Kelvins:
        """Heated part -> its largest rise (K) at the rated point."""
        self.solve([how])
        return self.rises[how]

    def solve(self, meshes: Iterable[Meshing], candidates: Iterable[Meshing] = ()) -> None:
        """Look at those that were not, two at a time where both are small enough.

        candidates : of these, which may be asked for next, one is looked at beside a single one
        """
        new = sorted({how for how in meshes if how not in self.rises}, key=lambda how: -self.size(how)[1])
        if len(new) == 1:
            others = (how for how in candidates if how not in self.rises and how not in new)
            new += [how for how in others if self.size(how)[1] + self.size(new[0])[1] <= MOST_BESIDE][:1]
        sizes = [*(self.size(how)[1] for how in new), 0]
        large = [how for how, *pair in zip(new, sizes, sizes[1:], strict=False) if sum(pair) > MOST_BESIDE]
        point = self.point  # before processes part

        def hottest_points(how: Meshing) -> Kelvins:
            ready = meshed(self.machine, how, silent).field  # who listens may hold a lock as it forks
            return hot_spots(point, ready, point.of_field(ready))

        for group in (*([how] for how in large), new[len(large) :]):
            self.progress("estimating the error of the mesh")
            hot = in_two_processes(hottest_points, group, max((self.size(how)[1] for how in group), default=0))
            self.rises.update(zip(group, hot, strict=True))

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

    def less(self, gain: Kelvins) -> "_Way":
        """After smaller triangles of one part have moved the hot spots by so much, a halving's worth at most."""
        rest = [{p: max(K - gain[p], 0.5**ORDER * K) for p, K in move.items()} for move in self.moves]
        return replace(self, moves=tuple(rest))

    def left(self, part: str) -> float:
        """What the mesh at hand is off by (K), factor of safety included."""
        moves = [move[part] for move in self.moves]
        k = min(self.level, len(moves) - 1)
        # Of what two halvings in turn moved, no better than the order allows.
        ratio = float(np.clip(moves[k] / max(moves[k - 1], 1e-12), 0.5**ORDER, SLOWEST)) if k else 0.5**ORDER
        return SAFETY * moves[k] / (1.0 - ratio) * (ratio if self.level == len(moves) else 1.0)


def _looked_for(looks: _Looks, accuracy: float, most: int) -> MeshChoice:
    how = replace(looks.first, bends=_bends(looks, looks.first, accuracy))
    linear = looks.moved(how, looks.every)
    ends = [p.name for p in looks.machine.parts if laminated(looks.machine, p.name)]
    ways = dict.fromkeys((*WAYS, *ends), _Way())
    in_vain: set[tuple[str, str]] = set()
    stale: set[str] = set()  # ways looked at before another step was taken, which may have done some of theirs
    while True:
        looks.measure(how.along(way, 0.5) for way, halvings in ways.items() if halvings.unsure)
        pairs = {way: _halved(looks, how, way) for way, halvings in ways.items() if halvings.unsure}
        candidates = (finer.along(way, 0.5) for way, (_, finer) in pairs.items() if way not in WAYS)
        looks.solve([how, *(mesh for pair in pairs.values() for mesh in pair)], candidates)
        for halved, pair in pairs.items():
            ways[halved] = replace(ways[halved], moves=(*ways[halved].moves, looks.moved(*pair)))
        percent = _percent(looks.hot(how), linear, ways)
        worst = max(percent, key=lambda p: percent[p])
        way = _refined(looks, how, {way: halvings.left(worst) for way, halvings in ways.items()}, most)
        enough = SHARE if looks.size(how)[1] <= CHEAP else LARGEST_SHARE
        if percent[worst] <= enough * accuracy:
            return MeshChoice(how, percent, *looks.size(how), True)
        plane = max(ways[w].left(worst) for w in IN_PLANE)
        rise = max(looks.hot(how)[worst], FLOOR * max(looks.hot(how).values()))
        missing = rise * (percent[worst] - enough * accuracy) / 100.0
        will_do = way is not None and (1.0 - 0.5**ORDER) * ways[way].left(worst) > missing
        way_left = max(ways, key=lambda w: ways[w].left(worst))
        if stale and (way is None or way_left in stale):
            again = stale if way is None else {way_left}
            finer = {w for w in again if _solvable(looks, how.along(w, 0.5))}  # others keep what a finer mesh said
            ways, stale = {**ways, **dict.fromkeys(finer, _Way())}, stale - again
        elif (way is None or way in IN_PLANE or (ways[way].left(worst) < plane and not will_do)) and (
            alone := _one_part_finer(looks, how, worst, plane, in_vain, most)
        ):
            most_left = max(IN_PLANE, key=lambda w: ways[w].left(worst))
            ways[most_left] = ways[most_left].less(looks.moved(how, alone))
            how, ways = alone, ways | {w: _Way() for w in IN_PLANE if _solvable(looks, alone.along(w, 0.5))}
        elif way is None:
            return MeshChoice(how, percent, *looks.size(how), percent[worst] <= LARGEST_SHARE * accuracy)
        else:
            there, halvings = how.along(way, 0.5), ways[way]
            new = () if len(halvings.moves) > halvings.level else (looks.moved(how, there),)
            how, ways[way] = there, _Way((*halvings.moves, *new), halvings.level + 1)
            # Those refined know the order that they show, and keep it; ends and axis overlap.
            unrefined = {way for way, halvings in ways.items() if halvings.level == 0}
            stale |= unrefined - set(IN_PLANE if way not in IN_PLANE else ways)


def _one_part_finer(
    looks: _Looks, how: Meshing, worst: str, plane: float, in_vain: set[tuple[str, str]], most: int
) -> Meshing | None:
    """Smaller triangles in the one part where they move the worst hot spot, None where no part alone does.

    plane : K that halving all of them may leave of it;  in_vain : pairs of worst and finer part that were tried
    """
    column = list(looks.hot(how)).index(worst)
    worth = {p: lost for p, loss in looks.losses.items() if (lost := loss[column]) >= NOTABLE}
    new = [p for p in sorted(worth, key=lambda p: -worth[p]) if (worst, p) not in in_vain]
    finer = {part: replace(how, finer=(*how.finer, part)) for part in new}
    looks.measure(finer.values())
    fits = {part: there for part, there in finer.items() if looks.size(there)[1] <= most}
    for part, there in fits.items():
        looks.solve([there], fits.values())
        if UNCONFIRMED * looks.moved(how, there)[worst] >= ALIKE * plane:
            return there
        in_vain.add((worst, part))
    return None


def _acting(looks: _Looks, how: Meshing, most: int) -> Meshing:
    """The first mesh, coarser where it leaves no room, with the largest triangles that are there at all: small parts
    have smaller ones anyway."""
    enough = (BEGIN if looks.size(how)[1] > ROOM * most else ROOM) * most
    while (
        looks.size(how)[1] > enough and ACTS * looks.size(coarser := how.along("across", 2.0))[1] < looks.size(how)[1]
    ):
        how = coarser
    while looks.size(finer := how.along("size_m", 0.5))[0] < ACTS * looks.size(how)[0] and finer.size_m > SMALLEST_M:
        how = finer
    return how


def _bends(looks: _Looks, how: Meshing, accuracy: float) -> Bends:
    """Where elements are quadratic: along edges that are worth it, after a look at all of them."""
    linear = [part.name for part in looks.machine.parts if not wound(looks.machine, part.name)]
    looks.every = replace(how, bends=Bends.everywhere(linear))
    (_, few), (_, many) = counts_of(looks.machine, how), counts_of(looks.machine, looks.every)
    while linear and looks.size(looks.every)[1] > MOST_QUADRATIC:
        linear.remove(max(linear, key=lambda part: many[part] - few[part]))
        looks.every = replace(how, bends=Bends.everywhere(linear))
    if not linear:
        return Bends({})
    quadratic = looks.ready(looks.every).field
    edges = bending_edges(
        looks.point,
        quadratic,
        lambda bends: looks.ready(replace(how, bends=bends)).field,
        linear,
        STRAIGHT * accuracy,
        FLOOR,
    )
    looks.losses = edges.losses
    looks.rises |= {looks.every: edges.hot_quadratic, replace(how, bends=edges.bends): edges.hot}
    return edges.bends


def _halved(looks: _Looks, how: Meshing, way: str) -> tuple[Meshing, Meshing]:
    """Two meshes that are one halving apart: from the one at hand, or where its halving cannot be solved, from one that
    is coarser the other ways, since the errors of the ways add up."""
    here = how
    for other in 2 * [w for w in reversed(WAYS) if w != way]:
        if _solvable(looks, here.along(way, 0.5)):
            break
        here = here.along(other, 2.0)
    return here, here.along(way, 0.5)


def _solvable(looks: _Looks, there: Meshing) -> bool:
    return looks.size(there)[1] <= MOST_SOLVED


def _refined(looks: _Looks, how: Meshing, left: Mapping[str, float], most: int) -> str | None:
    """Of the ways that may be halved and leave about as much as the worst of them, the one with the fewest unknowns."""
    idle = IDLE * sum(left.values())
    finer = {way: how.along(way, 0.5) for way, kelvins in left.items() if kelvins > idle}
    looks.measure(finer.values())
    sizes = {way: looks.size(there)[1] for way, there in finer.items()}
    fits = {way: size for way, size in sizes.items() if size <= most}
    worst = max((left[way] for way in fits), default=0.0)
    alike = (way for way in fits if left[way] >= ALIKE * worst)
    return min(alike, key=lambda way: (fits[way], -left[way]), default=None)


def _percent(hot: Kelvins, linear: Kelvins, ways: Mapping[str, _Way]) -> dict[str, float]:
    """Of every part's own rise, of a share of the largest at least."""
    floor = FLOOR * max(hot.values())
    left = {p: linear[p] + sum(halvings.left(p) for halvings in ways.values()) for p in hot}
    return {p: 100.0 * left[p] / max(hot[p], floor) for p in hot}


def size_of(machine: Machine, how: Meshing) -> tuple[int, int]:
    """Points and unknowns of a mesh, which stays on disk: parts have nodes of their own, and middles of edges."""
    points, unknowns = counts_of(machine, how)
    return points, sum(unknowns.values())


def counts_of(machine: Machine, how: Meshing) -> tuple[int, Mapping[str, int]]:
    """Points of a mesh, and unknowns of each part."""
    mesh = plain_mesh(machine, how)
    unknowns = {}
    for k, part in enumerate(mesh.parts):
        points, tets = renumbered(mesh.tets[mesh.region == k], len(mesh.points))
        midsides = wound(machine, part) or (how.bends is not None and how.bends.of(part))
        unknowns[part] = len(Elements.on(tets, mesh.points[points], midsides).xyz)
    return len(mesh.points), unknowns


def _at_rated_point(ready: Prepared) -> FixedCoefficients:
    machine = ready.machine
    network = on_every_base(means_network(machine, reduced(ready, MEANS)))
    return rated(machine, network, ready.films, ready.contacts)
