"""The FMU passes the checker of FMPy and runs in it as `simulate` does; JSON and MAT with their solver too."""

import importlib.util
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.io import loadmat
from small_case import small_case
from test_export_code import curved, states

from extras.export.c_code import RUNTIME
from extras.export.compilers import AGREES_K, here, sampled, signals_of
from extras.export.document import document, mat
from extras.export.fmu import fmu, variables
from extras.export.model import exported, packed
from lumped.integration.simulate import initial_state, simulate
from measured.case import Reference
from thermoscope.case_folder.folder import load_case
from thermoscope.console.terminal import plain
from validation.comparison.error_budget import model_of
from validation.comparison.predict import record
from validation.parameters.unknowns import start_name

fmpy = pytest.importorskip("fmpy")


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    """The small case: its model, its first test as a record, and what `simulate` makes of it."""
    folder = load_case(small_case(tmp_path_factory.mktemp("export")))
    network, values = model_of(folder)
    given, model = sampled(record(folder.case.tests[0], {})), exported(folder, {"winding": 155.0})
    run = simulate(network, given, values, [o.row for o in model.outputs])
    return model, given, run.y, initial_state(network, given.initial)


def unpacked(model, version, folder):
    content, platforms = fmu(model, version, [here()])
    file = folder / f"model{version}.fmu"
    file.write_bytes(content)
    assert len(platforms) == 1
    return str(file)


@pytest.mark.parametrize("version", [2, 3])
def test_fmpy_checks_and_runs_it(three, version, tmp_path):
    """Inputs stand still within a communication step of 0.1 s, which costs up to a hundredth of a kelvin here."""
    from fmpy.validation import validate_fmu

    model, given, y, x0 = three
    file = unpacked(model, version, tmp_path)
    assert validate_fmu(file) == []
    u = signals_of(model, given)
    table = np.array(
        [(t, *row) for t, row in zip(given.time, u, strict=True)],
        dtype=[("time", float), *((s.name, float) for s in model.signals)],
    )
    starts = {f"start of {n}": float(x) for n, x in zip(model.states, x0, strict=True)}
    names = [o.name for o in model.outputs]
    seen = fmpy.simulate_fmu(
        file, stop_time=given.time[-1], output_interval=0.1, input=table, start_values=starts, output=names
    )
    own = np.column_stack([np.interp(given.time, seen["time"], seen[name]) for name in names])
    assert np.abs(own - y).max() < AGREES_K


def test_a_fitted_start_of_what_no_sensor_sees_is_exported(tmp_path):
    folder = load_case(small_case(tmp_path))
    test, plain = folder.case.tests[0].name, exported(folder, {})
    state = next(n for n, is_node in zip(plain.states, plain.node, strict=True) if is_node)
    model = replace(folder.case.model, values={start_name(state, test): 7.0}, reference=Reference(tests=(test,)))
    begun = exported(replace(folder, case=replace(folder.case, model=model)), {})
    each = {v.name: v.start for v in variables(begun)}
    assert each[f"start of {state}"] == pytest.approx(begun.initial_degC + 7.0)
    assert document(begun)["start_degC"][plain.states.index(state)] == each[f"start of {state}"]
    assert {v.start for v in variables(plain) if v.name.startswith("start of ")} == {plain.initial_degC}


class Slave:
    """An FMI 2.0 unit in FMPy, from its start on.  x0 (n_states,) degC, of which nodes are set;  u (n_signal,)"""

    def __init__(self, model, folder, x0, u):
        from fmpy.fmi2 import FMU2Slave

        file = unpacked(model, 2, folder)
        said = fmpy.read_model_description(file)
        at = {v.name: v.valueReference for v in said.modelVariables}
        self.unit = FMU2Slave(
            guid=said.guid,
            unzipDirectory=fmpy.extract(file, folder / "x"),
            instanceName="one",
            modelIdentifier=said.coSimulation.modelIdentifier,
        )
        self.ins, self.outs = [at[s.name] for s in model.signals], [at[o.name] for o in model.outputs]
        self.unit.instantiate()
        self.unit.setupExperiment()
        self.unit.enterInitializationMode()
        starts = {f"start of {n}": x for n, x in zip(model.states, x0, strict=True)}
        self.unit.setReal([at[n] for n in starts if n in at], [x for n, x in starts.items() if n in at])
        self.unit.setReal(self.ins, u)
        self.unit.exitInitializationMode()

    def over(self, time, u):
        """(n_time, n_output) degC, sample by sample; a jump is a step of no length."""
        y = [self.unit.getReal(self.outs)]
        for k, h in enumerate(np.diff(time)):
            y.append(stepped(self.unit, self.ins, self.outs, u, time, k) if h > 0.0 else y[-1])
        self.unit.terminate()
        self.unit.freeInstance()
        return np.array(y)


def test_stiff_steps_run_in_fmpy(tmp_path):
    """A node of a millionth of the other's capacity under 40 W, every temperature law, air that jumps by 15 K."""
    network, given = curved()
    model = packed(network, {}, Reference(), states(network))
    run, u = simulate(network, given, {}, [o.row for o in model.outputs]), signals_of(model, given)
    own = Slave(model, tmp_path, initial_state(network, given.initial), u[0]).over(given.time, u)
    assert np.abs(own - run.y).max() < AGREES_K


def test_fmi_2_with_slopes_of_inputs_takes_whole_samples(three, tmp_path):
    model, given, y, x0 = three
    u = signals_of(model, given)
    slave = Slave(model, tmp_path, x0, u[0])
    unit, ins, outs = slave.unit, slave.ins, slave.outs
    own = [unit.getReal(outs)]
    for k, h in enumerate(np.diff(given.time)):
        if k == 20:
            kept = unit.getFMUstate()
        if k == 30:  # back in time and on again
            unit.setFMUstate(kept)
            own = own[:21]
            for j in range(20, 30):
                own.append(stepped(unit, ins, outs, u, given.time, j))
        own.append(stepped(unit, ins, outs, u, given.time, k))
        assert h > 0
    assert np.abs(np.array(own) - y).max() < 0.01
    unit.terminate()
    unit.freeInstance()


def stepped(unit, ins, outs, u, time, k):
    h = time[k + 1] - time[k]
    unit.setReal(ins, u[k])
    unit.setRealInputDerivatives(ins, [1] * len(ins), (u[k + 1] - u[k]) / h)
    unit.doStep(time[k], h)
    return unit.getReal(outs)


def solver():
    made = importlib.util.spec_from_file_location("reference_solver", RUNTIME / "reference_solver.py")
    module = importlib.util.module_from_spec(made)
    made.loader.exec_module(module)
    return module


def test_the_reference_solver_runs_the_json(three):
    model, given, y, x0 = three
    said = json.loads(json.dumps(plain(document(model))))
    signals = dict(zip([s.name for s in model.signals], signals_of(model, given).T, strict=True))
    assert np.abs(solver().solve(said, given.time, signals, x0) - y).max() < AGREES_K


def test_json_says_the_same_flow_as_the_network():
    """All temperature laws: heat into every node at one state, against the terms' own formulas at 80 and 20 degC."""
    network, _ = curved()
    said = json.loads(json.dumps(plain(document(packed(network, {}, Reference(), states(network))))))
    F = solver().flow(said, np.array([80.0, 82.0]), {"air": 20.0})
    table = 0.2 * np.interp(60.0, [0, 1, 10, 100], [1, 2, 4, 6]) * 60.0
    film = 0.1 * np.interp(60.0, [0, 1, 10, 100], [1, 2, 4, 6]) * (1.0 + 0.05 * (50.0 + 60.0) / 20.0) * 60.0
    assert_allclose(F, [6.0 - table - film, 40.0 * (1.0 + 0.004 * 62.0) - 6.0], rtol=1e-9)


def test_mat_holds_the_json_with_columns_from_one(three, tmp_path):
    model, *_ = three
    (tmp_path / "model.mat").write_bytes(mat(model))
    held, said = loadmat(tmp_path / "model.mat", simplify_cells=True)["model"], document(model)
    assert_allclose(held["K0"], said["K0"])
    assert_allclose(held["C"], said["C"])
    terms = np.atleast_1d(held["terms"])
    assert [t["name"] for t in terms] == [t["name"] for t in said["terms"]]
    first, own = terms[0], said["terms"][0]
    assert_allclose(np.ravel(first["hot"]["col"]), own["hot"]["col"] + 1)
    assert first["factor"]["coefficient"] == own["factor"][0]["coefficient"]


def test_equal_models_give_equal_files(three):
    model, *_ = three
    assert fmu(model, 3, [here()])[0] == fmu(model, 3, [here()])[0]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--as", "hdf"), "'hdf' is not a form to export"),
        (("--as", "c", "--limit", "winding"), "'winding' is not a limit; PLACE=DEGC"),
        (("--as", "c", "--limit", "coil=155"), "no temperature 'coil' to limit"),
        (("--as", "fmu", "--fmi", "1"), "FMI 1 is not written; 2 or 3"),
    ],
)
def test_what_is_wrong_is_one_message(arguments, message, thermoscope, tmp_path):
    case = small_case(tmp_path)
    said = thermoscope("export", case, *arguments)
    assert said.code == 2
    assert message in said.err.splitlines()[-1]
    assert not (case / "out").exists()


ONLY_IN_TOWN = """
[[revision]]
number = 1
action = "add"
effect = "convection@flange in town"
effects = ["convection@flange in town"]
why = "by hand"
[revision.values]
"convection@flange in town" = 3.0
"""


def test_a_law_that_c_cannot_have_ends_with_exit_code_2(thermoscope, tmp_path):
    """Convection that held in one test alone: the message names it, and nothing is written."""
    case = small_case(tmp_path)
    (case / "model.toml").write_text(ONLY_IN_TOWN)
    said = thermoscope("export", case, "--as", "c")
    assert said.code == 2
    assert said.err.count("error:") == 1
    assert "convection@flange in town" in said.err.splitlines()[-1]
    assert not (case / "out").exists()


def test_the_command_writes_a_model_and_the_workbook_is_still_there(tmp_path, thermoscope):
    case = small_case(tmp_path)
    said = thermoscope("export", case, "--as", "json", "--limit", "winding=155", "--json", "-")
    assert said.code == 0, said.err
    assert [Path(f).name for f in said.document["files"]] == ["model.json", "reference_solver.py"]
    assert {o["name"]: o["limit_degC"] for o in said.document["outputs"]}["winding"] == 155.0
    assert thermoscope("export", case, "--as", "csv", "--out", tmp_path / "o").code == 0
    assert list((tmp_path / "o").glob("*.csv"))
