"""thermoscope model import FILE"""

import tomllib
from pathlib import Path
from shlex import quote
from typing import Annotated, Any

import typer

from geom import import_draft
from geom.errors import InputError
from geom.importing.assumptions import TEMPLATES, USUAL_TEMPLATE
from geom.importing.draft import ASSUMED, COPIED, UNUSED, Draft
from geom.machine_file import machine_from
from geom.text import counted
from lumped.machine.loss_sources import checked_losses
from thermoscope.commands.model.machines import write_machine_file
from thermoscope.commands.model.stored_case import stored_summary, write_stored_case
from thermoscope.console.options import Json, Out
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give

File = Annotated[
    Path,
    typer.Argument(metavar="FILE", help="Of Motor-CAD (.mot), of pyleecan (.json), a drawing (.dxf), or a loss map."),
]
Template = Annotated[
    str, typer.Option(metavar="NAME", help=f"Frame and cooling, where the file has none: {', '.join(TEMPLATES)}.")
]
Stack = Annotated[float | None, typer.Option(metavar="MM", help="Length of the stack, which no drawing has.")]
Units = Annotated[
    str, typer.Option(metavar="UNIT", help="Where the file has none: mm of a drawing, speed=rad/s,power=kW of a map.")
]
OfMachine = Annotated[
    str | None, typer.Option("--machine", metavar="MACHINE", help="Of a loss map: the machine whose losses it says.")
]
Copper = Annotated[
    float | None, typer.Option("--copper-degc", metavar="DEGC", help="Of a loss map: the winding's temperature in it.")
]

Case = Annotated[
    Path | None,
    typer.Option("--case", metavar="DIR", help="A new case instead: the machine, and the file's temperatures as test."),
]


def import_(
    file: File,
    out: Out = None,
    family_template: Template = USUAL_TEMPLATE,
    stack_mm: Stack = None,
    units: Units = "",
    machine: OfMachine = None,
    copper_degC: Copper = None,
    case: Case = None,
    target: Json = None,
) -> int:
    """A machine file of another program as one of ours: what was taken, what is assumed, what was not understood."""
    if case is not None and (out is not None or machine is not None):
        raise InputError("--case holds the machine file itself", "--case", "without --out and --machine")
    if machine is not None:
        from thermoscope.commands.model.import_losses import losses_draft

        draft, text = losses_draft(file, Path(machine), units, copper_degC)
    else:
        draft = import_draft(file, family_template, stack_mm, units)
        text = draft.toml()
    test = None if case is None else write_stored_case(draft, case)
    target_file = write_import(draft, text, out or Path()) if case is None else case / "machine.toml"
    document = {
        "machine": draft.name,
        "program": draft.program,
        "file": target_file,
        "values": [entry.document() for entry in draft.entries],
        "readings_C": draft.readings,
        "test": test,
    }
    summary = import_summary(draft, target_file)
    give(document, target, lambda: summary if test is None else stored_summary(draft, test, summary))
    return 0


def write_import(draft: Draft, text: str, folder: Path) -> Path:
    """The machine file in a folder. InputError where it cannot be built, or one of its name lies there."""
    checked_losses(machine_from(tomllib.loads(text), str(draft.path)))
    return write_machine_file(draft.name, text, folder)


def import_summary(draft: Draft, target_file: Path) -> Summary:
    """How many values of each kind, and the table of them."""
    kinds: dict[str, Any] = {kind: sum(e.kind == kind for e in draft.entries) for kind in (COPIED, ASSUMED, UNUSED)}
    values = ", ".join(f"{counted(n, 'value')} {kind}" for kind, n in kinds.items())
    sentence = f"{target_file}: {values}."
    return Summary(sentence, [draft.table()], f"Next: thermoscope model build {quote(str(target_file))}; --json FILE")
