"""Under the noise of a good model: what held in one test or for a while must not pass for noise of them all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from measured.case import Test
from measured.doubt import USUAL
from validation.calibration.calibrate import Fit
from validation.inference.evidence import Evidence, continuation, under
from validation.noise import START, Level, Noise


def quiet_fit(fit: Fit, tests: Sequence[Test]) -> Fit:
    """A calibration under a noise no larger than is usual; the same where it is no larger."""
    noise = usual_noise(fit.noise)
    return fit if noise == fit.noise else continuation(fit, tests, noise, fit.parts)


def quiet(evidence: Evidence) -> Evidence:
    """The evidence under a noise no larger than is usual, calibrated under it; the same where it is no larger."""
    noise = usual_noise(evidence.fit.noise)
    return evidence if noise == evidence.fit.noise else under(evidence, noise)


def usual_noise(noise: Noise) -> Noise:
    """Every part of a noise no larger than a good model leaves."""
    return replace(noise, levels={name: at_most(level) for name, level in noise.levels.items()})


def at_most(level: Level) -> Level:
    """Levels are in units of the error that is usual for their record."""
    return replace(
        level,
        white=min(level.white, START.white),
        fast=min(level.fast, USUAL["fast"]),
        slow=min(level.slow, START.slow),
    )
