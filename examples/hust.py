"""Measured traction motor: the starting network, what the tool names, and the error on four profiles never used.

    python examples/hust.py [--rounds 4] [--draws 24] [--out out/hust]

What `thermoscope calibrate`, `diagnose` and `add` do, round by round: the effect that leads is added and what was not
published is calibrated again, until nothing is named. Profiles 5, 8, 11 and 15 are only ever predicted, and nothing
here looks at them before the end. Prints the tables of cases/hust-ipmsm/README.md and writes them to --out, with the
model.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from thermoscope.files import write_whole
from thermoscope.folder import find_case, load_case
from thermoscope.history import History, Revision, save_history
from validation import revise
from validation.case import Case
from validation.compare import Comparison, compare
from validation.diagnose import diagnose
from validation.fitting import with_model

CHANNELS = ("winding", "stator", "rotor")
Step = tuple[str, Comparison]


def calibrated(case: Case) -> Case:
    return with_model(case, revise.calibrate(case).model)


def added(case: Case, name: str) -> Case:
    return with_model(case, revise.add(case, name).model)


def rounds(case: Case, most: int, draws: int, tell: Callable[[str], None]) -> tuple[Case, list[Step], History]:
    """Diagnose and add what leads, at most `most` times: the case at the end, every step's errors, the revisions."""
    steps, history = [("start", compare(case))], History()
    case = calibrated(case)
    steps.append(("calibrated", compare(case)))
    for _ in range(most):
        found = diagnose(case, draws=draws, plan=False, progress=tell)
        tell(f"{found.verdict}: {found.words}")
        named = [n for n in found.named if n not in {e.name for e in case.model.effects}]
        if not named:
            break
        case = added(case, named[0])
        steps.append((f"+ {named[0]}", compare(case)))
        history = history.and_then(revision(case, steps, f"{found.verdict}: {found.words}"))
    return case, steps, history


def revision(case: Case, steps: Sequence[Step], why: str) -> Revision:
    before = {t.name: t.rmse_K for t in steps[-2][1].tests}
    names = tuple(e.name for e in case.model.effects)
    fell = {t.name: (before[t.name], t.rmse_K) for t in steps[-1][1].tests}
    return Revision(0, "add", names, names[-1], dict(case.model.values), rmse_K=fell, why=why)


def errors(comparison: Comparison, role: str) -> dict[str, float]:
    """Channel -> error (K) over all tests of a role, all readings together."""
    out = {}
    for channel in CHANNELS:
        rows = [c for t in comparison.tests if t.role == role for c in t.channels if c.channel == channel]
        out[channel] = float(np.sqrt(np.average([r.rmse_K**2 for r in rows], weights=[r.n for r in rows])))
    return out


def table(steps: Sequence[Step]) -> str:
    """Markdown: error (K) of every held-out profile and sensor at start and end, then every step's errors."""
    (_, first), (_, last) = steps[0], steps[-1]
    lines = ["| held-out profile | sensor | start (K) | end (K) |", "|---|---|---|---|"]
    for a, b in zip(first.tests, last.tests, strict=True):
        if a.role == "hold-out":
            ends = {c.channel: c.rmse_K for c in b.channels}
            lines += [f"| {a.name} | {c.channel} | {c.rmse_K:.2f} | {ends[c.channel]:.2f} |" for c in a.channels]
            lines.append(f"| **{a.name}** | **all** | **{a.rmse_K:.2f}** | **{b.rmse_K:.2f}** |")
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
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--draws", type=int, default=24)
    parser.add_argument("--out", type=Path, default=Path("out/hust"))
    options = parser.parse_args()

    def tell(message: str) -> None:
        print(message, file=sys.stderr)

    _, steps, history = rounds(load_case(find_case("hust-ipmsm"), tell).case, options.rounds, options.draws, tell)
    save_history(options.out / "model.toml", history)
    write_whole(options.out / "table.md", table(steps) + "\n")
    write_whole(options.out / "compare.json", json.dumps(steps[-1][1].document(), indent=1))
    print(table(steps))


if __name__ == "__main__":
    main()
