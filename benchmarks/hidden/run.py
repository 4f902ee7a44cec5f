"""Cases through the diagnosis, one line each, in as many processes as wanted; what is done is not done again."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from joblib import Parallel, delayed

from hidden import odds
from hidden.after import followed, worth
from hidden.answer import answer
from hidden.cases import Label, edits_of, records_of
from hidden.folders import diagnosed, found_in, words_of
from hidden.peers import peers
from hidden.user import case_of
from scripts.published import add_lines, json_lines

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
