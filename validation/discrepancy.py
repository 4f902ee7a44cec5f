"""Where a comparison fails: whiteness, inputs the error follows, and the heat that would mend it."""

from collections.abc import Callable
from dataclasses import dataclass

from geom.one_thread import one_blas_thread
from measured.case import Case
from validation.calibration.calibrate import no_progress
from validation.comparison.compare import physical
from validation.comparison.linearisation import segments
from validation.comparison.residuals import Pattern, patterns
from validation.inference.contradiction import Contradiction, contradiction
from validation.inference.evidence import calibrated_case, quiet_fit
from validation.inference.low_fidelity import low_fidelity_case
from validation.inference.missing_heat import MissingHeat, missing_heat
from validation.inference.stretches import pulses
from validation.parameters.unknowns import standing


@dataclass(frozen=True)
class Discrepancy:
    """All rows of all tests, held-out ones too; heat : what would have to enter where, most evident first.

    contradiction : what would have to differ between the tests that are fitted
    """

    patterns: tuple[Pattern, ...]
    heat: tuple[MissingHeat, ...]
    contradiction: Contradiction

    def document(self) -> dict:
        return {
            "patterns": [p.document() for p in self.patterns],
            "where": [{**h.document(), "pulses": pulse_rows(h)} for h in self.heat],
            "contradiction": self.contradiction.document(),
        }


@one_blas_thread
def discrepancies(case: Case, progress: Callable[[str], None] = no_progress) -> Discrepancy:
    """The model as it stands; the scan for heat is made after calibration, or it would find what calibration mends."""
    network = standing(case)
    now = physical(case)
    left = patterns(segments(network, case.tests, now), case.tests)
    case = low_fidelity_case(case, progress)
    tests = case.usable
    fit = quiet_fit(calibrated_case(case, progress), tests)
    progress("looking for where heat is missing")
    return Discrepancy(tuple(left), tuple(missing_heat(fit, tests)), contradiction(fit, tests))


def pulse_rows(heat: MissingHeat) -> list[dict]:
    """Every stretch in which a missing-heat curve stands on another level: test, begin and end (s), W."""
    by_test = {test: pulses(*curve) for test, curve in heat.heat_W.items()}
    return [
        {"test": test, "begin_s": a, "end_s": b, "heat_W": level}
        for test, levels in by_test.items()
        for (a, b), level in levels
    ]
