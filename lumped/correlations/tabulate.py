"""Any correlation at compiled speed: tabulated once over the temperature difference."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from lumped.correlations.info import Info
from lumped.transfer.laws import FILMS, FIRST_C, STEP_K, FilmTable, Table
from lumped.transfer.ranges import within_silence

# A fifth apart: between two a film of the power 1/4 is straight to 0.1 %.
STILL_AIR_K = tuple(float(d) for d in np.concatenate([[0.0], np.geomspace(0.1, 300.0, 48)]))


def film_tabulated(
    correlation: Callable[[float, float], tuple[float, Info]], differences: Iterable[float] = STILL_AIR_K
) -> FilmTable:
    """Temperature law from `correlation(surface degC, fluid degC) -> (h, info)`, whatever the fluid's temperature."""
    grid = tuple(float(d) for d in differences)
    with within_silence():
        h = (
            float(correlation(FIRST_C + k * STEP_K + 0.5 * d, FIRST_C + k * STEP_K - 0.5 * d)[0])
            for k in range(FILMS)
            for d in grid
        )
        return FilmTable(grid, tuple(h))


def tabulated(
    correlation: Callable[[float, float], tuple[float, Info]],
    differences: Iterable[float] = STILL_AIR_K,
    fluid_temperature: float = 20.0,
) -> Table:
    """Temperature law from `correlation(surface degC, fluid degC) -> (h, info)` at a fixed fluid temperature (degC).

    The default grid holds a quarter-power law to 0.1 % above 1 K. At small differences the table leaves
    the correlation's range by construction, so range warnings are silent here.
    """
    grid = tuple(float(d) for d in differences)
    with within_silence():
        h = tuple(float(correlation(fluid_temperature + d, fluid_temperature)[0]) for d in grid)
    return Table(grid, h)
