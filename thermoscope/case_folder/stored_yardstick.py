"""The plain models of a case, kept by the content of its tests: every comparison shows them."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from geom.disk_cache import recalled, store
from geom.storage import cache_folder
from measured.case import Case
from thermoscope.case_folder.content import code_digest, recorded_arrays
from validation.comparison.compare import Comparison
from validation.yardstick.terms import Term
from validation.yardstick.words import model_error, sentence, warning
from validation.yardstick.yardstick import Yardstick, yardstick


def yardstick_document(yard: Yardstick | None, comparison: Comparison) -> dict[str, Any]:
    """What plain models leave beside a model, for a document; empty where the tests teach nothing."""
    if yard is None:
        return {}
    words = {"sentence": sentence(yard, comparison), "warning": warning(yard, comparison)}
    return {"yardstick": {**yard.document(), "model_K": model_error(yard, comparison), **words}}


def stored_yardstick(case: Case) -> Yardstick | None:
    """From the cache, or learnt now; None where the tests teach nothing."""
    file = cache_folder() / f"yardstick-{_key(case)}.json"
    earlier = recalled(file, _read)
    if earlier is not None:
        return earlier
    new = yardstick(case)
    if new is not None:
        store(file, json.dumps(asdict(new)))
    return new


def _read(file: Path) -> Yardstick:
    document = json.loads(file.read_text(encoding="utf-8"))
    return Yardstick(**{**document, "terms": tuple(Term(**term) for term in document["terms"])})


def _key(case: Case) -> str:
    """Of all that a yardstick is made from: the readings, inputs and roles of the tests, and the nodes' capacities."""
    content = hashlib.sha256(code_digest("validation"))
    content.update(case.model.network.C.tobytes())
    for test in case.tests:
        channels = [(c.name, c.place) for c in test.channels]
        content.update(repr((test.name, test.role, [*test.inputs], [*test.boundaries], channels)).encode())
    for array in recorded_arrays(case.tests):
        content.update(np.ascontiguousarray(array, float).tobytes())
    return content.hexdigest()[:20]
