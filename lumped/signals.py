"""The inputs of a record, checked, and what the laws make of them, worked out once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.laws import Law

Array = NDArray[np.float64]
LONG = 200_000  # samples: factors of longer records are not kept, whose runs take far longer than their factors


class Signals(dict[str, Array]):
    """Input -> finite array (nt,); a factor of a record that is not LONG stays known as long as its law.

    Laws and signals never change, so the runs of a fit, which differ in multipliers alone, share them.
    """

    def __init__(self, inputs: Mapping[str, Any], nt: int) -> None:
        super().__init__({name: _checked(name, value, nt) for name, value in inputs.items()})
        self.nt = nt
        self._around: tuple[Signals, slice] | None = None
        self._known: dict[int, tuple[ref[Law], Array]] = {}

    def part(self, some: slice) -> Signals:
        """The signals of a stretch of the record; all of it is itself."""
        if (some.start, some.stop) == (0, self.nt):
            return self
        out = Signals({name: value[some] for name, value in self.items()}, some.stop - some.start)
        out._around = self, some
        return out

    def __reduce__(self) -> Any:
        return Signals, (dict(self), self.nt)

    def factor(self, name: str, law: Law) -> Array:
        """The input factor of the law of a link or source: a number (), or (nt,) where it varies."""
        found = self._known.get(id(law))
        if found is not None and found[0]() is law:
            return found[1]
        value, key = self._made(name, law), id(law)
        if self.nt <= LONG:
            self._known[key] = ref(law, lambda _: self._known.pop(key, None)), value
        return value

    def _made(self, name: str, law: Law) -> Array:
        missing = [x for x in law.reads if x not in self]
        if missing:
            raise InputError(
                f"input '{missing[0]}' is missing", f"'{name}'", f"given: {', '.join(sorted(self)) or 'none'}"
            )
        if self._around and law.looks_at_all:
            whole, some = self._around
            value = whole.factor(name, law)
            value = value if value.ndim == 0 else value[some]
        else:
            value = np.asarray(law.factor(self), float)
        if value.shape not in ((), (self.nt,)) or not np.all(np.isfinite(value)):
            raise InputError(
                f"the input factor is not finite or has shape {value.shape}", f"'{name}'", f"finite, () or ({self.nt},)"
            )
        constant = value.ndim == 1 and bool(np.all(value == value[0]))
        return np.asarray(value[0]) if constant else value


def _checked(name: str, value: Any, nt: int) -> Array:
    array = np.asarray(value, float)
    if array.shape not in ((), (nt,)):
        raise InputError(f"input '{name}' has shape {array.shape}", "record", f"a number or ({nt},)")
    if not np.all(np.isfinite(array)):
        raise InputError(f"input '{name}' is not finite everywhere", "record", "fill its gaps first")
    return np.broadcast_to(array, (nt,))
