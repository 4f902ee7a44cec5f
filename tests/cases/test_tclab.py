"""The two measured heaters: what the files are, and what the exchange between them explains."""

from dataclasses import replace

import numpy as np
import pytest

from lumped.integration.simulate import simulate
from measured.case import AddedEffect
from thermoscope.case_folder.folder import load_case
from validation.calibration.calibrate import minimise
from validation.comparison.compare import compare
from validation.comparison.predict import record
from validation.parameters.unknowns import with_model, working
from validation.revision.revise import start

COOLED = (AddedEffect("convection.constant", "heater1"), AddedEffect("convection.constant", "heater2"))
EXCHANGE = AddedEffect("coupling", "heater1|heater2")


@pytest.fixture(scope="module")
def case(root):
    return load_case(root / "cases" / "tclab", bare=True).case


def test_the_bare_model_loses_nothing(case):
    """All the heat of the heaters stays in the two masses: 2 J/K each. 2 % covers the sum over instants."""
    test, net = case.tests[0], case.model.network
    z = simulate(net, record(test, {}), keep_states=True).z
    heat = 1.0 * test.inputs["heater1_percent"] / 100 + 0.75 * test.inputs["heater2_percent"] / 100
    assert 2.0 * float(np.sum(z[-1, :2] - z[0, :2])) == pytest.approx(np.trapezoid(heat, test.time), rel=0.02)


def fitted(case, effects):
    """Comparison after one fit of the case with some effects to all but the held-out recording."""
    grown = replace(case, model=replace(case.model, effects=tuple(effects)))
    network, unknowns = working(grown)
    tests = [t for t in case.tests if t.role != "hold-out"]
    fit = minimise(network, tests, unknowns, unknowns.coordinates(start(grown)), draft=True)
    return compare(with_model(grown, replace(grown.model, values=fit.values)))


def test_exchange_explains_what_the_second_heater_reads(case):
    """It warms before it is switched on. Below 1 K, the thermometers' accuracy; without the exchange above 1.5 K."""
    apart, joined = (
        [c.rmse_K for t in found.tests if t.role != "hold-out" for c in t.channels if c.channel == "T2"]
        for found in (fitted(case, COOLED), fitted(case, (*COOLED, EXCHANGE)))
    )
    assert min(apart) > 1.5
    assert max(joined) < 1.0
