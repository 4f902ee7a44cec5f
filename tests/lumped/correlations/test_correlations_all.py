"""What every correlation must do, by one test each over all of them; a new one without a case fails here."""

import inspect
import re
import warnings

import numpy as np
import pytest
from correlation_cases import AIR, CARRY_UNITS, CASES, GLYCOL, Units, declared
from test_correlations_worked import WORKED

from lumped.correlations import Info, RangeWarning

OTHER = Units(m=3.0, s=0.25, kg=7.0, K=1.7)
EVERY = sorted(declared())


@pytest.fixture
def in_silence():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


def test_every_correlation_has_a_case_and_a_worked_value():
    assert set(CASES) == set(WORKED) == set(EVERY)


@pytest.mark.parametrize("name", EVERY)
def test_dimensions_fit(name, monkeypatch, in_silence):
    """In other units of length, time, mass and temperature it gives the same answer, in air and in glycol."""
    case = CASES[name]
    here = [case.run(fluid, Units())[0] for fluid in (AIR, GLYCOL)]
    for (module, constant), scaled in {at: of(OTHER) for at, of in CARRY_UNITS.items()}.items():
        monkeypatch.setattr(module, constant, scaled)
    there = [case.run(fluid, OTHER)[0] for fluid in (AIR, GLYCOL)]
    assert there == pytest.approx([h * case.gives(OTHER) for h in here], rel=1e-9)


@pytest.mark.parametrize("name", EVERY)
def test_outside_its_range_it_warns_with_value_and_range(name):
    with pytest.warns(RangeWarning, match=r"= \S+ outside \S+ to \S+ \("):
        _, info = CASES[name].outside()
    assert isinstance(info, Info)
    assert info.outside


@pytest.mark.parametrize("name", EVERY)
def test_it_runs_one_way_without_a_jump_across_its_regimes(name, in_silence):
    """Of 8000 equal steps none turns back, and none is larger than 2 % of the whole: a root at 0 takes that much."""
    case = CASES[name]
    value = np.array([case.sweep(x) for x in np.linspace(0.0, case.top, 8001)])
    steps = np.diff(value) * np.sign(value[-1] - value[0])
    assert np.all(steps >= -1e-12 * np.abs(value[1:]))
    assert steps[1:].max() <= 0.02 * np.abs(value).max()


@pytest.mark.parametrize("name", EVERY)
def test_at_rest_it_has_the_right_limit(name, in_silence):
    """Conduction through the gap, the shape's still Nusselt number, or nothing; and it is reached, not jumped to."""
    case = CASES[name]
    assert case.sweep(0.0) == pytest.approx(case.rest, rel=1e-6, abs=1e-12)
    nearly, top = case.sweep(1e-12 * case.top), abs(case.sweep(case.top))
    assert nearly == pytest.approx(case.rest, abs=0.01 * top)


@pytest.mark.parametrize("name", EVERY)
def test_it_names_source_and_range(name, in_silence):
    """A source with a year (or a law of nature) in docstring and answer, and limits; sets of a law share its own."""
    info = WORKED[name][0]()[1]
    text = (inspect.getdoc(declared()[name]) or "") + (inspect.getdoc(declared().get(info.name)) or "")
    assert info.limits
    assert re.search(r"(18|19|20)\d\d|Stefan", text)
    assert re.search(r"[Ss]ource:|et al\.|Stefan", text)
    assert re.search(r"Range:|Range \(", text)
    assert re.search(r"(18|19|20)\d\d|Stefan", info.source)
