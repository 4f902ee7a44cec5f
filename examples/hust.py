"""Measured traction motor: the starting network, what the tool names, and the error on four profiles never used.

    python examples/hust.py [--rounds 4] [--draws 24] [--ablation] [--out out/hust]

What `thermoscope calibrate`, `diagnose` and `add` do, round by round: the effect that leads is added and what was not
published is calibrated again, until nothing is named. Profiles 5, 8, 11 and 15 are only ever predicted, and nothing
here looks at them before the end. With --ablation every effect that was added is deleted in turn, the rest calibrated
anew, and the diagnosis asked what is missing. Prints the tables of cases/hust-ipmsm/README.md and writes them to --out,
with the model.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Found:
    """What the diagnosis says of a model from which one effect was taken.

    group : the first group it names;  again : the deleted effect is in one of its groups;  score, threshold : its own
    """

    deleted: str
    verdict: str
    group: tuple[str, ...]
    again: bool
    score: float
    threshold: float

    def row(self) -> str:
        words = "found" if self.again else "not found"
        group = " or ".join(self.group) or "nothing"
        return f"| {self.deleted} | {words} | {self.verdict} | {group} | {self.score:.1f} | {self.threshold:.1f} |"


def ablated(case: Case, draws: int, tell: Callable[[str], None]) -> list[Found]:
    """Every effect of the model deleted in turn and looked for."""
    out = []
    for name in [e.name for e in case.model.effects]:
        tell(f"without {name}")
        less = with_model(case, revise.remove(case, name).model)
        found = diagnose(less, draws=draws, plan=False, progress=tell)
        score = next((c.score for c in found.candidates if c.effect == name), float("nan"))
        group = found.groups[0] if found.groups else ()
        again = any(name in g for g in found.groups)
        out.append(Found(name, found.verdict, group, again, score, found.threshold))
        tell(out[-1].row())
    return out


def ablation(found: Sequence[Found]) -> str:
    """Markdown of the ablation."""
    head = ["| deleted | again | verdict | leading | score | threshold |", "|---|---|---|---|---|---|"]
    return "\n".join([*head, *(f.row() for f in found)])


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
    parser.add_argument("--ablation", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("out/hust"))
    options = parser.parse_args()

    def tell(message: str) -> None:
        print(message, file=sys.stderr)

    case, steps, history = rounds(load_case(find_case("hust-ipmsm"), tell).case, options.rounds, options.draws, tell)
    save_history(options.out / "model.toml", history)
    text = table(steps)
    write_whole(options.out / "table.md", text + "\n")
    write_whole(options.out / "compare.json", json.dumps(steps[-1][1].document(), indent=1))
    print(text)
    if options.ablation:
        rows = ablation(ablated(case, options.draws, tell))
        write_whole(options.out / "ablation.md", rows + "\n")
        print(rows)


if __name__ == "__main__":
    main()
