"""HUST's measured motor: the rotor from the winding's and the stator's sensors alone, on profiles never used."""

from pathlib import Path

import numpy as np
import pytest

from thermoscope.case_folder.folder import load_case
from thermoscope.verification.error_budget import model_of
from validation.bands import parameter_posterior
from validation.comparison.predict import predict
from validation.observer import ProcessNoise
from validation.observer.learning import learned, over, usual_rise
from validation.observer.process import Process, bodies_of
from validation.observer.process_noise import of_doubt

HUST = Path(__file__).parents[2] / "cases" / "hust-ipmsm"
TIME_S = 300.0  # what the calibration profiles choose among 300, 600, 1200 and 2400 s (docs/how-to/watch.md)


@pytest.fixture(scope="module")
def errors():
    """(open loop, observer): errors (K) of the rotor on the profiles that neither fit nor noise has seen."""
    folder = load_case(HUST)
    network, values = model_of(folder)
    process = Process(network, values, bodies_of(network))
    tests = [t for t in folder.case.tests if t.role == "calibrate"]
    table = of_doubt(parameter_posterior(folder.case), tests, process.bodies)
    noise = ProcessNoise(learned(process, tests, table, TIME_S).without(None, table), TIME_S)
    out = []
    for test in (t for t in folder.case.tests if t.role != "calibrate"):
        j = [c.name for c in test.channels].index("rotor")
        rotor = test.channels[j]
        _, samples = over(process, noise, test, ("winding", "stator"), usual_rise(tests))
        plain = rotor.y - predict(network, test, values).y[:, j]
        out.append(np.column_stack([plain, rotor.y - [s.at(rotor.row)[0] for s in samples]]))
    return np.concatenate(out).T


def rms(x):
    return float(np.sqrt(np.nanmean(x**2)))


def test_the_rotor_is_known_better_than_without_sensors(errors):
    """At least 30 % below the open loop, which even knows where the rotor starts."""
    free, observed = errors
    assert rms(observed) < 0.7 * rms(free)
