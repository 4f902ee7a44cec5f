"""The inputs of a record, checked, and what the laws make of them, worked out once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.curve import NONE, Between, Curve, between, curve, straight
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
        self._around: tuple[Signals, Array] | None = None
        self._known: dict[int, tuple[ref[Law], Curve]] = {}
        self._finer: dict[bytes, Signals] = {}

    def part(self, some: slice) -> Signals:
        """The signals of a stretch of the record; all of it is itself."""
        if (some.start, some.stop) == (0, self.nt):
            return self
        return self._at(np.arange(some.start, some.stop, dtype=float))

    def finer(self, at: Array) -> Signals:
        """The signals at positions (index of a sample plus share), kept for the next time."""
        key = at.tobytes()
        if key not in self._finer:
            self._finer[key] = self._at(at)
        return self._finer[key]

    def _at(self, at: Array) -> Signals:
        out = Signals({name: between(value, at) for name, value in self.items()}, at.size)
        out._around = self, at
        return out

    def __reduce__(self) -> Any:
        return Signals, (dict(self), self.nt)

    def factor(self, name: str, law: Law) -> Array:
        """The input factor of the law of a link or source: a number (), or (nt,) where it varies."""
        return self.curve(name, law).value

    def curve(self, name: str, law: Law) -> Curve:
        """The same, and how it runs between the samples."""
        found = self._known.get(id(law))
        if found is not None and found[0]() is law:
            return found[1]
        made, key = self._made(name, law), id(law)
        if self.nt <= LONG:
            self._known[key] = ref(law, lambda _: self._known.pop(key, None)), made
        return made

    def _made(self, name: str, law: Law) -> Curve:
        missing = [x for x in law.reads if x not in self]
        if missing:
            raise InputError(
                f"input '{missing[0]}' is missing", f"'{name}'", f"given: {', '.join(sorted(self)) or 'none'}"
            )
        if not law.looks_at_all:
            return curve(lambda at: self._factor(name, law, at), self.nt, self._turns(law.reads))
        if self._around:
            whole, at = self._around
            value = whole.factor(name, law)
            return straight(value if value.ndim == 0 else between(value, at))
        value = self._factor(name, law, None)
        constant = value.ndim == 1 and bool(np.all(value == value[0]))
        return straight(np.asarray(value[0]) if constant else value)

    def _turns(self, names: Iterable[str]) -> Array:
        """Positions at which one of the inputs passes through zero between two samples."""
        out = [NONE]
        for x in (self[name] for name in names):
            left = np.flatnonzero(x[:-1] * x[1:] < 0.0)
            out.append(left + x[left] / (x[left] - x[left + 1]))
        return np.concatenate(out)

    def _factor(self, name: str, law: Law, at: Array | None) -> Array:
        """The factor at positions, or at the samples of the whole record."""
        size = self.nt if at is None else at.size
        value = np.asarray(law.factor(self if at is None else Between(self, at)), float)
        if value.shape not in ((), (size,)) or not np.all(np.isfinite(value)):
            raise InputError(
                f"the input factor is not finite or has shape {value.shape}", f"'{name}'", f"finite, () or ({size},)"
            )
        return value


def _checked(name: str, value: Any, nt: int) -> Array:
    array = np.asarray(value, float)
    if array.shape not in ((), (nt,)):
        raise InputError(f"input '{name}' has shape {array.shape}", "record", f"a number or ({nt},)")
    if not np.all(np.isfinite(array)):
        raise InputError(f"input '{name}' is not finite everywhere", "record", "fill its gaps first")
    return np.broadcast_to(array, (nt,))
