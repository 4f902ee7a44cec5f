"""thermoscope bench screen MACHINE, thermoscope bench two-paths CASE, thermoscope bench carry CASE CASE..."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer

from thermoscope import InputError, plugin as th

DESIGNS = ("full", "half", "gap", "morris", "sobol")
TRAJECTORIES, SAMPLES = 20, 256  # 160 runs, 2304 runs of some milliseconds


def screen(
    machine: Annotated[str, typer.Argument(metavar="MACHINE", help="A machine file, or a name that comes along.")],
    design: Annotated[str, typer.Option(help="full (128 runs), half (64), gap (256), morris or sobol.")] = "full",
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Which factors move the temperatures of a PM machine: effects with Lenth's limits, Morris or Sobol."""
    if design not in DESIGNS:
        raise InputError(f"no design '{design}'", "--design", f"one of {', '.join(DESIGNS)}")
    th.required(("SALib",) if design in ("morris", "sobol") else ())
    with th.progress() as tell:
        tell(f"screening {machine}")
        design_machine = th.load_machine_file(Path(machine))
        roles = {part.role for part in design_machine.parts}
        if th.Role.MAGNET not in roles or th.Role.HOUSING in roles:
            right = "a machine with magnets in open laminations, e.g. pmsm-m1"
            raise InputError(f"{design_machine.name} has a housing or no magnets", "screening", right)
        effects = (_by_shares if design in ("morris", "sobol") else _by_effects)(design_machine, design)
    document = {"machine": design_machine.name, "design": design, **effects}
    th.give(document, json, lambda: screening_summary(document))
    if out is not None:
        th.notes(f"written: {path}" for path in plots(document, out))
    return 0


def two_paths(
    case: th.CaseArgument,
    winding: Annotated[str, typer.Option(help="Place of the winding's mean.")] = "winding.copper",
    machine: Annotated[str, typer.Option(help="Place of the machine's inside.")] = "magnets",
    json: th.JsonOption = None,
) -> int:
    """The network of a case as two resistances: machine to ambient, winding to machine."""
    from extras.bench.reduction.two_paths import of_test

    if winding == machine:
        raise InputError(f"'{winding}' is both", "--winding, --machine", "two places of the network")
    with th.progress() as tell:
        folder = th.open_case(case, tell)
        by_test = {t.name: of_test(folder.case, t, winding, machine).document() for t in folder.case.tests}
    th.give({"case": folder.case.name, "tests": by_test}, json, lambda: paths(by_test))
    return 0


def carry(
    source: th.CaseArgument,
    targets: Annotated[list[str], typer.Argument(metavar="CASE...", help="Cases of other machines.")],
    json: th.JsonOption = None,
) -> int:
    """The calibrated model of one case on other machines. Exit code 1 if one disagrees beyond its uncertainty."""
    from extras.bench.reduction.two_paths import transferred

    with th.progress() as tell:
        calibrated = th.open_case(source, tell)
        transfers = [transferred(calibrated.case, th.open_case(name, tell).case) for name in targets]
    of, rows = calibrated.case, [one.document() for one in transfers]
    document = {"source": of.name, "revision": of.model.revision, "targets": rows}
    th.give(document, json, lambda: show_transfer(document))
    return 0 if all(one.agrees for one in transfers) else 1


def _by_effects(machine: th.MachineDescription, design: str) -> dict[str, Any]:
    from extras.bench.factors.factorial import fractional, full
    from extras.bench.factors.screening import TABLE_I, WITH_GAP, screen as screened

    plans = {
        "full": lambda: full(TABLE_I),
        "half": lambda: fractional(TABLE_I, {"G": "ABCDEF"}),
        "gap": lambda: full(WITH_GAP),
    }
    return screened(machine, plans[design]()).document()


def _by_shares(machine: th.MachineDescription, design: str) -> dict[str, Any]:
    from extras.bench.factors.factorial import morris, sobol
    from extras.bench.factors.screening import varied

    factors, responses = varied(machine)
    method = partial(morris, trajectories=TRAJECTORIES) if design == "morris" else partial(sobol, base=SAMPLES)
    return {"rankings": {name: method(factors, response).document() for name, response in responses.items()}}


def screening_summary(document: Mapping[str, Any]) -> th.Summary:
    """The factor that moves each response most; a table per response, largest first: the Pareto chart."""
    tables = [_effects(name, effects) for name, effects in document.get("effects", {}).items()]
    tables += [_ranking(name, effects) for name, effects in document.get("rankings", {}).items()]
    leading = "; ".join(
        f"{g.title.partition(':')[0]}: {g.rows[0][1] if document.get('effects') else g.rows[0][0]}"
        for g in tables
        if g.rows
    )
    sentence = f"{document['machine']}, {document['design']}: what moves most. {leading}."
    return th.Summary(sentence, tables, "--out DIR for plots; --json FILE")


def _effects(name: str, effects: Mapping[str, Any]) -> th.Table:
    title = f"{name}: beyond {effects['simultaneous']:.2f} is not chance (Lenth, simultaneous 95 %)"
    columns = f"effect | factors=words | *high - low ({unit_of(name)})=value | *active"
    return th.Table.of(title, effects["effects"], columns, ["yes"], active=lambda e: "yes" if e["active"] else "")


def _ranking(name: str, indices: Mapping[str, Any]) -> th.Table:
    title = f"{name}: {indices['method']}, {indices['runs']} runs"
    return th.Table.of(title, indices["ranking"], "factor | measure | +- 95 %=conf95 | spread")


def unit_of(response: str) -> str:
    return "mK/W" if "mK/W" in response else "K"


def plots(document: Mapping[str, Any], out: Path) -> list[Path]:
    """A plot per response: half-normal and Pareto of the effects, or the factors by Morris' or Sobol's measure."""
    from extras.bench.figure import ranking, screened

    title = f"{document['machine']}, {document['design']}"
    paths = []
    for name, effects in document.get("effects", {}).items():
        paths.append(_png(out, name))
        screened(effects, unit=unit_of(name), title=f"{title}: {name}", png=paths[-1])
    for name, effects in document.get("rankings", {}).items():
        paths.append(_png(out, name))
        ranking(effects["ranking"], measure=effects["method"], title=f"{title}: {name}", png=paths[-1])
    return paths


def _png(out: Path, response: str) -> Path:
    return out / f"{response.split(' (')[0].replace(' ', '-')}.png"


def paths(resistances: Mapping[str, Mapping[str, Any]]) -> th.Summary:
    """Two resistances per test."""
    columns = "test | R_ext (K/W)=R_ext | R_w (K/W)=R_w | winding (K)=winding_K | machine (K)=machine_K"
    columns += " | left at other loads (K)=largest_residual_K"
    rows = [{"test": name, **one} for name, one in resistances.items()]
    left = max(one["largest_residual_K"] for one in resistances.values())
    sentence = f"Two resistances describe {len(resistances)} tests to {left:.2g} K at other loads."
    return th.Summary(sentence, [th.Table.of("", rows, columns)])


def show_transfer(document: Mapping[str, Any]) -> th.Summary:
    """Where the model of one machine is over on the others."""
    words = {True: "within", False: "over"}
    rows = [
        {**r, "case": one["case"], "verdict": words[r["within"]]}
        for one in document["targets"]
        for r in sorted(one["rows"], key=lambda r: r["within"])
    ]
    columns = "sensor=channel | *case | test | measured (degC)=measured_C | simulated (degC)=simulated_C"
    columns += " | *difference (K)=difference_K | *95 % (K)=U95_K | worst case (K)=worst_K | *verdict"
    over = sum(row["verdict"] == "over" for row in rows)
    parameters = document["targets"][0]["parameters"] if document["targets"] else []
    sentence = (
        f"{document['source']}, revision {document['revision']}, on other machines: {over} of {len(rows)} "
        "sensors are over."
    )
    note = f"Taken over: {', '.join(parameters) or 'nothing'}."
    return th.Summary(sentence, [th.Table.of("", rows, columns, ["over"]), note])
