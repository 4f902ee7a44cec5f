"""Measured traction motor: the starting network, what the tool names, and the error on four profiles never used.

    python examples/hust.py [--rounds 4] [--draws 24] [--ablation] [--out out/hust]

What `thermoscope calibrate`, `diagnose` and `add` do, round by round: the effect that leads is added and what case.toml
leaves free is calibrated again, until nothing is named. Profiles 5, 8, 11 and 15 are only ever predicted, and nothing
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
from validation.findings import Diagnosis
from validation.fitting import with_model

CHANNELS = ("winding", "stator", "rotor")
EVIDENCE = (
    "| added | size (95 % interval) | score | threshold | verdict | confused with |", "|---|---|---|---|---|---|",
)  # fmt: skip
Step = tuple[str, Comparison]


def calibrated(case: Case) -> Case:
    return with_model(case, revise.calibrate(case).model)


def added(case: Case, name: str) -> Case:
    return with_model(case, revise.add(case, name).model)


@dataclass(frozen=True)
class Climbed:
    """The case at the end, every step's errors, the revisions, and a row of evidence for each addition."""

    case: Case
    steps: list[Step]
    history: History
    evidence: list[str]


def rounds(case: Case, most: int, draws: int, tell: Callable[[str], None]) -> Climbed:
    """Diagnose and add what leads, at most `most` times."""
    steps, history, rows = [("published", compare(case))], History(), []
    case = calibrated(case)
    steps.append(("calibrated", compare(case)))
    for _ in range(most):
        found = diagnose(case, draws=draws, plan=False, progress=tell)
        tell(f"{found.verdict}: {found.words}")
        named = [n for n in found.named if n not in {e.name for e in case.model.effects}]
        if not named:
            break
        rows.append(evidence(found, named[0]))
        case = added(case, named[0])
        steps.append((f"+ {named[0]}", compare(case)))
        history = history.and_then(revision(case, steps, f"{found.verdict}: {found.words}"))
    return Climbed(case, steps, history, rows)


def evidence(found: Diagnosis, name: str) -> str:
    """What speaks for an effect, as a row of Markdown."""
    c = next(c for c in found.candidates if c.effect == name)
    size = f"{c.value:.3g} {c.unit} ({c.ci95[0]:.3g} to {c.ci95[1]:.3g})"
    alike = cell(", ".join(c.confused_with)) or "nothing"
    return f"| {cell(name)} | {size} | {c.score:.1f} | {c.threshold:.1f} | {found.verdict} | {alike} |"


def cell(text: str) -> str:
    """Text that a table of Markdown takes as one cell."""
    return text.replace("|", "\\|")


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
        group = cell(" or ".join(self.group) or "nothing")
        return (
            f"| {cell(self.deleted)} | {words} | {self.verdict} | {group} | {self.score:.1f} | {self.threshold:.1f} |"
        )


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
    """Markdown: error (K) of every held-out profile and sensor, published and at the end; then every step's errors."""
    (_, first), (_, last) = steps[0], steps[-1]
    lines = ["| held-out profile | sensor | published (K) | end (K) |", "|---|---|---|---|"]
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
                f"| {cell(name)} | {role} | {e['winding']:.2f} | {e['stator']:.2f} | {e['rotor']:.2f} | {whole:.2f} |"
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

    done = rounds(load_case(find_case("hust-ipmsm"), tell).case, options.rounds, options.draws, tell)
    save_history(options.out / "model.toml", done.history)
    text = "\n".join([table(done.steps), "", *EVIDENCE, *done.evidence, ""])
    write_whole(options.out / "table.md", text + "\n")
    write_whole(options.out / "compare.json", json.dumps(done.steps[-1][1].document(), indent=1))
    print(text)
    if options.ablation:
        rows = ablation(ablated(done.case, options.draws, tell))
        write_whole(options.out / "ablation.md", rows + "\n")
        print(rows)


if __name__ == "__main__":
    main()
