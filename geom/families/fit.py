"""Values that are allowed one by one but do not fit together: the first that does not is refused."""

from geom.description.geometry import Geometry
from geom.errors import InputError

mm = 1e3


class Fit:
    """Rules on a geometry; a rule that does not hold raises InputError with the key, its value, and what would fit.

    Keys are "group.attribute" of the geometry; limits in m.  why : how the sentence ends, with its punctuation
    """

    def __init__(self, geometry: Geometry) -> None:
        self.geometry = geometry

    def need(self, holds: bool, key: str, right: str, unit: str = "mm") -> None:
        """unit : of the key in the machine file, "" for a count or a share"""
        if not holds:
            group, attribute = key.split(".")
            place = f"[geometry.{group}] {attribute}{'_' * bool(unit)}{unit}"
            value = self._value(key) * (mm if unit else 1)
            raise InputError(f"{value:.4g} does not fit", place, f"must be {right}")

    def below(self, limit: float, key: str, why: str = "") -> None:
        """A length below a limit."""
        self.need(self._value(key) < limit, key, f"less than {limit * mm:.4g} mm{why}")

    def above(self, limit: float, key: str, why: str = "") -> None:
        """A length above a limit."""
        self.need(self._value(key) > limit, key, f"more than {limit * mm:.4g} mm{why}")

    def _value(self, key: str) -> float:
        group, attribute = key.split(".")
        return float(getattr(getattr(self.geometry, group), attribute))
