"""The observer in C: the estimates of Python, few bytes, no allocation."""

import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_case import small_case
from watched import run

from geom.errors import InputError
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import mean_rows
from thermoscope.export.model import Output
from thermoscope.export.observer_code import MOST_BYTES, CompiledObserver, observer_files, observer_model
from thermoscope.verification.error_budget import model_of
from validation.bands import parameter_posterior
from validation.observer import ProcessNoise, observer
from validation.observer.process import Process, bodies_of
from validation.observer.process_noise import of_doubt

WITHIN_K = 0.05
CODES = {"": 0, "lost": 1, "frozen": 2, "drifting": 3}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = load_case(small_case(tmp_path_factory.mktemp("code"), strength=0.0))
    network, values = model_of(folder)
    tests = [t for t in folder.case.tests if t.role == "calibrate"]
    table = of_doubt(parameter_posterior(folder.case), tests, bodies_of(network))
    process, noise = Process(network, values, bodies_of(network)), ProcessNoise(table, 1200.0)
    looks = [Output(n, r) for n, r in mean_rows(network).items()]
    return observer_model(process, noise, np.sqrt(np.diag(table)), 20.0, tests[0].channels, tests, looks)


@pytest.fixture(scope="module")
def code(made):
    return CompiledObserver(made)


def in_python(made, truth, y):
    one = observer(made.process, made.noise, made.table_sd, made.sensors, y[0], {"ambient": 20.0}, made.rise_K)
    samples, codes = [], []
    rows = [o.row for o in made.model.outputs]
    for s in one.follow(truth.record, y):
        samples.append([s.at(row)[0] for row in rows])
    codes = [CODES[state.dropped] for state in one.states]
    return np.array(samples), np.array(codes), one


@pytest.mark.parametrize("kind", ["good", "heat", "lost", "frozen", "drifting"])
def test_c_estimates_what_python_does(made, code, kind):
    """Single precision of the covariance, other steps of the mean: 0.05 K in all. The sensors dropped are the same."""
    truth = run(lambda t: 150.0 * (kind == "heat") * (t > 2000.0), seed=4)
    y, late = truth.y.copy(), truth.time > 3000.0
    y[late, 1] = {"lost": np.nan, "frozen": y[3000, 1]}.get(kind, y[late, 1])
    y[late, 1] += (kind == "drifting") * (truth.time[late] - 3000.0) / 60.0
    T, codes, one = in_python(made, truth, y)
    u = np.column_stack(
        [{"current_A": truth.current, "ambient": np.full(truth.time.size, 20.0)}[n] for n in made.given]
    )
    got, heat, dropped = code.run(truth.time, u, y)
    assert np.abs(got - T).max() < WITHIN_K
    assert np.abs(heat[-1] - one.filter.q).max() < 0.02 * np.abs(heat).max() + 1.0
    assert np.array_equal(dropped[-1], codes)


def test_it_fits_on_a_controller(made, code):
    assert code.bytes <= MOST_BYTES
    assert abs(code.bytes - made.bytes) <= 64


def test_an_observer_too_large_is_refused(made):
    sensors = [replace(made.sensors[0], name=f"T{i}") for i in range(60)]
    with pytest.raises(InputError, match="fewer sensors"):
        observer_model(made.process, made.noise, made.table_sd, 20.0, sensors, (), made.model.outputs)


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
