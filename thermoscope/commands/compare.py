"""thermoscope compare CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.commands.opened import opened
from thermoscope.terminal import give, progress, say, table


def compare(case: str, target: str | None) -> int:
    """Exit code 1 when a sensor is outside its uncertainty and outside the 4 % rule."""
    from validation.compare import compare as held_against

    with progress() as tell:
        folder = opened(case, tell)
        tell("running the model")
        result = held_against(folder.case)
    document = result.document()
    give(document, target, lambda: show(document))
    return 0 if result.agrees else 1


def show(document: Mapping[str, Any]) -> None:
    """A table per test, and the whole in one sentence."""
    headers = ["sensor", "place", "n", "rms (K)", "bias (K)", "largest (K)", "1 sigma (K)", "% of rise", "verdict"]
    keys = ["channel", "place", "n", "rmse_K", "bias_K", "max_abs_K", "sigma_K", "percent_of_rise", "verdict"]
    for test in document["tests"]:
        title = f"{test['name']} ({test['role']}): rms {test['rmse_K']:.2f} K"
        table(title, headers, [[c[k] for k in keys] for c in test["channels"]], marked=["over"])
    model, over = document["model"], [c for t in document["tests"] for c in t["channels"] if c["verdict"] == "over"]
    effects = f" with {', '.join(model['effects'])}" if model["effects"] else ""
    say(
        f"{document['case']}, revision {model['revision']}{effects}: rms {document['rmse_K']:.2f} K; the sensors' own "
        f"uncertainty explains {document['floor_K']:.2f} K; {len(over)} sensor records out of tolerance"
    )
