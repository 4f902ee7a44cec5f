"""HUST's measured motor: the rotor from the winding's and the stator's sensors alone, on profiles never used."""

from pathlib import Path

import numpy as np
import pytest

from extras.monitor.observer.kalman import of_doubt, thinned
from extras.monitor.observer.learning import design_of, taught, unsettled
from extras.monitor.observer.process import bodies_of
from thermoscope.case_folder.folder import load_case
from validation.comparison.error_budget import model_of
from validation.comparison.predict import predict, record

pytestmark = pytest.mark.nightly

HUST = Path(__file__).parents[4] / "cases" / "hust-ipmsm"


def over(design, test, measured):
    """Samples of an observer along a test, from some of its sensors."""
    test = thinned(test)
    course, sensors = record(test, {}), [c for c in test.channels if c.name in measured]
    y = np.column_stack([c.y for c in sensors])
    around = {b: float(np.asarray(u, float).flat[0]) for b, u in course.boundaries.items()}
    return list(design.started(sensors, y[0], around).follow(course, y))


@pytest.fixture(scope="module")
def errors():
    """Profile -> (open loop, observer): errors (K) of the rotor, on profiles that nothing has learned from."""
    folder = load_case(HUST)
    network, values = model_of(folder)
    tests, bodies, doubt = (
        [t for t in folder.case.tests if t.role == "calibrate"],
        bodies_of(network),
        folder.case.doubt,
    )
    table = of_doubt(unsettled(folder.case), tests, bodies)
    design = design_of(network, values, taught(network, values, bodies, table, tests, doubt), tests, doubt)
    out = {}
    for test in (t for t in folder.case.tests if t.role == "hold-out"):
        j = [c.name for c in test.channels].index("rotor")
        rotor = test.channels[j]
        samples = over(design, test, ("winding", "stator"))
        plain = rotor.y - predict(network, test, values).y[:, j]
        out[test.name] = np.column_stack([plain, rotor.y - [s.at(rotor.row)[0] for s in samples]])
    return out


def rms(x):
    return float(np.sqrt(np.nanmean(x**2)))


def test_the_rotor_is_known_better_than_without_sensors(errors):
    """At least 30 % below the open loop, which even knows where the rotor starts."""
    assert set(errors) == {"id_5", "id_8", "id_11", "id_15"}
    free, observed = np.concatenate([*errors.values()]).T
    assert rms(observed) < 0.7 * rms(free)
