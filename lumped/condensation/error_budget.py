"""One error budget: what the mesh, the condensation and the time steps leave in a temperature, in K per place."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from lumped.model.network import Array, Row


@dataclass(frozen=True)
class PlaceError:
    """Estimated errors (K) of the temperature at one place.

    mesh, condensation : None for a network that was not condensed from a field;  time : None where nothing estimates it
    """

    place: str
    mesh_K: float | None
    condensation_K: float | None
    time_K: float | None

    @property
    def total_K(self) -> float:
        """Their sum: errors of discretisation are not chance, so they need not cancel. 0 where nothing is estimated."""
        return sum(e for e in (self.mesh_K, self.condensation_K, self.time_K) if e is not None)

    def document(self) -> dict[str, Any]:
        estimable = any(e is not None for e in (self.mesh_K, self.condensation_K, self.time_K))
        return {**vars(self), "total_K": self.total_K if estimable else None}


@dataclass(frozen=True)
class ErrorBudget:
    """Of one run: every sensor, and the hot spot of every part that is heated."""

    places: tuple[PlaceError, ...]

    @property
    def total_K(self) -> Mapping[str, float]:
        """place -> K"""
        return {p.place: p.total_K for p in self.places}

    @classmethod
    def worst(cls, budgets: "Iterable[ErrorBudget]") -> "ErrorBudget":
        """Place by place the run in which most is left."""
        largest: dict[str, PlaceError] = {}
        for place in (p for budget in budgets for p in budget.places):
            if place.place not in largest or place.total_K > largest[place.place].total_K:
                largest[place.place] = place
        return cls(tuple(largest.values()))

    def with_condensation(self, more_K: Mapping[str, float]) -> "ErrorBudget":
        """With so much more at some places, as a network of fewer shapes leaves."""

        def one(p: PlaceError) -> PlaceError:
            more = more_K.get(p.place)
            return p if more is None else replace(p, condensation_K=more + (p.condensation_K or 0.0))

        return replace(self, places=tuple(map(one, self.places)))

    def document(self) -> list[dict[str, Any]]:
        return [p.document() for p in self.places]


@dataclass(frozen=True)
class MonitoredPlaces:
    """Where a budget looks. rows : sensor -> row over the network's z; points : sensor -> (part, xyz m) where known."""

    rows: Mapping[str, Row]
    places: Mapping[str, str]
    points: Mapping[str, Array]
