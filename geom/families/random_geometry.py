"""Random machines of a family: every parameter drawn within its documented bounds, all by themselves."""

from typing import Any

import numpy as np

from geom.description.parameters import Parameter
from geom.families.family import Family

NONE = 0.5  # of what may be absent


def random_geometry(family: Family, rng: np.random.Generator) -> dict[str, dict[str, Any]]:
    """A [geometry] table: sizes evenly in their logarithm, all else evenly."""
    table: dict[str, dict[str, Any]] = {}
    for parameter in family.parameters:
        name, value = _random_value(parameter, rng)
        table.setdefault(parameter.group, {})[name] = value
    return table


def _random_value(p: Parameter, rng: np.random.Generator) -> tuple[str, Any]:
    if p.choices:
        return p.name, str(rng.choice(p.choices))
    if p.off and rng.random() < NONE:
        return p.name, type(p.default)(0)
    if p.of is not None:
        return p.ratio_name, float(rng.uniform(p.of.low, p.of.high))
    if isinstance(p.default, int):
        return p.name, int(rng.integers(int(p.low), int(p.high), endpoint=True))
    if p.unit == "mm":
        return p.name, float(p.low * (p.high / p.low) ** rng.random())
    return p.name, float(rng.uniform(p.low, p.high))
