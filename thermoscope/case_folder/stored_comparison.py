"""The comparison of a machine's case, kept by content: it takes many runs, and every picture and page asks for it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from geom.arrays import Array
from geom.disk_cache import recalled, stored
from geom.storage import cache_folder
from lumped.condensation.error_budget import ErrorBudget, PlaceError
from thermoscope.case_folder.content import CaseWithFiles, result_key
from validation.comparison.compare import ChannelError, Comparison, TestError, compare, physical
from validation.comparison.predict import predict
from validation.comparison.uncertainty import Uncertainty
from validation.parameters.unknowns import standing


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
    tests = tuple(
        TestError(
            row["name"],
            row["role"],
            tuple(ChannelError(**c) for c in row["channels"]),
            tuple(Uncertainty(**u) for u in row["uncertainty"]),
        )
        for row in document["tests"]
    )
    budgets = {n: ErrorBudget(tuple(PlaceError(**p) for p in places)) for n, places in document["budgets"].items()}
    comparison = Comparison(folder.case.name, model.revision, effects, tests, model.network.identities)
    return StoredComparison(comparison, budgets, readings)
