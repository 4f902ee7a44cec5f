"""What a textbook would suspect at every node: laws that act on a body's mean and spread evenly over it.

They tell which explanations of a hidden effect come so near that no one could be sure. Names are the catalogue's.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hidden.truth.archetype import Archetype
from hidden.truth.body import Array, Cells, Skeleton
from hidden.truth.change import Change
from hidden.truth.machine import Inputs

Law = Callable[[float, Inputs], float]


@dataclass(frozen=True)
class Lumped:
    """law (mean temperature, inputs) -> W, evenly over a body's cells and, with the other sign, over another's."""

    cells: Cells
    other: Cells | None
    law: Callable[[float, float, Inputs], float]

    def into(self, q: Array, T: Array, u: Inputs) -> None:
        away = T[self.other].mean() if self.other is not None else u["T_ambient"]
        watts = self.law(float(T[self.cells].mean()), float(away), u)
        q[self.cells] += watts / self.cells.size
        if self.other is not None:
            q[self.other] -= watts / self.other.size


def speed(u: Inputs) -> float:
    return abs(u.get("speed_rpm", 0.0)) / 1000.0


def amps(u: Inputs) -> float:
    return abs(u.get("current_A", 0.0)) / 100.0


# law of a power (W), and the kinds of effect that follow it
HEAT: Mapping[tuple[str, ...], Law] = {
    ("loss.constant",): lambda T, u: 1.0,
    ("brush.friction",): lambda T, u: speed(u),
    ("bearing.friction",): lambda T, u: speed(u) ** (5 / 3),
    ("iron",): lambda T, u: speed(u) ** 1.5,
    ("loss.rotor",): lambda T, u: speed(u) ** 2,
    ("windage",): lambda T, u: speed(u) ** 3,
    ("brush.drop",): lambda T, u: amps(u),
    ("loss.winding",): lambda T, u: amps(u) ** 2,
    ("copper.ac", "loss.rotor.load"): lambda T, u: (amps(u) * speed(u)) ** 2,
    ("copper.feedback",): lambda T, u: amps(u) ** 2 * (T - 20.0),
    ("iron.pwm",): lambda T, u: u.get("switching_Hz", 0.0) / 8000.0,
}
# conductance (W/K) to the room, at temperatures of body and room
FILMS: Mapping[tuple[str, ...], Callable[[float, float, Inputs], float]] = {
    ("convection.constant", "conduction.shaft", "conduction.cable"): lambda T, Ta, u: 1.0,
    ("convection.buoyant",): lambda T, Ta, u: (abs(T - Ta) / 40.0) ** 0.25,
    ("radiation",): lambda T, Ta, u: 5.67e-8 * ((T + 273.15) ** 2 + (Ta + 273.15) ** 2) * (T + Ta + 546.3),
    ("convection",): lambda T, Ta, u: (abs(u.get("vehicle_speed_mps", 0.0)) / 10.0) ** 0.8,
    ("convection.rotation", "convection.fan"): lambda T, Ta, u: speed(u) ** 0.7,
}


def hypotheses(kind: Archetype) -> dict[tuple[str, ...], Change]:
    """Names of an explanation (all that follow its law) -> what it does at one unit."""
    out: dict[tuple[str, ...], Change] = {}
    for node, body in kind.parts.items():
        for kinds, law in HEAT.items():
            out[_at(kinds, node)] = _lumped(body, None, lambda T, away, u, law=law: law(T, u))
        for kinds, g in FILMS.items():
            out[_at(kinds, node)] = _lumped(body, None, lambda T, Ta, u, g=g: -g(T, Ta, u) * (T - Ta))
        for bath, spot in kind.baths.items():
            name = f"conduction.bench@{node}"
            out[(name,)] = _lumped(body, spot.body, lambda T, away, u: away - T) if bath == "bench" else Change()
    return out


def bridges(kind: Archetype) -> dict[tuple[str, ...], Change]:
    """A conductance of 1 W/K between any two parts; across a gap it grows with the root of speed as well."""
    nodes, out = list(kind.parts.items()), {}
    for i, (a, one) in enumerate(nodes):
        for b, other in nodes[i + 1 :]:
            pair = "|".join(sorted((a, b)))
            out[(f"coupling@{a}|{b}", f"coupling@{b}|{a}")] = _lumped(one, other, lambda T, away, u: away - T)
            out[(f"gap.convection@{pair}",)] = _lumped(one, other, lambda T, away, u: speed(u) ** 0.5 * (away - T))
    return out


def _at(kinds: tuple[str, ...], node: str) -> tuple[str, ...]:
    return tuple(f"{kind}@{node}" for kind in kinds)


def _lumped(body: str, other: str | None, law: Callable[[float, float, Inputs], float]) -> Change:
    def terms(s: Skeleton) -> tuple[Lumped, ...]:
        return (Lumped(s.cells(body), s.cells(other) if other else None, law),)

    return Change(terms=terms)
