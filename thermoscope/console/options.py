"""Arguments and options that several commands have, and NAME=VALUE on the command line."""

from collections.abc import Sequence
from math import inf, nan
from pathlib import Path
from typing import Annotated

import typer

from geom.constants import ZERO_C
from geom.errors import InputError
from thermoscope.files import checked_out, checked_target

Case = Annotated[str, typer.Argument(metavar="CASE", help="A case folder, or the name of a case that comes along.")]
Effect = Annotated[str, typer.Argument(metavar="EFFECT@PLACE", help="For example convection@flange.right.")]
Effects = Annotated[
    list[str],
    typer.Argument(metavar="EFFECT@PLACE...", help="For example convection@flange.right; several are added together."),
]
Json = Annotated[
    str | None,
    typer.Option("--json", metavar="FILE|-", callback=checked_target, help="Write the JSON document; - is stdout."),
]
Without = Annotated[
    list[str] | None,
    typer.Option("--without", metavar="EFFECT|sensors", help="Leave out a kind, KIND@PLACE, or all sensors; several."),
]
Only = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="EFFECT|sensors", help="Ask about these alone, and unknown heat; several."),
]
Quick = Annotated[bool, typer.Option("--quick", help="Stop at the first odds, which are preliminary.")]
Anyway = Annotated[bool, typer.Option("--anyway", help="Write it even if it is not accepted.")]
Machine = Annotated[str, typer.Argument(metavar="MACHINE", help="A machine or STEP file, or a name that comes along.")]
# Percent of a part's rise that a network may be off by: contacts and films, known to 10 to 20 %, move it more, and
# finer meshes of most machines that come along are beyond 3 min and 4 GB (docs/condensation.md).
ACCURACY = 5.0
Accuracy = Annotated[
    float, typer.Option(min=0.01, max=100.0, help="Percent of a part's rise; means within half of it.")
]
Limit = Annotated[
    list[str] | None,
    typer.Option("--limit", metavar="PLACE=DEGC", help="For example winding=155; several are possible."),
]
HotLimit = Annotated[
    list[str] | None,
    typer.Option(
        "--limit",
        metavar="PLACE=DEGC",
        help="For example winding=155, of its hottest point, or winding.mean=145; several.",
    ),
]
Sure = Annotated[
    bool | None,
    typer.Option("--bands/--no-bands", help="95 % bands of all temperatures; usual for networks of up to 40 states."),
]
Out = Annotated[Path | None, typer.Option("--out", metavar="DIR", callback=checked_out, help="Folder for the results.")]


def read_pairs(
    words: Sequence[str], option: str, what: str, right: str, low: float = -inf, high: float = inf
) -> dict[str, float]:
    """Values between two bounds by name. Raises InputError for anything else, and for a name that comes twice."""
    out: dict[str, float] = {}
    for one in words:
        name, _, text = one.rpartition("=")
        if name in out:
            raise InputError(f"'{name}' is given twice", option, f"one {what} for each")
        try:
            value = float(text.replace(",", "."))
        except ValueError:
            value = nan
        if not name or not low < value < high:
            raise InputError(f"'{one}' is not {'an' if what[0] in 'aeiou' else 'a'} {what}", option, right)
        out[name] = value
    return out


def read_limits(words: Sequence[str]) -> dict[str, float]:
    """PLACE=DEGC, ..."""
    return read_pairs(words, "--limit", "limit", "PLACE=DEGC, for example winding=155", -ZERO_C, 3000.0)
