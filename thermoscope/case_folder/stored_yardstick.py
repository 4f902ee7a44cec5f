"""The plain models of a case, kept by the content of its tests: every comparison shows them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from geom.disk_cache import recalled, store
from geom.storage import cache_folder
from measured.case import Case
from thermoscope.case_folder.content import code_digest, digest, recorded_arrays
from validation.comparison.compare import Comparison
from validation.effects.build import links_between
from validation.parameters.unknowns import standing
from validation.yardstick.suggestions import suggested_effects
from validation.yardstick.terms import Term
from validation.yardstick.words import model_error, sentence, warning
from validation.yardstick.yardstick import Yardstick, yardstick

FEW = 3  # of what is lacking in a sentence


def yardstick_document(yard: Yardstick | None, comparison: Comparison, case: Case) -> dict[str, Any]:
    """What plain models leave beside a model, for a document; empty where the tests teach nothing."""
    if yard is None:
        return {}
    words = {"sentence": sentence(yard, comparison), "warning": warning(yard, comparison)}
    network = standing(case)
    of_file = {x.name for x in case.model.network.links}
    lacking = [
        s.document()
        for s in suggested_effects(yard.terms, case)
        if all(x.name in of_file for x in links_between(network, s.place, s.other))  # none was added
    ]
    return {"yardstick": {**yard.document(), "model_K": model_error(yard, comparison), "lacking": lacking, **words}}


def lacking_words(document: Mapping[str, Any]) -> str:
    """What a free network has and the model lacks, as a sentence; "" where nothing, or where it predicts no better."""
    yard = document.get("yardstick", {})
    best = yard.get("free_network_K") or float("inf")
    each = [row["words"] for row in yard.get("lacking", [])][:FEW] if best < yard.get("model_K", 0.0) else []
    return f"The free network has what the model lacks: {'; '.join(each)}." if each else ""


def stored_yardstick(case: Case) -> Yardstick | None:
    """From the cache, or learnt now; None where the tests teach nothing.

    Its key is of all that a yardstick is made from: readings, inputs and roles of the tests, the nodes' capacities.
    """
    tests = [
        (t.name, t.role, [*t.inputs], [*t.boundaries], [(c.name, c.place) for c in t.channels]) for t in case.tests
    ]
    key = digest(code_digest("validation"), case.model.network.C, tests, *recorded_arrays(case.tests))
    file = cache_folder() / f"yardstick-{key}.json"
    yard = recalled(file, _read)
    if yard is None and (yard := yardstick(case)) is not None:
        store(file, json.dumps(asdict(yard)))
    return yard


def _read(file: Path) -> Yardstick:
    document = json.loads(file.read_text(encoding="utf-8"))
    return Yardstick(**{**document, "terms": tuple(Term(**term) for term in document["terms"])})
