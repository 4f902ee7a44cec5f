"""Effects that no catalogue has."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from hidden.truth.body import Array, Body, Cells, Joint, Skeleton
from hidden.truth.change import Change, Terms
from hidden.truth.machine import Film, Loss


def cable(body: str, G: float, C: float) -> Change:
    """A thick lead with a mass of its own, cooled by the room."""

    def terms(s: Skeleton) -> tuple[Film, ...]:
        cells = s.cells("cable")
        return (Film("cable air", cells, "T_ambient", np.full(cells.size, G / cells.size), lambda T, Ta, u: 0.5),)

    return Change(
        bodies=(Body("cable", C, 4, 1.0 / G),), joints=(Joint("cable", body, "cable", G, (0.5, 0.0)),), terms=terms
    )


def gusts(body: str, watts: float, seed: int) -> Change:
    """Splash water: heat taken now and then for five to ten minutes, whatever the machine does."""
    rng = np.random.default_rng(seed)
    start, length = np.sort(rng.uniform(0.0, 4500.0, 4)), rng.uniform(300.0, 600.0, 4)

    def wet(time: Array) -> Array:
        return np.asarray(np.any((time >= start[:, None]) & (time < (start + length)[:, None]), axis=0), float)

    def taken(T: Array, u: Mapping[str, float]) -> Array:
        return -watts * u["splash"] * np.maximum(T - u["T_ambient"], 0.0) / 30.0

    return Change(terms=_on(body, taken), signals={"splash": wet})


@dataclass(frozen=True)
class Rub:
    """Heat (W) in cells at 1500 rpm and 10 K beyond 8 K of difference between the means of two other bodies."""

    name: str
    cells: Cells
    hot: Cells
    cold: Cells
    watts: float

    def into(self, q: Array, T: Array, u: Mapping[str, float]) -> None:
        beyond = max(float(T[self.hot].mean() - T[self.cold].mean()) - 8.0, 0.0) / 10.0
        q[self.cells] += self.watts * u["speed_rpm"] / 1500.0 * beyond / self.cells.size


def rub(body: str, hot: str, cold: str, watts: float) -> Change:
    """A seal that rubs once the shaft has grown against the housing."""
    return Change(terms=lambda s: (Rub("rub", s.cells(body), s.cells(hot), s.cells(cold), watts),))


def hot_spell(body: str, watts: float, start: float = 1500.0, end: float = 3300.0) -> Change:
    """A heater of the neighbour's that runs for half an hour of every test."""

    def on(time: Array) -> Array:
        return ((time >= start) & (time < end)).astype(float)

    return Change(terms=_on(body, lambda T, u: watts * u["neighbour"]), signals={"neighbour": on})


def _on(body: str, watts: Callable[[Array, Mapping[str, float]], Array]) -> Terms:
    def terms(s: Skeleton) -> tuple[Loss, ...]:
        cells = s.cells(body)
        return (Loss("foreign", cells, np.full(cells.size, 1.0 / cells.size), watts),)

    return terms


def runaway(body: str, watts: float, above: float) -> Change:
    """Magnets that demagnetise: a loss with the square of speed that sets in at a temperature, 10 K to full size."""

    def loss(T: Array, u: Mapping[str, float]) -> Array:
        return watts * (u["speed_rpm"] / 3000.0) ** 2 * np.clip((T - above) / 10.0, 0.0, 3.0)

    return Change(terms=_on(body, loss))
