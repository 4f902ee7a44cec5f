"""Films of moving fluids over an input and a temperature together: by Reynolds number, so that no regime is cut."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from geom.errors import InputError
from lumped.correlations.info import Info, domain
from lumped.transfer.laws import FILMS, FIRST_C, FULL_UNITS, STEP_K, Array, StreamTable, Table
from lumped.transfer.properties import TABULATED_C, Fluid
from lumped.transfer.ranges import Domain, within_silence
from lumped.transfer.streamed import Streamed

Moving = Callable[[float, Fluid], tuple[float, Info]]
TOLERANCE = 1e-3  # of a film, between two points of its table
THIN = 1.5e-3  # of a viscosity between two temperatures: where a regime begins a film grows with its fourth power
LEAST, MOST = 1e-5, 1e4  # times the usual input: where a table ends at the latest
REACH = 20.0  # and at the earliest: at four times the usual input in a fluid of a fifth of the viscosity
LOOKS = (0.2, 0.5, 0.8)  # of a cell, where a film is looked at: a corner may be anywhere in it
GRID_K = TABULATED_C[1] - TABULATED_C[0]
STEPS = 25  # of a coolant's temperatures: between two its heat capacity is straight to 0.02 %
FINEST = 2e-3  # of a logarithm: no cell is cut further, at a jump


def streamed(
    of: str | None,
    usual: float,
    film: Moving,
    fluid: Callable[[float], Fluid],
    degC: float,
    liquid: bool,
    value: float = 1.0,
    stretch: float = 0.0,
) -> Streamed:
    """value times a film over |input|, with the domain of its correlation.

    film : of |input| and fluid;  usual : of |input|, above 0;  degC : usual temperature
    liquid : whether the fluid's own temperature counts, else that of the film;  stretch : see StreamTable
    """
    with within_silence():
        wide = TABULATED_C[::4] if liquid else [FIRST_C + STEP_K * k for k in range(FILMS)]
        ends = liquid_range(fluid) if liquid else (wide[0], wide[-1])
        some = sorted({T for T in (*wide, degC) if ends[0] < T < ends[1]})
        temperatures = list(_between(film, fluid, usual, [ends[0], *some, ends[1]]))
        fluids = [fluid(T) for T in temperatures]
        reference = fluid(degC).nu
        shift = [math.log(x.nu / reference) for x in fluids]
        holds = _domain(film, fluid, (degC, usual), [ends[0], *some, ends[1]])
        high = math.log(max((REACH * usual, *holds.high)))
        states, low = list(zip(fluids, shift, strict=True)), math.log(LEAST * usual)
        number = _numbers(film, states, low, math.log(usual), high)
        each = [_film(film, x, s, y, low) for x, s in states for y in number]
    times = 1.0 if liquid else 2.0
    totals = tuple(times * T for T in temperatures)
    table = StreamTable(of, usual, times * degC, totals, tuple(shift), tuple(number), tuple(each), stretch)
    return Streamed(value, replace(table, domain=holds), liquid)


def liquid_range(liquid: Callable[[float], Fluid]) -> tuple[float, float]:
    """From what temperature to what (degC) the properties of a liquid are known."""
    span = [T for T in TABULATED_C if _exists(liquid, T)]
    return _limit(liquid, span[0], -GRID_K), _limit(liquid, span[-1], GRID_K)


def warmed(liquid: Callable[[float], Fluid], at_degC: float, degC: Sequence[float] = ()) -> Table:
    """Heat capacity of a volume over that at `at_degC`, at some or all temperatures at which the coolant is liquid."""
    some, usual = degC or np.linspace(*liquid_range(liquid), STEPS).tolist(), liquid(at_degC)
    return Table(tuple(some), tuple(x.rho * x.cp / (usual.rho * usual.cp) for x in map(liquid, some)))


def restretched(units: float, share: float) -> float:
    """By what to take a film so that a stretch for the usual heat capacity rate is right at `share` times that.

    units : transfer units of a cell at the usual rate
    """
    N = units / share
    if share == 1.0 or N <= 0.0 or math.expm1(FULL_UNITS) < N:
        return 1.0
    N = min(N, FULL_UNITS)
    return math.log1p(share * math.expm1(N)) / (share * N)


def _film(film: Moving, fluid: Fluid, shift: float, number: float, low: float) -> float:
    """At the lowest number what it is at rest."""
    return float(film(math.exp(number + shift) if number > low else 0.0, fluid)[0])


def _domain(film: Moving, fluid: Callable[[float], Fluid], usual: tuple[float, float], degC: Sequence[float]) -> Domain:
    """Over |input| as at the usual viscosity: a Reynolds number's range is then alike at all temperatures."""
    at, size = usual
    thin = fluid(at).nu

    def info(T: float, alike: float) -> Info:
        here = fluid(T)
        return film(alike * here.nu / thin, here)[1]

    return domain(info, degC, usual, LEAST * size, MOST * size)


def _limit(fluid: Callable[[float], Fluid], inside: float, step: float) -> float:
    """Where a fluid freezes or boils between a temperature at which it is known and the next, to 0.02 K."""
    gone = inside + step
    if _exists(fluid, gone):
        return inside
    for _ in range(8):
        middle = 0.5 * (inside + gone)
        inside, gone = (middle, gone) if _exists(fluid, middle) else (inside, middle)
    return inside


def _exists(fluid: Callable[[float], Fluid], T: float) -> bool:
    try:
        fluid(T)
    except InputError:
        return False
    return True


def _between(film: Moving, fluid: Callable[[float], Fluid], usual: float, degC: Sequence[float]) -> Iterator[float]:
    """The temperatures, and those halfway as long as these are missed."""
    for a, b in pairwise(degC):
        cold, middle, warm = fluid(a), fluid(0.5 * (a + b)), fluid(b)
        curved = abs(math.log(middle.nu**2 / (cold.nu * warm.nu))) > 2.0 * THIN
        h = [film(usual * x.nu / middle.nu, x)[0] for x in (cold, middle, warm)]
        if b - a > 1.0 and (curved or abs(0.5 * (h[0] + h[2]) - h[1]) > TOLERANCE * h[1]):
            yield from list(_between(film, fluid, usual, (a, 0.5 * (a + b), b)))[:-1]
        else:
            yield a
    yield degC[-1]


def _numbers(film: Moving, fluids: Sequence[tuple[Fluid, float]], low: float, usual: float, high: float) -> list[float]:
    """Logarithms of the input, as at the usual viscosity, between which the films are straight."""
    some = [fluids[k] for k in sorted({0, len(fluids) // 3, 2 * len(fluids) // 3, len(fluids) - 1})]

    def at(y: float) -> Array:
        return np.array([_film(film, fluid, shift, y, low) for fluid, shift in some])

    def cut(a: float, b: float, first: Array, last: Array) -> Iterator[float]:
        middle = 0.5 * (a + b)
        inside = {share: at(a + share * (b - a)) for share in LOOKS}
        missed = (np.abs(first + share * (last - first) - h) > TOLERANCE * h for share, h in inside.items())
        if b - a > FINEST and any(map(np.any, missed)):
            yield from cut(a, middle, first, inside[0.5])
            yield from cut(middle, b, inside[0.5], last)
        else:
            yield a

    start = sorted({*np.linspace(low, high, 25).tolist(), usual})
    films = [at(y) for y in start]
    inner = [y for k in range(len(start) - 1) for y in cut(start[k], start[k + 1], films[k], films[k + 1])]
    return [*inner, high]
