"""A machine file in the making: every value with its source, and what of the other program's file went nowhere."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from geom.description.names import checked_name, file_stem
from geom.description.profile import Loop
from geom.errors import InputError
from geom.escapes import toml_key, toml_value
from geom.limits import MACHINE_BYTES
from geom.table import Table

COPIED, ASSUMED, UNUSED = "taken", "assumed", "not understood"
_LINE = 150  # letters of a source, of a value in the table


@dataclass(frozen=True)
class Entry:
    """One value of the machine file, or of the other program's.

    kind : COPIED, ASSUMED or UNUSED;  section : "" of what is UNUSED, "[outlines.NAME]" of shapes
    """

    section: str
    key: str
    value: Any
    kind: str
    source: str

    def document(self) -> dict[str, Any]:
        """For JSON and the table: the key as a machine file has it."""
        name = ".".join(filter(None, [self.section, self.key]))
        return {"key": name, "value": _display(self.value), "kind": self.kind, "source": self.source}


@dataclass
class Draft:
    """name : of the machine;  path : what it was read from;  readings : temperatures (degC) the other program stored

    places : reading -> where our network has it, of those whose names are understood
    surroundings : boundary of our network -> degC, as the file has it
    """

    name: str
    path: Path
    program: str
    entries: list[Entry] = field(default_factory=list)
    readings: dict[str, float] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)
    surroundings: dict[str, float] = field(default_factory=dict)

    def take(self, section: str, source: str, **values: Any) -> None:
        """Values as the file has them, or as they follow from it.  source : its keys"""
        self.entries += [Entry(section, key, value, COPIED, one_line(source)) for key, value in values.items()]

    def assume(self, section: str, why: str, **values: Any) -> None:
        """Values that the file does not know."""
        self.entries += [Entry(section, key, value, ASSUMED, one_line(why)) for key, value in values.items()]

    def leave(self, key: str, value: Any, why: str) -> None:
        """What the file says and the machine file does not: with the reason."""
        self.entries.append(Entry("", key, value, UNUSED, one_line(why)))

    def draw(self, name: str, source: str, copies: int, loops: Iterable[Loop]) -> None:
        """Shapes (m) around the axis, for [[outlines.name]]."""
        points = [[[in_mm(x), in_mm(y), *([b] if b else [])] for x, y, b in loop] for loop in loops]
        if points:
            self.take(f"[outlines.{name}]", source, copies=copies, loops_mm=points)

    def value(self, section: str, key: str) -> Any:
        """What was last entered there; None if nothing was."""
        return next((e.value for e in reversed(self.entries) if (e.section, e.key) == (section, key)), None)

    def sections(self) -> dict[str, Any]:
        """The tables of the machine file, as `geom.machine_file.machine_from` takes them."""
        out: dict[str, Any] = {}
        for section, entries in self._by_section():
            if section.startswith("["):
                out.setdefault("outlines", {}).setdefault(section[10:-1], []).append({e.key: e.value for e in entries})
                continue
            table = out
            for word in section.split("."):
                table = table.setdefault(word, {})
            table |= {e.key: e.value for e in entries}
        return out

    def _by_section(self) -> Iterable[tuple[str, list[Entry]]]:
        """Sections in the order they began; each set of outlines is one of its own."""
        groups: dict[tuple[str, int], list[Entry]] = {}
        for entry in self.entries:
            if entry.kind == UNUSED:
                continue
            shape = entry.section.startswith("[")
            count = sum(e.key == entry.key for key, g in groups.items() if key[0] == entry.section for e in g)
            groups.setdefault((entry.section, count if shape else 0), []).append(entry)
        return [(section, entries) for (section, _), entries in groups.items()]

    def toml(self) -> str:
        """The machine file: each value with its source behind it, what went nowhere at the end."""
        sentence = "Each value names the key it was taken from, or why it is assumed."
        lines = [f"# From {self.program}: {one_line(self.path.name)}. {sentence}"]
        for section, entries in self._by_section():
            lines += ["", f"[{section}]"]
            for e in entries:
                mark = "assumed: " if e.kind == ASSUMED else ""
                lines.append(f"{toml_key(e.key)} = {_toml(e.value)}  # {mark}{e.source}")
        left = [f"{e.key} = {_display(e.value)}: {e.source}" for e in self.entries if e.kind == UNUSED]
        lines += ["", "# Not understood, or of no use here:", *(f"# {one_line(line)}" for line in left)]
        return "\n".join([*lines, ""])

    def table(self) -> Table:
        """What was not understood, what is assumed, what was taken: first what a reader must know."""
        order = {UNUSED: 0, ASSUMED: 1, COPIED: 2}
        rows = sorted((e.document() for e in self.entries), key=lambda row: order[row["kind"]])
        return Table.of("", rows, "*kind | *key | value | *source", [UNUSED])


def new_draft(name: Any, path: Path, program: str) -> Draft:
    """With the name in the file, made fit for a file's name, or the file's own."""
    words = " ".join(str(name or path.stem).split())
    return Draft(checked_name(file_stem(words), f"{path} name"), path, one_line(program))


def read_text(path: Path, right: str) -> str:
    """A text of bounded size in UTF-8 or, as older programs write, Latin-1.  right : what the file should be"""
    if not path.is_file():
        raise InputError("no such file", str(path), right)
    MACHINE_BYTES.check(path.stat().st_size, path, "holds")
    data = path.read_bytes()
    if b"\0" in data:
        raise InputError("is not a text", str(path), right)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def number(values: Mapping[str, Any], key: str, where: str, low: float = -1e9, high: float = 1e9) -> float:
    """A finite number of a table. Raises InputError that names where it stands and what would be right."""
    value = values.get(key)
    try:
        size = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        size = math.nan
    if isinstance(value, bool) or not low <= size <= high:
        raise InputError(f"{key} = {str(value)[:40]} is not possible", where, f"a number from {low:g} to {high:g}")
    return size


def in_mm(length: float) -> float:
    return round(1e3 * length, 9)


def one_line(text: str) -> str:
    """One printable line of bounded length: it stands in a comment."""
    words = " ".join("".join(c if c.isprintable() else " " for c in str(text)).split())
    return words if len(words) <= _LINE else f"{words[: _LINE - 3]}..."


def _display(value: Any) -> Any:
    if isinstance(value, list) and value and isinstance(value[0], list):
        return f"{len(value)} shapes of {sum(map(len, value))} points"
    return value if isinstance(value, int | float | bool) else one_line(str(value))


def _toml(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{toml_key(k)} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return f"[{', '.join(map(_toml, value))}]"
    return toml_value(value)
