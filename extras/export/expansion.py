"""Laws as sums of products (products.py), exactly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import singledispatch
from itertools import product as pairs

import numpy as np

from extras.export.products import Mapped, Positive, Powered, Product, Straight, Sum
from thermoscope.plugin import (
    BrushLoss,
    CopperLoss,
    Direction,
    EddyLoss,
    Fixed,
    InputPower,
    IronLoss,
    Law,
    MapLoss,
    MeasuredLoss,
    OneWay,
    PowerLoss,
    Scaled,
    Stirred,
    Streamed,
    Switched,
    WithTemperature,
)


@dataclass(frozen=True)
class Unknown:
    """No expansion is known: to be tabulated."""


@singledispatch
def expanded(law: Law) -> Sum | Unknown:
    """The input factor of a law, exactly, where it is known how."""
    return Unknown()


@expanded.register
def _(law: Fixed) -> Sum | Unknown:
    return (Product(law.value),)


@expanded.register
def _(law: InputPower) -> Sum | Unknown:
    return (Product(law.value, tuple(Powered(*t) for t in law.terms)),)


@expanded.register
def _(law: PowerLoss) -> Sum | Unknown:
    return tuple(Product(watts, tuple(Powered(*t) for t in powers)) for watts, powers in law.terms)


@expanded.register
def _(law: CopperLoss) -> Sum | Unknown:
    return tuple(Product(law.factor_ * law.resistance, (Powered(name, 1.0, 2.0),)) for name in law.currents)


@expanded.register
def _(law: EddyLoss) -> Sum | Unknown:
    c0, *others = law.ac
    orders = [(c0 - 1.0, ()), *((c, (Powered(law.speed, law.speed_at, float(k)),)) for k, c in enumerate(others, 1))]
    R = law.copper.factor_ * law.copper.resistance
    return tuple(
        Product(R * c, (Powered(name, 1.0, 2.0), *ac)) for name, (c, ac) in pairs(law.copper.currents, orders) if c
    )


@expanded.register
def _(law: IronLoss) -> Sum | Unknown:
    flux = (Powered(law.excitation, law.excitation_at, law.flux_exponent),) if law.excitation else ()
    parts = ((law.hysteresis, law.frequency_exponent), (law.eddy, 2.0), (law.excess, 1.5))
    return tuple(Product(w, (Powered(law.speed, law.speed_at, e), *flux)) for w, e in parts if w)


@expanded.register
def _(law: BrushLoss) -> Sum | Unknown:
    drop = Product(law.drop, (Powered(law.current, 1.0, 1.0),))
    return (drop, Product(law.friction, (Powered(law.speed, law.speed_at, 1.0),))) if law.speed else (drop,)


@expanded.register
def _(law: MapLoss) -> Sum | Unknown:
    watts = tuple(np.ravel(law.watts).tolist())
    return (Product(1.0, (Mapped(law.speed, law.torque, law.at_speed, law.at_torque, watts, True),)),)


@expanded.register
def _(law: MeasuredLoss) -> Sum | Unknown:
    return tuple(Product(scale, tuple(Straight(n, 0.0, 1.0) for n in names)) for scale, names in law.powers)


@expanded.register
def _(law: Streamed) -> Sum | Unknown:
    return (Product(law.value),)


@expanded.register
def _(law: Stirred) -> Sum | Unknown:
    stirring = law.k1 * law.k2 * abs(law.per_rpm) ** law.k3
    return Product(law.k1), Product(stirring, (Powered("speed_rpm", 1.0, law.k3),))


def _each(base: Law, change: Callable[[Product], Product]) -> Sum | Unknown:
    """What another law's expansion becomes, product by product."""
    inner = expanded(base)
    return inner if isinstance(inner, Unknown) else tuple(change(p) for p in inner)


@expanded.register
def _(law: Scaled) -> Sum | Unknown:
    return _each(law.base, lambda p: replace(p, coefficient=law.by * p.coefficient))


@expanded.register
def _(law: OneWay | WithTemperature) -> Sum | Unknown:
    return expanded(law.base)


@expanded.register
def _(law: Direction) -> Sum | Unknown:
    return _each(law.base, lambda p: p.times(Positive(law.column, float(law.way))))


@expanded.register
def _(law: Switched) -> Sum | Unknown:
    on = Straight(law.switch, 0.0, 1.0) if law.closed else Straight(law.switch, 1.0, -1.0)
    return _each(law.base, lambda p: p.times(on))
