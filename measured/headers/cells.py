"""One cell of a recording: a number with point or comma, an instant, a unit, or on and off."""

import re
from collections.abc import Sequence
from datetime import date, datetime, time, timedelta

from measured.headers.layout import MISSING
from measured.headers.words import QUANTITY, VOCABULARY, is_time, quantities_of, roles_of, tokens

NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+)([eE][-+]?\d+)?")
# Digits in threes: with a decimal part, in several groups, or with a sign between them that is not a decimal sign.
GROUPED = re.compile(
    r"[-+]?[1-9]\d{0,2}(?:(?:\.\d{3})+,\d+|(?:,\d{3})+\.\d+|(?:\.\d{3}){2,}|(?:,\d{3}){2,}"
    r"|(?:['\u2019 \u00a0\u202f]\d{3})+(?:[.,]\d+)?)"
)
ONE_GROUP = re.compile(r"[-+]?[1-9]\d{0,2}([.,])\d{3}")
DECIMAL = re.compile(r"^[-+]?\d*([.,])\d+(?:[eE][-+]?\d+)?$")
WITH_UNIT = re.compile(r"([-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)\s*([^\d\s.,:;+-][^\d\s]{0,8})")
# 10:05, 1:10:05.5 and 10:05:00 pm; 3 days 10:05:00 and 3.10:05:00 of a span of time; PT1H10M5S.
CLOCK = re.compile(
    r"(?:(?P<days>\d+)(?:\s*d(?:ays?)?,?\s*|[.\s]))?(?P<first>\d{1,4}):(?P<second>\d{2}(?:[.,]\d+)?|\d(?=:\d))"
    r"(?::(?P<third>\d{1,2}(?:[.,:]\d+)?))?\s?(?P<half>[AaPp])?\.?\s?(?(half)[Mm]\.?)"
)
SPAN = re.compile(
    r"P?(?:(\d+)\s?D)?\s?T?(?:(\d+)\s?H)?\s?(?:(\d+)\s?M(?:IN)?)?\s?(?:(\d+(?:[.,]\d+)?)\s?S)?", re.IGNORECASE
)  # and 1h 10m 5s
_MONTH = f"(?:{'|'.join(' '.join(VOCABULARY['months'].values()).split())})[^\\W\\d_]{{0,7}}"
DATE = re.compile(
    r"(?:[^\W\d_]{2,10}[.,]{0,2}\s+)?"  # the day of the week
    r"(\d{4}[-/.年]\s?\d{1,2}[-/.月]\s?\d{1,2}[.日]?|\d{1,2}[-/.]\s?\d{1,2}[-/.]\s?\d{2,4}\.?(?=\D|$)|(?:19|20)\d{6}(?:[T:]?\d{4,6})?(?=\D|$)"
    r"|\d{1,2}[-/.]\s?\d{1,2}\.?(?=\s+\d{1,2}:\d\d)"  # 03/28 10:05, without a year
    rf"|\d{{1,2}}[-/. ]{{1,2}}{_MONTH}\.?[-/., ]{{1,2}}\d{{2,4}}|{_MONTH}\.?\s\d{{1,2}},?(\s\d{{4}})?)"
    r"([T ,_].*|:\d\d:.*)?",
    re.IGNORECASE,
)
COMPACT = re.compile(r"(?:19|20)\d\d(?:0[1-9]|1[0-2])(?:0[1-9]|[12]\d|3[01])(?:[01]\d|2[0-3])[0-5]\d[0-5]\d")
EMPTY = MISSING | set(VOCABULARY["cells"]["empty"])
SWITCH = {word: value for name, value in (("on", 1.0), ("off", 0.0)) for word in VOCABULARY["cells"][name].split()}
SPELLED = {word: unit for unit, words in VOCABULARY["units"].items() for word in words.split()}
SHEET_UNITS = frozenset(VOCABULARY["units"]) | {"MW"}  # as sheets write them; a capital M is another unit
OTHER = frozenset(VOCABULARY["other_units"]["all"].split())
DEGREES = re.compile(
    r"(?:deg(?:ree)?s?|grad|grd|gr|â?[°º˚⁰*'’o]|\?|\ufffd|&deg;)?\.?_?(?:(c)(?:el(?:sius)?)?|(f)(?:ahrenheit)?|(k)(?:elvin)?)°?|(℃)|(℉)"
)
RELATIVE = re.compile(r"(?:%|percent|pct)_?(?:of|i|n|m|p|fla|load|rated|max|fs)[\w.()]*")  # % of nominal, %In, % load


def number(cell: object) -> float:
    """The number in a cell, nan where there is none; a decimal comma is a point, digits may stand in threes."""
    if isinstance(cell, bool):
        return float(cell)
    if isinstance(cell, int | float):
        return float(cell)
    text = str(cell).strip().replace("\u2212", "-")
    if text[1:2].isspace():
        text = re.sub(r"^([-+])\s+", r"\1", text)
    if NUMBER.fullmatch(text):
        return float(text.replace(",", "."))
    if GROUPED.fullmatch(text):
        return float(_ungrouped(text))
    valued = WITH_UNIT.fullmatch(text)
    return number(valued[1]) if valued and is_unit(valued[2]) else float("nan")


def _ungrouped(text: str) -> str:
    """1.234,5 and 1 234,5 and 1,234.5 -> 1234.5"""
    match = re.search(r"[.,](\d+)$", text)
    last = "" if match is None or text.count(match[0][0]) > 1 else match[0]
    return re.sub(r"[^\d+-]", "", text.removesuffix(last)) + last.replace(",", ".")


def in_thousands(columns: Sequence[Sequence[object]]) -> dict[int, list[object]]:
    """Columns whose points, or commas, stand between thousands, without them: where all others have decimal commas,
    1.500 is 1500.  columns : cells of a text file; a file with both decimal signs says nothing"""
    text = {j: [c for c in cells if isinstance(c, str)] for j, cells in enumerate(columns)}
    marked = {j: signed for j, cells in text.items() if (signed := [c for c in cells if "," in c or "." in c])}
    groups = {j: sign for j, cells in marked.items() if (sign := _grouping(cells))}
    decimals = {m[1] for j, cells in marked.items() if j not in groups for c in cells if (m := DECIMAL.search(c))}
    if len(decimals) != 1:
        return {}
    return {
        j: [c.replace(sign, "") if isinstance(c, str) else c for c in columns[j]]
        for j, sign in groups.items()
        if sign not in decimals
    }


def _grouping(cells: Sequence[str]) -> str:
    """The sign that stands before three digits in every cell that has one, "" if a cell says otherwise."""
    if not ONE_GROUP.fullmatch(cells[0].strip()):
        return ""  # most columns
    signs = {match[1] if (match := ONE_GROUP.fullmatch(c.strip())) else "" for c in cells}
    return signs.pop() if len(signs) == 1 else ""


def is_clock(cell: object) -> bool:
    """A time of day, minutes and seconds, or a span of time."""
    if isinstance(cell, time | timedelta):
        return True
    text = str(cell).strip()
    return bool(CLOCK.fullmatch(text)) or is_span(text)


def is_span(text: str) -> bool:
    """PT1H5S, or 1h 5s: a number with one unit alone is a reading."""
    return (
        bool(SPAN.fullmatch(text))
        and (text[:1] in "Pp" or len(re.findall("[a-z]+", text.lower())) > 1)
        and len(text) > 2
    )


def is_date(cell: object) -> bool:
    """A date, with or without a time of day and a zone."""
    return isinstance(cell, datetime | date) or bool(DATE.fullmatch(str(cell).strip()))


def is_reading(cell: object) -> bool:
    """A number, an instant, on or off, or one of the ways to write that there is none."""
    if isinstance(cell, int | float | datetime | date | time | timedelta):
        return True
    text = str(cell).strip()
    if number(text) == number(text):
        return True
    return text.lower() in EMPTY | SWITCH.keys() or is_clock(text) or is_date(text)


PER_TIME = re.compile(r"/(h|s|min)(?:(?<=h)(?:ou)?rs?|(?<=s)ec(?:ond)?|(?<=min)ute)$")  # m3/hr, l/sec


def unit_of(text: str) -> str:
    """A unit as sheets write it, "" where it is none that is known."""
    if text in SHEET_UNITS:
        return text
    plain = PER_TIME.sub(r"/\1", text.strip().strip("[](){}<>").replace(" ", "").replace("Ω", "ω").lower())
    if match := DEGREES.fullmatch(plain):
        c, _, k, celsius, _ = match.groups()
        return "degC" if c or celsius else "K" if k else "degF"
    return "%" if RELATIVE.fullmatch(plain) else SPELLED.get(plain) or SPELLED.get(re.sub("[.*·⋅]", "", plain), "")


def is_unit(text: str) -> bool:
    """Is it a unit, also one that no column of a sheet has?"""
    return bool(unit_of(text)) or text.strip().strip("[](){}<>").replace(" ", "").lower() in OTHER


TIMES = ("us", "ms", "s", "min", "h")  # that are also the ends of names: Wicklung US, I_sek, T_wdg_min
BRACKETS = re.compile(r"\[([^\[\]]+)\]|[(（]([^()（）]+)[)）]|\{([^{}]+)\}|<([^<>]+)>")
INNER = re.compile(r"^([^,]+),\s*([^\s,()]+)\s*(\(.+\))$")  # Temp, °F (LGR S/N: 1, LBL: winding)
SERIAL = re.compile(r"(?:LGR |SEN )?S/N: ?\w+(?:, )?")  # of a logger and its sensor: LGR is not a bearing
BEFORE = re.compile(r"^(?:M\d\d:\s*|(?=[°º]))(\S+)\s+(\S.*)$")  # M00: °C Wicklung, °C Wicklung
BARS = re.compile(r'^"?([^|"]+)"?\|"?([^|"]*)"?(?:\|[^|]*)+$')  # MotorTemp|"C"|0.0|300.0|5
SMALL = {  # p_loss_w, but not T_f
    unit: QUANTITY[of]
    for unit, of in (("c", "temperature"), ("f", "temperature"), ("w", "power"), ("v", "voltage"), ("a", "current"))
}
RATIO = re.compile(r"^(.*[^\W_])_(?!per_)([a-z]+\d?|1)(?:_per)?_(s|sec(?:ond)?|min(?:ute)?|h(?:ou)?r?)$")  # flow_l_s
JOINT = re.compile(r"([Tt]ime)(US|MS|NS)")  # of flight controllers
TRAILING = re.compile(r"^(.*?)(?:_|\s*/\s*|\s+in\s+|[,:]\s*|\s+)((?:deg(?:rees?)?[ _])?[^\s_/]+(?:/[^\W_A-Z]+)?)$")


def split_unit(header: str) -> tuple[str, str]:
    """A header without its unit, and the unit as sheets write it: "T1 [°C]", "Speed (1/min)", "T_yoke / °C", "n_rpm".

    A unit that no column of a sheet has ("position [rad]") is one too, as it is written.
    """
    for match in reversed([*BRACKETS.finditer(header)]):
        inside = next(g for g in match.groups() if g)
        is_number = inside == "1" and (match.end() < len(header) or roles_of(header))  # Y[1] Frame, Wdg_Avg(1)
        if is_unit(inside) and not is_number:
            return f"{header[: match.start()].strip()} {header[match.end() :].strip()}".strip(" _/,"), unit_of(
                inside
            ) or inside.strip()
    if (bars := BARS.match(header)) and is_unit(bars[2]):
        return bars[1].strip(), unit_of(bars[2]) or bars[2]
    if (before := BEFORE.match(header)) and is_unit(before[1]):
        return before[2], unit_of(before[1]) or before[1]
    if (inner := INNER.match(header)) and is_unit(inner[2]):
        return f"{inner[1]} {SERIAL.sub('', inner[3])}", unit_of(inner[2]) or inner[2]
    if (ratio := RATIO.match(header)) and is_unit(over := f"{ratio[2]}/{ratio[3]}"):
        return ratio[1], unit_of(over) or over
    if (
        (last := TRAILING.match(header))
        and last[1]
        and (_surely(last[2]) or any(len(w) > 1 and w in SMALL.get(last[2], ()) for w in tokens(last[1])))
        and not (unit_of(last[2]) in TIMES and not is_time(last[1]) and (roles_of(last[1]) or quantities_of(last[1])))
        and not re.search(r"\([^)]*$|\[[^]]*$", last[1])
    ):
        return last[1].strip(), unit_of(last[2])
    front, _, rest = header.partition(" ")
    if len(front) > 1 and _surely(front) and quantities_of(rest) and unit_of(front) not in TIMES:  # kW Loss
        return rest.strip(), unit_of(front)
    joint = JOINT.fullmatch(header)
    return (joint[1], joint[2].lower()) if joint else (header.strip(), "")


def _surely(word: str) -> bool:
    """A word that is a unit and hardly the name of a phase, a winding or a sensor (A, C, K, V, W, 1)."""
    return (bool(unit_of(word)) and (len(word) > 1 or word in "%℃℉с秒초")) or word in [
        "s",
        "A",
        "V",
        "W",
        "K",
        "C",
        "F",
        "h",
    ]
