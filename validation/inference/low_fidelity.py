"""Many runs of a diagnosis on the small network, whose readings are corrected to agree with the large one.

See `validation.comparison.reading_correction`; `fidelity_error` says how much is lost away from there.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from measured.case import Case
from validation.calibration.calibrate import calibrated, no_progress
from validation.comparison.reading_correction import corrected, reading_gaps
from validation.inference.decide import Posterior
from validation.inference.evidence import with_members
from validation.parameters.unknowns import working


def low_fidelity_case(case: Case, progress: Callable[[str], None] = no_progress) -> Case:
    """The case on its small network, corrected at the model's values; as it is where there is none.

    A model that was never calibrated is calibrated roughly first, and begins there, where the correction holds.
    """
    small = corrected(case, case.model.values)
    if small is case or case.model.values:
        return small
    training = small.training()
    network, unknowns = working(training)
    fit = calibrated(network, training.tests, unknowns, {}, 1, progress, rough=True)
    return corrected(replace(case, model=replace(case.model, values=fit.values)), fit.values)


def fidelity_error(case: Case, small: Case, posterior: Posterior) -> dict[str, float]:
    """Channel -> how far (K) the small network's prediction of the most probable hypothesis is from the large one's.

    small : of `low_fidelity_case`, which the posterior is about; no error where that is the case itself
    """
    if small is case:
        return {}
    e, h = posterior.evidence, posterior.best
    network, _, fixed = with_members(e, h.members)
    values = {**fixed, **(h.fit.values if h.fit else e.fit.values)}
    large = e.hypothesis(h.members).extend(working(case)[0])
    by_name = {t.name: t for t in case.tests}
    tests = [by_name[t.name] for t in e.tests]
    out: dict[str, float] = {}
    gaps = reading_gaps(large, tests, network, e.tests, values)
    for test, corrected_test, gap in zip(tests, e.tests, gaps, strict=True):
        for j, (c, less) in enumerate(zip(test.channels, corrected_test.channels, strict=True)):
            off = float(np.nanmax(np.abs(gap[:, j] - (c.y - less.y)), initial=0.0))
            out[c.name] = max(out.get(c.name, 0.0), off)
    return out
