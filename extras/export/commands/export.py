"""thermoscope use export CASE: a workbook of results, or the model itself to run elsewhere."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from extras.export.c_code import RUNTIME, c_files, state_bytes, step_operations
from extras.export.compilers import AGREES_K, Compiled, compiler, difference, here, sampled
from extras.export.model import Model, exported, reach_of
from thermoscope import InputError, MissingDependency, ThermoscopeError, plugin as th

WORKBOOKS = ("xlsx", "csv")
MODELS = ("c", "fmu", "json", "matlab")
VERSIONS = (2, 3)  # of FMI


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
    further = {} if form in (*WORKBOOKS, *MODELS) else th.plugins("exports")
    if form not in (*WORKBOOKS, *MODELS, *further):
        raise InputError(
            f"'{form}' is not a form to export", "--as", th.suggestion(form, (*WORKBOOKS, *MODELS, *further))
        )
    if fmi not in VERSIONS:
        raise InputError(f"FMI {fmi} is not written", "--fmi", "2 or 3")
    if sensor and form not in further:
        raise InputError(f"--as {form} has no sensors", "--sensor", "--as observer")
    if form == "fmu":
        compiler(here())
    if form in further:
        return int(further[form](case, out, th.read_limits(limit or ()), tuple(sensor or ()), json))
    if form in MODELS:
        return export_model(case, out, form, th.read_limits(limit or ()), fmi, json)
    return export_workbook(case, out, form, json)


def export_workbook(case: str, out: Path | None, form: str, target: str | None) -> int:
    """Results as a workbook or CSV files."""
    with th.progress() as tell:
        folder = th.open_case(case, tell)
        tell("running the model")
        content = th.tables(folder)
    where, name = out or folder.settings.out, folder.settings.path.resolve().name
    paths = th.write_csvs(where, content) if form == "csv" else [th.write_xlsx(where / f"{name}.xlsx", content)]
    files = [str(path) for path in paths]
    document = {"case": folder.case.name, "files": files, "worksheets": [table.title for table in content]}
    th.give(document, target, lambda: th.Summary(f"{th.counted(len(paths), 'file')} written.", files))
    return 0


def export_model(
    case: str, out: Path | None, form: str, limits: Mapping[str, float], version: int, target: str | None
) -> int:
    """The model itself, to run elsewhere."""
    with th.progress() as tell:
        folder = th.open_case(case, tell, untested=True)
        tell("collecting the network")
        model = exported(folder, limits)
        differences = _differences(folder, model, tell) if form in ("c", "fmu") else {}
        files, platforms = _files(model, form, version, tell)
    where = out or folder.settings.out / form
    paths = [th.write_whole(where / name, content) for name, content in files.items()]
    document = {
        "case": folder.case.name,
        "revision": model.revision,
        "as": form,
        "files": [str(p) for p in paths],
        "platforms": platforms,
        "states": len(model.states),
        "state_bytes": state_bytes(model),
        "step_multiplications": step_operations(model),
        "inputs": [vars(s) for s in model.signals],
        "outputs": [
            {"name": o.name, "limit_degC": o.limit, "error_K": o.error_K, "role": o.role} for o in model.outputs
        ],
        "difference_K": differences,
    }
    th.give(document, target, lambda: export_summary(document))
    return 0


def _differences(folder: th.Folder, model: Model, tell: th.Progress) -> dict[str, float]:
    """Test -> largest difference (K) between the code and the simulation; empty where nothing can compile here.

    Raises ThermoscopeError where they disagree.
    """
    tell("holding the code against the simulation")
    try:
        code = Compiled(model)
    except MissingDependency as fault:
        tell(f"not held against the simulation: {fault}")
        return {}
    network, values = th.model_of(folder)
    out = {}
    for test in folder.case.tests:
        out[test.name] = difference(code, network, sampled(th.record(test, {})), values)
        what = f"the exported code differs from the simulation of '{test.name}' by {out[test.name]:.3g} K"
        outside = [
            f"{s.name} = {u:.4g} (to {reach:.4g})"
            for s in model.inputs
            if (reach := reach_of(s)) < (u := float(np.max(np.abs(test.inputs.get(s.name, 0.0)))))
        ]
        if not out[test.name] <= AGREES_K and outside:
            th.notes([f"{what}, where an input is beyond what the fitted tests give a table for: {', '.join(outside)}"])
        elif not out[test.name] <= AGREES_K:
            raise ThermoscopeError(what)
    return out


def _files(model: Model, form: str, version: int, tell: th.Progress) -> tuple[dict[str, str | bytes], list[str]]:
    """File name -> content; the platforms that compiled code in them runs on."""
    import json

    from extras.export.document import document, mat
    from extras.export.fmu import fmu, identifier

    if form == "c":
        return {**c_files(model)}, []
    if form == "fmu":
        tell("compiling (the first time for other platforms: some minutes)")
        content, platforms = fmu(model, version)
        return {f"{identifier(model)}.fmu": content}, platforms
    beside = "reference_solver.py" if form == "json" else "thermal_solve.m"
    solver = {beside: (RUNTIME / beside).read_text(encoding="utf-8")}
    if form == "json":
        return {"model.json": json.dumps(th.plain(document(model)), ensure_ascii=False), **solver}, []
    return {"model.mat": mat(model), **solver}, []


def export_summary(document: Mapping[str, Any]) -> th.Summary:
    """What was written and how well it agrees."""
    sentence = f"{document['states']} states, {document['state_bytes']} bytes from step to step."
    lines = [f"Compiled for {', '.join(document['platforms'])}."] if document["platforms"] else []
    if differences := document["difference_K"]:
        test = max(differences, key=lambda t: differences[t])
        tests = th.counted(len(differences), "test")
        lines.append(f"Largest difference from simulate over {tests}: {differences[test]:.2g} K ({test}).")
    return th.Summary(sentence, [*lines, *document["files"]], "--json FILE has all numbers")
