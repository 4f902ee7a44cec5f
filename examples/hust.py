"""Measured traction motor: the starting network, what the tool names, and the error on four profiles never used.

    python examples/hust.py [--rounds 3] [--draws 24] [--out out/hust]

Round by round: diagnose, add the effects it names, calibrate what was not published. Profiles 5, 8, 11 and 15 are only
ever predicted. Prints the table of cases/hust-ipmsm/README.md and writes it with the model to --out.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from thermoscope.files import write_whole
from thermoscope.folder import find_case, load_case
from thermoscope.history import History, Revision, save_history
from validation.calibrate import minimise
from validation.case import AddedEffect, Case
from validation.compare import Comparison, compare
from validation.diagnose import diagnose
from validation.evidence import diagnosing
from validation.fitting import Unknowns, working
from validation.noise import GRID, Noise, Shape
from validation.revise import nudge

SLOW = Shape(0.0, 120.0, 10.0, 1200.0)  # white 0.3 K, and slow errors of 1 K that last about 20 min
WHITE_K = 0.3
CHANNELS = ("winding", "stator", "rotor")


def settled(case: Case) -> Case:
    """The case calibrated to its readings as they stand, under one fixed noise.

    The usual calibration estimates the noise from what the model leaves. Three nodes leave slow errors of many kelvin
    in this rotor, which such a noise would excuse. Sensors get a bias but no slope and no lag, which would absorb them.
    """
    network, unknowns = working(case)
    kept = tuple(p for p in unknowns.parameters if not p.name.startswith(("slope of", "lag of")))
    start = {p.name: nudge(p) for p in kept if "@" in p.name} | dict(case.model.values)
    index = GRID.index(SLOW)
    noise = Noise(dict.fromkeys(CHANNELS, index), dict.fromkeys(CHANNELS, WHITE_K))
    free = Unknowns(kept)
    fit = minimise(network, diagnosing(case), free, free.coordinates(start), noise, iterations=30)
    model = replace(case.model, values={**case.model.values, **fit.values}, revision=case.model.revision + 1)
    return replace(case, model=model)


def with_effects(case: Case, names: Sequence[str]) -> Case:
    added = tuple(AddedEffect(*name.split("@", 1)) for name in names)
    return replace(case, model=replace(case.model, effects=(*case.model.effects, *added)))


def errors(comparison: Comparison, role: str) -> dict[str, float]:
    """Channel -> error (K) over all tests of a role, all readings together."""
    out = {}
    for channel in CHANNELS:
        rows = [c for t in comparison.tests if t.role == role for c in t.channels if c.channel == channel]
        out[channel] = float(np.sqrt(np.average([r.rmse_K**2 for r in rows], weights=[r.n for r in rows])))
    return out


def table(steps: Sequence[tuple[str, Comparison]]) -> str:
    """Markdown: error (K) of every held-out profile and sensor before and after."""
    (_, first), (_, last) = steps[0], steps[-1]
    lines = ["| held-out profile | sensor | start (K) | end (K) |", "|---|---|---|---|"]
    for a, b in zip(first.tests, last.tests, strict=True):
        if a.role == "hold-out":
            ends = {c.channel: c.rmse_K for c in b.channels}
            lines += [f"| {a.name} | {c.channel} | {c.rmse_K:.2f} | {ends[c.channel]:.2f} |" for c in a.channels]
    lines += ["", "| model | role | winding (K) | stator (K) | rotor (K) | all (K) |", "|---|---|---|---|---|---|"]
    for name, comparison in steps:
        for role in ("calibrate", "validate", "hold-out"):
            e = errors(comparison, role)
            whole = np.sqrt(np.mean(np.square(list(e.values()))))
            lines.append(
                f"| {name} | {role} | {e['winding']:.2f} | {e['stator']:.2f} | {e['rotor']:.2f} | {whole:.2f} |"
            )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--draws", type=int, default=24)
    parser.add_argument("--out", type=Path, default=Path("out/hust"))
    options = parser.parse_args()

    def tell(message: str) -> None:
        print(message, file=sys.stderr)

    case = load_case(find_case("hust-ipmsm"), tell).case
    steps, history = [("start", compare(case))], History()
    calibrated = settled(case)
    steps.append(("calibrated", compare(calibrated)))
    for _ in range(options.rounds):
        found = diagnose(case, draws=options.draws, plan=False, progress=tell)
        named = [n for n in found.named if n not in {e.name for e in case.model.effects}]
        tell(f"{found.verdict}: {found.words}; {[(c.effect, round(c.score, 1)) for c in found.candidates[:8]]}")
        if not named:
            break
        case = settled(with_effects(case, named))
        steps.append((f"+ {', '.join(named)}", compare(case)))
        before = {t.name: t.rmse_K for t in steps[-2][1].tests}
        history = history.and_then(
            Revision(
                0, "add", tuple(e.name for e in case.model.effects), ", ".join(named), dict(case.model.values),
                rmse_K={t.name: (before[t.name], t.rmse_K) for t in steps[-1][1].tests}, why=found.words,
            )
        )  # fmt: skip
    save_history(options.out / "model.toml", history)
    write_whole(options.out / "table.md", table(steps) + "\n")
    write_whole(options.out / "compare.json", json.dumps(steps[-1][1].document(), indent=1))
    print(table(steps))


if __name__ == "__main__":
    main()
