"""What scores are held against: the simulated null where nothing drags the calibration, and the smallest sizes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from validation.calibrate import Fit, silent
from validation.case import Case
from validation.detectable import smallest_sizes
from validation.evidence import Evidence, null_of, scored
from validation.null import Null
from validation.rivals import leading

SUSPECT = 3.0  # formal deviations


@dataclass(frozen=True)
class Bar:
    """sizes : effect -> smallest detectable amplitude in its unit;  refits : of the candidates that scored best"""

    null: Null
    sizes: Mapping[str, float]
    refits: Mapping[int, Fit] = field(default_factory=dict)

    @cached_property
    def threshold(self) -> float:
        return self.null.threshold()


@dataclass(frozen=True)
class Simulation:
    """draws : of the null;  cache : folder of nulls and sizes that were made before"""

    draws: int = 60
    seed: int = 0
    workers: int = 2
    cache: Path | None = None


def bar_of(
    case: Case, evidence: Evidence, how: Simulation, sizes: bool = False, progress: Callable[[str], None] = silent
) -> Bar:
    """The bar for a model and its tests.

    sizes : search the smallest sizes; without it they are linear, often a tenth and at times several times too small
    """
    leaders = leading(evidence, np.ones(len(evidence.effects)), SUSPECT, progress)
    evidence = undisturbed(case, evidence, leaders) if leaders else evidence
    null = null_of(evidence, how.draws, how.seed, how.workers, how.cache, progress)
    limit = null.threshold()
    found = (
        smallest_sizes(evidence, null.kappa, limit, how.workers, how.cache, progress)
        if sizes
        else evidence.score.detectable(null.kappa, limit)
    )
    return Bar(null, dict(zip(evidence.names, found.tolist(), strict=True)), leaders)


def undisturbed(case: Case, evidence: Evidence, leaders: Mapping[int, Fit]) -> Evidence:
    """The evidence at the state that the calibration reaches once the best candidate is in the model, without it.

    A missing effect drags the calibrated parameters along. What the machine looks like when nothing is missing, and how
    small an effect would show, is asked where they stand without that.
    """
    best = min(leaders.values(), key=lambda fit: fit.objective)
    return scored(case, evidence.effects, replace(evidence.fit, theta=best.theta[: evidence.fit.theta.size]))
