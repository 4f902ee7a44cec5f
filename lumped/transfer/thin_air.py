"""Films and streams in thinner air: Reynolds number falls with density, Rayleigh number with its square.

Conductivity, heat capacity and Prandtl number do not depend on pressure. So a film of air that is blown past at v is in
air of rho times the density what it was at rho v, one of still air at a rise of D what it was at rho^2 D.
"""

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array
from lumped.transfer import laws
from lumped.transfer.properties import air
from lumped.transfer.streamed import Streamed

STILL = 0.5  # h ~ density^n of a declared number: Nu ~ Ra^(1/4)


def density(altitude_m: float) -> float:
    """Of air over that at sea level, at one temperature."""
    return air(20.0, altitude_m).rho / air(20.0).rho


@dataclass(frozen=True)
class Slowed(laws.Wrapped):
    """Another law that sees some inputs `by` times as large."""

    by: float
    inputs: tuple[str, ...]

    def factor(self, inputs: laws.Inputs) -> Array | float:
        slower = {n: self.by * np.asarray(inputs[n], float) for n in self.inputs}
        return self.base.factor({**{n: inputs[n] for n in self.reads}, **slower})


def thin_film(law: laws.Law, rho: float, moving: Collection[str]) -> laws.Law:
    """A film in air of `rho` times its density.  moving : the inputs that move air"""
    if isinstance(law, Streamed):
        return replace(law, table=_thin_table(law.table, rho))
    if isinstance(law, laws.Wrapped):
        inner = replace(law, base=thin_film(law.base, rho, moving))
        if isinstance(inner, laws.WithTemperature):
            return replace(inner, temperature=_thin(law.temperature, rho))
        return inner
    if isinstance(law, laws.Fixed) and law.temperature == laws.CONSTANT:
        return laws.Scaled(law, rho**STILL)
    thin: laws.Law = law if law.temperature == laws.CONSTANT else laws.WithTemperature(law, _thin(law.temperature, rho))
    if isinstance(law.temperature, laws.Power):
        thin = laws.Scaled(thin, rho ** (2.0 * law.temperature.exponent))
    movers = tuple(name for name in law.reads if name in moving)
    return Slowed(thin, rho, movers) if movers else thin


def thin_stream(law: laws.Law, rho: float) -> laws.Law:
    """The heat capacity rate of a volume flow; where it divides anew at every flow, it does so by Reynolds number."""
    return laws.Scaled(laws.WithTemperature(law, _thin(law.temperature, rho)), rho)


def _thin(law: laws.TemperatureLaw, rho: float) -> laws.TemperatureLaw:
    if isinstance(law, laws.StreamTable):
        return _thin_table(law, rho)
    if isinstance(law, laws.FilmTable):
        return _thin_film(law, rho)
    if isinstance(law, laws.Table) and law.difference[0] >= 0.0:
        return replace(law, difference=_over(law.difference, rho**2))
    return law


def _thin_film(law: laws.FilmTable, rho: float) -> laws.FilmTable:
    holds = law.domain and replace(law.domain, low=_over(law.domain.low, rho**2), high=_over(law.domain.high, rho**2))
    return replace(law, difference=_over(law.difference, rho**2), domain=holds)


def _over(values: tuple[float, ...], by: float) -> tuple[float, ...]:
    return tuple(x / by for x in values)


def _thin_table(law: laws.StreamTable, rho: float) -> laws.StreamTable:
    still = law.still and _thin_film(law.still, rho)
    return replace(law, shift=tuple(s - math.log(rho) for s in law.shift), still=still)
