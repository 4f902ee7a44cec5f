"""Laws as sums of products (products.py), exactly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import singledispatch
from itertools import product as pairs
from typing import Any

import numpy as np

from extras.export.products import Mapped, Positive, Powered, Product, Straight, Sum
from thermoscope import plugin as th


@singledispatch
def expanded(law: th.Law) -> Sum | None:
    """The input factor of a law, exactly; None where no expansion is known: to be tabulated."""
    return None


def _eddy(law: th.EddyLoss) -> Sum:
    c0, *others = law.ac
    orders = [(c0 - 1.0, ()), *((c, (Powered(law.speed, law.speed_at, float(k)),)) for k, c in enumerate(others, 1))]
    R = law.copper.factor_ * law.copper.resistance
    return tuple(
        Product(R * c, (Powered(name, 1.0, 2.0), *ac)) for name, (c, ac) in pairs(law.copper.currents, orders) if c
    )


def _iron(law: th.IronLoss) -> Sum:
    flux = (Powered(law.excitation, law.excitation_at, law.flux_exponent),) if law.excitation else ()
    parts = ((law.hysteresis, law.frequency_exponent), (law.eddy, 2.0), (law.excess, 1.5))
    return tuple(Product(w, (Powered(law.speed, law.speed_at, e), *flux)) for w, e in parts if w)


def _brush(law: th.BrushLoss) -> Sum:
    drop = Product(law.drop, (Powered(law.current, 1.0, 1.0),))
    return (drop, Product(law.friction, (Powered(law.speed, law.speed_at, 1.0),))) if law.speed else (drop,)


def _map(law: th.MapLoss) -> Sum:
    watts = tuple(np.ravel(law.watts).tolist())
    grid = Mapped(law.speed, law.torque, law.at_speed, law.at_torque, watts, True)
    return (Product(1.0, (grid, *(Powered(*t) for t in law.powers))),)


def _stirred(law: th.Stirred) -> Sum:
    stirring = law.k1 * law.k2 * abs(law.per_rpm) ** law.k3
    return Product(law.k1), Product(stirring, (Powered("speed_rpm", 1.0, law.k3),))


def _each(base: th.Law, change: Callable[[Product], Product]) -> Sum | None:
    """What another law's expansion becomes, product by product."""
    inner = expanded(base)
    return inner and tuple(change(p) for p in inner)


def _switched(law: th.Switched) -> Sum | None:
    on = Straight(law.switch, 0.0, 1.0) if law.closed else Straight(law.switch, 1.0, -1.0)
    return _each(law.base, lambda p: p.times(on))


EXACT: dict[type[th.Law], Callable[[Any], Sum | None]] = {
    th.Fixed: lambda law: (Product(law.value),),
    th.Streamed: lambda law: (Product(law.value),),
    th.InputPower: lambda law: (Product(law.value, tuple(Powered(*t) for t in law.terms)),),
    th.PowerLoss: lambda law: tuple(Product(watts, tuple(Powered(*t) for t in powers)) for watts, powers in law.terms),
    th.CopperLoss: lambda law: tuple(
        Product(law.factor_ * law.resistance, (Powered(name, 1.0, 2.0),)) for name in law.currents
    ),
    th.EddyLoss: _eddy,
    th.LayerLoss: lambda law: expanded(law.copper),
    th.IronLoss: _iron,
    th.BrushLoss: _brush,
    th.MapLoss: _map,
    th.MeasuredLoss: lambda law: tuple(
        Product(scale, tuple(Straight(n, 0.0, 1.0) for n in names)) for scale, names in law.powers
    ),
    th.Stirred: _stirred,
    th.Scaled: lambda law: _each(law.base, lambda p: replace(p, coefficient=law.by * p.coefficient)),
    th.OneWay: lambda law: expanded(law.base),
    th.WithTemperature: lambda law: expanded(law.base),
    th.Direction: lambda law: _each(law.base, lambda p: p.times(Positive(law.column, float(law.way)))),
    th.Switched: _switched,
}
for kind, form in EXACT.items():
    expanded.register(kind, form)
