"""Any correlation at compiled speed: tabulated once over the temperature difference."""

from collections.abc import Callable, Iterable

import numpy as np

from lumped.correlations.info import Info, domain
from lumped.transfer.laws import FILMS, FIRST_C, STEP_K, USUAL_RISE_K, FilmTable
from lumped.transfer.ranges import Domain, within_silence

# A fifth apart: between two a film of the power 1/4 is straight to 0.1 %.
STILL_AIR_K = tuple(float(d) for d in np.concatenate([[0.0], np.geomspace(0.1, 300.0, 48)]))
USUAL_C = 35.0  # of a film


def film_tabulated(
    correlation: Callable[[float, float], tuple[float, Info]], differences: Iterable[float] = STILL_AIR_K
) -> FilmTable:
    """Temperature law from `correlation(surface degC, fluid degC) -> (h, info)`, whatever the fluid's temperature."""
    grid, films = tuple(float(d) for d in differences), [FIRST_C + k * STEP_K for k in range(FILMS)]

    def at(T: float, d: float) -> tuple[float, Info]:
        return correlation(T + 0.5 * d, T - 0.5 * d)

    with within_silence():
        h = tuple(float(at(T, d)[0]) for T in films for d in grid)
        holds = domain(lambda T, d: at(T, d)[1], films, (USUAL_C, USUAL_RISE_K), grid[1], grid[-1])
        if not holds.degC or not holds.degC[0] <= USUAL_C <= holds.degC[-1]:  # a size for which it is not meant
            holds = Domain(", ".join(at(USUAL_C, USUAL_RISE_K)[1].words))
        return FilmTable(grid, h, holds)
