"""A network as small as the wish allows: error against number of states, checked at points it has not seen."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from geom import Machine
from geom.one_thread import one_blas_thread
from lumped.build.fixed_coefficients import load_cases
from lumped.build.mesh_choice import MOST_UNKNOWNS, MeshChoice, chosen_mesh, size_of
from lumped.build.pipeline import ACROSS, AXIAL, Built, Meshing, Progress, meshed, reduced, silent
from lumped.condensation.greedy_enrichment import Enrichment, Size, checks, enrich
from lumped.condensation.reduction import Recipe, Reduction
from lumped.condensation.reduction_error import Accuracy
from lumped.machine.bases import on_all
from lumped.machine.motor import motor_network
from lumped.machine.zones import motor_zones

# Finer than a case's own: every accuracy that may be asked is cut out of it.
FINE = Recipe(tolerance=0.01, random_points=8, local_points=12, local_states=16)
ROUNDS = 3  # of learning: each solves the field at new points
POINTS_EACH = 3  # random ones and extreme ones: each costs a solve of the field, and errors of a kind are alike
CONTACT_FACTORS = (0.2, 5.0)  # times all contacts at once: about the spread of one contact in the tables
SEGMENTS = 48  # chords per turn
BYTES, PROGRAM = 20_000, 0.9e9  # per unknown (snapshots, factors, points learned from), and of all else: both processes
SECONDS, FACTOR_ORDER = 140.0, 4.0 / 3.0  # of one core at 100,000 unknowns, growing as a factor by nested dissection
FIRST_AXIAL = 1.5  # thickest layer over the size of a triangle: quadratic elements are as good as two linear ones each
MISSED = 0.5  # of the wish, asked of the condensation where the mesh has used it up: the table says no in any case
CONDENSED = 2.0  # percent that the condensation may add at most, whatever the mesh leaves: films and contacts change it


@dataclass(frozen=True)
class NetworkSize:
    """built : with the network that was kept;  reduction : with the points it learned from;  sizes : the table

    mesh : how it was chosen, and its error; None where it was given
    """

    built: Built
    reduction: Reduction
    limit: Accuracy
    sizes: tuple[Size, ...]
    enrichment: Enrichment | None
    mesh: MeshChoice | None = None

    @property
    def met(self) -> bool:
        return (self.enrichment is None or self.enrichment.met) and (self.mesh is None or self.mesh.met)

    def document(self) -> dict[str, Any]:
        """Errors in percent of a part's own rise, at nominal coefficients and at random ones."""
        rounds = () if self.enrichment is None else self.enrichment.rounds
        return {
            "wish_percent": {"mean": self.limit.mean, "hot": self.limit.hot, "point": self.limit.point},
            "met": self.met,
            "states": len(self.built.network.states),
            "sizes": [size.document() for size in self.sizes],
            "guard": [r.document() for r in rounds],
            "mesh": None if self.mesh is None else self.mesh.document(),
        }


@one_blas_thread
def accurate_network(
    machine: Machine, accuracy: float, size_m: float = 0.06, progress: Progress = silent, say: Progress = silent
) -> NetworkSize:
    """Mesh and condensation together within `accuracy` percent of a part's own rise: what the mesh leaves of it, the
    condensation may use, CONDENSED at most.  size_m : of the triangles of the first mesh that is looked at (m)

    say : how large the meshes are and what they need, before they are solved
    """
    first = Meshing(size_m, SEGMENTS, ACROSS, FIRST_AXIAL * size_m)
    points, unknowns = size_of(on_all(machine), first)
    say(f"first mesh: {points:,} points, {needs(unknowns)}; the finest that is condensed: {needs(MOST_UNKNOWNS)}")
    mesh = chosen_mesh(on_all(machine), accuracy, first, progress)
    part = max(mesh.percent, key=lambda p: mesh.percent[p])
    say(f"mesh: {mesh.points:,} points, {needs(mesh.unknowns)}; hot spots within {mesh.worst:.2g} % ({part})")
    if not mesh.met:
        say(f"no finer mesh is condensed: within {accuracy:g} % no network will be, and the exit code is 1")
    left = accuracy - mesh.worst if mesh.met else MISSED * accuracy
    return replace(smallest_network(machine, min(left, CONDENSED), progress=progress, how=mesh.meshing), mesh=mesh)


def needs(unknowns: int) -> str:
    """What a build on so many unknowns takes."""
    gigabytes, minutes = (PROGRAM + BYTES * unknowns) / 1e9, SECONDS / 60.0 * (unknowns / 1e5) ** FACTOR_ORDER
    return f"{unknowns:,} unknowns, about {gigabytes:.1f} GB and {max(minutes, 0.1):.1f} min of a core"


@one_blas_thread
def smallest_network(
    machine: Machine,
    accuracy: float,
    size_m: float = 0.06,
    segments: int = 48,
    recipe: Recipe = FINE,
    progress: Progress = silent,
    rounds: int = ROUNDS,
    how: Meshing | None = None,
    points_each: int = POINTS_EACH,
    contact_factors: Sequence[float] = CONTACT_FACTORS,
) -> NetworkSize:
    """Build at several sizes and keep the smallest that is accurate enough; if none is, learn from where it fails.

    how : the mesh, None for one of size_m and segments
    points_each : random points, and extreme ones, at which every size is checked;  contact_factors : times all contacts
    """
    machine = on_all(machine)
    ready = meshed(machine, how or Meshing(size_m, segments, ACROSS, AXIAL * size_m), progress)
    progress("what the parts can look like")
    reduction = reduced(ready, recipe, motor_zones(machine))
    cases, limit = load_cases(machine, reduction), Accuracy(accuracy / 2, accuracy, accuracy)
    progress("error against number of states")
    at_points = [reduction.random_point(k) for k in range(points_each)]
    at_points += [reduction.nominal_point(), *(reduction.extreme_point(k) for k in range(points_each))]
    at_points += [*map(reduction.joined_point, contact_factors), reduction.early_point(0)]
    full = reduction.solved(at_points)
    answers = checks(full, cases)
    looks = [*answers[points_each:], *answers[:points_each]]
    table = tuple(Size.of(reduction, requested, looks, cases, limit) for requested in SIZES)
    good = [size for size in table if size.met]
    if good:
        enrichment, condensed = None, good[0].network
    else:
        reduction.learn(full[points_each:])
        del full[points_each:]  # what was learned is let go
        enrichment = enrich(reduction, cases, limit, rounds, answers[points_each:], full, tell=progress)
        condensed = enrichment.network
    few = motor_network(machine, table[SIZES.index(SMALL)].network)
    built = Built(machine, ready.mesh, motor_network(machine, condensed), ready.meshing, few)
    return NetworkSize(built, reduction, limit, table, enrichment)


SIZES = (0, 50, 100, 200, 400)  # 0: the means only
SMALL = 200  # for many runs: its means are within 1 %
