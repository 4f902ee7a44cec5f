"""Every case that comes along, exported once: C, FMU, JSON and MAT run as `simulate` does."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from test_export_code import CASES
from test_export_fmu import Slave, solver

from extras.export.c_code import c_files
from extras.export.compilers import AGREES_K, Compiled, difference, sampled, signals_of
from extras.export.document import document
from extras.export.fmu import sources
from extras.export.model import exported
from extras.monitor.observer.process import Process
from lumped.integration.simulate import initial_state, simulate
from thermoscope.case_folder.folder import load_case
from thermoscope.console.terminal import plain
from validation.comparison.error_budget import model_of
from validation.comparison.predict import record

HOUR = 3600.0
INSTANTS = 5  # of a record, at which a JSON model is looked at
FILES = sorted(f for f in CASES.rglob("case.toml") if "[tests." in f.read_text(encoding="utf-8"))


def parameter(file):
    """A case with a machine takes half a minute: its mesh and network are of full size. tclab's is the smallest."""
    marks = [] if file.parent.name == "tclab" else [pytest.mark.nightly]
    return pytest.param(str(file.parent.relative_to(CASES)), marks=marks)


@pytest.fixture(scope="module", params=[parameter(file) for file in FILES])
def shipped(request):
    """A case with its exported model."""
    folder = load_case(CASES / request.param)
    network, values = model_of(folder)
    return SimpleNamespace(network=network, values=values, model=exported(folder, {}), tests=folder.case.tests)


def test_c_fmu_and_json_agree(shipped):
    """C over every test; FMU of both versions: the same C; JSON and so .mat: the same heat into every state."""
    network, values, model = shipped.network, shipped.values, shipped.model
    code, records = Compiled(model), [sampled(record(t, {})) for t in shipped.tests]
    assert max(difference(code, network, given, values) for given in records) < AGREES_K
    for version in (2, 3):
        assert c_files(model).items() <= sources(model, version).items()
    said = json.loads(json.dumps(plain(document(model))))
    assert max(heat_apart(said, model, network, given, values) for given in records) < AGREES_K


def test_it_runs_in_fmpy(shipped, tmp_path):
    """Its shortest test, sample by sample: what `simulate` says, within 0.05 K."""
    network, values, model = shipped.network, shipped.values, shipped.model
    given = sampled(record(min(shipped.tests, key=lambda t: t.time.size), {}))
    run, u = simulate(network, given, values, [o.row for o in model.outputs]), signals_of(model, given)
    own = Slave(model, tmp_path, initial_state(network, given.initial), u[0]).over(given.time, u)
    assert np.abs(own - run.y).max() < AGREES_K


def heat_apart(said, model, network, given, values):
    """By how much (K) the heat flows of a JSON model shift a state in an hour, largest over some instants of a run."""
    process = Process(network, values, ())
    by, z = process.driven(given), simulate(network, given, values, keep_states=True).z
    u, out = signals_of(model, given), 0.0
    for k in np.linspace(1, given.time.size - 1, INSTANTS).astype(int):
        x, names = z[k, : len(network.states)], [s.name for s in model.signals]
        F, G = process._at(by.core, x, by.u[k], by.factor[k])
        off = solver().flow(said, x, dict(zip(names, u[k], strict=True))) - F
        out = max(out, float(np.abs(np.linalg.solve(np.diag(by.core.C) / HOUR + G, off)).max()))
    return out
