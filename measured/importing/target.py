"""What a model offers to a recording: places for sensors, boundaries and inputs, and which of them a column means."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from geom.description.roles import Role
from lumped.model.network import Network
from measured.headers.words import INLET, is_spoken, roles_of, tokens
from measured.recordings.units import QUANTITIES

WORD, ROLE, DIGIT, EXTRA = 2.0, 1.5, 1.0, 0.1  # worth of a shared word, of a role, of a number; of a word too many
LEAST = 0.8  # likeness of two names below which none is guessed; chosen
FLUID = frozenset({"air", "gap", "stream"})
UNITS = {q.feeds.rpartition("_")[2]: name for name, q in reversed(QUANTITIES.items()) if q.feeds}  # A -> current
SIDES = (
    {"left", "right"},
    {"links", "rechts"},
    {"de", "nde"},
    {"front", "rear"},
    {"inlet", "outlet"},
    {"upper", "lower"},
)


@dataclass(frozen=True)
class Target:
    """places : where a sensor may sit -> what it is;  boundaries, inputs alike (inputs -> what they measure)

    places_by_header : header without its unit -> its place, of a network that was made from the headers
    inputs_by_column : column -> what it feeds, of such a network
    """

    places: Mapping[str, Role | None] = field(default_factory=dict)
    boundaries: Mapping[str, Role | None] = field(default_factory=dict)
    inputs: Mapping[str, str] = field(default_factory=dict)
    places_by_header: Mapping[str, str] = field(default_factory=dict)
    inputs_by_column: Mapping[str, str] = field(default_factory=dict)

    def place_of(self, label: str) -> tuple[str, str]:
        """The place or boundary a name means and what it could be as well, "" where nothing fits."""
        if label in self.places_by_header:
            return self.places_by_header[label], ""
        return _best({n: _likeness(label, n, role) for n, role in {**self.places, **self.boundaries}.items()})

    def input_of(self, label: str, quantity: str) -> str:
        """The input a name means: by its words, or because it is the only one of its quantity."""
        alike = {n: q for n, q in self.inputs.items() if not quantity or q in (quantity, "")}
        best, _ = _best(
            {
                n: _likeness(label, n, None)
                for n in alike
                if quantity or any(len(w) > 1 for w in _words(label) & _words(n))
            }
        )
        same = [n for n, q in alike.items() if q == quantity and quantity]
        return best or (same[0] if len(same) == 1 else "")


def target_of(network: Network) -> Target:
    """Places, boundaries and inputs of a network; of the places those that a user would name."""
    identities = network.identities
    roles = {name: identity.role for name, identity in identities.items()}
    places = {n: roles.get(n, roles.get(p.part)) for n, p in network.places.items() if n not in network.boundaries}
    inputs = {n: network.measures(n) or measure_of(n) for n in sorted(network.inputs)}
    inputs.pop("time_s", None)
    return Target(places, {b: roles.get(b) for b in network.boundaries}, inputs)


def measure_of(name: str) -> str:
    """The quantity that the unit at the end of an input's name says, "" where it says none."""
    return UNITS.get(name.rpartition("_")[2], "") if "_" in name else ""


def _best(scores: Mapping[str, float]) -> tuple[str, str]:
    good = sorted(((score, name) for name, score in scores.items() if score >= LEAST), reverse=True)
    if not good:
        return "", ""
    second = good[1][1] if len(good) > 1 and good[1][0] > good[0][0] - EXTRA else ""
    return good[0][1], second


def _likeness(label: str, name: str, role: Role | None) -> float:
    """Words and numbers that a header and a name share, and whether the header's words mean the name's role."""
    a, b = set(tokens(label)), set(tokens(name))
    if any(len(side & a) == 1 and len(side & b) == 1 and side & a != side & b for side in SIDES):
        return 0.0
    if _digits(a) and _digits(b) and not _digits(a) & _digits(b):
        return 0.0
    words, numbers = _words(label) & _words(name), _digits(a) & _digits(b)
    score = WORD * len(words) + DIGIT * len(numbers)
    if role is not None and role in roles_of(label)[:2]:
        score += ROLE + (DIGIT / 2 if role is Role.COOLANT and is_spoken(label, INLET) else 0.0)
    wrong = sum(w in FLUID for w in b - a)  # a sensor on the housing is not in the air of the housing
    return score - EXTRA * len(b - a) - WORD * wrong


def _digits(words: Iterable[str]) -> set[str]:
    return {w for w in words if w.isdigit()}


def _words(name: str) -> set[str]:
    return {w for w in tokens(name) if not w.isdigit()}
