"""Two measured heaters: from two bare masses, the missing heat paths are named and added one after the other.

    python examples/tclab.py [--draws 40] [--out out/tclab]

Each rung is one `diagnose` and one `add` of what leads; where several cannot be told apart the first is taken and the
others are listed. Asked is which path of heat is missing, so the catalogue is restricted to paths and the sensors' lag.
The third recording is only ever predicted. Prints the tables of cases/tclab/README.md.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from thermoscope.files import write_whole
from thermoscope.folder import find_case, load_case
from validation.climb import Climbed, Guide, Stair, climb, leading
from validation.findings import Candidate, Diagnosis
from validation.revise import Revision

PATHS = ("convection.constant", "convection.buoyant", "radiation", "coupling", "sensor.lag")


def first(found: Diagnosis, choice: Sequence[Candidate]) -> str | None:
    """Of a group its best-fitting member: the candidates come in that order."""
    return choice[0].effect


class Rungs:
    """Every accepted step with its evidence and the effect's interval."""

    def __init__(self) -> None:
        self.steps: list[tuple[Revision, Mapping[str, float | str]]] = []

    def keep(self, step: Revision, evidence: Mapping[str, float | str]) -> None:
        self.steps.append((step, evidence))


def ladder(draws: int, tell: Callable[[str], None], most: int = 8, cache: Path | None = None) -> tuple[Climbed, Rungs]:
    """All rungs of the case."""
    rungs = Rungs()
    case = load_case(find_case("tclab"), tell, bare=True).case
    return climb(case, Guide(first, rungs.keep, leading), draws, most, cache, tell, PATHS), rungs


def table(done: Climbed, rungs: Rungs) -> str:
    """Markdown: error (K) per recording after every rung, the effect's size, and what it could also have been."""
    lines = ["| model | steps | random-1 | **random-2 (held out)** | size (95 %) | verdict | also possible |",
             "|---|---|---|---|---|---|---|", row(done.stairs[0], "", {})]  # fmt: skip
    for stair, (step, evidence) in zip(done.stairs[1:], rungs.steps, strict=True):
        lines.append(row(stair, size(step), evidence))
    return "\n".join(lines)


def row(stair: Stair, size: str, evidence: Mapping[str, float | str]) -> str:
    errors = " | ".join(f"{t.rmse_K:.2f}" for t in stair.comparison.tests)
    name = f"+ {stair.effect}" if stair.effect else stair.step
    return f"| {name} | {errors} | {size} | {evidence.get('verdict', '')} | {evidence.get('confused_with', '')} |"


def size(step: Revision) -> str:
    found = [p for p in step.parameters if p.name == step.effect]
    return "".join(f"{p.value:.3g} {p.unit} ({p.ci95[0]:.3g} to {p.ci95[1]:.3g})" for p in found)


def ends(done: Climbed) -> str:
    """Why it ended there, and what of the physics could not have been seen."""
    blind = [h for h in done.diagnosis.cannot_see if h.effect.split("@")[0] in PATHS]
    hidden = [f"- {h.effect}: below {h.smallest_detectable:.3g} {h.unit}, absorbed by {h.absorbed_by}" for h in blind]
    return "\n".join([f"\n{done.diagnosis.verdict}: {done.why}", *hidden])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=24)
    parser.add_argument("--out", type=Path, default=Path("out/tclab"))
    options = parser.parse_args()
    done, rungs = ladder(options.draws, lambda message: print(message, file=sys.stderr))
    text = f"{table(done, rungs)}\n{ends(done)}"
    write_whole(options.out / "table.md", text + "\n")
    print(text)


if __name__ == "__main__":
    main()
