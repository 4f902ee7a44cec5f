"""What a part, a node, a fluid or a boundary is: its role, never read out of its name, and how that is known."""

import tomllib
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

DECLARED = "declared"
SHORTEST = 4  # letters of a word that may be looked for inside another
GERMAN = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
CROSSED = str.maketrans("łøđı", "lodi")  # which are no letter and an accent


class Role(StrEnum):
    """What something does in the machine.

    ROTOR is the turning iron or, in a coarse model, all that turns; IRON stands. AIR_GAP, INNER_AIR and COOLANT are
    fluids. AMBIENT, TEST_BED and DRIVEN_MACHINE are what the machine meets outside.
    """

    WINDING = "winding"
    IRON = "iron"
    ROTOR = "rotor"
    CAGE = "cage"
    MAGNET = "magnet"
    SHAFT = "shaft"
    BEARING = "bearing"
    COMMUTATOR = "commutator"
    BRUSH = "brush gear"
    INSULATION = "insulation"
    HOUSING = "housing"
    END_SHIELD = "end shield"
    FOOT = "foot"
    BASE = "base"
    FAN = "fan"
    AIR_GAP = "air gap"
    INNER_AIR = "inner air"
    COOLANT = "coolant"
    AMBIENT = "ambient"
    TEST_BED = "test bed"
    DRIVEN_MACHINE = "driven machine"

    @property
    def turns(self) -> bool:
        """Does such a part turn with the shaft, if nothing else is said?  A winding may do either; it stands."""
        return self in _TURNING


_TURNING = frozenset({Role.ROTOR, Role.CAGE, Role.MAGNET, Role.SHAFT, Role.COMMUTATOR, Role.FAN})


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


def words_of(text: str) -> frozenset[str]:
    """Words, and long ones as controllers and CAN tools have to write them: without accents, German ones with an e."""
    words = text.split()
    return frozenset(words) | {p for w in words if len(w) >= SHORTEST for p in (plain(w), w.translate(GERMAN))}


def plain(word: str) -> str:
    """Latin letters without what stands over, under or across them."""
    letters = word.translate(CROSSED)
    return "".join(unicodedata.normalize("NFD", c)[0] if "À" <= c <= "ſ" else c for c in letters)


_VOCABULARY = tomllib.loads(Path(__file__).with_name("role_words.toml").read_text("utf-8"))
ROLE_WORDS: Mapping[Role, frozenset[str]] = {Role[name]: words_of(text) for name, text in _VOCABULARY.items()}
