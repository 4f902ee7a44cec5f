"""Two measured heaters: from two bare masses, the missing heat paths are named and added one after the other.

    python examples/tclab.py [--out out/tclab]

What `thermoscope explain improve tclab --yes` does, rung by rung. Asked is which path of heat is missing, so case.toml
restricts the catalogue to paths and the sensors' lag. The third recording is only ever predicted. Prints the table of
cases/tclab/README.md and writes it to --out; scripts/published.py puts it there.
"""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from thermoscope.case_folder.folder import find_case, load_case
from thermoscope.geom.storage import write_whole
from thermoscope.validation.revision.improvement import MOST, Improvement, Step, Supervisor, improve, singletons
from thermoscope.validation.revision.revise import TOGETHER

BAR = "\\|"  # in a cell of Markdown


def ladder(tell: Callable[[str], None], most: int = MOST) -> Improvement:
    """All rungs of the case."""
    folder = load_case(find_case("tclab"), tell, bare=True)
    return improve(folder.case, Supervisor(singletons, suggest=True), most, tell, folder.settings.kinds)


def table(done: Improvement) -> str:
    """Markdown: error (K) per recording after every rung, the effect's size, and what it could also have been."""
    lines = [
        "| model | steps | random-1 | **random-2 (held out)** | size (95 %) | it was | also possible |",
        "|---|---|---|---|---|---|---|",
    ]
    return "\n".join([*lines, *(row(stair) for stair in done.stairs)])


def row(stair: Step) -> str:
    name = f"+ {stair.effect}" if stair.effect else stair.step
    verdict, alike = (str(stair.evidence.get(key, "")) for key in ("verdict", "confused_with"))
    said = "free network" if "free network" in stair.evidence else verdict
    cells = [name, *(f"{t.rmse_K:.2f}" for t in stair.comparison.tests), size(stair), said, alike]
    return f"| {' | '.join(c.replace('|', BAR) for c in cells)} |"


def size(stair: Step) -> str:
    names = (stair.effect or "").split(TOGETHER)
    found = [p for p in stair.revision.parameters if p.name in names] if stair.revision else []
    return ", ".join(f"{p.value:.3g} {p.unit} ({p.ci95[0]:.3g} to {p.ci95[1]:.3g})" for p in found)


def ends(done: Improvement) -> str:
    """Why it ended there, and what of the physics could not have been seen."""
    unseen = done.diagnosis.cannot_see
    sizes = [f"{h.smallest_detectable:.3g} {h.unit}".removesuffix(" 1") for h in unseen]
    hidden = [f"- {h.effect}: below {size}, absorbed by {h.absorbed_by}" for h, size in zip(unseen, sizes, strict=True)]
    return "\n".join([f"\nIt ended: {done.why}. What could be there unseen:\n", *hidden])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out/tclab"))
    options = parser.parse_args()
    done = ladder(lambda message: print(message, file=sys.stderr))
    text = f"{table(done)}\n{ends(done)}"
    write_whole(options.out / "table.md", text + "\n")
    print(text)


if __name__ == "__main__":
    main()
