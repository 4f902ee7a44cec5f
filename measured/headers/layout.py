"""What the search for a table finds, and the ways to write that nothing was read."""

from collections.abc import Sequence
from dataclasses import dataclass

Row = Sequence[object]
# As loggers, spreadsheets and statistics programs write that nothing was read.
MISSING = frozenset(
    {"", "na", "n/a", "#na", "#n/a", "#n/a n/a", "<na>", "null", "none"}
    | {"nan", "-nan", "1.#ind", "-1.#ind", "1.#qnan", "-1.#qnan"}
)


@dataclass(frozen=True)
class Layout:
    """names, units : one per column, "" where the file gives none;  first : row where the readings begin

    width : columns;  preamble : rows before the names;  header : row of the names, -1 where the file gives none
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    first: int
    width: int
    preamble: int = 0
    header: int = -1

    @property
    def units_by_name(self) -> dict[str, str]:
        """Name -> unit, of the columns that have one in a row under their names."""
        return {name.strip(): unit for name, unit in zip(self.names, self.units, strict=True) if unit}
