"""thermoscope use export CASE: a workbook of results, or the model itself to run elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.constants import ZERO_C
from geom.errors import InputError, MissingDependency, ThermoscopeError
from geom.storage import write_whole
from lumped.schemas.reader import suggestion
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.workbook import tables, write_csvs, write_xlsx
from thermoscope.commands.open_case import open_case
from thermoscope.commands.pairs import read_pairs
from thermoscope.console.answer import Answer
from thermoscope.console.terminal import Progress, give, notes, plain, progress
from thermoscope.export.compilers import compiler, here

if TYPE_CHECKING:
    from thermoscope.export.model import Model

WORKBOOKS = ("xlsx", "csv")
MODELS = ("c", "fmu", "json", "matlab", "observer")
VERSIONS = (2, 3)  # of FMI


def export(
    case: str, out: Path | None, form: str, limits: Sequence[str], version: int, target: str | None,
    sensors: Sequence[str] = (),
) -> int:  # fmt: skip
    """A workbook, CSV files, the model as C, FMU, JSON or MAT file, or its observer.  sensors : of the observer"""
    if form not in (*WORKBOOKS, *MODELS):
        raise InputError(f"'{form}' is no form to export", "--as", suggestion(form, (*WORKBOOKS, *MODELS)))
    if version not in VERSIONS:
        raise InputError(f"FMI {version} is not written", "--fmi", "2 or 3")
    if sensors and form != "observer":
        raise InputError(f"--as {form} has no sensors", "--sensor", "--as observer")
    if form == "fmu":
        compiler(here())
    if form == "observer":
        return _observer(case, out, read_limits(limits), sensors, target)
    if form in MODELS:
        return _model(case, out, form, read_limits(limits), version, target)
    with progress() as tell:
        folder = open_case(case, tell)
        tell("running the model")
        content = tables(folder)
    where, name = out or folder.settings.out, folder.settings.path.resolve().name
    paths = write_csvs(where, content) if form == "csv" else [write_xlsx(where / f"{name}.xlsx", content)]
    document = {"case": folder.case.name, "files": [str(p) for p in paths], "worksheets": list(content)}
    give(document, target, lambda: Answer(f"{len(paths)} files written.", [str(p) for p in paths]))
    return 0


def read_limits(words: Sequence[str]) -> dict[str, float]:
    """PLACE=DEGC, ..."""
    return read_pairs(words, "--limit", "limit", "PLACE=DEGC, for example winding=155", -ZERO_C, 3000.0)


def _model(
    case: str, out: Path | None, form: str, limits: Mapping[str, float], version: int, target: str | None
) -> int:
    from thermoscope.export.heading import state_bytes, step_operations
    from thermoscope.export.model import exported

    with progress() as tell:
        folder = open_case(case, tell, untested=True)
        tell("collecting the network")
        model = exported(folder, limits)
        differences = _differences(folder, model, tell) if form in ("c", "fmu") else {}
        files, platforms = _files(model, form, version, tell)
    where = out or folder.settings.out / form
    paths = [write_whole(where / name, content) for name, content in files.items()]
    document = {
        "case": folder.case.name, "revision": model.revision, "as": form, "files": [str(p) for p in paths],
        "platforms": platforms, "states": len(model.states), "state_bytes": state_bytes(model),
        "step_multiplications": step_operations(model), "inputs": [vars(s) for s in model.signals],
        "outputs": [{"name": o.name, "limit_degC": o.limit, "error_K": o.error_K, "role": o.role}
                    for o in model.outputs],
        "difference_K": differences,
    }  # fmt: skip
    give(document, target, lambda: answer(document))
    return 0


def _observer(
    case: str, out: Path | None, limits: Mapping[str, float], names: Sequence[str], target: str | None
) -> int:
    """The observer of a case in C99."""
    import numpy as np

    from thermoscope.export.model import outputs
    from thermoscope.export.observer_code import observer_files, observer_model
    from thermoscope.monitoring.observing import chosen, designed
    from validation.comparison.error_budget import model_of
    from validation.parameters.unknowns import standing_reference

    with progress() as tell:
        folder = open_case(case, tell).small  # a controller's memory is short
        channels = {c.name: c for t in folder.case.tests for c in t.channels}
        sensors = chosen([*channels.values()], names, str(folder.settings.path))
        design = designed(folder, tell)
        tell("writing the observer")
        looks = outputs(model_of(folder)[0], folder, limits)
        filters = [design.as_learned(c) for c in sensors]
        of = observer_model(design.process, design.noise, design.noise.sd, design.rise_K, [s.channel for s in filters],
                            standing_reference(folder.case), looks, np.array([s.bias_K for s in filters]))  # fmt: skip
    where = out or folder.settings.out / "observer"
    paths = [write_whole(where / name, text) for name, text in observer_files(of).items()]
    document = {
        "case": folder.case.name, "revision": folder.case.model.revision, "as": "observer",
        "files": [str(p) for p in paths], "state_bytes": of.bytes, "inputs": of.input_names,
        "sensors": [c.name for c in sensors], "missing_heat": of.process.bodies, "outputs": [o.name for o in looks],
    }  # fmt: skip
    sentence = f"An observer of {len(sensors)} sensors, {of.bytes} bytes from step to step."
    give(document, target, lambda: Answer(sentence, [str(p) for p in paths], "--json FILE"))
    return 0


def _differences(folder: Folder, model: Model, tell: Progress) -> dict[str, float]:
    """Test -> largest difference (K) between the code and the simulation; empty where nothing can compile here.

    Raises ThermoscopeError where they disagree.
    """
    import numpy as np

    from thermoscope.export.drive import AGREES_K, Compiled, difference, sampled
    from thermoscope.export.model import reach_of
    from validation.comparison.error_budget import model_of
    from validation.comparison.predict import record

    tell("holding the code against the simulation")
    try:
        code = Compiled(model)
    except MissingDependency as fault:
        tell(f"not held against the simulation: {fault}")
        return {}
    network, values = model_of(folder)
    out = {}
    for test in folder.case.tests:
        out[test.name] = difference(code, network, sampled(record(test, {})), values)
        what = f"the exported code differs from the simulation of '{test.name}' by {out[test.name]:.3g} K"
        outside = [f"{s.name} = {u:.4g} (to {reach:.4g})" for s in model.inputs
                  if (reach := reach_of(s)) < (u := float(np.max(np.abs(test.inputs.get(s.name, 0.0)))))]  # fmt: skip
        if not out[test.name] <= AGREES_K and outside:
            notes([f"{what}, where an input is beyond what the fitted tests give a table for: {', '.join(outside)}"])
        elif not out[test.name] <= AGREES_K:
            raise ThermoscopeError(what)
    return out


def _files(model: Model, form: str, version: int, tell: Progress) -> tuple[dict[str, str | bytes], list[str]]:
    """File name -> content; the platforms that compiled code in them runs on."""
    import json

    from thermoscope.export.c_code import RUNTIME, c_files
    from thermoscope.export.document import document, mat
    from thermoscope.export.fmu import fmu, identifier

    if form == "c":
        return {**c_files(model)}, []
    if form == "fmu":
        tell("compiling (the first time for other platforms: some minutes)")
        content, platforms = fmu(model, version)
        return {f"{identifier(model)}.fmu": content}, platforms
    beside = "reference_solver.py" if form == "json" else "thermal_solve.m"
    solver = {beside: (RUNTIME / beside).read_text(encoding="utf-8")}
    if form == "json":
        return {"model.json": json.dumps(plain(document(model)), ensure_ascii=False), **solver}, []
    return {"model.mat": mat(model), **solver}, []


def answer(document: Mapping[str, Any]) -> Answer:
    """What was written and how well it agrees."""
    sentence = f"{document['states']} states, {document['state_bytes']} bytes from step to step."
    lines = [f"Compiled for {', '.join(document['platforms'])}."] if document["platforms"] else []
    if differences := document["difference_K"]:
        test = max(differences, key=lambda t: differences[t])
        lines.append(
            f"Largest difference from simulate over {len(differences)} tests: {differences[test]:.2g} K ({test})."
        )
    return Answer(sentence, [*lines, *document["files"]], "--json FILE")
