"""Do the tests contradict each other: which calibrated parameters would have to differ between them, and by how much?

Every parameter is let free in one test after the other, all else fitted anew, by the tangents of the joint fit with the
model error in account. What must differ by many standard deviations although no mass or joint can means that
conditions differed. Source: Chow 1960 (equal coefficients in two samples), here with priors.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from geom.table import TableRow
from lumped.model.network import Network, Parameter
from measured.case import Test
from measured.sensors.operators import head
from validation.calibration.calibrate import Fit
from validation.inference.score import fit_score
from validation.parameters.unknowns import parameter_words, to_value

FALSE = 0.05  # share of consistent cases in which some parameter of some test seems to differ
FAR = 5.0  # factor from which tangents tell no size


@dataclass(frozen=True)
class Difference(TableRow):
    """A parameter that would have to differ in one test.

    others, here : its value in the other tests and in this one;  sd : standard deviations between the two
    nats : log evidence gained;  possible : whether it physically can differ from test to test
    relative : whether it is a factor
    """

    parameter: str
    words: str
    test: str
    others: float
    here: float
    unit: str
    sd: float
    nats: float
    possible: bool
    relative: bool = False


@dataclass(frozen=True)
class Contradiction(TableRow):
    """All that would have to differ beyond the limit (standard deviations), most certain first.

    test : the one that stands against the others, "" for none;  words : the whole in one sentence
    """

    words: str
    test: str
    limit: float
    differences: tuple[Difference, ...]


def contradiction(fit: Fit, tests: Sequence[Test]) -> Contradiction:
    """Of a fit with its model error; cheap, nothing is run."""
    if len(tests) < 2:
        return Contradiction("there is one test only: nothing can contradict it", "", 0.0, ())
    rows = differences(fit)
    limit = -float(ndtri(0.5 * FALSE / max(len(rows), 1)))
    sure = tuple(sorted((d for d in rows if abs(d.sd) > limit), key=lambda d: -abs(d.sd)))
    return Contradiction(sentence(sure, len(tests)), sure[0].test if sure else "", limit, sure)


def differences(fit: Fit) -> list[Difference]:
    """Every parameter in every test, the others held together."""
    parts = [replace(s, J=np.column_stack([s.J, s.J])) for s in fit.parts]  # once for all tests, once for this one
    scores = fit_score(fit, parts, each_test=True)
    tests = list(dict.fromkeys(s.test for s in parts))
    each = [(q, test) for test in tests for q in fit.unknowns.parameters]
    rows = zip(each, fit.theta.tolist() * len(tests), scores.amplitude, scores.sd, scores.visible, strict=True)
    return [
        _row(fit.network, q, test, x, float(a), float(s))
        for (q, test), x, a, s, visible in rows
        if visible and head(q) not in ("initial", "delay")  # starts and clocks belong to one test anyhow
    ]


def _row(network: Network, q: Parameter, test: str, x: float, a: float, sd: float) -> Difference:
    z = a / sd
    wide = (a / q.prior_sd) ** 2
    nats = 0.5 * z**2 - 0.5 * float(np.log1p((q.prior_sd / sd) ** 2)) - 0.5 * wide / (1.0 + (q.prior_sd / sd) ** 2)
    here = float(np.clip(x + a, -20.0, 20.0)) if q.mapping == "log" else x + a
    law, power = parameter_words(q.name)
    words = f"{power} in the {law}" if power else law
    return Difference(
        q.name,
        words,
        test,
        to_value(q, x),
        to_value(q, here),
        q.unit,
        z,
        nats,
        can_differ(network, q),
        q.mapping == "log",
    )


def can_differ(network: Network, q: Parameter) -> bool:
    """Films, flows, losses, thermometers and mounting can be different from test to test; masses and joints cannot."""
    if head(q) != "thermal":
        return True
    links, sources = {x.name: x for x in network.links}, {x.name for x in network.sources}
    return all(
        t in sources or (t in links and (links[t].kind in ("film", "stream") or is_outer(network, links[t].places)))
        for t, _ in q.targets
    )


def is_outer(network: Network, places: tuple[str, str]) -> bool:
    """Does a link end at a boundary or a fluid?"""
    return any(p in network.boundaries or (p in network.places and network.places[p].kind == "fluid") for p in places)


def sentence(sure: Sequence[Difference], tests: int) -> str:
    """Which test stands against the others, what it would need that cannot be, and what can."""
    if not sure:
        return f"the {tests} tests agree: no calibrated parameter would have to differ between them"
    of_test = [d for d in sure if d.test == sure[0].test]
    fixed = max((d for d in of_test if not d.possible), key=lambda d: abs(d.sd), default=None)
    able = max((d for d in of_test if d.possible), key=lambda d: d.nats, default=None)
    clauses = []
    if fixed:
        clauses.append(
            f"it would need {needs(fixed)}, which cannot be: conditions differed, or something is missing there"
        )
    if able and able.nats > 0.0:
        clauses.append(f"{'or ' if fixed else 'it would need '}{needs(able)}, which can differ between tests")
    return f"{sure[0].test} contradicts the other tests: {'; '.join(clauses) or 'no parameter alone mends it'}"


def needs(d: Difference) -> str:
    """ "the film of joint to be 2.7 times theirs (6 standard deviations)"; beyond five times only the side is sure."""
    if d.relative:
        by = d.here / d.others
        size = (
            f"{by:.2g} times theirs"
            if 1.0 / FAR < by < FAR
            else "over five times theirs"
            if by > 1.0
            else "below a fifth of theirs"
        )
    else:
        size = f"{d.here - d.others:+.2g}{'' if d.unit == '1' else f' {d.unit}'} beside theirs"
    return f"the {d.words} to be {size} ({abs(d.sd):.1f} standard deviations)"
