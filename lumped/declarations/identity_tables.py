"""What network.toml says of its nodes, boundaries and inputs: roles, what turns, what is measured."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from geom.description.roles import Identity, Role, identity
from lumped.model.quantities import INPUTS
from lumped.schemas.reader import Table, suggestion


def read_identities(
    top: Table, nodes: Mapping[str, Table], boundaries: Iterable[str], cells: Iterable[str]
) -> dict[str, Identity]:
    """`role` and `turns` of nodes, and of boundaries in [boundaries.NAME]; the cells of circuits carry coolant."""
    around = top.tables("boundaries")
    for name, table in around.items():
        if name not in boundaries:
            raise table.error(f"'{name}' is no boundary", suggestion(name, boundaries))
    out = {
        name: statement
        for name, table in {**nodes, **around}.items()
        if (statement := _declared_identity(table)) is not None
    }
    for table in around.values():
        table.close()
    return {**out, **{cell: identity(Role.COOLANT, False) for cell in cells}}


def _declared_identity(table: Table) -> Identity | None:
    role = Role(table.word("role", None, list(Role))) if "role" in table else None
    turns = table.flag("turns") if "turns" in table else None
    return None if role is None and turns is None else identity(role, turns)


def read_quantities(top: Table) -> dict[str, str]:
    """[inputs.NAME] quantity = "speed": what an input measures."""
    out = {}
    for name, table in top.tables("inputs").items():
        out[name] = table.word("quantity", None, INPUTS)
        table.close()
    return out
