"""Cases through the diagnosis, a line each; what an addition is worth on held-out tests, what a proposed test says.

In as many processes as wanted; what is done is not done again.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from joblib import Parallel, delayed

from hidden import odds
from hidden.answer import answer
from hidden.cases import Label, edits_of, hidden_in, records_of
from hidden.folders import diagnosed, found_in, words_of
from hidden.kinds import KINDS
from hidden.odds import unordered
from hidden.peers import peers
from hidden.truth.archetype import measured
from hidden.truth.candidate_tests import CANDIDATE_TESTS, carried_out
from hidden.user import case_of, test_of
from measured.case import Case
from scripts.published import add_lines, json_lines
from validation import Revision, add, calibrate
from validation.inference.evidence import candidates
from validation.planning.rivals import DECISIVE

LABELS, ANSWERS = "labels.jsonl", "answers.jsonl"
COMPARED, FOLLOWED = ("one", "nothing"), ("one", "pair")  # classes peers are asked about; what is said is acted on


def answered(out: Path) -> dict[str, dict]:
    return {a["case"]: a for a in json_lines(out / ANSWERS)}


def pairs(out: Path) -> list[tuple[dict, dict]]:
    """Labels and answers that belong together."""
    done = odds.unordered(answered(out))
    labels = {label["case"]: odds.unordered(label) for label in json_lines(out / LABELS)}
    return [(labels[name], found) for name, found in done.items() if name in labels]


@dataclass(frozen=True)
class Wanted:
    """plan : next tests;  peers : the simpler methods as well, on classes COMPARED;
    after : add what is claimed, and carry out the proposed test, on classes FOLLOWED"""

    plan: bool = False
    peers: bool = False
    after: bool = False


def run(labels: Sequence[Label], out: Path, wanted: Wanted, jobs: int) -> None:
    """Diagnose what `out` does not have yet; one line printed per case."""
    out.mkdir(parents=True, exist_ok=True)
    known = {label["case"] for label in json_lines(out / LABELS)}
    add_lines(out / LABELS, *(x.document() for x in labels if x.case not in known))
    done = answered(out)
    todo = [label for label in labels if label.case not in done]
    work = (delayed(_diagnosed)(label, wanted) for label in todo)
    for label, found in zip(todo, Parallel(jobs, return_as="generator")(work), strict=True):
        add_lines(out / ANSWERS, found)
        print(line(label, found), flush=True)


def run_folders(root: Path, out: Path, only: Sequence[str], count: int, jobs: int, words: Path | None) -> None:
    """The same for folders of another generator: `count` of every class."""
    out.mkdir(parents=True, exist_ok=True)
    done = {name.rsplit("-", 1)[1] for name in answered(out)}
    todo = {name: truth for name, truth in found_in(root, only, count).items() if name not in done}
    work = (delayed(diagnosed)(root / name, truth, words_of(words)) for name, truth in todo.items())
    for label, found in Parallel(jobs, return_as="generator")(work):
        add_lines(out / LABELS, label.document())
        add_lines(out / ANSWERS, found)
        print(line(label, found), flush=True)


def _diagnosed(label: Label, wanted: Wanted) -> dict:
    """Only the case goes to the diagnosis; the label serves to make it, and to carry out what was proposed."""
    start = time.process_time()
    case = case_of(label.case, label.machine, records_of(label), edits_of(label))
    made = time.process_time() - start
    after = wanted.after and label.group in FOLLOWED
    found = {**answer(case, wanted.plan or after), "made_s": made}
    if wanted.peers and label.group in COMPARED:
        found["peers"] = peers(case)
    if after:
        found |= {"worth": worth(case, label, found), "followed": followed(case, label, found)}
    return found


def line(label: Label, found: dict) -> str:
    """Truth, verdict, leading group, score over threshold, time."""
    truth = (" + ".join(label.truth) or "-") + (f" in {label.test}" if label.test else "")
    size = f" {label.size:g}x" if label.size else ""
    lead = ", ".join(found["groups"][0][:3]) if found["groups"] else "-"
    more = f" (+{len(found['groups'][0]) - 3})" if found["groups"] and len(found["groups"][0]) > 3 else ""
    best = max((c["score"] for c in found["candidates"].values()), default=0.0)
    nats = odds.nats(odds.unordered(label.document()), odds.unordered(found))
    cost = f"{nats:.1f} nats  {found['made_s']:.0f}+{found['cpu_s']:.0f} s"
    told = f"{best:.1f}/{found['threshold']:.1f}  rmse {found['rmse_K']:.2f}/{found['floor_K']:.2f} K"
    return f"{label.case:24s} {truth + size:44s} {found['verdict']:9s} {lead}{more}  {told}  {cost}"


Answer = dict[str, Any]


def worth(case: Case, label: Label, found: Answer) -> dict[str, float] | None:
    """Held-out error (K) calibrated as it is, with what was claimed first, and with the truth; one effect only.

    Nothing claimed leaves the error as it is.
    """
    if label.group != "one":
        return None
    base = calibrate(case, roles=("calibrate", "validate"))
    ready, before = replace(case, model=base.model), held_out(base)
    names = set(unordered(label.right[0]))
    true = next((n for n in possible(case) if unordered(n) in names), None)
    best = held_out(add(ready, true)) if true else before
    claims = found["verdict"] in ("named", "group", "several") and found["groups"]
    if not claims:
        return {"before": before, "claimed": before, "best": best}
    first = found["groups"][0][0]
    claimed = best if first == true else held_out(add(ready, first))
    return {"before": before, "claimed": claimed, "best": best}


def possible(case: Case) -> list[str]:
    """Every effect of the catalogue that can sit somewhere in a case."""
    return [one.name for one in candidates(case)]


def held_out(done: Revision) -> float:
    """Error (K) after a revision on the held-out test."""
    return next(t.after for t in done.tests if t.role == "hold-out")


def followed(case: Case, label: Label, found: Answer) -> Answer | None:
    """The best test that is said to decide, carried out on the true machine, and what the diagnosis says then."""
    kind = KINDS[label.machine]
    said = [(name, factor) for name, gain, _, factor in found["next"] if gain >= DECISIVE and name in CANDIDATE_TESTS]
    if found["verdict"] != "group" or not said:
        return None
    name, factor = said[0]
    plan = carried_out(name, kind.plans[3], factor)
    (record,) = measured(kind, label.seed, hidden_in(kind, label), (plan,))
    longer = replace(case, tests=(test_of(kind, case.model.network, record), *case.tests))
    return {"test": name, **answer(longer, plan=False)}
