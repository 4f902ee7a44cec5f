"""Films of an input and of temperatures together, as sums of products of one each.

A law is an input factor times a temperature law, and a film over speed and film temperature, say, is no such product
where its regime changes. Its table is written as a sum of them. Every product is positive: the profile over temperature
at one speed, times the shares with which the films at all speeds are mixtures of a few such profiles.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.correlations import Info
from lumped.transfer.laws import CONSTANT, FILMS, FIRST_C, STEP_K, Array, FilmTable, Inputs, Law, TemperatureLaw
from lumped.transfer.laws import Table as TableLaw
from lumped.transfer.properties import TABULATED_C, Fluid
from lumped.transfer.ranges import out_of_range, within_silence

POINTS = 97  # of a table, closer near rest, where a film changes most
TOLERANCE, SMALL = 3e-3, 1.0  # relative, of a film of at least SMALL (W/m2/K)
MOST = 6  # products: where regimes change the speed of that turns with temperature, and no few products follow
USUAL, OUTSIDE_WEIGHT = (0.0, 120.0), 0.25  # degC, film temperatures of machines; weight of errors beyond
Film = Callable[[float], tuple[float, Info]]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class FilmOver(Law):
    """A film (W/m2/K) over |input|, tabulated from `film` up to `top`; warns where the correlation itself would.

    The grid is denser towards 0, where films start as roots; above `top` the film is held and the warning says so.
    """

    of: str
    film: Film
    top: float

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.of,)

    @property
    def at(self) -> Array:
        """Of |input|."""
        return np.asarray(self.top * np.linspace(0.0, 1.0, POINTS) ** 2)

    def factor(self, inputs: Inputs) -> Array:
        x = np.abs(np.asarray(inputs[self.of], float))
        largest = float(x.max(initial=0.0))
        self.film(min(largest, self.top))
        if largest > self.top:
            out_of_range(f"film over {self.of}: {self.of} = {largest:.4g} outside 0 to {self.top:g}")
        return np.interp(x, self.at, over_grid(self.film, self.at))


@dataclass(frozen=True)
class Share(Law):
    """One product: `value` at `at` of |input|, times the temperature law; `film` warns for all products.

    of_fluid : whether the temperature law looks at the fluid's temperature alone
    """

    film: FilmOver
    at: tuple[float, ...]
    value: tuple[float, ...]
    temperature: TemperatureLaw = CONSTANT
    first: bool = False
    of_fluid: bool = False

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.film.reads

    def factor(self, inputs: Inputs) -> Array:
        if self.first:
            self.film.factor(inputs)
        return np.interp(np.abs(np.asarray(inputs[self.film.of], float)), self.at, self.value)


def over_grid(film: Film, at: Sequence[float] | Array) -> Array:
    """h (W/m2/K) on a grid, which leaves the correlation's range by construction."""
    with within_silence():
        return np.array([film(float(v))[0] for v in at])


def following(
    of: str,
    film: Callable[[Fluid], Film],
    fluid: Callable[[float], Fluid],
    usual_degC: float,
    top: float,
    liquid: bool = False,
) -> list[Law]:
    """A film over |input| with the fluid's properties at the film temperature: laws that act in parallel.

    Of a liquid they are those at its own temperature, as the correlations of channels ask for.
    film : over the input, for a fluid;  fluid : of degC;  usual_degC : at which ranges are checked
    """
    over = FilmOver(of, film(fluid(usual_degC)), top)
    degC = _liquid_range(fluid) if liquid else film_degC()
    h = np.stack([over_grid(film(fluid(T)), over.at) for T in degC], axis=1)
    law = TableLaw(tuple(degC), ()) if liquid else FilmTable((0.0, 1.0), ())
    shares = enumerate(products(h, weights(np.array(degC))))
    return [Share(over, tuple(over.at), tuple(u), _profile(law, w), k == 0, liquid) for k, (u, w) in shares]


def weights(degC: Array) -> Array:
    """Of errors at film temperatures."""
    return np.where((degC >= USUAL[0]) & (degC <= USUAL[1]), 1.0, OUTSIDE_WEIGHT)


def film_degC() -> list[float]:
    """Film temperatures of a FilmTable."""
    return [FIRST_C + STEP_K * k for k in range(FILMS)]


def _liquid_range(fluid: Callable[[float], Fluid]) -> list[float]:
    """Where a liquid is one."""
    out = []
    for T in TABULATED_C:
        try:
            fluid(T)
        except InputError:
            continue
        out.append(T)
    return out


def _profile(law: FilmTable | TableLaw, w: Array) -> TemperatureLaw:
    """The law with values over temperature; none where they are all the same."""
    if np.ptp(w) <= 1e-9 * float(np.max(np.abs(w))):
        return CONSTANT if w[0] == 1.0 else FilmTable((0.0, 1.0), (float(w[0]),) * (2 * FILMS))
    if isinstance(law, TableLaw):
        return TableLaw(law.difference, tuple(w.tolist()))
    return FilmTable(law.difference, tuple(np.repeat(w, 2).tolist()))


def products(h: Array, weight: Array | None = None) -> list[tuple[Array, Array]]:
    """Pairs of positive factors whose products sum to h (rows, columns), as many as TOLERANCE asks for and MOST allows.

    weight : (columns,) how much an error there counts
    """
    profile, scale = h / np.maximum(h.max(axis=1, keepdims=True), 1e-300), np.maximum(h, SMALL)
    scale = scale / (np.ones(h.shape[1]) if weight is None else weight)
    few = np.arange(0, len(h), 4), np.arange(0, h.shape[1], max(1, h.shape[1] // 30))
    basis: list[int] = []
    while True:
        errors = {k: _missed(h, scale, profile, [*basis, k], *few) for k in few[0].tolist() if k not in basis}
        basis.append(min(errors, key=lambda k: errors[k]))
        share = _shares(h, scale, profile[basis])
        if np.all(np.abs(h - share @ profile[basis]) <= TOLERANCE * scale) or len(basis) == MOST:
            return list(zip(share.T, profile[basis], strict=True))


def _shares(h: Array, scale: Array, profiles: Array) -> Array:
    """(rows, profiles) positive: every row as a mixture of the profiles."""
    from scipy.optimize import nnls

    return np.array([nnls((profiles / s).T, row / s)[0] for row, s in zip(h, scale, strict=True)])


def _missed(h: Array, scale: Array, profile: Array, basis: list[int], rows: Indices, cols: Indices) -> float:
    """What mixtures of the chosen rows miss of some rows and columns; large errors count most."""
    h, scale, profiles = h[rows][:, cols], scale[rows][:, cols], profile[basis][:, cols]
    off = (h - _shares(h, scale, profiles) @ profiles) / scale
    return float(np.sum(off**4))
