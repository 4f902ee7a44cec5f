"""Every kind of hypothesis keeps one promise: columns, signs and sizes of as many amplitudes, neutral at zero."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from two_bodies import bench

from validation.comparison.linearisation import segments
from validation.effects import effect
from validation.inference.evidence import calibrated_case, candidates, joined, scored
from validation.inference.hypotheses import NOTHING, Cause, Together, condition_prior, law_prior
from validation.inference.missing_heat import scan_heat
from validation.inference.refit import is_unreadable

LASTING, FAULT = "convection.constant@body", "sensor.bias@core"
CONDITION, LAW = "loss.constant@core in noon:600-1200s", "law@loss:heat|load>0.7"


@cache
def evidence():
    """A film, a sensor's fault, heat for a while and a law that is off, about one calibrated state."""
    case = bench((("noon", ((600.0, 1200.0),)),), 1.0)
    loaded = replace(case, tests=tuple(replace(t, inputs={"load": 0.5 + t.time / t.time[-1]}) for t in case.tests))
    e = scored(loaded, [effect(LASTING), effect(FAULT)], calibrated_case(loaded))
    more = {effect(CONDITION): condition_prior(0.01), effect(LAW): law_prior(0.5)}
    return joined(e, more, e.fit.values), scan_heat(e.fit, e.tests)


def hypotheses():
    """Each kind with a run that has its columns."""
    e, scan = evidence()
    few = Together(e.causes[:2], -3.0)
    return [(h, e.run) for h in (*e.causes, few, NOTHING)] + [(h, scan.run) for h in scan.hypotheses]


def test_there_is_every_kind():
    assert [h.name for h, _ in hypotheses()][:6] == [LASTING, FAULT, CONDITION, LAW, f"{LASTING} + {FAULT}", "nothing"]
    assert {h.name for h, _ in hypotheses()[6:]} == {"heat@body", "heat@core"}


@pytest.mark.parametrize("i", range(8))
def test_signs_sizes_and_columns_are_of_the_same_amplitudes(i):
    h, run = hypotheses()[i]
    assert h.sign.shape == h.scale.shape
    assert set(h.sign.tolist()) <= {-1, 0, 1}
    assert np.all(h.scale > 0.0)
    assert -50.0 < h.log_prior < 0.0
    for s, columns in zip(run.parts, h.columns(run), strict=True):
        assert columns.shape == (s.r.size, h.sign.size)


@pytest.mark.parametrize("i", range(8))
def test_a_network_with_a_hypothesis_at_zero_is_the_network_without(i):
    e, _ = evidence()
    h, _ = hypotheses()[i]
    larger = h.extend(e.fit.network)
    new = [q for q in larger.parameters if q.name in h.name.split(" + ")]
    assert len(new) in (0, len(h.sign)), "an amplitude each, or none where there is nothing to refit"
    for plain, also in zip(segments(e.fit.network, e.tests, e.fit.values), segments(larger, e.tests, e.fit.values)):
        np.testing.assert_allclose(also.r, plain.r, atol=1e-9)


@pytest.mark.parametrize("i", range(4))
def test_a_column_is_the_change_of_the_readings_by_a_small_amplitude(i):
    e, _ = evidence()
    cause = e.causes[i]
    assert isinstance(cause, Cause)
    step = 1e-3 * cause.parameter.prior_sd
    larger = cause.extend(e.fit.network)
    low, high = (segments(larger, e.tests, {**e.fit.values, cause.name: x}) for x in (0.0, step))
    for a, b, column in zip(low, high, cause.columns(e.run), strict=True):
        np.testing.assert_allclose((a.r - b.r) / step, column[:, 0], rtol=0.02, atol=0.02 * np.abs(column).max() + 1e-6)


def test_heat_of_unknown_cause_has_no_smaller_size_than_an_effect():
    """Readings without a residual speak against it as they do against an effect of the least usual size."""
    e, scan = evidence()
    still = [replace(s, r=np.zeros_like(s.r)) for s in e.fit.parts]
    for one in scan.read(still, e.fit.noise, np.zeros(e.p), e.fit.error):
        assert one.log_bayes < -1.0


def test_a_large_amplitude_is_weighed_whatever_its_tangent_says():
    """A joint at a fifth of its conductance bends the machine: its tangent may well point the other way."""
    case = bench((), 0.0)
    e = scored(case, candidates(case, ["contact", "blockage", "loss.constant"]), calibrated_case(case))
    large = {x.name for x in e.effects if x.large}
    assert any(a * u <= 0.0 for x, u in zip(e.effects, e.score.u, strict=True) for a in x.large)
    assert set(e.jumps) == large
    assert [n for n, x in zip(e.names, e.whole, strict=True) if np.isfinite(x)] == [n for n in e.names if n in large]


@pytest.mark.parametrize(
    ("name", "target", "excluded"),
    [
        ("input.offset@flow_l_min", "film:x", True),
        ("input.offset@flow_l_min in warm", "film:x", False),
        ("ambient.offset@room", "boundary:room", True),
        ("convection@flange", "convection@flange", False),
    ],
)
def test_a_record_off_by_all_that_bounds_allow_explains_nothing(name, target, excluded):
    """`add` refuses it, so no diagnosis may propose it; of one test's input, or of a film, the size is told."""
    amplitude = SimpleNamespace(targets=((target, 1.0),))
    evidence = SimpleNamespace(p=2, effects=[effect(name)], parameters=[amplitude])
    for at_bound in (True, False):
        fit = SimpleNamespace(at_bound=np.array([True, False, at_bound]))
        assert is_unreadable(evidence, [0], fit) == (excluded and at_bound)
