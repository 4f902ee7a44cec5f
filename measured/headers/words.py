"""What headers of other people's files usually mean, by the words of vocabulary.toml: a guess, always shown."""

import re
import tomllib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path

from geom.description.roles import GERMAN, ROLE_WORDS, SHORTEST, Role, words_of

WORD = re.compile(r"[A-ZÀ-ÖØ-Þ]?[a-zß-öø-ſ]+|[A-ZÀ-ÖØ-Þ]+(?![a-zß-öø-ÿ])|\d+|(?:[^\W\d_A-Za-zªµºÀ-ſ]|[\u0e30-\u0e4e])+")

NAMES = 4096  # of a wide file, each of which is asked for beside every other
IDEOGRAPHS = "\u0e00"  # from here on a sign is a word, or words stand without blanks between them

VOCABULARY = tomllib.loads(Path(__file__).with_name("vocabulary.toml").read_text("utf-8"))
QUANTITY: Mapping[str, frozenset[str]] = {name: words_of(text) for name, text in VOCABULARY["quantities"].items()}
ROLES = ROLE_WORDS
WORDS = {name: words_of(text) for name, text in VOCABULARY["words"].items()}
SETPOINT, READ, MODELLED, INLET = (WORDS[n] for n in ("setpoint", "read", "modelled", "inlet"))
NOTHING, RATIO = WORDS["nothing"], WORDS["ratio"]
DIFFERENCE, CLOCKS, LOSS, OUTER, CHANNELS = (WORDS[n] for n in ("difference", "clock", "loss", "outer", "channels"))
EXTREME, SPREAD, MEAN, INSTRUMENT, MACHINE = (WORDS[n] for n in ("extreme", "spread", "mean", "instrument", "machine"))
SPARE, RUNS, SUPPLY, GOES_IN, COMES_OUT = (WORDS[n] for n in ("spare", "runs", "supply", "goes_in", "comes_out"))
BATTERY = WORDS["battery"]
CONVERTED = (frozenset({"dc", "pdc"}), frozenset({"ac", "pac"}))  # of a power, on both sides of a converter
SUPPLY |= BATTERY
STATISTICS = EXTREME | MEAN | SPREAD
STAGE, PUMP, EXHAUST, CABINET, COLD = (WORDS[n] for n in ("stage", "pump", "exhaust", "cabinet", "cold"))
SPOT, LOGGER, OIL, ROOMS = (WORDS[n] for n in ("spot", "logger", "oil", "rooms"))
INSTRUMENT |= CABINET | LOGGER
PHRASES = {
    re.compile(rf"(?:(?<![^\W\d_])|(?<=[a-z])(?=[A-Z]))(?i:{phrase.replace(' ', '[ _-]?')})(?![a-zß-ÿ])"): word
    for word, phrases in VOCABULARY["phrases"].items()
    for plain_phrase in phrases.split(",")
    for phrase in {plain_phrase, plain_phrase.translate(GERMAN)}
}
WOUND = frozenset({*"uvw", "rtd", "pt", "ntc", "ptc", "kty"})  # phases, and what is put between the wires of one
PATH = re.compile(r"[/\\.:|]")  # between the names of groups: Model Root/i_phase, Motor.T_winding
CHANNEL = re.compile(r"^(?:[A-Z]+\d+-\d+|CH ?\d+)[: ]+")  # of a logger, before what it reads
HEAT = re.compile("(.+?)(?:(?<=ng)s)?(temp|temperatu.+)|(temp)(.+)")  # motortemp, Lufttemperatur, Wicklungstemp
LAST = ("time", "timestamp", "zeit")  # of a path, which is a clock whatever it leads through
LETTERED = re.compile(
    r"(?<![A-Za-z])[a-z]?([TP])(?!im|yp|ag|ab|es|ot|or|q|rq|as|ic|re|os|ha|he|er|ar|wm|id)[a-z]{1,2}(?![A-Za-z])"
)
SHORT = re.compile(r"[A-Z][a-z]{1,3}(T)")  # MotT, as flight controllers write it
OUTSIDE = re.compile(r"(?<![A-Za-z])[a-z]?T(?:_?a|e|o|ext|out|am)(?![A-Za-z])")  # as building physics writes the air
END_OF_SHAFT = re.compile(r"(?<![A-Za-z])(?:N?DE|[AB]S)(?![A-Za-z])")  # drive and non-drive end, or A-Seite and B-Seite
DESIRED = re.compile(r"(?<=[^\W\d])(?:[_ ][Dd]es|Des)(?=\s*(?:$|[\\(\[]))")  # last: in French it is an article
AXIS = re.compile(r"(?<![a-z])i[_ .]?s?[_ .]?(alpha|beta|d|q)(?![a-z])|(?:current|strom)[_ .]?(d|q)(?![a-z])")


@lru_cache(NAMES)
def tokens(name: str) -> tuple[str, ...]:
    """Words and numbers of a name in lower case: "T_yokeLeft2" -> t, yoke, left, 2; "Twdg" -> t, wdg."""
    out: list[str] = []
    for phrase, meaning in PHRASES.items():
        name = phrase.sub(f" {meaning} ", name)
    for word in WORD.findall(name):
        low = word.lower()
        plural = len(low) > SHORTEST and low.endswith("s") and not low.endswith("ss")
        if plural and (low not in TERMS or low[:-1] in TERMS):
            low = low[:-1]  # the singular
        joint = len(low) > 2 and low[0] == "t" and low not in PARTS and low[1:] in PARTS
        pair = [p for p in match.groups() if p] if (match := HEAT.fullmatch(low)) and low not in TERMS else [low]
        out += ["t", low[1:]] if joint else pair if TERMS.issuperset(pair) else [low]
    return tuple(out)


PARTS = SPOT.union(*ROLES.values())
TERMS = PARTS.union(*QUANTITY.values(), *WORDS.values())


def axis_of(name: str) -> str:
    """ "id" of i_d, Id, IdFbk, i_sd and the like; "iq", "ialpha", "ibeta"; "" for what is not part of a current."""
    pointed = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    return f"i{match[1] or match[2]}" if (match := AXIS.search(pointed)) else ""


@lru_cache(NAMES)
def quantities_of(name: str) -> list[str]:
    """Quantities whose words stand in a name; single letters count only in front, and a small p is a pressure."""
    name = CHANNEL.sub("", name)
    paths = [tokens(part) for part in PATH.split(name)]
    words = [word for path in paths for word in path]
    spoken = {
        w for path in paths for i, w in enumerate(path) if len(w) > 1 or (i == 0 and path in (paths[0], paths[-1]))
    }
    spoken = {w for w in spoken if len(w) > 1 and any(w in terms for terms in QUANTITY.values())} or spoken
    quantities = [q for q, terms in QUANTITY.items() if spoken & terms]
    if quantities == ["power"] and not spoken & QUANTITY["power"] - {"p"} and name[0] == "p":
        return []
    long = {q: [k for k in terms if len(k) > SHORTEST or k[0] >= IDEOGRAPHS] for q, terms in QUANTITY.items()}
    inside = {q: max((len(k) for k in terms for w in words if k in w), default=0) for q, terms in long.items()}
    inside |= {
        q: SHORTEST
        for q, terms in QUANTITY.items()
        if not inside[q] and any(w[-SHORTEST:] in terms for w in words if len(w) > 1)
    }
    quantities = quantities or sorted((q for q in inside if inside[q]), key=lambda q: -inside[q])
    if quantities == ["water_flow"] and WORDS["air"] & {*words}:
        return ["air_flow"]
    letter = LETTERED.search(name) or SHORT.fullmatch(name)
    return quantities or (["temperature" if letter[1] == "T" else "power"] if letter else [])


@lru_cache(NAMES)
def roles_of(name: str) -> list[Role]:
    """Roles whose words stand in a name, whole words first, then in their order; long words also inside others.

    Of an outer winding the winding, and of the room of a test bed the room: words for outside and for a test bed come
    last.
    """
    parts = PATH.split(name)
    if parts[1:] and (last := roles_of(parts[-1])):  # base/ambient is the room
        return last + [role for role in roles_of(" ".join(parts[:-1])) if role not in last]
    words = tokens(name)
    hits = {}
    for role, terms in ROLES.items():
        at = [
            (w in OUTER or role is Role.TEST_BED, w not in terms, i, -_end(w, terms))
            for i, w in enumerate(words)
            if w in terms or _inside(w, terms)
        ]
        if at:
            hits[role] = min(at)
    if [*hits] == [Role.IRON] and OUTER & {*words} and WOUND & {*words}:  # Stator U1, Stator RTD 2
        return [Role.WINDING]
    if not hits and OUTSIDE.search(name):
        return [Role.AMBIENT]
    if not hits and END_OF_SHAFT.search(name):
        return [Role.BEARING]
    return sorted(hits, key=lambda role: hits[role])


def is_within(name: str, terms: frozenset[str]) -> bool:
    """Does one of some words stand in a name, a long one also inside others?"""
    return any(w in terms or _inside(w, terms) for w in tokens(name))


def is_stator(name: str) -> bool:
    """Does it name the stator, and neither its iron nor its winding?"""
    return roles_of(name)[:1] == [Role.IRON] and not is_spoken(name, ROLES[Role.IRON] - OUTER)


@lru_cache(NAMES)
def is_setpoint(name: str) -> bool:
    """Is it what was asked for, rather than read?  SP1 is the first spot of a camera."""
    return bool(DESIRED.search(name)) or is_spoken(re.sub(r"(?i)\b[s]p ?\d+", " ", name), SETPOINT)


def is_unknown(word: str) -> bool:
    """Is a word none of a vocabulary, a number, a letter, or an end of a shaft?"""
    return len(word) > 1 and not word.isdigit() and word not in TERMS and not END_OF_SHAFT.fullmatch(word.upper())


def is_stage(name: str) -> bool:
    """Does one of its words end on one for a stage, as compounds do?"""
    return any(_end(word, STAGE) == len(word) for word in tokens(name))


def is_rise(header: str) -> bool:
    """Is it a difference of temperatures, or a rate as der(T)?"""
    return (
        "Δ" in header
        or header.startswith("der(")
        or bool(DIFFERENCE & {*tokens(header), *re.findall("[a-z]+", header.lower())})
    )


def without_rise(name: str) -> str:
    """ "Winding" of "Winding rise ΔT": the words that say no difference."""
    return " ".join(word for word in re.split(r"[\s_]+", name) if not is_rise(word))


def is_spoken(name: str, terms: frozenset[str]) -> bool:
    """Does one of some words stand in a name?  Signs that are words may stand inside others."""
    signs = [term for term in terms if term[0] >= IDEOGRAPHS]
    return any(word in terms or any(sign in word for sign in signs) for word in tokens(name))


def _end(word: str, words: frozenset[str]) -> int:
    """Where the last of some words ends inside another: of a compound the last names it."""
    return max((word.rfind(k) + len(k) for k in words if len(k) >= SHORTEST and k in word), default=0)


def _inside(word: str, words: frozenset[str]) -> bool:
    inside = {k for k in words if (len(k) >= SHORTEST or k[0] >= IDEOGRAPHS) and k in word}
    return any(k[0] >= IDEOGRAPHS or word.find(k) != 1 or word[0] == "t" for k in inside)  # "boven" is not an oven


def is_time(label: str) -> bool:
    """Is it a name for time?  A small t is one, a large T a temperature; "temps" of a part are temperatures."""
    words = re.split(r"[\W\d_]+", label.lower().strip())
    if "temps" in words and (roles_of(label) or is_spoken(label, INSTRUMENT | SPOT)):
        return False
    starts = label.lower().startswith(("timestamp", "x_value", "zeit", "tick"))
    last = PATH.split(label)[-1].strip()
    inside = any(k in label for k in CLOCKS if k[0] >= IDEOGRAPHS)  # without blanks, as in Japanese
    return last == "t" or last.lower() in LAST or bool(CLOCKS & set(words[:2])) or starts or inside
