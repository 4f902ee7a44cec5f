"""A law that follows one input through a table: how a motor's films depend on speed and flow, and on temperature."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import CONSTANT, FILMS, FIRST_C, STEP_K, Array, FilmTable, Inputs, Law, TemperatureLaw
from lumped.transfer.ranges import within_silence


@dataclass(frozen=True)
class Interpolated(Law):
    """Piecewise linear in |input|, flat outside: a film (W/m2/K) or a conductance (W/K)."""

    of: str
    at: tuple[float, ...]
    value: tuple[float, ...]
    temperature: TemperatureLaw = CONSTANT

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.of,)

    def factor(self, inputs: Inputs) -> Array:
        return np.interp(np.abs(np.asarray(inputs[self.of], float)), self.at, self.value)


def film_over(
    of: str, at: Sequence[float], film: Callable[[float, float], float], usual: float, reference: float
) -> Interpolated:
    """A film (W/m2/K) over |input| and its film temperature.

    film : of the input and of the film temperature (degC), at which the fluid's properties are taken
    usual : the input at which the film's dependence on temperature is taken: it is the same throughout a regime
    reference : film temperature (degC) at which the film is tabulated over the input
    """
    with within_silence():
        value = tuple(float(film(float(x), reference)) for x in at)
        ratio = [film(usual, FIRST_C + k * STEP_K) / film(usual, reference) for k in range(FILMS)]
    return Interpolated(of, tuple(map(float, at)), value, FilmTable((0.0, 1.0), tuple(np.repeat(ratio, 2).tolist())))
