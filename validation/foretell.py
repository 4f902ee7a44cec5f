"""What a planned test would decide: its readings as one candidate foretells them, explained by another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from validation.calibrate import Fit, minimise
from validation.case import Test
from validation.evidence import Evidence, with_members
from validation.fitting import Unknowns, nuisances
from validation.predict import predict
from validation.rivals import Race, behind
from validation.sheet import segments


def read_by(fit: Fit, test: Test) -> Test:
    """The test with the readings that a fitted model foretells."""
    standing = {p.name: p.value for p in fit.network.parameters}
    y = predict(fit.network, test, {**standing, **fit.values}).y
    return replace(test, channels=tuple(replace(c, y=y[:, j]) for j, c in enumerate(test.channels)))


def foretold(evidence: Evidence, found: Race, planned: Test, pair: tuple[int, int], kappa: float) -> float:
    """Deviance by which the wrong one of a pair would be behind with the planned test added, the smaller way.

    Unlike a gap in the tangents it counts what the tests at hand say already, and all that the wrong one may still
    bend: its own refit, with the start and the clock of the new test, meets noiseless readings of the right one.
    """
    return min(_behind(evidence, found, planned, right, wrong, kappa) for right, wrong in (pair, pair[::-1]))


def _behind(evidence: Evidence, found: Race, planned: Test, right: int, wrong: int, kappa: float) -> float:
    fits = dict(zip(found.index, found.fits, strict=True))
    new, rival = read_by(fits[right], planned), fits[wrong]
    network, unknowns, held = with_members(evidence, [wrong])
    known = {p.name for p in network.parameters}
    own = tuple(p for p in nuisances(network, [new]) if p.name not in known)
    network, free = replace(network, parameters=(*network.parameters, *own)), (*unknowns.parameters, *own)
    here = {**held, **{p.name: p.value for p in own}, **rival.values}
    near = [replace(s, J=np.pad(s.J, ((0, 0), (0, len(own))))) for s in rival.parts]
    near += segments(network, [new], here, free)
    theta, tests = np.concatenate([rival.theta, np.zeros(len(own))]), (*evidence.tests, new)
    fit = minimise(network, tests, Unknowns(free), theta, found.noise, held, start=near)
    return behind(fit, fits[right], kappa)
