"""What to change where values that are each allowed do not fit together.

Any ratios within their bounds fit. So where a machine cannot be, some length is out of proportion; brought back within
its bounds, one after another, they end in a machine.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from geom.description.geometry import Geometry
from geom.description.parameters import UNITS, Parameter
from geom.description.reading import read_geometry
from geom.errors import InputError
from geom.families.family import Family

_INSIDE = 0.02  # of the way between the bounds of a ratio: as far inside a length is brought
Table = Mapping[str, Any]


def remedy(family: Family, table: Table, refusal: InputError) -> str:
    """The length to change and a value that fits, as a machine file has them; "" if nothing is out of proportion.

    table : [geometry] of the file, which `family.build` refused.  Where no single length is enough, the one to begin
    with: one that lifts this refusal if there is one.
    """
    trials = list(_trials(family, table))
    trials.sort(key=lambda trial: f"[geometry.{trial[0].group}] {trial[0].name}" != refusal.where)
    answers = [(p, key, value, _refusal(family, _changed(table, p, key, value))) for p, key, value in trials]
    for word, holds in (
        ("fits", lambda e: e is None),
        ("is a beginning", lambda e: e.where != refusal.where),
        ("is a beginning", lambda e: True),
    ):
        for p, key, value, answer in answers:
            if holds(answer):
                return f"[geometry.{p.group}] {key} = {value} {word}"
    return ""


def _trials(family: Family, table: Table) -> Iterator[tuple[Parameter, str, str]]:
    """Lengths out of proportion, each with a key and a value within its bounds: a ratio where mm leave their range."""
    values = read_geometry(family.parameters, table, "")
    for p in family.parameters:
        ratio = None if p.of is None else _ratio(p, values)
        if p.of is None or ratio is None or p.of.low <= ratio <= p.of.high:
            continue
        margin = _INSIDE * (p.of.high - p.of.low)
        inside = min(max(ratio, p.of.low + margin), p.of.high - margin)
        length = (p.of.start(values) + inside * p.of.span(values)) / UNITS[p.unit]
        yield (p, p.name, f"{length:.6g}") if p.low <= length <= p.high else (p, p.ratio_name, f"{inside:.6g}")


def _ratio(p: Parameter, values: Geometry) -> float | None:
    """None for what is absent, or measured in what is not there."""
    assert p.of is not None
    value, span = getattr(getattr(values, p.group), p.attribute), p.of.span(values)
    return (value - p.of.start(values)) / span if span > 0.0 and not (p.off and value == 0) else None


def _changed(table: Table, p: Parameter, key: str, value: str) -> dict[str, Any]:
    group = {name: entry for name, entry in table.get(p.group, {}).items() if name not in (p.name, p.ratio_name)}
    return {**table, p.group: {**group, key: float(value)}}


def _refusal(family: Family, table: Table) -> InputError | None:
    try:
        family.build(read_geometry(family.parameters, table, ""))
    except InputError as refusal:
        return refusal
    return None
