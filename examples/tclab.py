"""Two measured heaters: from two bare masses, the missing heat paths are named and added one after the other.

    python examples/tclab.py [--out out/tclab]

Each rung is one `diagnose` and one `add` of what leads; where several cannot be told apart the first is taken and the
others are listed. Asked is which path of heat is missing, so case.toml restricts the catalogue to paths and the
sensors' lag. The third recording is only ever predicted. Prints the tables of cases/tclab/README.md.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

from thermoscope.case_folder.folder import find_case, load_case
from thermoscope.geom.storage import write_whole
from thermoscope.validation.revision.improvement import Improvement, Step, Supervisor, best, improve, leading


def ladder(tell: Callable[[str], None], most: int = 8) -> Improvement:
    """All rungs of the case."""
    folder = load_case(find_case("tclab"), tell, bare=True)
    return improve(folder.case, Supervisor(best, offer=leading), most, tell, folder.settings.kinds)


def table(done: Improvement) -> str:
    """Markdown: error (K) per recording after every rung, the effect's size, and what it could also have been."""
    lines = [
        "| model | steps | random-1 | **random-2 (held out)** | size (95 %) | verdict | also possible |",
        "|---|---|---|---|---|---|---|",
    ]
    return "\n".join([*lines, *(row(stair) for stair in done.stairs)])


def row(stair: Step) -> str:
    errors = " | ".join(f"{t.rmse_K:.2f}" for t in stair.comparison.tests)
    name = f"+ {stair.effect}" if stair.effect else stair.step
    verdict, alike = (stair.evidence.get(key, "") for key in ("verdict", "confused_with"))
    return f"| {name} | {errors} | {size(stair)} | {verdict} | {alike} |"


def size(stair: Step) -> str:
    found = [p for p in stair.revision.parameters if p.name == stair.effect] if stair.revision else []
    return "".join(f"{p.value:.3g} {p.unit} ({p.ci95[0]:.3g} to {p.ci95[1]:.3g})" for p in found)


def ends(done: Improvement) -> str:
    """Why it ended there, and what of the physics could not have been seen."""
    unseen = done.diagnosis.cannot_see
    hidden = [f"- {h.effect}: below {h.smallest_detectable:.3g} {h.unit}, absorbed by {h.absorbed_by}" for h in unseen]
    return "\n".join([f"\n{done.diagnosis.verdict}: {done.why}", *hidden])


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
