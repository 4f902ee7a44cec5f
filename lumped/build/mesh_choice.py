"""A mesh as fine as the wish asks for: its error at every hot spot, from meshes of half the element size each way.

In the plane, across compact faces, along the axis and towards the ends of laminated parts elements are made smaller one
at a time, since only some of it helps: the errors of the ways add up, and a mesh that is finer every way has eight
times the elements. Before that, one field of quadratic elements says in which parts they are worth their unknowns.
Where smaller triangles of one part alone do what smaller ones everywhere would, it alone has them.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from fem.matrices.assembly import FieldModel
from fem.matrices.block import renumbered
from fem.matrices.elements import Elements
from fem.solvers.linear_losses import linear_losses
from fem.solvers.two_processes import in_two_processes
from geom import Machine
from geom.disk_cache import recalled, store
from geom.storage import cache_folder
from lumped.build.crosscheck import FLOOR
from lumped.build.fixed_coefficients import FixedCoefficients, rated
from lumped.build.pipeline import Meshing, Prepared, Progress, means_network, meshed, plain_mesh, reduced
from lumped.condensation.reduction import Recipe
from lumped.machine.bases import on_every_base
from lumped.machine.shapes import laminated, wound
from lumped.model.network import Array

SHARE = 0.6  # of the wish that the mesh may use up: of 5 % the condensation, which costs less, has 2
LARGEST_SHARE = 0.75  # of a mesh beyond CHEAP, or where nothing finer fits: the condensation can do with a quarter
CHEAP = 90_000  # unknowns that are condensed within a minute of two cores
ORDER = 2.0  # of the means and the hottest points of linear elements; windings, quadratic, converge faster
SAFETY = 1.25  # Roache's factor where the order is known (1994, J. Fluids Eng. 116, 405)
UNCONFIRMED = 3.0  # his factor where nothing finer confirms an order; one is assumed: left is what halving moved
SLOWEST = 0.75  # of what a halving moved, moved by the next: slower, and nothing can be foretold
ACTS = 1.25  # times the points: a halving that adds less changes next to nothing, and the next one is looked at
MOST_UNKNOWNS = 150_000  # of the mesh that is condensed: 2.8 GB, and with the choice some 3 min of a core
MOST_SOLVED = 220_000  # of one that is solved once, for its hot spots: some 10 s
MOST_BESIDE = 300_000  # of both meshes that are solved at once: of 360,000 they took 4.5 GB
MOST_QUADRATIC = 300_000  # of the one that has quadratic elements in every part: 2.5 GB and 30 s
ROOM = 0.75  # of those: quadratic parts that are chosen in advance leave the rest to what is refined
BEGIN = 0.5  # of those: what a first mesh that has no ROOM keeps, with fewer elements across slots and bars
IDLE = 0.02  # of what all ways leave: a way that leaves less is not refined
ALIKE = 0.5  # of what the worst way leaves: of such ways the cheapest is refined
WORTH = 4.0  # percent of a hot spot for as many unknowns again: quadratic elements that gain less are left out
NOTABLE = 0.3  # percent of a hot spot that linear triangles of a part would cost: below, it is not the cause of errors
SMALLEST_M = 1e-3  # triangles that no machine of these families needs
IN_PLANE = ("size_m", "across")
WAYS = (*IN_PLANE, "axial_m")  # and, of every laminated part, towards its ends
MEANS = Recipe(max_states=0)  # enough for losses, fluids and streams
Kelvins = Mapping[str, float]  # heated part -> K
Counts = tuple[int, Mapping[str, tuple[int, int]]]  # points of a mesh; part -> its corners and middles of edges
Losses = Mapping[str, Array]  # part -> (2, n_heated) percent of each hot spot: by edges in the plane, along the axis


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
    """The first mesh, refined the way that leaves most until its error uses up no more than SHARE of the wish,
    LARGEST_SHARE on a mesh beyond CHEAP.

    accuracy : percent of a part's own rise, as the wish has it, of mesh and condensation together
    No mesh of more than `most` unknowns is chosen; `met` is False where its error is more than LARGEST_SHARE of the
    wish. The choice is kept by content.
    """
    file = cache_folder() / f"mesh-choice-{_key(machine, accuracy, first, most)}.json"
    cached = recalled(file, lambda path: _read(path.read_text(encoding="utf-8")))
    if cached is None:
        looks = _Looks(machine, progress, first)
        looks.first = _acting(looks, first, most)
        cached = _looked_for(looks, accuracy, most)
        store(file, json.dumps(asdict(cached)))
    return cached


def _key(machine: Machine, accuracy: float, first: Meshing, most: int) -> str:
    shapes = [(p.name, p.prisms, p.solid, machine.material_of(p.name)) for p in machine.parts]
    fluids = [(p.name, p.prisms) for p in machine.fluids]
    rules = (first, accuracy, most, SHARE, CHEAP, SAFETY, WORTH, ROOM, NOTABLE, BEGIN, IDLE, ALIKE, WAYS)
    content = repr((shapes, fluids, sorted(machine.sections.items()), rules))
    return hashlib.sha256(content.encode()).hexdigest()[:20]


def _read(text: str) -> MeshChoice:
    data = json.loads(text)
    how: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in data["meshing"].items()
    }
    return MeshChoice(**{**data, "meshing": Meshing(**how)})


@dataclass
class _Looks:
    """Meshes of a machine that were looked at: how large they are, and how hot their parts.

    point : the rated one, its coefficients the same on every mesh
    losses, every : what each part's linear elements cost, and the mesh of quadratic ones that it is known from
    """

    machine: Machine
    progress: Progress
    first: Meshing
    counts: dict[Meshing, Counts] = field(default_factory=dict)
    rises: dict[Meshing, Kelvins] = field(default_factory=dict)
    losses: Losses = field(default_factory=dict)
    every: Meshing = field(init=False)

    def size(self, how: Meshing) -> tuple[int, int]:
        """Points and unknowns; nothing is assembled."""
        plain = replace(how, quadratic=())
        if plain not in self.counts:
            self.counts[plain] = counts_of(self.machine, plain)
        return _size(self.machine, how, *self.counts[plain])

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

        def hot_spots(how: Meshing) -> Kelvins:
            return _hot_spots(point, self.ready(how).field)

        for group in (*([how] for how in large), new[len(large) :]):
            hot = in_two_processes(hot_spots, group, max((self.size(how)[1] for how in group), default=0))
            self.rises.update(zip(group, hot, strict=True))

    def lose(self, how: Meshing) -> None:
        """Find out what every hot spot would lose, in the first order, if the elements of a part were linear ones."""
        self.rises[how], lost = _linear_losses(self.point, self.ready(how).field)
        floor = FLOOR * max(self.rises[how].values())
        scale = np.array([max(rise, floor) for rise in self.rises[how].values()])
        self.losses = {part: 100.0 * np.abs(kelvins) / scale for part, kelvins in lost.items()}

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


def _looked_for(looks: _Looks, accuracy: float, most: int) -> MeshChoice:
    how = _curved(looks, looks.first, most)
    ends = [p.name for p in looks.machine.parts if laminated(looks.machine, p.name)]
    ways = dict.fromkeys((*WAYS, *ends), _Way())
    in_vain: set[tuple[str, str]] = set()
    stale: set[str] = set()  # ways looked at before another step was taken, which may have done some of theirs
    while True:
        first = replace(looks.first, quadratic=how.quadratic)
        others = {way: other for way, halvings in ways.items() if (other := _other(looks, how, way, halvings))}
        candidates = (other.along(way, 0.5) for way, other in others.items() if way not in WAYS)
        looks.solve([how, first, *others.values()], candidates)
        for way, other in others.items():
            ways[way] = _looked_further(ways[way], other == how.along(way, 0.5), looks.moved(how, other))
        linear = looks.moved(first, looks.every)
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
        most_left = ways[way_left].left(worst)
        if stale and (way is None or way_left in stale):
            again = stale if way is None else {way_left}
            ways, stale = {**ways, **dict.fromkeys(again, _Way())}, stale - again
        elif linear[worst] > ALIKE * most_left and (part := _part_to_bend(looks, how, worst, most)):
            how, stale = replace(how, quadratic=(*how.quadratic, part)), _not_refined(ways)
        elif (way is None or way in IN_PLANE or (ways[way].left(worst) < plane and not will_do)) and (
            alone := _one_part_finer(looks, how, worst, plane, in_vain, most)
        ):
            how, ways = alone, {**ways, **dict.fromkeys(IN_PLANE, _Way())}
        elif way is None:
            return MeshChoice(how, percent, *looks.size(how), percent[worst] <= LARGEST_SHARE * accuracy)
        else:
            there, halvings = how.along(way, 0.5), ways[way]
            moves = (
                halvings.moves if len(halvings.moves) > halvings.level else (*halvings.moves, looks.moved(how, there))
            )
            how, ways[way] = there, _Way(moves, halvings.level + 1)
            stale |= _not_refined(ways) - set(IN_PLANE if way not in IN_PLANE else ways)  # ends and axis overlap


def _not_refined(ways: Mapping[str, _Way]) -> set[str]:
    """Those refined know the order that they show, and keep it."""
    return {way for way, halvings in ways.items() if halvings.level == 0}


def _part_to_bend(looks: _Looks, how: Meshing, worst: str, most: int) -> str | None:
    """The part whose linear elements cost the worst hot spot most for each unknown that quadratic ones would add."""
    column, here = list(looks.hot(how)).index(worst), looks.size(how)[1]
    worth = {}
    for part in set(looks.every.quadratic) - set(how.quadratic):
        there = looks.size(replace(how, quadratic=(*how.quadratic, part)))[1]
        if (loss := float(looks.losses[part][:, column].sum())) >= NOTABLE and there <= most:
            worth[part] = loss / (there - here)
    return max(worth, key=lambda part: (worth[part], part), default=None)


def _one_part_finer(
    looks: _Looks, how: Meshing, worst: str, plane: float, in_vain: set[tuple[str, str]], most: int
) -> Meshing | None:
    """Smaller triangles in the one part where they move the worst hot spot, None where no part alone does.

    plane : K that halving all of them may leave of it;  in_vain : pairs of worst and finer part that were tried
    """
    column = list(looks.hot(how)).index(worst)
    worth = {p: lost for p, loss in looks.losses.items() if (lost := loss[0, column]) >= NOTABLE}
    new = [p for p in sorted(worth, key=lambda p: -worth[p]) if (worst, p) not in in_vain]
    finer = {part: replace(how, finer=(*how.finer, part)) for part in new}
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


def _curved(looks: _Looks, how: Meshing, most: int) -> Meshing:
    """Quadratic elements in every part that is worth its unknowns, after a look at all parts with them."""
    bare = looks.size(how)[1]
    added = {part: looks.size(replace(how, quadratic=(part,)))[1] - bare for part in _linear(looks.machine)}
    while bare + sum(added.values()) > MOST_QUADRATIC and added:
        del added[max(added, key=lambda p: added[p])]
    looks.every = replace(how, quadratic=tuple(added))
    looks.lose(looks.every)
    worth = {p: looks.losses[p].sum(axis=0).max() * bare / added[p] for p in added}
    for part in sorted(added, key=lambda p: -worth[p]):
        there = replace(how, quadratic=(*how.quadratic, part))
        if worth[part] >= WORTH and looks.size(there)[1] <= ROOM * most:
            how = there
    return how


def _linear(machine: Machine) -> list[str]:
    return [part.name for part in machine.parts if not wound(machine, part.name)]


def _other(looks: _Looks, how: Meshing, way: str, halvings: _Way) -> Meshing | None:
    """One halving more where that tells more and can be solved; where none can be, one coarser instead."""
    if not halvings.unsure:
        return None
    there = how.along(way, 0.5)
    if looks.size(there)[1] <= MOST_SOLVED or way not in WAYS:  # towards ends there is nothing coarser to look at
        return there
    return None if halvings.moves else how.along(way, 2.0)


def _looked_further(halvings: _Way, finer: bool, move: Kelvins) -> _Way:
    return replace(halvings, moves=(*halvings.moves, move)) if finer else _Way((move,), 1)


def _refined(looks: _Looks, how: Meshing, left: Mapping[str, float], most: int) -> str | None:
    """Of the ways that may be halved and leave about as much as the worst of them, the one with the fewest unknowns."""
    idle = IDLE * sum(left.values())
    sizes = {way: looks.size(how.along(way, 0.5))[1] for way, kelvins in left.items() if kelvins > idle}
    fits = {way: size for way, size in sizes.items() if size <= most}
    worst = max((left[way] for way in fits), default=0.0)
    return min(
        (way for way in fits if left[way] >= ALIKE * worst), key=lambda way: (fits[way], -left[way]), default=None
    )


def _percent(hot: Kelvins, linear: Kelvins, ways: Mapping[str, _Way]) -> dict[str, float]:
    """Of every part's own rise, of a share of the largest at least."""
    floor = FLOOR * max(hot.values())
    left = {p: linear[p] + sum(halvings.left(p) for halvings in ways.values()) for p in hot}
    return {p: 100.0 * left[p] / max(hot[p], floor) for p in hot}


def size_of(machine: Machine, how: Meshing) -> tuple[int, int]:
    """Points and unknowns of a mesh, which stays on disk: parts have nodes of their own, windings middles of edges."""
    return _size(machine, how, *counts_of(machine, how))


def _size(machine: Machine, how: Meshing, points: int, parts: Mapping[str, tuple[int, int]]) -> tuple[int, int]:
    curved = {part for part in parts if wound(machine, part) or part in how.quadratic}
    return points, sum(corners + (part in curved) * middles for part, (corners, middles) in parts.items())


def counts_of(machine: Machine, how: Meshing) -> Counts:
    """Of a mesh, which stays on disk."""
    mesh = plain_mesh(machine, how)
    parts = {}
    for k, part in enumerate(mesh.parts):
        points, tets = renumbered(mesh.tets[mesh.region == k], len(mesh.points))
        parts[part] = len(points), len(Elements.on(tets, mesh.points[points], True).middles)
    return len(mesh.points), parts


def _at_rated_point(ready: Prepared) -> FixedCoefficients:
    machine = ready.machine
    network = on_every_base(means_network(machine, reduced(ready, MEANS)))
    return rated(machine, network, ready.films, ready.contacts)


def _hot_spots(point: FixedCoefficients, field: FieldModel) -> dict[str, float]:
    """Heated part -> its largest rise (K)."""
    T = point.of_field(field)
    return {part: float(T[k]) for part, k in _hottest(point, field, T).items()}


def _linear_losses(point: FixedCoefficients, field: FieldModel) -> tuple[dict[str, float], dict[str, Array]]:
    """Hot spots as above; and part -> (2, n_heated) K that each of them would lose if this part had linear elements."""

    def readings(T: Array) -> Array:
        unit = np.zeros((field.n, len(point.watts)))
        unit[list(_hottest(point, field, T).values()), range(len(point.watts))] = 1.0
        return unit

    T, influence = point.influence(field, readings)
    hot = {part: float(T[k]) for part, k in _hottest(point, field, T).items()}
    return hot, linear_losses(field, field.stiffness(point.films, point.contacts), T, influence)


def _hottest(point: FixedCoefficients, field: FieldModel, T: Array) -> dict[str, int]:
    dofs = {part: field.blocks[part].dofs for part in point.watts}
    return {part: mine.start + int(np.argmax(T[mine])) for part, mine in dofs.items()}
