"""The comparison of a machine's case and its plain models, kept by content: every picture and page asks for them."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from geom.arrays import Array
from geom.disk_cache import recalled, store, stored
from geom.storage import cache_folder
from lumped.condensation.error_budget import ErrorBudget, PlaceError
from measured.case import Case
from thermoscope.case_folder.content import CaseWithFiles, code_digest, digest, recorded_arrays, result_key
from validation.comparison.compare import ChannelError, Comparison, TestError, compare, physical
from validation.comparison.predict import predict
from validation.comparison.uncertainty import Uncertainty
from validation.effects.build import links_between
from validation.parameters.unknowns import standing
from validation.yardstick.suggestions import suggested_effects
from validation.yardstick.terms import Term
from validation.yardstick.words import model_error, sentence, warning
from validation.yardstick.yardstick import Yardstick, yardstick


class BudgetedCase(CaseWithFiles, Protocol):
    """An open case with what mesh, condensation and time steps may put wrong.  numeric_K : test -> channel -> sum"""

    @property
    def budgets(self) -> Mapping[str, ErrorBudget]: ...
    @property
    def numeric_K(self) -> Mapping[str, Mapping[str, float]]: ...


@dataclass(frozen=True)
class StoredComparison:
    """comparison, budgets : as of Folder;  readings : test -> (n_time, n_channel) degC, what its sensors would read"""

    comparison: Comparison
    budgets: Mapping[str, ErrorBudget]
    readings: Mapping[str, Array]


def stored_comparison(folder: CaseWithFiles) -> StoredComparison | None:
    """From the cache; None where this very model was not compared before, and for a network declared by hand."""
    return None if folder.built is None else recalled(_file(folder), lambda path: _read(folder, path))


def new_comparison(folder: BudgetedCase) -> Comparison:
    """Run the model on every test, and keep what comes of it. Networks declared by hand are quick and are not kept."""
    result = compare(folder.case, budgets=folder.numeric_K)
    if folder.built is not None:
        network, values = standing(folder.case), physical(folder.case)
        readings = [predict(network, test, values).y for test in folder.case.tests]  # the runs are remembered
        budgets = {name: [asdict(p) for p in budget.places] for name, budget in folder.budgets.items()}
        document = {"tests": [asdict(test) for test in result.tests], "budgets": budgets}
        with stored(_file(folder)) as partial:
            np.savez_compressed(partial, json.dumps(document), *readings)
    return result


def _file(folder: CaseWithFiles) -> Path:
    return cache_folder() / f"comparison-{result_key(folder)}.npz"


def _read(folder: CaseWithFiles, file: Path) -> StoredComparison:
    with np.load(file) as archive:
        document = json.loads(str(archive["arr_0"]))
        readings = {test.name: archive[f"arr_{i}"] for i, test in enumerate(folder.case.tests, 1)}
    model, effects = folder.case.model, tuple(e.name for e in folder.case.model.effects)
    tests = []
    for row in document["tests"]:
        channels, doubts = (ChannelError(**c) for c in row["channels"]), (Uncertainty(**u) for u in row["uncertainty"])
        tests.append(TestError(row["name"], row["role"], tuple(channels), tuple(doubts)))
    budgets = {n: ErrorBudget(tuple(PlaceError(**p) for p in places)) for n, places in document["budgets"].items()}
    comparison = Comparison(folder.case.name, model.revision, effects, tuple(tests), model.network.identities)
    return StoredComparison(comparison, budgets, readings)


FEW = 3  # of what is lacking in a sentence


def yardstick_document(yard: Yardstick | None, comparison: Comparison, case: Case) -> dict[str, Any]:
    """What plain models leave beside a model, for a document; empty where the tests teach nothing."""
    if yard is None:
        return {}
    words = {"warning": warning(yard, comparison), "sentence": sentence(yard, comparison)}
    network = standing(case)
    of_file = {x.name for x in case.model.network.links}
    lacking = [
        s.document()
        for s in suggested_effects(yard.terms, case)
        if all(x.name in of_file for x in links_between(network, s.place, s.other))  # none was added
    ]
    return {"yardstick": {**words, **yard.document(), "model_K": model_error(yard, comparison), "lacking": lacking}}


def yardstick_words(document: Mapping[str, Any]) -> str:
    """What plain models leave, and what a free network has and the model lacks where it predicts better; "" of none."""
    yard = document.get("yardstick", {"sentence": ""})
    best = yard.get("free_network_K") or float("inf")
    each = [row["words"] for row in yard.get("lacking", [])][:FEW] if best < yard.get("model_K", 0.0) else []
    lacking = f" The free network has what the model lacks (in brackets: a test left out): {'; '.join(each)}."
    return str(yard["sentence"]) + lacking * bool(each)


def stored_yardstick(case: Case) -> Yardstick | None:
    """From the cache, or learnt now; None where the tests teach nothing.

    Its key is of all that a yardstick is made from: readings, inputs and roles of the tests, the nodes' capacities.
    """
    tests = [
        (t.name, t.role, [*t.inputs], [*t.boundaries], [(c.name, c.place) for c in t.channels]) for t in case.tests
    ]
    key = digest(code_digest("validation"), case.model.network.C, tests, *recorded_arrays(case.tests))
    file = cache_folder() / f"yardstick-{key}.json"
    yard = recalled(file, _read_yardstick)
    if yard is None and (yard := yardstick(case)) is not None:
        store(file, json.dumps(asdict(yard)))
    return yard


def _read_yardstick(file: Path) -> Yardstick:
    document = json.loads(file.read_text(encoding="utf-8"))
    return Yardstick(**{**document, "terms": tuple(Term(**term) for term in document["terms"])})
