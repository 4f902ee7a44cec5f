"""What a part, a node, a fluid or a boundary is, and how that is known."""

from __future__ import annotations

from dataclasses import dataclass

from geom.description.roles import Role

DECLARED = "declared"


@dataclass(frozen=True)
class Identity:
    """role, turns : None where nobody says and nothing tells
    why : "declared", or the evidence of a guess in words
    """

    role: Role | None = None
    turns: bool | None = None
    why: str = DECLARED

    @property
    def declared(self) -> bool:
        return self.why == DECLARED


def identity(role: Role | None, turns: bool | None = None) -> Identity:
    """As declared: what turns follows from the role unless it is said."""
    return Identity(role, role.turns if turns is None and role is not None else turns)
