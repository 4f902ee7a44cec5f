"""Heat-transfer correlations: one function per correlation, named by its author, in one file per family.

Every function returns (value, Info): the film coefficient in W/m2/K unless it says otherwise, and what it rests on.
Outside a stated range it warns with a RangeWarning that carries the number and the range; it never clips in silence.
"""

from lumped.correlations.info import Info
from lumped.correlations.tabulate import film_tabulated
from lumped.transfer.ranges import RangeWarning

__all__ = ["Info", "RangeWarning", "film_tabulated"]
