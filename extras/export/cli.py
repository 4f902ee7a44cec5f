"""The command of this extra; nothing heavy is loaded until it runs."""

from __future__ import annotations

from typing import Annotated

import typer

from thermoscope import plugin as th

use_commands = typer.Typer(name="use")


@use_commands.command()
def export(
    case: th.CaseArgument,
    out: th.OutOption = None,
    form: Annotated[str, typer.Option("--as", help="xlsx, csv: results; c, fmu, json, matlab; observer: C.")] = "xlsx",
    limit: th.LimitOption = None,
    fmi: Annotated[int, typer.Option(help="Version of an FMU: 2 or 3.")] = 2,
    sensor: Annotated[list[str] | None, typer.Option(metavar="NAME", help="Of an observer; else all.")] = None,
    json: th.JsonOption = None,
) -> int:
    """Results as a workbook or CSV files; or the model to run elsewhere: C99, FMU, JSON or MAT file."""
    from extras.export.commands.export import MODELS, WORKBOOKS, check_form, export_model, export_workbook

    further = {} if form in (*WORKBOOKS, *MODELS) else th.plugins("exports")
    check_form(form, fmi, sensor or (), further)
    if form in further:
        return int(further[form](case, out, th.read_limits(limit or ()), tuple(sensor or ()), json))
    if form in MODELS:
        return export_model(case, out, form, th.read_limits(limit or ()), fmi, json)
    return export_workbook(case, out, form, json)
