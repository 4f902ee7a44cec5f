"""thermoscope bench screen MACHINE, thermoscope bench two-paths CASE"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermoscope import InputError
from thermoscope.plugin import Role, Summary, Table, give, load_machine_file, notes, open_case, progress, required

if TYPE_CHECKING:
    from thermoscope.plugin import MachineDescription as Machine

DESIGNS = ("full", "half", "gap", "morris", "sobol")
TRAJECTORIES, SAMPLES = 20, 256  # 160 runs, 2304 runs of some milliseconds


def screen(machine: str, design: str, target: str | None, out: Path | None = None) -> int:
    """Which of table I's factors move magnets, winding, end winding and laminations; `out`: folder for plots."""
    if design not in DESIGNS:
        raise InputError(f"no design '{design}'", "--design", f"one of {', '.join(DESIGNS)}")
    required(("SALib",) if design in ("morris", "sobol") else ())
    design_machine = load_machine_file(Path(machine))
    roles = {part.role for part in design_machine.parts}
    if Role.MAGNET not in roles or Role.HOUSING in roles:
        right = "a machine with magnets in open laminations, e.g. pmsm-m1"
        raise InputError(f"{design_machine.name} has a housing or no magnets", "screening", right)
    with progress() as tell:
        tell(f"screening {design_machine.name}")
        document = (
            _by_shares(design_machine, design) if design in ("morris", "sobol") else _by_effects(design_machine, design)
        )
    document = {"machine": design_machine.name, "design": design, **document}
    give(document, target, lambda: screening_summary(document))
    if out is not None:
        notes(f"written: {path}" for path in plots(document, out))
    return 0


def _by_effects(machine: Machine, design: str) -> dict[str, Any]:
    from extras.bench.factors.factorial import fractional, full
    from extras.bench.factors.screening import TABLE_I, WITH_GAP, screen

    plans = {
        "full": lambda: full(TABLE_I),
        "half": lambda: fractional(TABLE_I, {"G": "ABCDEF"}),
        "gap": lambda: full(WITH_GAP),
    }
    return screen(machine, plans[design]()).document()


def _by_shares(machine: Machine, design: str) -> dict[str, Any]:
    from extras.bench.factors.screening import varied
    from extras.bench.factors.sensitivity import morris, sobol

    factors, responses = varied(machine)
    method = partial(morris, trajectories=TRAJECTORIES) if design == "morris" else partial(sobol, base=SAMPLES)
    return {"rankings": {name: method(factors, response).document() for name, response in responses.items()}}


def screening_summary(document: Mapping[str, Any]) -> Summary:
    """The factor that moves each response most; a table per response, largest first: the Pareto chart."""
    tables = [_effects(name, effects) for name, effects in document.get("effects", {}).items()]
    tables += [_ranking(name, effects) for name, effects in document.get("rankings", {}).items()]
    leading = "; ".join(
        f"{g.title.partition(':')[0]}: {g.rows[0][1] if document.get('effects') else g.rows[0][0]}"
        for g in tables
        if g.rows
    )
    return Summary(
        f"{document['machine']}, {document['design']}: what moves most. {leading}.",
        tables,
        "--out DIR for plots; --json FILE",
    )


def _effects(name: str, effects: Mapping[str, Any]) -> Table:
    rows = [[e["effect"], e["words"], e["value"], "yes" if e["active"] else ""] for e in effects["effects"]]
    title = f"{name}: beyond {effects['simultaneous']:.2f} is not chance (Lenth, simultaneous 95 %)"
    headers = ["effect", "factors", f"high - low ({unit_of(name)})", "active"]
    return Table(title, headers, rows, ["yes"], headers[2:])


def _ranking(name: str, indices: Mapping[str, Any]) -> Table:
    rows = [[r["factor"], r["measure"], r["conf95"], r["spread"]] for r in indices["ranking"]]
    title = f"{name}: {indices['method']}, {indices['runs']} runs"
    return Table(title, ["factor", "measure", "+- 95 %", "spread"], rows)


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


def two_paths(case: str, winding: str, machine: str, target: str | None) -> int:
    """R_ext and R_w of the case's network at the mean load of every test."""
    from extras.bench.reduction.two_paths import of_test

    if winding == machine:
        raise InputError(f"'{winding}' is both", "--winding, --machine", "two places of the network")
    with progress() as tell:
        folder = open_case(case, tell)
        by_test = {t.name: of_test(folder.case, t, winding, machine).document() for t in folder.case.tests}
    document = {"case": folder.case.name, "tests": by_test}
    give(document, target, lambda: paths(by_test))
    return 0


def paths(resistances: Mapping[str, Mapping[str, Any]]) -> Summary:
    """Two resistances per test."""
    headers = ["test", "R_ext (K/W)", "R_w (K/W)", "winding (K)", "machine (K)", "left at other loads (K)"]
    keys = ("R_ext", "R_w", "winding_K", "machine_K", "largest_residual_K")
    left = max(one["largest_residual_K"] for one in resistances.values())
    sentence = f"Two resistances describe {len(resistances)} tests to {left:.2g} K at other loads."
    return Summary(
        sentence, [Table("", headers, [[name, *(one[k] for k in keys)] for name, one in resistances.items()])]
    )


def carry(source: str, targets: list[str], target: str | None) -> int:
    """Exit code 1 when a sensor of a machine that was not used disagrees by more than its uncertainty."""
    from extras.bench.reduction.transfer import transferred

    with progress() as tell:
        calibrated = open_case(source, tell)
        transfers = [transferred(calibrated.case, open_case(name, tell).case) for name in targets]
    document = {
        "source": calibrated.case.name,
        "revision": calibrated.case.model.revision,
        "targets": [one.document() for one in transfers],
    }
    give(document, target, lambda: show_transfer(document))
    return 0 if all(one.agrees for one in transfers) else 1


def show_transfer(document: Mapping[str, Any]) -> Summary:
    """Where the model of one machine is over on the others."""
    keys = ("test", "measured_C", "simulated_C", "difference_K", "U95_K", "worst_K")
    headers = [
        "sensor",
        "case",
        "test",
        "measured (degC)",
        "simulated (degC)",
        "difference (K)",
        "95 % (K)",
        "worst case (K)",
        "verdict",
    ]
    rows = [
        [r["channel"], one["case"], *(r[key] for key in keys), "within" if r["within"] else "over"]
        for one in document["targets"]
        for r in sorted(one["rows"], key=lambda r: r["within"])
    ]
    over = sum(row[-1] == "over" for row in rows)
    parameters = document["targets"][0]["parameters"] if document["targets"] else []
    sentence = (
        f"{document['source']}, revision {document['revision']}, on other machines: {over} of {len(rows)} "
        "sensors are over."
    )
    keep = ["case", "difference (K)", "95 % (K)", "verdict"]
    return Summary(
        sentence, [Table("", headers, rows, ["over"], keep), f"Taken over: {', '.join(parameters) or 'nothing'}."]
    )
