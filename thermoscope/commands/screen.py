"""thermoscope screen MACHINE, thermoscope two-paths CASE"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.errors import InputError
from thermoscope.commands.opened import opened
from thermoscope.folder import load_machine_file
from thermoscope.terminal import give, notes, progress, say, table

if TYPE_CHECKING:
    from geom import Machine

DESIGNS = ("full", "half", "gap", "morris", "sobol")
ROWS = 12
TRAJECTORIES, SAMPLES = 20, 256  # 160 runs, 2304 runs of some milliseconds


def screen(machine: str, design: str, target: str | None, out: Path | None = None) -> int:
    """Which of table I's factors move magnets, winding, end winding and laminations; `out`: folder for plots."""
    if design not in DESIGNS:
        raise InputError(f"no design '{design}'", "--design", f"one of {', '.join(DESIGNS)}")
    described = load_machine_file(Path(machine))
    if described.family != "pmsm" or described.geometry.housing.kind != "none":
        right = "a machine of family pmsm without a housing, e.g. pmsm-m1"
        raise InputError(f"{described.name} has a housing or no magnets", "screening", right)
    with progress() as tell:
        tell(f"screening {described.name}")
        document = _by_shares(described, design) if design in ("morris", "sobol") else _by_effects(described, design)
    document = {"machine": described.name, "design": design, **document}
    give(document, target, lambda: show(document))
    if out is not None:
        notes(f"written: {path}" for path in plots(document, out))
    return 0


def _by_effects(machine: Machine, design: str) -> dict[str, Any]:
    from validation.procedure.factorial import fractional, full
    from validation.procedure.screening import TABLE_I, WITH_GAP, screen

    plans = {
        "full": lambda: full(TABLE_I),
        "half": lambda: fractional(TABLE_I, {"G": "ABCDEF"}),
        "gap": lambda: full(WITH_GAP),
    }
    return screen(machine, plans[design]()).document()


def _by_shares(machine: Machine, design: str) -> dict[str, Any]:
    from validation.procedure.screening import varied
    from validation.procedure.sensitivity import morris, sobol

    factors, responses = varied(machine)
    method = partial(morris, trajectories=TRAJECTORIES) if design == "morris" else partial(sobol, base=SAMPLES)
    return {"rankings": {name: method(factors, response).document() for name, response in responses.items()}}


def show(document: Mapping[str, Any]) -> None:
    """A table per response, largest first: the Pareto chart."""
    for name, found in document.get("effects", {}).items():
        title = f"{name}: effects beyond {found['simultaneous']:.2f} are not chance (Lenth, simultaneous 95 %)"
        rows = [[e["effect"], e["words"], e["value"], "yes" if e["active"] else ""] for e in found["effects"][:ROWS]]
        table(title, ["effect", "factors", f"high - low ({unit_of(name)})", "active"], rows, marked=["yes"])
    for name, found in document.get("rankings", {}).items():
        rows = [[r["factor"], r["measure"], r["conf95"], r["spread"]] for r in found["ranking"]]
        table(f"{name}: {found['method']}, {found['runs']} runs", ["factor", "measure", "+- 95 %", "spread"], rows)


def unit_of(response: str) -> str:
    return "mK/W" if "mK/W" in response else "K"


def plots(document: Mapping[str, Any], out: Path) -> list[Path]:
    """A plot per response: half-normal and Pareto of the effects, or the factors by Morris' or Sobol's measure."""
    from viz.screening import ranking, screened

    title = f"{document['machine']}, {document['design']}"
    made = []
    for name, found in document.get("effects", {}).items():
        made.append(_png(out, name))
        screened(found, unit=unit_of(name), title=f"{title}: {name}", png=made[-1])
    for name, found in document.get("rankings", {}).items():
        made.append(_png(out, name))
        ranking(found["ranking"], measure=found["method"], title=f"{title}: {name}", png=made[-1])
    return made


def _png(out: Path, response: str) -> Path:
    return out / f"{response.split(' (')[0].replace(' ', '-')}.png"


def two_paths(case: str, winding: str, machine: str, target: str | None) -> int:
    """R_ext and R_w of the case's network at the mean load of every test."""
    from validation.procedure.two_paths import of_test

    with progress() as tell:
        folder = opened(case, tell)
        found = {t.name: of_test(folder.case, t, winding, machine).document() for t in folder.case.tests}
    document = {"case": folder.case.name, "tests": found}
    headers = ["test", "R_ext (K/W)", "R_w (K/W)", "winding (K)", "machine (K)", "left at other loads (K)"]
    keys = ("R_ext", "R_w", "winding_K", "machine_K", "largest_residual_K")
    rows = [[name, *(one[k] for k in keys)] for name, one in found.items()]
    give(document, target, lambda: table("Two resistances", headers, rows))
    return 0


def carry(source: str, targets: list[str], target: str | None) -> int:
    """Exit code 1 when a sensor of a machine that was not used disagrees by more than its uncertainty."""
    from validation.procedure.carry import carried

    with progress() as tell:
        calibrated = opened(source, tell)
        found = [carried(calibrated.case, opened(name, tell).case) for name in targets]
    document = {"source": calibrated.case.name, "revision": calibrated.case.model.revision,
                "targets": [one.document() for one in found]}  # fmt: skip
    give(document, target, lambda: show_carried(document))
    return 0 if all(one.agrees for one in found) else 1


def show_carried(document: Mapping[str, Any]) -> None:
    keys = ("test", "channel", "measured_C", "simulated_C", "difference_K", "U95_K", "worst_K")
    headers = [
        "case",
        "test",
        "sensor",
        "measured (degC)",
        "simulated (degC)",
        "difference (K)",
        "95 % (K)",
        "worst case (K)",
        "",
    ]
    rows = [
        [one["case"], *(r[key] for key in keys), "within" if r["within"] else "over"]
        for one in document["targets"] for r in one["rows"]
    ]  # fmt: skip
    table(f"Model of {document['source']}, revision {document['revision']}, on other machines", headers, rows, ["over"])
    taken = document["targets"][0]["parameters"] if document["targets"] else []
    say(f"taken over: {', '.join(taken) or 'nothing'}")
