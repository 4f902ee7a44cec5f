"""A guess at what the nodes of a network are, from topology and losses alone; what is declared stands."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from geom.description.roles import Identity, Role
from lumped.model.quantities import LIQUID
from lumped.model.rotation import turning
from lumped.model.topology import Topology, conductance, fixed

if TYPE_CHECKING:
    from lumped.model.structure import Structure

Evidence = tuple[Role, str]
MUCH = 3.0  # a boundary that takes more than this times what the surroundings take is a coolant


def identities(network: "Structure") -> Mapping[str, Identity]:
    """Name of a part, node, fluid or boundary -> what it is, with the evidence where it is a guess."""
    top = Topology(network)
    names = (*top.bodies, *top.fluids, *network.boundaries)
    if all((identity := network.declared.get(n)) is not None and identity.role is not None for n in names):
        return {**network.declared}
    statements = top.network.declared
    turns = turning(top, {n: bool(i.turns) for n, i in statements.items() if i.turns is not None and n in top.bodies})
    roles = {n: i.role for n, i in statements.items() if i.role is not None}
    guesses = _boundaries(top, roles)
    guesses |= _fluids(top, {**roles, **{b: role for b, (role, _) in guesses.items()}})
    guesses |= _bodies(top, {b: t for b, (t, _) in turns.items()}, roles)
    others = {n: i for n, i in statements.items() if n not in names}
    return {n: _one(n, statements.get(n), guesses.get(n), turns.get(n)) for n in names} | others


def _one(name: str, statement: Identity | None, guess: Evidence | None, turns: tuple[bool, str] | None) -> Identity:
    if statement is not None and statement.role is not None:
        return statement
    whys = [why for why in (guess and guess[1], turns and turns[1]) if why and why != "declared"]
    role = guess[0] if guess else None
    return Identity(role, turns[0] if turns else None, ", ".join(dict.fromkeys(whys)) or "nothing tells")


def _boundaries(top: Topology, statements: Mapping[str, Role]) -> dict[str, Evidence]:
    """The surroundings are what free convection and most faces meet; an inlet or a strong sink is a coolant."""
    free = [b for b in top.network.boundaries if b not in statements]
    out: dict[str, Evidence] = {}
    if Role.AMBIENT not in statements.values() and free:
        air = _ambient(top, free)
        if air is not None:
            out[air[0]] = (Role.AMBIENT, air[1])
    assigned = [b for b in top.network.boundaries if statements.get(b) == Role.AMBIENT or b in out]
    usual = max((_sink(top, b) for b in assigned), default=0.0)
    inlets = {x.places[0] for x in top.links if x.kind == "stream"}
    for boundary in free:
        if boundary in out:
            continue
        if boundary in inlets:
            out[boundary] = (Role.COOLANT, "a stream comes from there")
        elif not top.outer(boundary):
            out[boundary] = (Role.TEST_BED, "read in the tests and joined to nothing")
        elif any(link.kind == "film" for _, link in top.outer(boundary)):
            out[boundary] = (Role.COOLANT, "a film leads there")
        elif _sink(top, boundary) > MUCH * usual:
            out[boundary] = (Role.COOLANT, "takes more heat than the surroundings")
        else:
            out[boundary] = (Role.TEST_BED, "a fixed joint alone leads there")
    return out


def _sink(top: Topology, boundary: str) -> float:
    """W/K that lead there whatever the machine does."""
    return sum(conductance(top.network, link) for _, link in top.outer(boundary))


def _ambient(top: Topology, free: list[str]) -> tuple[str, str] | None:
    """By films of free convection first, then by faces met, then by how little the strongest joint there conducts."""
    natural = {b: sum(not fixed(x) and not x.law.reads for _, x in top.outer(b)) for b in free}
    faces = {b: sum(p.fluid == b for p in top.network.places.values()) for b in free}
    bodies = {b: len({name for name, _ in top.outer(b)}) for b in free}
    score = {b: (natural[b], faces[b], bodies[b], -_sink(top, b)) for b in free if natural[b] or faces[b] or bodies[b]}
    if not score:
        return (free[0], "the only boundary") if len(top.network.boundaries) == 1 else None
    best = max(score, key=lambda b: score[b])
    why = (
        f"{natural[best]} films of still air lead there"
        if natural[best]
        else f"{max(faces[best], bodies[best])} bodies meet it"
        if max(faces[best], bodies[best]) > 1 or len(score) == 1
        else "the weaker sink"
    )
    return best, why


def _fluids(top: Topology, roles: Mapping[str, Role]) -> dict[str, Evidence]:
    """A fluid is inner air unless a stream brings it from a coolant or at a rate of liquid."""
    out: dict[str, Evidence] = {}
    streams = [x for x in top.links if x.kind == "stream"]
    wet = {b for b, role in roles.items() if role is Role.COOLANT}
    wet |= {top.part(x.places[1]) for x in streams for name in x.law.reads if top.network.measures(name) == LIQUID}
    for _ in streams:
        wet |= {top.part(x.places[1]) for x in streams if x.places[0] in wet}
    for fluid in (f for f in top.fluids if f not in roles):
        out[fluid] = (Role.COOLANT, "a stream of coolant") if fluid in wet else (Role.INNER_AIR, "a fluid")
    return out


def _bodies(top: Topology, turns: Mapping[str, bool], statements: Mapping[str, Role]) -> dict[str, Evidence]:
    by_heat = {b: role for b in top.bodies if b not in statements and (role := _by_heat(top, b, turns)) is not None}
    for _ in range(2):  # the housing first, then what hangs on it
        roles = {**statements, **{b: role for b, (role, _) in by_heat.items()}}
        remaining = {b: _by_place(top, b, turns.get(b), roles) for b in top.bodies if b not in roles}
        by_heat |= {b: role for b, role in remaining.items() if role is not None}
    return by_heat


def _by_heat(top: Topology, body: str, turns: Mapping[str, bool]) -> Evidence | None:
    """Losses tell most: copper a winding, iron a core, friction a bearing."""
    kinds, turning_ = top.heat.get(body, frozenset()), turns.get(body)
    if "brush" in kinds:
        return Role.COMMUTATOR, "carries the heat of brushes"
    if "magnet" in kinds:
        return Role.MAGNET, "carries a loss of magnets"
    if kinds & {"copper", "ripple"}:
        if turning_ and _has_separate_current(top, body, turns):
            return Role.CAGE, "copper loss of its own current, and turns"
        return Role.WINDING, "carries a copper loss"
    if body in top.bearings:
        outside = [b for b in top.network.boundaries if b in top.neighbours.get(body, frozenset())]
        if outside:
            return Role.END_SHIELD, "carries friction and meets the outside"
        return Role.BEARING, "carries friction"
    if kinds & {"iron", "map", "stray", "measured"}:
        if turning_:
            return Role.ROTOR, "carries a loss of the field and turns"
        return Role.IRON, "carries a loss of the field"
    return None


def _has_separate_current(top: Topology, body: str, turns: Mapping[str, bool]) -> bool:
    """Does its copper loss follow none of the inputs that a standing one follows, while there is a standing one?"""
    still = [b for b in top.bodies if b != body and not turns.get(b)]
    others = [top.reads[b, "copper"] for b in still if (b, "copper") in top.reads]
    mine = top.reads.get((body, "copper"), frozenset())
    return bool(others) and not any(mine & other for other in others)


def _by_place(top: Topology, body: str, turns: bool | None, roles: Mapping[str, Role]) -> Evidence | None:
    """What carries no loss: by what it is joined to."""
    near = top.neighbours.get(body, frozenset())
    beside = {roles[b] for b in near if b in roles}
    outside = any(b in near for b in top.network.boundaries)
    if turns:
        return (Role.SHAFT, "turns beside a bearing") if Role.BEARING in beside else (Role.ROTOR, "turns")
    if turns is None:
        return None
    if outside and Role.BEARING in beside:
        return Role.END_SHIELD, "beside a bearing, and meets the outside"
    if outside and beside & {Role.IRON, Role.WINDING}:
        return Role.HOUSING, "around the iron, and meets the outside"
    if outside and beside & {Role.HOUSING, Role.END_SHIELD}:
        return Role.FOOT, "joined to the shell, and meets the outside"
    return None
