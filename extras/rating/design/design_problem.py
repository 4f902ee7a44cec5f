"""What is asked of an optimisation, and the problem that says it: of a case as it stands, or of a machine file."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from extras.rating.design.condensations import Condensations
from extras.rating.design.machine_keys import FLOWS, MachineFile
from extras.rating.operation import flows, operation
from extras.rating.optimisation.electrics import GAINS, Driven, electrics_of, wanted_inputs
from extras.rating.optimisation.problem import COPPER, OBJECTIVES, PEAK, SETTLING, Problem
from extras.rating.optimisation.scaling import Scaling, design_parameters
from extras.rating.optimisation.space import Space, Variable
from extras.rating.points import hot_spots
from extras.rating.request import places, usual_point
from thermoscope import InputError, Network, plugin as th

GAIN_RANGE = (0.25, 4.0)  # of a controller's gain
INPUT_RANGE = (0.5, 2.0)  # of an input's value at the operating point, where nothing else is said


@dataclass(frozen=True)
class DesignRequest:
    """limits : place -> degC, the first is what peaks;  torque (N m);  at : input or boundary -> value

    vary : variable -> its bounds, or None for the usual ones; empty for all usual variables
    cycle : of a vehicle, whose controller's gains are varied too, in place of a torque
    robust : temperatures at the upper end of their 95 % band
    """

    limits: Mapping[str, float]
    torque: float | None = None
    at: Mapping[str, float] | None = None
    vary: Mapping[str, tuple[float, float] | None] | None = None
    robust: bool = False
    cycle: str | None = None


def design_problem(
    folder: th.Folder, request: DesignRequest, progress: th.CaseProgress
) -> tuple[Problem, MachineFile | None]:
    """The problem with what its reduced model gets wrong about other geometries learned, and the file of its machine.

    Raises InputError for what is not known, and where a limit is exceeded without any load.
    """
    network, values = th.model_of(folder)
    file = None if folder.settings.machine is None else MachineFile.read(folder.settings.machine)
    op = operation(network, usual_point(folder, network), request.at or {})
    sections = {} if file is None else file.sections
    series = file is not None and file.machine.features.series is not None
    electrics = electrics_of(series, sections.get("ratings", {}), sections.get("losses", {}))
    inputs = wanted_inputs(op.inputs, request.torque, electrics)
    larger, sure = _grown(folder, network, request.robust, progress)
    rows = th.named_rows(network, folder)
    limits = places(request.limits, rows, network.identities)
    first = len(places(dict(list(request.limits.items())[:1]), rows, network.identities))
    drive = None if request.cycle is None else _driven(folder, network, request, sections.get("ratings", {}))
    space = Space(tuple(_variables(larger, inputs, file, request.vary or {}, drive)))
    machine = {} if file is None else _of_machine(larger, file, space, inputs)
    objectives = (PEAK, SETTLING, COPPER) if file is None else OBJECTIVES
    problem = Problem(
        larger,
        values,
        inputs,
        op.boundaries,
        space,
        hot_spots(larger, rows, limits),
        first,
        electrics,
        sure=sure,
        driven=drive,
        aimed=objectives,
        **machine,
    )
    _refuse_hot_at_no_load(problem, op.loads)
    if file is not None and any(v.conducts for v in space.variables):
        problem = replace(problem, corrections=Condensations(problem, progress).learn())
    return problem, file


def checked_request(settings: th.Settings, request: DesignRequest) -> None:
    """Raises InputError for a name in a request that a machine file cannot mean, before its mesh is made."""
    if request.cycle is not None:
        th.find_cycle(settings.path, request.cycle)
    file = None if settings.machine is None else MachineFile.read(settings.machine)
    if file is None or settings.model_file.exists():  # what its effects add is not known without the network
        return
    sheets = [th.load_sheet(entry.sheet) for entry in settings.tests]
    inputs = {*th.rated_inputs(file.machine), *(name for sheet in sheets for name in _inputs_of(sheet))}
    _check_names(
        request.at or {}, {*inputs, *th.boundaries(file.machine)}, "--at", "is not an input or boundary of the model"
    )
    _check_names(
        request.limits, temperatures_of(file.machine, sheets), "--limit", "is not a temperature of the machine"
    )
    vary = request.vary or {}
    if not (vary or request.cycle or file.usual()):
        raise _nothing_to_vary(inputs)
    for name in filter(file.knows, vary):
        file.variable(name, vary[name])
    variables = {*inputs, *(GAINS if request.cycle else ()), *filter(file.knows, vary), *(v.name for v in file.usual())}
    _check_names(vary, variables, "--vary", "is nothing that a design could change")


def _inputs_of(sheet: th.Sheet) -> set[str]:
    """Inputs and boundaries that a test has."""
    columns = {name for c in sheet.columns for name in (c.feeds, c.place)}
    return {*columns, *sheet.inputs, *sheet.boundaries, *sheet.squares, *sheet.events}


def temperatures_of(machine: th.MachineDescription, sheets: Sequence[th.Sheet]) -> set[str]:
    """Names, and roles, of all that a limit may be for."""
    parts = (*machine.parts, *machine.fluids)
    roles = {role.value for role in th.Role}
    jackets = {f"{part.name}.outlet" for part in machine.fluids}
    sensors = {f"sensor {c.name}" for sheet in sheets for c in sheet.columns}
    sensors |= {f"sensor {mean.name}" for sheet in sheets for mean in sheet.means}
    cells = {*th.fluids(machine), *th.boundaries(machine), *machine.sections.get("sensors", {})}
    return {part.name for part in parts} | roles | jackets | sensors | cells


def _check_names(names: Iterable[str], choices: Collection[str], option: str, what: str) -> None:
    for name in names:
        if name not in choices:
            raise InputError(f"'{name}' {what}", option, th.suggestion(name, choices))


def _grown(
    folder: th.Folder, network: Network, robust: bool, progress: th.CaseProgress
) -> tuple[Network, th.AtRest | None]:
    """The network with the parameters of a design; for a robust one with those of the table of doubt too."""
    if not robust:
        return network.extended(parameters=design_parameters(network)), None
    of = th.posterior_of(folder, progress)
    larger = th.thermal(of.network)
    larger = larger.extended(parameters=design_parameters(larger))
    return larger, th.AtRest(of, larger)


def _variables(
    network: Network,
    inputs: Mapping[str, float],
    file: MachineFile | None,
    vary: Mapping[str, Any],
    drive: Driven | None,
) -> list[Variable]:
    if not vary:
        usual = file.usual() if file is not None else [_input(n, inputs, None) for n in flows(network, inputs)]
        usual += [] if drive is None else [_gain(key, drive, None) for key in GAINS]
        if not usual:
            raise _nothing_to_vary(inputs)
        return usual
    out = []
    for name, bounds in vary.items():
        if file is not None and file.knows(name):
            out.append(file.variable(name, bounds))
        elif drive is not None and name in GAINS:
            out.append(_gain(name, drive, bounds))
        elif name in inputs:
            out.append(_input(name, inputs, bounds))
        else:
            here = [
                *inputs,
                *(GAINS if drive is not None else ()),
                *([v.name for v in file.usual()] if file is not None else []),
            ]
            raise InputError(f"'{name}' is nothing that a design could change", "--vary", th.suggestion(name, here))
    return out


def _nothing_to_vary(inputs: Iterable[str]) -> InputError:
    some = f"a key of the machine file, or one of {', '.join(sorted(inputs))}"
    return InputError("no flow, jacket or fins that a design could change", "--vary", f"--vary NAME=LOW:HIGH, {some}")


def _input(name: str, inputs: Mapping[str, float], bounds: tuple[float, float] | None) -> Variable:
    low, high = bounds or tuple(share * inputs[name] for share in INPUT_RANGE)
    return Variable(name, low, high, inputs[name])


def _gain(key: str, drive: Driven, bounds: tuple[float, float] | None) -> Variable:
    low, high = bounds or tuple(share * drive.usual(key) for share in GAIN_RANGE)
    return Variable(key, low, high, drive.usual(key))


def _driven(folder: th.Folder, network: Network, request: DesignRequest, ratings: Mapping[str, float]) -> Driven:
    """The vehicle of a cycle, its windings at the first limit."""
    cycle = th.load_cycle(th.find_cycle(folder.settings.path, str(request.cycle)), network, ratings)
    s = cycle.series
    if s is None:
        raise InputError("the cycle has no controller", f"--cycle {request.cycle}", "a cycle with [vehicle]")
    drive = Driven(s.machine, s.vehicle, s.controller, np.asarray(cycle.record.time, float), s.target_mps, s.slope)
    return drive.at(next(iter(request.limits.values())), s.reference_degC)


def _of_machine(network: Network, file: MachineFile, space: Space, inputs: Mapping[str, float]) -> dict[str, Any]:
    names = {v.name for v in space.variables}
    from_machine = tuple(n for key, n in FLOWS.items() if key in names and n in inputs)
    return {"machine_at": file.at, "scaling": Scaling(network, file.machine), "from_machine": from_machine}


def _refuse_hot_at_no_load(problem: Problem, loads: tuple[str, ...]) -> None:
    """A limit that the reference exceeds without any load no design can keep."""
    idle = replace(problem, inputs={**problem.inputs, **dict.fromkeys(loads, 0.0)}, sure=None)
    usual = {v.name: v.usual for v in problem.space.variables if v.name not in loads}
    performance = idle.judged(usual)
    for s in problem.spots:
        if performance.places[s.name] >= s.limit:
            hot, right = performance.places[s.name], "a higher limit, cooler surroundings or a lower speed"
            what = f"the limit of '{s.name}', {s.limit:g} degC, is exceeded without any load ({hot:.1f} degC)"
            raise InputError(what, "--limit", right)
