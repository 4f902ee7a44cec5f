"""How far a condensed network is from its field, in the numbers a user cares about."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from lumped.condensation.linear import linear, unit_load
from lumped.condensation.recovery import PartShape, Shapes
from lumped.model.network import Array, Network

FLOOR = 0.1  # of the machine's largest rise: below it a percentage of a part's own rise means nothing
POINTS = 25  # random points per part
DRAWS = 4  # losses of all zones drawn at random: they cost no solve


@dataclass(frozen=True)
class Accuracy:
    """Largest errors that will do, in percent of the part's own rise: means, hot spots, points."""

    mean: float = 1.0
    hot: float = 2.0
    point: float = 2.0

    def excess(self, error: "PartError") -> float:
        """1 where a part is just good enough."""
        return max(error.mean / self.mean, error.hot / self.hot, error.point / self.point)


@dataclass(frozen=True)
class PartError:
    """Of one part, in percent of its own rise: mean, hottest point, worst of random points."""

    mean: float
    hot: float
    point: float


@dataclass(frozen=True)
class Errors:
    """Worst over parts, in percent of the part's own rise: mean, hottest point, random points; and of which part."""

    mean: float
    hot: float
    point: float
    mean_part: str
    hot_part: str
    point_part: str
    parts: Mapping[str, PartError]

    def document(self) -> dict[str, Any]:
        """The three numbers and where they arise."""
        return {key: value for key, value in vars(self).items() if key != "parts"}

    def __str__(self) -> str:
        return f"{self.mean:.2f}/{self.hot:.2f}/{self.point:.2f} % ({self.mean_part}, {self.hot_part})"


def worst(parts: Mapping[str, PartError]) -> Errors:
    """The largest of each kind, and where."""
    names = [max(parts, key=lambda p: getattr(parts[p], kind)) for kind in ("mean", "hot", "point")]
    mean, hot, point = names
    return Errors(parts[mean].mean, parts[hot].hot, parts[point].point, mean, hot, point, parts)


def merged(errors: Sequence[Errors]) -> Errors:
    """Part by part the worst of several comparisons."""
    kinds, parts = ("mean", "hot", "point"), errors[0].parts
    return worst({p: PartError(*(max(getattr(e.parts[p], kind) for e in errors) for kind in kinds)) for p in parts})


def errors(network: Network, full: Array, x: Array, largest: float | None = None, floor: float = FLOOR) -> Errors:
    """Compare a field `full` (n,) with the network's states x (n_states,), both as rises over the surroundings (K).

    largest : the machine's largest rise (K) that the floor refers to; None: of this field
    floor : least rise, as a share of the largest, that a percentage refers to; 1: of the largest rise throughout
    """
    return _between(_shapes(network), full, _shapes(network).field(x), largest, floor)


def _shapes(network: Network) -> Shapes:
    shapes = network.recovery
    assert isinstance(shapes, Shapes)
    return shapes


def _between(
    shapes: Shapes, full: Array, recovered: Array, largest: float | None = None, floor: float = FLOOR
) -> Errors:
    """The same of two fields (n,)."""
    rng, start = np.random.default_rng(0), 0
    least = floor * (float(np.abs(full).max()) if largest is None else largest)
    parts: dict[str, PartError] = {}
    for part, shape in shapes.parts.items():
        mine = slice(start, start + len(shape.V))
        start = mine.stop
        parts[part] = _part(full[mine], recovered[mine], shape, least, rng)
    return worst(parts)


def _part(T: Array, sampled: Array, shape: PartShape, floor: float, rng: np.random.Generator) -> PartError:
    w = shape.weights
    mean, off = w @ T, T - sampled
    at = rng.choice(len(T), min(POINTS, len(T)), replace=False)
    rise = max(abs(float(mean)), floor)
    hottest = abs(float(T.max() - sampled.max())) / max(float(T.max()), floor)
    return PartError(100 * abs(float(w @ off)) / rise, 100 * hottest, 100 * float(np.abs(off[at]).max()) / rise)


@dataclass(frozen=True)
class LoadCases:
    """Load cases: watts (n_case, n_zone) in the zones, kelvin (n_case, n_fluid) of the fluids over the surroundings."""

    zones: tuple[str, ...]
    fluids: tuple[str, ...]
    watts: Array
    kelvin: Array

    def of_field(self, X: NDArray[np.floating]) -> Array:
        """(n, n_case) from unit solutions X (n, n_zone + n_fluid)."""
        return np.asarray(X @ np.hstack([self.watts, self.kelvin]).T)


def random_load_cases(
    zones: Sequence[str], fluids: Sequence[str], rated: Mapping[str, float], rises: Mapping[str, float] | None = None
) -> LoadCases:
    """Load cases: rated losses, losses of every zone drawn at random, and half of rated with inner fluids 20 K warmer.

    rated : zone -> W;  rises : fluid -> K over the surroundings with the rated losses, 0 if not given
    """
    rng = np.random.default_rng(3)
    rated_watts = np.array([rated.get(zone, 0.0) for zone in zones])
    rated_watts = rated_watts if rated_watts.any() else np.ones(len(zones))
    random = rated_watts.sum() * rng.dirichlet(np.full(len(zones), 0.5), DRAWS)
    warm = np.array([0.0 if fluid == "ambient" else 20.0 for fluid in fluids])
    at_rated = np.array([(rises or {}).get(fluid, 0.0) for fluid in fluids])
    kelvin = [at_rated, *np.zeros((DRAWS, len(fluids))), 0.5 * at_rated + warm]
    return LoadCases(tuple(zones), tuple(fluids), np.array([rated_watts, *random, 0.5 * rated_watts]), np.array(kelvin))


def point_errors(
    network: Network,
    films: Mapping[str, float],
    contacts: Mapping[str, float],
    full: NDArray[np.floating],
    cases: LoadCases,
    shift: float = 0.0,
) -> Errors:
    """Worst over the load cases at one set of coefficients; full (n, n_case) of the field; shift as in reduction.Point.

    Early, in percent of the machine's largest rise: most parts have none of their own yet.
    """
    shapes, floor = _shapes(network), 1.0 if shift else FLOOR
    # Of the network: rises over the surroundings (n_states, n_case); shift (1/s) as of Point
    system = linear(network, films, contacts)
    load = np.column_stack([unit_load(network, zone, system.solid) for zone in cases.zones]) @ cases.watts.T
    names = (*network.states, *network.boundaries)
    order = [[names[c] for c in system.fluid].index(fluid) for fluid in cases.fluids]
    out = np.zeros((len(network.states), len(cases.watts)))
    heat = load + system.B[:, order] @ cases.kelvin.T
    out[system.solid] = cho_solve(cho_factor(system.A + np.diag(shift * system.C)), heat)
    recovered = shapes.field(out)
    return merged([_between(shapes, T, its, floor=floor) for T, its in zip(full.T, recovered.T, strict=True)])
