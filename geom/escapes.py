"""Texts that others wrote, made safe for each kind of file. No writer relies on the rule that let a name in."""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from typing import Any

from geom.text import visible

# A cell that begins so is computed when a spreadsheet opens the file; with semicolons as separators, parts too.
FORMULA = re.compile(r"((?:^|;)\s*)(?=[=+@\uff0b\uff0d\uff1d\uff20-])")
IN_COMMENTS = set(" .,:;()'_+-=<>%@#[]{}|&/^~°·")  # of C; no * and no ?, which could end the comment or be a trigraph
NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # XML 1.0, production 2


def csv_lines(rows: Iterable[Sequence[Any]]) -> str:
    """Rows as lines of CSV. An apostrophe keeps a text that looks like a formula a text."""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([_cell(value) for value in row] for row in rows)
    return out.getvalue()


def _cell(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    text = visible(value)
    try:
        float(text)
    except ValueError:
        return FORMULA.sub(r"\1'", text)
    return text


def c_comment(lines: Iterable[str]) -> str:
    """Lines as a comment of C: letters, digits and a few signs; all else is an underscore."""
    safe = ("".join(c if c.isalnum() or c in IN_COMMENTS else "_" for c in line) for line in lines)
    return "/* " + "\n   ".join(safe) + " */"


def xml_text(text: str) -> str:
    """Without what no XML file may hold; the library of XML escapes the rest."""
    return NO_XML.sub("\ufffd", text)


def toml_value(value: str | float | list[str]) -> str:
    """A text, a number or a list of texts, as TOML writes it."""
    import tomlkit

    return tomlkit.item(value).as_string()


def toml_key(name: str) -> str:
    """A key of TOML, in quotes where it needs them."""
    import tomlkit

    return tomlkit.key(name).as_string()
