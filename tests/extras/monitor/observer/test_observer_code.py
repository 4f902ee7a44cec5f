"""The observer in C: the estimates of Python, few bytes, no allocation."""

import json
import re
import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from compiled_observer import CompiledObserver
from small_case import small_case
from watched import run

from extras.export.model import Output
from extras.monitor.commands import observer as command
from extras.monitor.observer import ProcessNoise, observer
from extras.monitor.observer.kalman import of_doubt
from extras.monitor.observer.process import Process, bodies_of
from extras.monitor.observer_code import MOST_BYTES, observer_files, observer_model
from geom.errors import InputError
from lumped.integration.simulate import simulate
from lumped.model.network import Network
from lumped.transfer.laws import Fixed
from measured.case import LowFidelity, Reference
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import mean_rows
from validation.bands import parameter_posterior
from validation.comparison.error_budget import model_of
from validation.comparison.predict import record
from validation.parameters.reference import reference_of

pytestmark = pytest.mark.heavy

WITHIN_K = 0.05  # with the covariance in single precision
SAME_K = 1e-6  # and in double: the same arithmetic
DOUBLE = ("-DTHERMAL_COVARIANCE=double",)
BIAS_K = (0.2, -0.1, 0.3)  # what the sensors were learned to read too much
NONE = SimpleNamespace(sections=(), points=())  # of a machine and a mesh: the key of what is kept looks at them
CODES = {"": 0, "lost": 1, "frozen": 2, "drifting": 3}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = load_case(small_case(tmp_path_factory.mktemp("code"), strength=0.0))
    network, values = model_of(folder)
    tests = [t for t in folder.case.tests if t.role == "calibrate"]
    table = of_doubt(parameter_posterior(folder.case), tests, bodies_of(network))
    process, noise = Process(network, values, bodies_of(network)), ProcessNoise(table, 1200.0)
    looks = [Output(n, r) for n, r in mean_rows(network).items()]
    given = tests[0].channels
    ranges = reference_of(network, tests)
    return observer_model(process, noise, 20.0, given, ranges, looks, np.array(BIAS_K))


@pytest.fixture(scope="module")
def code(made):
    return CompiledObserver(made)


@pytest.fixture(scope="module")
def precise(made):
    return CompiledObserver(made, DOUBLE)


def in_python(made, truth, y):
    one = observer(made.process, made.noise, made.sensors, y[0], {"ambient": 20.0}, made.rise_K, made.bias)
    samples, codes = [], []
    rows = [o.row for o in made.model.outputs]
    for s in one.follow(truth.record, y):
        samples.append([s.at(row)[0] for row in rows])
    codes = [CODES[state.dropped] for state in one.states]
    return np.array(samples), np.array(codes), one


def readings_of(kind):
    """A machine, and what its sensors read of it; the yoke's fails from 3000 s on."""
    truth = run(lambda t: 150.0 * (kind == "heat") * (t > 2000.0), seed=4)
    y, late = truth.y.copy(), truth.time > 3000.0
    y[late, 1] = {"lost": np.nan, "frozen": y[3000, 1]}.get(kind, y[late, 1])
    y[late, 1] += (kind == "drifting") * (truth.time[late] - 3000.0) / 60.0
    return truth, y


@pytest.mark.parametrize("kind", ["good", "heat", "lost", "frozen", "drifting"])
def test_c_estimates_what_python_does(made, code, precise, kind):
    """Temperatures, missing heat and the sensors that are dropped; to rounding where the covariance is in double."""
    truth, y = readings_of(kind)
    T, codes, one = in_python(made, truth, y)
    u = np.column_stack(
        [{"current_A": truth.current, "ambient": np.full(truth.time.size, 20.0)}[n] for n in made.input_names]
    )
    for compiled, T_K, q_W in ((precise, SAME_K, 1e-6), (code, WITHIN_K, 0.02 * np.abs(one.filter.q).max() + 1.0)):
        got, heat, dropped = compiled.run(truth.time, u, y)
        assert np.abs(got - T).max() < T_K
        assert np.abs(heat[-1] - one.filter.q).max() < q_W
        assert np.array_equal(dropped[-1], codes)


def test_it_fits_on_a_controller(made, code):
    assert code.bytes <= MOST_BYTES
    assert abs(code.bytes - made.bytes) <= 64


def test_an_observer_too_large_is_refused(made):
    sensors = [replace(made.sensors[0], name=f"T{i}") for i in range(60)]
    with pytest.raises(InputError, match="fewer sensors"):
        observer_model(made.process, made.noise, 20.0, sensors, Reference(), made.model.outputs)


def test_the_code_is_clean_c99_without_allocation(made, tmp_path):
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    for name, text in observer_files(made).items():
        Path(tmp_path, name).write_text(text)
    warned = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", "-O2", "-c", "thermal_observer.c"]
    done = subprocess.run(["gcc", *warned], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    used = subprocess.run(["nm", "-u", "thermal_observer.o"], cwd=tmp_path, capture_output=True, text=True).stdout
    assert not {"malloc", "calloc", "realloc", "free"} & set(used.split())


@dataclass(frozen=True)
class TwoNetworks:
    """What a folder has where a machine file was built."""

    network: Network
    small: Network
    machine: object
    mesh: object


def test_sensors_of_a_small_network_are_as_unsure_as_it_is_off_the_large_one(tmp_path, monkeypatch):
    """Links that are half as good again stand for shapes that are left out; the C code is told, and the document."""
    folder = load_case(small_case(tmp_path, strength=0.0))
    large = folder.case.model.network
    links = tuple(replace(x, law=Fixed(1.5 * x.law.value)) if x.name == "link:winding-yoke" else x for x in large.links)
    small = replace(large, links=links)
    rows = {(t.name, c.name): c.row for t in folder.case.tests for c in t.channels}
    case = replace(folder.case, low=LowFidelity(large, small, rows))
    both = replace(folder, case=case, built=TwoNetworks(large, small, NONE, NONE))
    monkeypatch.setattr("thermoscope.plugin.open_case", lambda name, tell: both)
    assert command.export_observer("three", tmp_path, {}, (), str(tmp_path / "said.json")) == 0

    one = next(t for t in case.tests if t.role == "calibrate")
    looks = [c.row for c in one.channels]
    apart = simulate(large, record(one, {}), {}, looks).y - simulate(small, record(one, {}), {}, looks).y
    off = np.sqrt(np.mean(apart**2, axis=0))
    assert off[0] > 1.0  # the winding's, else nothing is shown
    told = re.search(r"SENSOR_SD\[\] = \{(.*?)\}", (tmp_path / "thermal_observer_data.h").read_text())[1]
    sigma = np.array([float(x) for x in told.split(",")])
    assert sigma == pytest.approx(np.hypot([c.sigma_K for c in one.channels], off), rel=1e-6)
    gap = json.loads((tmp_path / "said.json").read_text())["small_network_K"]
    assert [gap[f"sensor {c.name}"] for c in one.channels] == pytest.approx(off.tolist(), rel=1e-6)
    assert gap["winding"] == pytest.approx(off[0], rel=1e-6)
