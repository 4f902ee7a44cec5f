"""The coolant of a circuit or a channel in network.toml: a name, or a glycol mixture with its share."""

from __future__ import annotations

from lumped.schemas.reader import Table
from lumped.transfer.coolant import NAMES, Coolant, coolant


def read_coolant(table: Table) -> Coolant:
    """T (degC) -> Fluid of the table's key `coolant`."""
    if isinstance(table.raw("coolant"), str):
        return coolant(table.word("coolant", None, NAMES))
    inner = Table(table.raw("coolant", {}), f"{table.where} coolant")
    name = inner.word("name", None, NAMES)
    shares = {key: inner.number(key) for key in ("mass_percent", "volume_percent") if key in inner}
    inner.close()
    return coolant(name, **shares)
