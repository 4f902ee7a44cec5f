"""Measured traction motor: the starting network, what the tool names, and the error on four profiles never used.

    python examples/hust.py [--most 6] [--ablation] [--out out/hust]

What `thermoscope explain improve --yes` does: what leads or is sure is added and what case.toml leaves free is
calibrated again; where nothing is left to add, what a free network needs, as long as it predicts better. Profiles 5,
8, 11 and 15 are only ever predicted, and nothing here looks at them before the end. With --ablation every effect that
was added is deleted in turn, the rest calibrated anew, and the diagnosis asked what is missing. Prints the tables of
cases/hust-ipmsm/README.md and writes them to --out, with that of the front page and the model; scripts/published.py
puts them there.
"""

import argparse
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from thermoscope.case_folder.folder import find_case, load_case
from thermoscope.case_folder.history import History, load_history, save_history
from thermoscope.commands.model.revise import recorded
from thermoscope.geom.storage import write_whole
from thermoscope.measured.case import Case
from thermoscope.validation import diagnose
from thermoscope.validation.comparison.compare import Comparison, pooled
from thermoscope.validation.parameters.unknowns import with_model
from thermoscope.validation.revision import revise
from thermoscope.validation.revision.improvement import MOST, Step, Supervisor, improve, singletons
from thermoscope.validation.revision.revise import TOGETHER

CHANNELS = ("winding", "stator", "rotor")
EVIDENCE = ("| added | size (95 % interval) | probability | verdict | confused with |", "|---|---|---|---|---|")


def history(stairs: Sequence[Step]) -> History:
    """Every step as model.toml keeps it."""
    out = History()
    for s in stairs:
        out = out.and_then(recorded(s.revision, s.evidence)) if s.revision else out
    return out


def name(stair: Step) -> str:
    """A model as the tables call it."""
    return f"+ {stair.effect}" if stair.effect else {"start": "published", "calibrate": "calibrated"}[stair.step]


def evidence(stair: Step) -> str:
    """What speaks for the effects that were added, as rows of Markdown."""
    assert stair.revision
    e, rows = stair.evidence, []
    for p in (p for p in stair.revision.parameters if p.name in str(stair.effect).split(TOGETHER)):
        size = f"{p.value:.3g} {p.unit} ({p.ci95[0]:.3g} to {p.ci95[1]:.3g})"
        said = (
            [f"{100 * float(e['probability']):.0f} %", str(e["verdict"])]
            if "probability" in e
            else ["", "free network"]
        )
        rows.append(f"| {' | '.join([cell(p.name), size, *said, cell(str(e.get('confused_with', 'nothing')))])} |")
    return "\n".join(rows)


def cell(text: str) -> str:
    """Text that a table of Markdown takes as one cell."""
    return text.replace("|", "\\|")


@dataclass(frozen=True)
class Found:
    """What the diagnosis says of a model from which one effect was taken.

    group : the first group it names;  again : the deleted effect is in one of its groups;  probability : its own
    """

    deleted: str
    verdict: str
    group: tuple[str, ...]
    again: bool
    probability: float

    def row(self) -> str:
        words = "found" if self.again else "not found"
        group = cell(" or ".join(self.group) or "nothing")
        return f"| {cell(self.deleted)} | {words} | {self.verdict} | {group} | {100 * self.probability:.0f} % |"


def ablated(case: Case, tell: Callable[[str], None]) -> list[Found]:
    """Every effect of the model deleted in turn and looked for."""
    out = []
    for name in [e.name for e in case.model.effects]:
        tell(f"without {name}")
        less = with_model(case, revise.remove(case, name).model)
        found = diagnose(less, plan=False, progress=tell)
        share = next((c.probability for c in found.candidates if c.effect == name), 0.0)
        group = found.groups[0] if found.groups else ()
        again = any(name in g for g in found.groups)
        out.append(Found(name, found.verdict, group, again, share))
        tell(out[-1].row())
    return out


def ablation(found: Sequence[Found]) -> str:
    """Markdown of the ablation."""
    head = ["| deleted | again | verdict | leading | probability |", "|---|---|---|---|---|"]
    return "\n".join([*head, *(f.row() for f in found)])


def role_errors(comparison: Comparison, role: str = "hold-out") -> tuple[dict[str, float], dict[str, float]]:
    """Channel -> error (K) over all tests of a role, all readings together: as sensors read, and as fitted."""
    rows = [c for t in comparison.tests if t.role == role for c in t.channels]
    read, fitted = {}, {}
    for channel in CHANNELS:
        mine = [c for c in rows if c.channel == channel]
        read[channel] = pooled(mine)
        fitted[channel] = pooled([replace(c, rmse_K=c.fitted_rmse_K) for c in mine if c.fitted_rmse_K is not None])
    return read, fitted


def together(errors: Mapping[str, float]) -> float:
    """Root mean square of the sensors' errors."""
    return float(np.sqrt(np.mean(np.square([*errors.values()]))))


def number(error: float | None) -> str:
    """An error (K) in a cell; empty where there is none."""
    return "" if error is None or not np.isfinite(error) else f"{error:.2f}"


def table(stairs: Sequence[Step]) -> str:
    """Markdown: error (K) of every held-out profile and sensor, published and at the end; then every step's errors."""
    first, last = stairs[0].comparison, stairs[-1].comparison
    lines = [
        "| held-out profile | sensor | published (K) | end (K) | end, sensors as fitted (K) |",
        "|---|---|---|---|---|",
    ]
    for a, b in zip(first.tests, last.tests, strict=True):
        if a.role == "hold-out":
            ends = {c.channel: c for c in b.channels}
            lines += [
                f"| {a.name} | {c.channel} | {number(c.rmse_K)} | {number(ends[c.channel].rmse_K)} | "
                f"{number(ends[c.channel].fitted_rmse_K)} |"
                for c in a.channels
            ]
            lines.append(
                f"| **{a.name}** | **all** | **{number(a.rmse_K)}** | **{number(b.rmse_K)}** | "
                f"**{number(b.fitted_rmse_K)}** |"
            )
    lines += [
        "",
        "| model | role | winding (K) | stator (K) | rotor (K) | all (K) | all, sensors as fitted (K) |",
        "|---|---|---|---|---|---|---|",
    ]
    for stair in stairs:
        for role in ("calibrate", "validate", "hold-out"):
            read, fitted = role_errors(stair.comparison, role)
            numbers = " | ".join(map(number, (*read.values(), together(read), together(fitted))))
            lines.append(f"| {cell(name(stair))} | {role} | {numbers} |")
    return "\n".join(lines)


def front_page(stairs: Sequence[Step]) -> str:
    """Markdown of the project's front page: the held-out profiles alone, from the same numbers."""
    profiles = [t.name for t in stairs[0].comparison.tests if t.role == "hold-out"]
    head = [*CHANNELS, "all", "all, sensors as fitted", *(p.replace("id_", "profile ") for p in profiles)]
    lines = [f"| model | {' | '.join(head)} |", f"|{'---|' * (len(head) + 1)}"]
    for stair in stairs:
        (read, fitted), of = role_errors(stair.comparison), {t.name: t.rmse_K for t in stair.comparison.tests}
        row = (*read.values(), together(read), together(fitted), *(of[p] for p in profiles))
        lines.append(f"| {cell(name(stair))} | {' | '.join(map(number, row))} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=MOST, help="effects to add at most")
    parser.add_argument("--ablation", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("out/hust"))
    options = parser.parse_args()

    def tell(message: str) -> None:
        print(message, file=sys.stderr)

    case = load_case(find_case("hust-ipmsm"), tell).case
    done = improve(case, Supervisor(singletons, suggest=True), options.most, progress=tell)
    options.out.mkdir(parents=True, exist_ok=True)
    file = options.out / "model.toml"
    save_history(file, history(done.stairs), load_history(file))
    text = "\n".join([table(done.stairs), "", *EVIDENCE, *(evidence(s) for s in done.stairs if s.effect), ""])
    write_whole(options.out / "table.md", text + "\n")
    write_whole(options.out / "compare.json", json.dumps(done.stairs[-1].comparison.document(), indent=1))
    write_whole(options.out / "front-page.md", front_page(done.stairs) + "\n")
    print(text)
    if options.ablation:
        rows = ablation(ablated(done.case, tell))
        write_whole(options.out / "ablation.md", rows + "\n")
        print(rows)


if __name__ == "__main__":
    main()
