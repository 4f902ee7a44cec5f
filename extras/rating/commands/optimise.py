"""thermoscope use optimise CASE|MACHINE: designs that trade temperature, settling, loss and auxiliary power."""

import time
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from extras.rating.commands.rate import case_or_machine, once, read_at
from extras.rating.design.condensations import Condensations
from extras.rating.design.design_problem import DesignRequest, checked_request, design_problem
from extras.rating.design.machine_keys import MachineFile, machine_file_text, short_key
from extras.rating.designs import WORDS, column, page
from extras.rating.optimisation.problem import COPPER, SETTLING, Problem
from extras.rating.optimisation.search import METHODS, Design, Effort, StoppedSearchError, pareto_set
from thermoscope import InputError, plugin as th


def optimise(
    name: Annotated[str, typer.Argument(metavar="CASE|MACHINE", help="A case, or a machine with nothing measured.")],
    limit: th.HotLimitOption = None,
    torque: Annotated[float | None, typer.Option(min=0.0, metavar="NM", help="Required, for ever.")] = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="Input or boundary.")] = None,
    vary: Annotated[
        list[str] | None, typer.Option(metavar="NAME[=LOW:HIGH]", help="Else flows, jacket and fins.")
    ] = None,
    method: Annotated[str, typer.Option(help="nsga2 or unsga3.")] = "nsga2",
    population: Annotated[int, typer.Option(min=8, help="Designs per generation.")] = 48,
    generations: Annotated[int, typer.Option(min=1)] = 30,
    seed: Annotated[int, typer.Option(min=0)] = 1,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler.")] = None,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A vehicle's, with its gains.")] = None,
    robust: Annotated[bool, typer.Option("--robust", help="Temperatures at the upper end of their bands.")] = False,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Designs that trade peak temperature, settling time, copper loss and auxiliary power; each a machine file."""
    if method not in METHODS:
        raise InputError(f"'{method}' is not a method", "--method", ", ".join(METHODS))
    request = DesignRequest(
        th.read_limits(limit or ()), torque, read_at(at or ()), read_bounds(vary or ()), robust, cycle
    )
    if not request.limits:
        raise InputError("no limit is given", "--limit", "PLACE=DEGC, for example winding=155")
    effort = Effort(population, generations, seed)
    on_cluster = th.dask_cluster(cluster) if cluster else nullcontext()
    with once() as messages, th.progress() as tell, on_cluster as executor:
        folder = case_or_machine(name, tell, lambda settings: checked_request(settings, request))
        problem, file = design_problem(folder, request, tell)
        th.notes([effort_words(problem, effort)])
        count, stopped = population * generations, False
        try:
            designs = pareto_set(problem, METHODS[method], effort, executor, tell)
        except StoppedSearchError as stop:
            th.notes([f"stopped: {stop.judged} of {count} designs were judged; the best of these are written and stay"])
            designs, count, stopped = stop.designs, stop.judged, True
        document = {"case": folder.case.name, **document_of(problem, designs, method, count)}
        if not stopped and file is not None and any(v.conducts for v in problem.space.variables):
            spread = {round(k) for k in np.linspace(0, len(designs) - 1, min(3, len(designs)))}  # both ends among them
            samples = [problem.space.named(designs[k].x) for k in sorted(spread)]
            document["interpolation_error"] = Condensations(problem, tell).verified(samples)
        where = out or Path("out") / f"{th.file_stem(folder.case.name)}-designs"
        tell(f"writing {where}")
        document["files"] = _write(where, problem, designs, document, file)
    th.notes(messages)
    th.give(document, json, lambda: optimisation_summary(document, where))
    return 130 if stopped else 0  # as shells have it


def effort_words(problem: Problem, effort: Effort) -> str:
    """How long the search takes, by one design that is judged now; said before it begins."""
    usual = problem.space.usual
    problem.judged(usual)  # the first also compiles
    begin, count = time.perf_counter(), effort.population * effort.generations
    problem.judged(usual)
    minutes = count * (time.perf_counter() - begin) / 60.0
    more = "; --population and --generations set how many"
    return f"{count} designs are judged, about {max(minutes, 0.1):.2g} min of a core{more}"


def read_bounds(words: Sequence[str]) -> dict[str, tuple[float, float] | None]:
    """NAME or NAME=LOW:HIGH, ..."""
    out: dict[str, tuple[float, float] | None] = {}
    for one in words:
        name, equals, bounds = one.partition("=")
        out[name] = None
        if equals:
            try:
                low, high = map(float, bounds.split(":"))
            except ValueError:
                low, high = 1.0, 0.0
            if not (name and np.isfinite([low, high]).all() and low < high):
                raise InputError(
                    f"'{one}' is not a range", "--vary", "NAME=LOW:HIGH, as geometry.jacket.height_mm=8:20"
                )
            out[name] = low, high
    return out


def document_of(problem: Problem, designs: Sequence[Design], method: str, judged: int) -> dict[str, Any]:
    usual = problem.space.usual
    reference = problem.judged(usual)
    return {
        "method": method,
        "judged": judged,
        "objectives": list(problem.aimed),
        "robust": problem.sure is not None,
        "limits": [{"place": s.name, "degC": s.limit} for s in problem.spots],
        "operating_point": {"inputs": dict(reference.inputs), "boundaries": dict(problem.boundaries)},
        "torque_Nm": None if problem.driven else problem.electrics.torque(problem.inputs.get("current_A", 0.0)),
        "variables": [
            {"name": v.name, "low": v.low, "high": v.high, "usual": v.usual} for v in problem.space.variables
        ],
        "reference": {
            "values": usual,
            **dict(reference.objectives),
            "feasible": reference.feasible,
            "places": dict(reference.places),
        },
        "designs": [
            {
                "design": f"design-{k + 1:02d}",
                "values": problem.space.named(d.x),
                **dict(d.performance.objectives),
                "places": dict(d.performance.places),
            }
            for k, d in enumerate(designs)
        ],
    }


def _write(
    folder: Path, problem: Problem, designs: Sequence[Design], document: Mapping[str, Any], file: MachineFile | None
) -> list[str]:
    """pareto.csv, pareto.html, and a machine file per design."""
    rows = [{"design": d["design"], **{o: d[o] for o in problem.aimed}, **d["values"]} for d in document["designs"]]
    lines = ([f"{v:.6g}" if isinstance(v, float) else v for v in row.values()] for row in rows)
    out = [th.write_whole(folder / "pareto.csv", th.csv_lines([list(rows[0]), *lines]))]
    html = page(rows, problem.aimed, {v.name: short_key(v.name) for v in problem.space.variables}, folder.name)
    out.append(th.write_whole(folder / "pareto.html", html))
    for row, design in zip(rows, designs, strict=True) if file is not None else ():
        assert file is not None
        name, does = row["design"], design.performance.objectives
        comments = [f"A design of {file.where}: " + ", ".join(f"{o} {does[o]:.4g}" for o in problem.aimed)]
        values = problem.space.named(design.x)
        text = machine_file_text(file, values, f"{file.machine.name}-{name}", comments)
        out.append(th.write_whole(folder / f"{name}.toml", text))
    return [str(path) for path in out]


def optimisation_summary(document: Mapping[str, Any], where: Path) -> th.Summary:
    """How far the objectives reach, the designs, and how sure the reduced models are of them."""
    designs, reference, objectives = document["designs"], document["reference"], document["objectives"]
    ends = ", ".join(f"{WORDS[o]} {min(column(designs, o)):.4g} to {max(column(designs, o)):.4g}" for o in objectives)
    sentence = f"{len(designs)} designs that none beats, of {document['judged']} judged: {ends}."
    names = [v["name"] for v in document["variables"]]
    headers = ["design", *(WORDS[o] for o in objectives), *(short_key(n) for n in names)]
    rows = [_row("as it is" + (" (too hot)" if not reference["feasible"] else ""), reference, objectives, names)]
    picked = [designs[round(k)] for k in np.linspace(0, len(designs) - 1, min(12, len(designs)))]
    rows += [_row(d["design"], d, objectives, names) for d in picked]
    parts: list[th.Table | str] = [th.Table("Pareto set", headers, rows, keep=[WORDS[o] for o in objectives])]
    if error := document.get("interpolation_error"):
        rises = 100.0 * max(e for n, e in error.items() if n not in (SETTLING, COPPER))
        parts.append(
            f"Against models condensed anew for three of them: rises within {rises:.2g} %, settling "
            f"time within {100.0 * error[SETTLING]:.2g} %, copper loss within {100.0 * error[COPPER]:.2g} %."
        )
    if document["robust"]:
        parts.append("Temperatures are the upper ends of their 95 % bands.")
    torque = "" if document["torque_Nm"] is None else f"{document['torque_Nm']:.4g} N m; "
    point = {**document["operating_point"]["inputs"], **document["operating_point"]["boundaries"]}
    parts.append(f"At {torque}{', '.join(f'{n} = {u:.4g}' for n, u in point.items())}.")
    return th.Summary(sentence, parts, f"table, plots and machine files in {where}; --json FILE")


def _row(word: str, design: Mapping[str, Any], objectives: Sequence[str], names: Sequence[str]) -> list[Any]:
    return [word, *(column([design], o)[0] for o in objectives), *(design["values"][n] for n in names)]
