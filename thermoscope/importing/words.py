"""Words in headers of other people's files, English and German, and what they usually mean: a guess, always shown."""

from __future__ import annotations

import re
from collections.abc import Mapping

from geom.description.roles import Role

WORD = re.compile(r"[A-ZÄÖÜ]?[a-zäöüß]+|[A-ZÄÖÜ]+(?![a-zäöüß])|\d+")

QUANTITY: Mapping[str, frozenset[str]] = {
    "temperature": frozenset({"temperature", "temp", "temperatur", "tc", "thermocouple", "pt", "ntc", "theta", "t"}),
    "current": frozenset({"current", "strom", "i", "id", "iq", "irms", "amps", "iu", "iv", "iw"}),
    "speed": frozenset({"speed", "drehzahl", "rpm", "n", "omega"}),
    "vehicle_speed": frozenset({"vehicle", "wind", "fahrgeschwindigkeit", "road"}),
    "air_flow": frozenset({"airflow", "fan", "blower", "volumenstrom", "luftstrom"}),
    "water_flow": frozenset({"flow", "durchfluss", "flowrate"}),
    "torque": frozenset({"torque", "drehmoment", "moment", "md", "m"}),
    "power": frozenset({"power", "leistung", "loss", "losses", "verlust", "verluste", "p", "pel", "pele", "pin"}),
    "voltage": frozenset({"voltage", "spannung", "u", "ud", "uq", "vdc", "udc", "urms"}),
    "resistance": frozenset({"resistance", "widerstand", "rdc"}),
    "share": frozenset({"share", "duty", "percent", "heater", "valve", "pwm"}),
}  # fmt: skip

ROLES: Mapping[Role, frozenset[str]] = {
    Role.WINDING: frozenset({"winding", "wdg", "wicklung", "wickelkopf", "coil", "spule", "endwinding",
                             "endwind", "activewind", "copper", "kupfer", "wind", "nut", "slot"}),
    Role.IRON: frozenset({"stator", "yoke", "joch", "tooth", "teeth", "zahn", "core", "iron", "lamination",
                          "blechpaket", "pole", "staender", "ständer"}),
    Role.ROTOR: frozenset({"rotor", "läufer", "laeufer", "armature", "anker"}),
    Role.CAGE: frozenset({"cage", "käfig"}),
    Role.MAGNET: frozenset({"magnet", "pm"}),
    Role.SHAFT: frozenset({"shaft", "welle"}),
    Role.BEARING: frozenset({"bearing", "lager", "brg"}),
    Role.COMMUTATOR: frozenset({"commutator", "kommutator", "brush"}),
    Role.HOUSING: frozenset({"housing", "frame", "gehäuse", "gehaeuse", "casing", "enclosure"}),
    Role.END_SHIELD: frozenset({"flange", "flansch", "endcap", "endshield", "shield", "lagerschild", "endbell"}),
    Role.FOOT: frozenset({"foot", "feet", "fuss", "fuß"}),
    Role.COOLANT: frozenset({"coolant", "water", "wasser", "glycol", "oil", "öl", "inlet", "vorlauf", "kühlmittel",
                             "kuehlmittel", "kühlwasser", "kuehlwasser"}),
    Role.AMBIENT: frozenset({"ambient", "amb", "room", "umgebung", "raum", "umg", "lab", "surrounding", 
                             "air", "luft", "tamb"}),
    Role.TEST_BED: frozenset({"bench", "bed", "plate", "prüfstand", "pruefstand"}),
}  # fmt: skip

SETPOINT = frozenset(
    {"ref", "set", "setpoint", "soll", "sp", "target", "cmd", "demand", "command", "sollwert", "limit"}
)
READ = frozenset({"fbk", "act", "actual", "ist", "meas", "measured", "feedback", "mess", "istwert"})
INLET = frozenset({"inlet", "in", "vorlauf", "supply"})
SHORTEST = 4  # letters of a word that may be looked for inside another


def tokens(name: str) -> tuple[str, ...]:
    """Words and numbers of a name in lower case: "T_yokeLeft2" -> t, yoke, left, 2."""
    return tuple(_singular(word.lower()) for word in WORD.findall(name))


def _singular(word: str) -> str:
    return word[:-1] if len(word) > SHORTEST and word.endswith("s") and not word.endswith("ss") else word


def quantities_of(name: str) -> list[str]:
    """Quantities whose words stand in a name; single letters count only in front."""
    words = tokens(name)
    return [
        q for q, terms in QUANTITY.items() if any(w in terms and (len(w) > 1 or i == 0) for i, w in enumerate(words))
    ]


def roles_of(name: str) -> list[Role]:
    """Roles whose words stand in a name, whole words first, then in their order; long words also inside others."""
    words = tokens(name)
    hits = {}
    for role, terms in ROLES.items():
        at = [(w not in terms, i) for i, w in enumerate(words) if w in terms or _inside(w, terms)]
        if at:
            hits[role] = min(at)
    return sorted(hits, key=lambda role: hits[role])


def _inside(word: str, words: frozenset[str]) -> bool:
    return any(len(k) >= SHORTEST and k in word for k in words)
