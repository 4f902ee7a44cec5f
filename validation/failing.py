"""Where a comparison fails: uncertainty, whiteness, inputs the error follows, and the heat that would mend it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from validation.calibrate import silent
from validation.case import Case
from validation.compare import physical
from validation.fitting import working
from validation.inference.evidence import calibrated_case, diagnosing
from validation.residuals import Pattern, patterns
from validation.sheet import segments
from validation.threads import one_blas_thread
from validation.uncertainty import Uncertainty, uncertainties
from validation.where import Latent, latent_heat


@dataclass(frozen=True)
class Failing:
    """All rows of all tests, held-out ones too; heat : what would have to enter where, most evident first."""

    uncertainty: tuple[Uncertainty, ...]
    patterns: tuple[Pattern, ...]
    heat: tuple[Latent, ...]

    def document(self) -> dict:
        return {
            "uncertainty": [u.document() for u in self.uncertainty],
            "patterns": [p.document() for p in self.patterns],
            "where": [h.document() for h in self.heat],
        }


@one_blas_thread
def failing(case: Case, progress: Callable[[str], None] = silent) -> Failing:
    """The model as it stands; the scan for heat is made after calibration, or it would find what calibration mends."""
    network, _ = working(case)
    now = physical(case.model.values)
    progress("moving every input by its uncertainty")
    rows = tuple(u for test in case.tests for u in uncertainties(network, test, now))
    left = patterns(segments(network, case.tests, now), case.tests)
    fit = calibrated_case(case, progress)
    progress("looking for where heat is missing")
    return Failing(rows, tuple(left), tuple(latent_heat(fit, diagnosing(case))))
