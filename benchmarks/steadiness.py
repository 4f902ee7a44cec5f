"""Does a verdict hang on the sample step? Hidden cases asked again from fewer rows, by recorders of three habits.

    python benchmarks/steadiness.py --seeds test --skip 4000 --count 24 --classes nothing one condition fault --out FILE

A line of FILE per case, habit and number of rows; a run that is started again goes on where it stopped. `--page` puts
the table into docs/hidden-effects.md.
"""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from hidden.answer import answer
from hidden.cases import SHARES, Label, edits_of, plan, records_of
from hidden.kinds import KINDS
from hidden.odds import nats, unordered
from hidden.user import case_of

from geom.arrays import Array
from measured.case import Case, Recorded, Test
from measured.recordings.grid import averaged, read, rms
from scripts.published import ROOT, add_lines, json_lines, publish, table

EVERY, MOVED = (2, 10), 0.1
HABITS = {
    "grid": "the same file, looked at in longer steps (`sample_s`)",
    "means": "inputs are means over the time of a row",
    "instants": "all rows are instants: what lies between is lost",
}
PAGE = ROOT / "docs" / "hidden-effects.md"


def thinned(test: Test, every: int, habit: str, currents: frozenset[str] = frozenset()) -> Test:
    """The test as a logger with so much longer a step has it.  currents : inputs whose heat goes with their square"""
    time, lost = test.time[::every], habit == "instants"

    def kept(values: Array, mean: Callable[[Array, Array, Array], Array] = averaged) -> Array:
        whole = np.broadcast_to(np.asarray(values, float), test.time.shape)
        return whole[::every] if lost else mean(test.time, whole, time)

    inputs = {n: kept(u, rms if n in currents else averaged) for n, u in test.inputs.items()}
    channels = tuple(
        replace(c, y=read(test.time, c.y, time) if habit == "grid" else c.y[::every]) for c in test.channels
    )
    recorded = Recorded(test.time, test.inputs, time, inputs) if habit == "grid" else None
    boundaries = {n: kept(b) for n, b in test.boundaries.items()}
    return replace(test, time=time, inputs=inputs, boundaries=boundaries, channels=channels, recorded=recorded)


def thinned_case(case: Case, every: int, habit: str) -> Case:
    network = case.model.network
    names = {n for t in case.tests for n in t.inputs}
    currents = frozenset(n for n in names if network.measures(n) == "current")
    return replace(case, tests=tuple(thinned(t, every, habit, currents) for t in case.tests))


def asked(label: Label, every: int, habit: str) -> dict[str, Any]:
    """One answer; only what a user would see."""
    case = case_of(label.case, label.machine, records_of(label), edits_of(label))
    if every > 1:
        case = thinned_case(case, every, habit)
    found = answer(case, plan=False)
    return {"case": label.case, "kind": label.machine, "habit": habit, "every": every, **found}


def run(labels: Sequence[Label], habits: Sequence[str], every: Sequence[int], file: Path) -> None:
    """What the file does not have yet; one line printed per answer."""
    file.parent.mkdir(parents=True, exist_ok=True)
    done = {(r["case"], r["habit"], r["every"]) for r in json_lines(file)}
    for label in labels:
        for habit, n in [("whole", 1), *((h, n) for h in habits for n in every)]:
            if (label.case, habit, n) in done:
                continue
            found = {**asked(label, n, habit), "label": label.document()}
            add_lines(file, found)
            print(line(label, found), flush=True)


def line(label: Label, found: Mapping[str, Any]) -> str:
    lead = ", ".join(g[0] for g in found["groups"]) or "-"
    score = nats(unordered(label.document()), unordered(found))
    truth = " + ".join(label.truth) or "-"
    return (
        f"{label.case:24s} {truth:36s} {found['habit']:8s} {found['every']:3d} {found['verdict']:9s} {lead}  "
        f"P(nothing) {found['p_nothing']:.2f}  {score:.1f} nats  {found['cpu_s']:.0f} s"
    )


def changed(whole: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    """Another verdict, or a leading cause that the whole record does not have in its groups."""
    causes = {_bare(name) for g in whole["groups"] for name in g}
    leads = {_bare(g[0]) for g in other["groups"]}
    return whole["verdict"] != other["verdict"] or not leads <= causes


def _bare(name: str) -> str:
    """A cause without when it was: two records with other steps know that to their own step."""
    effect, _, when = str(unordered(name)).partition(" in ")
    return f"{effect} in {when.partition(':')[0]}" if when else effect


def markdown(answers: Sequence[Mapping[str, Any]], before: Sequence[Mapping[str, Any]] = ()) -> str:
    """Rows per recorder and number of rows left; of another file, too, on the cases that both have."""
    heads = "verdict or lead changed | P(nothing) moved by over 10 % | log score, whole record | then"
    lines = []
    files = [scores(x) for x in (before, answers) if x]
    for habit, n in sorted(set.intersection(*map(set, files)), key=lambda key: (list(HABITS).index(key[0]), key[1])):
        each = [x[habit, n] for x in files]
        cases = set.intersection(*map(set, each))
        told, now = [np.array([x[case] for case in cases]) for x in each], " now" * (len(each) > 1)
        cells = [" before, ".join(f"{t[:, k].sum():.0f} of {len(t)}" for t in told) + now for k in (0, 1)]
        cells += [" before, ".join(f"{t[:, k].mean():.2f}" for t in told) + now for k in (2, 3)]
        lines.append([HABITS[habit], f"one in {n}", *cells])
    return table(["recorder", "rows left", *heads.split(" | ")], lines)


def scores(answers: Sequence[Mapping[str, Any]]) -> dict[tuple[str, int], dict[str, tuple[float, ...]]]:
    """Habit and number -> case -> whether its verdict changed, its P(nothing) moved; log scores of both records."""
    whole, out = {a["case"]: a for a in answers if a["every"] == 1}, {}  # type: ignore[var-annotated]
    for a in (a for a in answers if a["every"] > 1 and a["case"] in whole):
        w = whole[a["case"]]
        two = (nats(unordered(x["label"]), unordered(x)) for x in (w, a))
        row = (float(changed(w, a)), float(abs(w["p_nothing"] - a["p_nothing"]) > MOVED), *two)
        out.setdefault((a["habit"], a["every"]), {})[a["case"]] = row
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", choices=("dev", "test"), default="dev")
    parser.add_argument("--count", type=int, default=12)
    parser.add_argument("--skip", type=int, default=0, help="leave out the first cases of the plan")
    parser.add_argument("--classes", nargs="+", choices=tuple(SHARES), default=["nothing", "one", "condition", "fault"])
    parser.add_argument("--kinds", nargs="+", choices=tuple(KINDS), default=list(KINDS))
    parser.add_argument("--habits", nargs="+", choices=tuple(HABITS), default=list(HABITS))
    parser.add_argument("--every", nargs="+", type=int, default=list(EVERY), help="one row in so many is left")
    parser.add_argument("--out", type=Path, default=Path("out/steadiness.jsonl"))
    parser.add_argument("--score", action="store_true", help="only score what the file has")
    parser.add_argument("--before", type=Path, default=Path(), help="FILE of an older version, to stand beside")
    parser.add_argument("--page", action="store_true", help="put the table into docs/hidden-effects.md")
    a = parser.parse_args()
    if not a.score:
        run(plan(a.seeds, a.skip + a.count, a.classes, a.kinds)[a.skip :], a.habits, a.every, a.out)
    found = markdown(json_lines(a.out), json_lines(a.before))
    print(found)
    if a.page:
        publish(PAGE, "steadiness", found)


if __name__ == "__main__":
    main()
