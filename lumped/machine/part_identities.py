"""What the parts, fluids and boundaries of a motor are: as declared, else by what they are made of."""

from collections.abc import Iterable
from dataclasses import replace

from geom.description.machine import Machine
from geom.description.part import Part
from geom.description.profile import ArcGrid
from geom.description.roles import Identity, Role, identity
from lumped.machine.path import stem
from lumped.machine.shapes import wound
from lumped.model.network import Network

# The names that lumped.machine.motor gives them.
BOUNDARIES = {"ambient": Role.AMBIENT, "coolant": Role.COOLANT, "oil": Role.COOLANT}
OF_MATERIAL = {
    "bearing": Role.BEARING,
    "commutator": Role.COMMUTATOR,
    "electrical-steel": Role.IRON,
    "magnet-ndfeb": Role.MAGNET,
    "mica": Role.INSULATION,
    "insulation": Role.INSULATION,
    "slot-liner": Role.INSULATION,
}


def declared(machine: Machine, network: Network, contacts: Iterable[str]) -> dict[str, Identity]:
    """By name.  contacts : "a|b", which tell what hangs on the shaft"""
    spaces = {part.name: part.role for part in machine.fluids if part.role is not None}
    fluids = {state: identity(spaces[stem(state)], False) for state in network.states if stem(state) in spaces}
    around = {name: identity(BOUNDARIES[name], False) for name in network.boundaries}
    return {**part_identities(machine, contacts), **fluids, **around}


def part_identities(machine: Machine, contacts: Iterable[str]) -> dict[str, Identity]:
    """Part -> what it is; imported parts by their material, the shaft by the axis inside it, if nothing is said."""
    identity_of = {part.name: part.identity or _by_material(machine, part) for part in machine.parts}
    # All that hangs on what turns through contacts, without a bearing or a standing part between
    pairs = [tuple(name.split("|")) for name in contacts]
    joints = [pair for pair in pairs if all(p in identity_of and identity_of[p].turns is not False for p in pair)]
    turning_parts, count = {name for name, i in identity_of.items() if i.turns}, -1
    while len(turning_parts) > count:
        count = len(turning_parts)
        turning_parts |= {part for pair in joints if turning_parts & set(pair) for part in pair}
    return {
        name: _turned(one, name in turning_parts) if one.turns is None else one for name, one in identity_of.items()
    }


def _turned(identity: Identity, turns: bool) -> Identity:
    role = Role.ROTOR if identity.role is Role.IRON and turns else identity.role
    why = f"{identity.why}, {'hangs on the shaft' if turns else 'stands'}"
    return replace(identity, role=role, turns=turns, why=why)


def _by_material(machine: Machine, part: Part) -> Identity:
    role = OF_MATERIAL.get(part.material)
    if role is not None:
        stands = None if role in (Role.IRON, Role.INSULATION) else role.turns
        return Identity(role, stands, f"made of {part.material}")
    if wound(machine, part.name):
        return Identity(Role.WINDING, None, "made of wires along the axis")
    import shapely

    grid = ArcGrid([profile for profile, _, _ in part.prisms], 24)
    if all(profile.to_polygon(grid).contains(shapely.Point(0.0, 0.0)) for profile, _, _ in part.prisms):
        return Identity(Role.SHAFT, True, "the axis runs through it")
    return Identity(None, None, "nothing tells")


def turning(machine: Machine, contacts: Iterable[str]) -> frozenset[str]:
    """Parts that turn."""
    return frozenset(name for name, i in part_identities(machine, contacts).items() if i.turns)
