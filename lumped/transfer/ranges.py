"""What lies outside the range of a source is said, once for each thread that is not told to be silent."""

import re
import threading
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array

_thread = threading.local()


class RangeWarning(UserWarning):
    """A correlation or a map was used outside the range of its source."""

    @property
    def subject(self) -> str:
        """Of what it warns: its words without their numbers, the same however often and however far outside."""
        return re.sub(r"(?<![\w.])-?\d[\d.e+-]*", "", str(self).partition(" = ")[0])


def out_of_range(what: str) -> None:
    """A RangeWarning, unless this thread is in `within_silence`."""
    if not getattr(_thread, "silent", False):
        warnings.warn(what, RangeWarning, stacklevel=2)


@contextmanager
def within_silence() -> Iterator[None]:
    """No RangeWarning of this thread: of grids that leave a range by construction, and of what was said before.

    Filters of `warnings` belong to all threads: who sets and restores them beside another leaves them wrong.
    """
    before = getattr(_thread, "silent", False)
    _thread.silent = True
    try:
        yield
    finally:
        _thread.silent = before


def _between(degC: Array | float, at: Sequence[float], limits: Sequence[float]) -> Array:
    """Limits between temperatures: they go as viscosities do; straight where one of them is 0."""
    if min(limits) > 0.0:
        return np.asarray(np.exp(np.interp(degC, at, np.log(limits))))
    return np.asarray(np.interp(degC, at, limits))


@dataclass(frozen=True)
class Domain:
    """Where a correlation is in the range of its source.

    degC : rising temperatures of its fluid, from the first to the last that it is for; none: it holds nowhere
    low, high : at each of them, the least and the largest of what it follows
    what : the correlation; of one that holds nowhere its own words
    """

    what: str
    degC: tuple[float, ...] = ()
    low: tuple[float, ...] = ()
    high: tuple[float, ...] = ()

    def ends(self, degC: Array | float) -> tuple[Array, Array]:
        """The least and the largest at temperatures of the fluid."""
        return _between(degC, self.degC, self.low), _between(degC, self.degC, self.high)

    def beside(self, degC: float, fluid: str) -> str:
        """How a temperature of the fluid lies outside, with value and range; else nothing."""
        if not self.degC:
            return self.what
        low, high = self.degC[0], self.degC[-1]
        what = f"its {fluid} at {degC:.4g} degC outside {low:.4g} to {high:.4g} ({self.what})"
        return "" if low <= degC <= high else what
