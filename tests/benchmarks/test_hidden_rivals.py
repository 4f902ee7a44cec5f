"""What a hidden effect could be taken for, on one true machine: a water-jacket motor with few candidates."""

import numpy as np
import pytest
from hidden.kinds import KINDS
from hidden.rivals import differences, gaps, reference
from hidden.truth.archetype import measured
from hidden.truth.change import NOTHING
from hidden.user import case_of
from validation.detectable import readings_with
from validation.evidence import calibrated_case, candidates, scored

SEED = 900001
WIND, MAGNETS = "convection@housing", "loss.rotor@magnets"
TAKES = "calibrated loss.magnets"


@pytest.fixture(scope="module")
def on():
    case = case_of("reference", "jacket", measured(KINDS["jacket"], SEED, NOTHING))
    few = candidates(case, ["convection", "loss.rotor", "windage", "sensor.gain"])
    return reference("jacket", SEED, scored(case, few, calibrated_case(case)))


@pytest.fixture(scope="module")
def change():
    return {h.name: h.make for h in KINDS["jacket"].missing}


def test_nothing_hidden_moves_nothing(on):
    assert max(np.nanmax(np.abs(d)) for d in on.moved(NOTHING)) == 0.0
    same = differences(on.foretold(NOTHING), on.still)
    assert np.nanmax(np.abs(np.concatenate(same))) == 0.0


def test_the_catalogues_own_law_is_explained_by_its_own_name(on):
    """Readings that the model itself makes with an effect in it, in place of the machine's."""
    k = on.evidence.names.index(WIND)
    found = gaps(on.evidence, k, 6.0, readings_with(on.evidence, {k: 6.0}), 1.0)
    assert found
    assert min(found.values()) > 20.0


def test_wind_has_no_rival_among_few(on, change):
    k = on.evidence.names.index(WIND)
    assert min(gaps(on.evidence, k, 6.0, on.foretold(change[WIND](6.0)), 1.0).values()) > 20.0


def test_readings_as_they_are_logged_carry_what_every_model_gets_wrong(on, change):
    """The same wind moves both alike; what the calibrated model leaves stays in the logged ones."""
    hidden = change[WIND](6.0)
    left = differences(on.recorded(hidden), on.foretold(hidden))
    np.testing.assert_allclose(np.concatenate(left), np.concatenate(differences(on.evidence.tests, on.still)))


def test_a_calibrated_loss_takes_what_another_loss_of_the_same_part_does(on, change):
    """More loss in the magnets, by a power of speed near that of their declared loss: were that one's prior wrong, it
    would follow as well as the effect, and drags far."""
    k = on.evidence.names.index(MAGNETS)
    found = gaps(on.evidence, k, 40.0, on.foretold(change[MAGNETS](40.0)), 1.0)
    assert found[TAKES] < min(v for name, v in found.items() if name != TAKES)
    assert found[TAKES] < 20.0


def test_deviance_is_in_units_of_the_scatter(on, change):
    k = on.evidence.names.index(WIND)
    tests = on.foretold(change[WIND](6.0))
    one, two = (gaps(on.evidence, k, 6.0, tests, kappa) for kappa in (1.0, 2.0))
    assert {n: v / 4.0 for n, v in one.items()} == pytest.approx(two, abs=0.01)
