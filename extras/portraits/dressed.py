"""From a machine to bodies that look like it: every meshed part, and what the mesh leaves out."""

from collections.abc import Callable

import numpy as np

from extras.portraits.ends import bearing, shaft, shield
from extras.portraits.making import extruded, revolved, rounded
from extras.portraits.outlines import Outlines
from extras.portraits.rotating import TURN, commutator, cowl, shaft_fan, wheel
from extras.portraits.shape import Body, Finish, joined
from extras.portraits.shell import fittings, housing, standing
from extras.portraits.windings import wound
from thermoscope import plugin as th

FINISH = {
    th.Role.IRON: Finish.LAMINATIONS,
    th.Role.ROTOR: Finish.ROTOR,
    th.Role.CAGE: Finish.CAST,
    th.Role.MAGNET: Finish.MAGNET,
    th.Role.INSULATION: Finish.INSULATION,
    th.Role.WINDING: Finish.COPPER,
    th.Role.COMMUTATOR: Finish.BRASS,
    th.Role.FAN: Finish.RUBBER,
    th.Role.BEARING: Finish.STEEL,
    th.Role.SHAFT: Finish.STEEL,
    th.Role.BASE: Finish.PLATE,
    th.Role.BRUSH: Finish.CARBON,
}
EDGE = 0.0006  # m; edges of plain parts are rounded by this


def dressed(machine: th.MachineDescription) -> list[Body]:
    """Bodies of all parts of a machine, then what is added for the picture."""
    o = Outlines(machine)
    out = [body for part in machine.parts for body in _MAKERS.get(o.role(part), _plain)(o, part)]  # type: ignore[arg-type]
    return [*out, *shaft_fan(o), *fittings(o)]


def _plain(o: Outlines, part: th.Part) -> list[Body]:
    """As it is described, its edges a little rounded."""
    role = o.role(part)
    finish = FINISH.get(role, Finish.CAST) if role else Finish.CAST
    sections = o.section(part)
    if sections:
        return [Body(part.name, finish, joined([revolved(rounded(s, 0.001)) for s in sections]))]
    plain = joined([extruded(o.of(p), *p[1:], EDGE) for p in part.prisms])
    # The insulation of a commutator is as long as its bars, and lies between them
    between = any(np.allclose(part.span, p.span) for p in o.parts(th.Role.COMMUTATOR)) and len(part.prisms) > 4
    return [Body(part.name, finish, plain.turned(TURN) if between else plain)]


def _housing(o: Outlines, part: th.Part) -> list[Body]:
    """A cowl stands before or behind the shields; all else is housing."""
    shields = [p.span for p in o.parts(th.Role.END_SHIELD)]
    outside = bool(shields) and (
        part.span[1] <= min(a for a, _ in shields) + 1e-6 or part.span[0] >= max(b for _, b in shields) - 1e-6
    )
    return cowl(o, part) if outside and o.section(part) else housing(o, part)


def _or_plain(maker: Callable[[Outlines, th.Part], list[Body]]) -> Callable[[Outlines, th.Part], list[Body]]:
    """Shields and bearings that are not round (of an imported assembly) stay as they are."""
    return lambda o, part: maker(o, part) if o.section(part) else _plain(o, part)


_MAKERS: dict[th.Role, Callable[[Outlines, th.Part], list[Body]]] = {
    th.Role.WINDING: wound,
    th.Role.END_SHIELD: _or_plain(shield),
    th.Role.BEARING: _or_plain(bearing),
    th.Role.SHAFT: shaft,
    th.Role.HOUSING: _housing,
    th.Role.FOOT: standing,
    th.Role.BASE: standing,
    th.Role.FAN: wheel,
    th.Role.COMMUTATOR: commutator,
}
