"""The smallest amplitude of each effect that a diagnosis would see, found by hiding it and calibrating to the result.

A deviation and a threshold say too little: a large effect drives the calibrated parameters far, where they follow it
better than their tangents foretell, and a conductance added to a conductance shows less and less. So the effect is put
into the calibrated model, the model without it is calibrated to what that reads, and the amplitude is sought at which
the deviance left passes the threshold four times in five, and is not only a strain of priors.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geom.kept import written_whole
from lumped.multipliers import values_of
from lumped.network import Network
from validation.calibrate import WORTH, Fit, Known, minimise, silent, square_of
from validation.case import Test
from validation.effects import extended
from validation.evidence import Evidence
from validation.fitting import Unknowns, at_level
from validation.predict import predict
from validation.rivals import COMPENSATED, SILENT
from validation.score import POWER
from validation.side_by_side import side_by_side

Array = NDArray[np.float64]
CLOSE = 0.08  # of the level sought: far below the scatter of a score, which is one
ENOUGH = 0.1  # nats: far below what matters of some nine
TRIALS = 6
INSIDE = 0.98  # of a physical bound
SMALL = 1.0  # prior deviations


@dataclass(frozen=True)
class Search:
    """What every effect's search needs.  kappa : (n_effect,);  level : scaled score to be reached

    small : prior deviations of an effect below which its linear size is good enough
    """

    evidence: Evidence
    kappa: Array
    level: float
    small: float = SMALL


@dataclass(frozen=True)
class Left:
    """A deviance, and the part of it that the readings contribute; the rest is the strain of the priors."""

    deviance: float
    readings: float


def smallest_sizes(
    evidence: Evidence,
    kappa: Array,
    threshold: float,
    workers: int = 2,
    cache: Path | None = None,
    progress: Callable[[str], None] = silent,
) -> Array:
    """Smallest detectable amplitude (n_effect,) of every candidate, inf where none that physics allows would show."""
    search = Search(evidence, kappa, threshold + POWER)
    file = cache / f"sizes-{fingerprint(search)}.npz" if cache else None
    if file and file.exists():
        with np.load(file) as saved:
            return np.asarray(saved["sizes"], float)
    found = side_by_side(smallest, search, len(evidence.effects), workers, progress, "smallest detectable sizes")
    sizes = np.array(found, float)
    if file:
        with written_whole(file) as partial:
            np.savez(partial, sizes=sizes)
    return sizes


def fingerprint(search: Search) -> str:
    """Hash of what the sizes depend on."""
    e = search.evidence
    h = hashlib.sha256(repr((e.names, round(search.level, 6))).encode())
    for numbers in (e.fit.theta, search.kappa, e.score.V):
        h.update(np.float32(numbers).tobytes())
    return h.hexdigest()[:20]


def smallest(search: Search, k: int) -> float:
    """The amplitude at which effect k's scaled score reaches the level; by secants of score over amplitude in logs.

    The linear size where that is small against the effect's prior: a machine bends little over so small an effect
    (of such sizes half came out within 8 %, nine in ten within 60 %, on machines of the benchmark).
    """
    e, kappa = search.evidence, float(search.kappa[k])
    if not e.score.visible[k]:
        return float("inf")
    most = INSIDE * abs(e.parameters[k].low if e.score.sign[k] < 0 else e.parameters[k].high)
    linear = search.level * kappa * float(e.score.sd[k])
    if linear < search.small * e.parameters[k].prior_sd:
        return linear
    a, known, theta = min(linear, most), (0.0, 0.0), e.fit.theta
    for _ in range(TRIALS):
        left, theta = followed(e, k, a, theta)
        by_itself = np.inf if e.effects[k].fault else told(left)
        reached = min(float(np.sqrt(left.deviance)) / kappa, search.level * by_itself)
        if a >= most and reached < search.level:
            return float("inf")
        if abs(reached / search.level - 1.0) < CLOSE:
            break
        steep = np.log(reached / known[1]) / np.log(a / known[0]) if known[0] and a != known[0] else 1.0
        known = (a, reached)
        grow = float(np.clip((search.level / reached) ** (1.0 / np.clip(steep, 0.3, 2.0)), 0.2, 5.0))
        new = min(a * grow, most)
        theta = e.fit.theta + (theta - e.fit.theta) * (new / a)
        a = new
    return a


def told(left: Left) -> float:
    """How much of what the readings must say themselves they say: 1 is enough four times in five (see rivals.weak)."""
    if left.readings > COMPENSATED * left.deviance:
        return float("inf")
    return float(np.sqrt(left.readings)) / (SILENT**0.5 + POWER)


def followed(evidence: Evidence, k: int, amplitude: float, theta: Array) -> tuple[Left, Array]:
    """What is left when the model without effect k is calibrated to what the model with it reads; the calibration.

    amplitude : on the side physics allows;  theta : where to start.  The prior is centred on the calibrated state,
    which stands for the truth.
    """
    hidden = readings_with(evidence, {k: amplitude * (int(evidence.score.sign[k]) or 1)})
    found = recalibrated(evidence, hidden, theta, evidence.fit.unknowns, ENOUGH)
    own = square_of(found.parts, found.noise)
    return Left(max(2.0 * found.objective, 1e-12), max(own, 1e-12)), found.theta


def recalibrated(
    evidence: Evidence, tests: Sequence[Test], theta: Array, unknowns: Unknowns, worth: float = WORTH
) -> Fit:  # fmt: skip
    """The model without any effect calibrated to other readings of its tests, priors centred on where it stands.

    theta : where to start;  unknowns : those of the calibration, with other priors at most;  worth : as in `minimise`
    """
    fit = evidence.fit
    held = values_of(fit.network, fit.values)
    return minimise(fit.network, tests, unknowns, theta, fit.noise, held,
                    known=Known(evidence.parts_of([]), renewed=True), centre=fit.theta, worth=worth)  # fmt: skip


def readings_with(evidence: Evidence, amplitudes: dict[int, float]) -> list[Test]:
    """The tests as the calibrated model with some effects reads them, where there are readings."""
    fit, effects = evidence.fit, [evidence.effects[k] for k in amplitudes]
    network = at_level(extended(fit.network, effects), {e.name for e in effects}, evidence.tests)
    values = values_of(network, fit.values | {evidence.names[k]: a for k, a in amplitudes.items()})
    return [_reading(network, test, values) for test in evidence.tests]


def _reading(network: Network, test: Test, values: dict[str, float]) -> Test:
    y = predict(network, test, values).y
    own = (np.where(np.isfinite(c.y), y[:, j], np.nan) for j, c in enumerate(test.channels))
    return replace(test, channels=tuple(replace(c, y=seen) for c, seen in zip(test.channels, own, strict=True)))
