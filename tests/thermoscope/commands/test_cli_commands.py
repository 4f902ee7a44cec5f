"""The commands on a case whose truth is known: exit codes, the documents' fields, what they write and leave alone."""

import json
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace

import pytest
from command_line import RUN
from small_case import small_case

from thermoscope.case_folder.folder import load_case
from thermoscope.commands.model.revise import CHANGE_K, _unmeasured_words, unmeasured

STRENGTH = 6.0  # W/K at 10 m/s: the convection hidden in the data


@pytest.fixture(scope="module")
def story(thermoscope, tmp_path_factory):
    """calibrate, compare, diagnose, add, compare on one case: name of the step -> answer, and the case."""
    case = small_case(tmp_path_factory.mktemp("story"), STRENGTH)
    done = {"calibrate": thermoscope("calibrate", case, "--json", "-")}
    done["wrong"] = thermoscope("compare", case, "--json", "-")
    done["diagnose"] = thermoscope("diagnose", case, "--json", "-")
    done["add"] = thermoscope("add", case, "convection@flange", "--json", "-")
    done["right"] = thermoscope("compare", case, "--json", "-")
    return case, done


def test_the_loop_finds_what_was_hidden(story):
    _, done = story
    best = done["diagnose"].document["candidates"][0]
    assert best["effect"] == "convection@flange"
    low, high = best["amplitude"]["ci95"]
    assert low - 0.5 < STRENGTH < high + 0.5  # W/K; the data's inputs are averaged to 20 s


def test_the_held_out_error_falls_to_what_the_sensors_leave(story):
    _, done = story
    town = next(t for t in done["add"].document["tests"] if t["name"] == "town")
    assert town["rmse_K"]["before"] > 2.0
    assert town["rmse_K"]["after"] < 0.4  # K, the smallest sigma declared


FIELDS = {
    "wrong": {"case", "model", "tests", "rmse_K", "floor_K", "roles"},
    "diagnose": {"verdict", "candidates", "cannot_see", "where", "next_tests"},
    "add": {"effect", "revision", "accepted", "why", "tests", "parameters", "unmeasured"},
    "calibrate": {"effect", "revision", "accepted", "why", "tests", "parameters"},
}
ROWS = {
    ("wrong", "tests"): {"name", "role", "rmse_K", "channels"},
    ("diagnose", "candidates"): {
        "effect",
        "score",
        "threshold",
        "amplitude",
        "explained",
        "rmse_K",
        "holdout_rmse_K",
        "confused_with",
        "decision",
    },
    ("diagnose", "cannot_see"): {"effect", "smallest_detectable", "unit"},
    ("diagnose", "where"): {"place", "evidence_nats"},
    ("add", "tests"): {"name", "role", "rmse_K"},
    ("add", "parameters"): {"name", "value", "unit", "ci95", "prior", "identified"},
}
CHANNEL = {"channel", "place", "n", "rmse_K", "bias_K", "max_abs_K", "sigma_K", "percent_of_rise", "verdict"}


def test_documents_have_the_contract_s_fields_and_exit_codes(story):
    _, done = story
    assert {step: answer.code for step, answer in done.items()} == dict.fromkeys(done, 0) | {"wrong": 1}
    for step, fields in FIELDS.items():
        assert fields <= set(done[step].document), step
    for (step, field), keys in ROWS.items():
        assert keys <= set(done[step].document[field][0]), (step, field)
    assert set(done["wrong"].document["tests"][0]["channels"][0]) >= CHANNEL


def test_places_without_a_sensor_that_a_step_moved_are_told(story):
    """The winding's thermometer is taken away; a copper loss of 1.5 instead of 1 warms it most."""
    folder = load_case(story[0])
    tests = [replace(t, channels=tuple(c for c in t.channels if c.place != "winding")) for t in folder.case.tests]
    folder = replace(folder, case=replace(folder.case, tests=tuple(tests)))
    model = folder.case.model
    copper = next(p.name for p in model.network.parameters if "copper" in p.name)
    after = replace(model, values={**model.values, copper: 1.5 * model.values[copper]})
    found = unmeasured(folder, SimpleNamespace(model=after))
    assert [(p["place"], p["test"]) for p in found] == [("winding", "town")]
    assert found[0]["after_C"] > found[0]["before_C"] + CHANGE_K
    assert _unmeasured_words(found).startswith("No sensor sees: winding ")
    assert _unmeasured_words([{**found[0], "after_C": found[0]["before_C"]}]) == ""


def test_revisions_are_kept_with_evidence(story):
    import tomllib

    case, _ = story
    first, second = tomllib.loads((case / "model.toml").read_text())["revision"]
    assert (first["action"], second["action"], second["effect"]) == ("calibrate", "add", "convection@flange")
    assert second["evidence"]["score"] > second["evidence"]["threshold"]
    assert set(second["rmse_K"]) == {"stand", "road", "town"}


def test_removed_again(story, thermoscope, tmp_path):
    import shutil

    case = shutil.copytree(story[0], tmp_path / "copy")
    done = thermoscope("remove", case, "convection@flange", "--json", "-")
    assert done.code == 0, done.err
    assert thermoscope("compare", case, "--json", "-").document["model"] == {"revision": 3, "effects": []}


def test_an_effect_against_its_sign_is_not_written(thermoscope, tmp_path, contents):
    """The truth here loses less heat in wind, which no convection can explain."""
    case = small_case(tmp_path, strength=-1.0)
    before = contents(case)
    done = thermoscope("add", case, "convection@flange", "--json", "-")
    assert (done.code, done.document["accepted"], done.document["written"]) == (1, False, False)
    assert contents(case) == before


def test_document_to_a_file_leaves_the_table_on_stdout(thermoscope, case):
    (case / "out").mkdir(exist_ok=True)
    done = thermoscope("compare", case, "--json", case / "out" / "compare.json")
    assert "T_flange" in done.out
    assert json.loads((case / "out" / "compare.json").read_text())["case"] == "three"


def test_a_case_inside_the_package_is_copied_before_writing(tmp_path, monkeypatch, capsys):
    from thermoscope.commands.open_case import open_case_for_writing

    package = tmp_path / "package"
    shipped = small_case(package / "cases")
    here = tmp_path / "here"
    here.mkdir()
    monkeypatch.chdir(here)
    folder = open_case_for_writing(str(shipped), lambda message: None, package=package)
    assert folder.settings.path.resolve() == here / "three"
    assert "copied the shipped case" in capsys.readouterr().err


@pytest.mark.heavy
def test_compare_loads_what_runs_a_network_alone(case):
    """Most of what a comparison of few nodes takes is loading packages: NumPy and Numba are needed, these are not."""
    slow = [
        "pandas",
        "scipy.special",
        "scipy.sparse",
        "scipy.optimize",
        "scipy.stats",
        "scipy.interpolate",
        "tkinter",
        "matplotlib",
        "plotly",
        "pint",
        "CoolProp",
        "ht",
        "fluids",
        "openpyxl",
        "ruptures",
        "uncertainties",
        "jsonschema",
        "geom.solids",
        "fem",
        "viz",
        "validation.inference.refit",
    ]
    end = f"atexit.register(lambda: print(*[m for m in {slow} if m in sys.modules], file=sys.stderr))"
    command = [sys.executable, "-c", f"import atexit, sys; {end}; {RUN}", "test", "compare", str(case)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=500)
    assert done.returncode == 1, done.stderr
    assert done.stderr.splitlines()[-1] == ""


def test_report_and_pictures_of_a_declared_network(story, thermoscope, tmp_path):
    case, _ = story
    done = thermoscope("render", case, "--out", tmp_path, "--json", "-")
    assert done.code == 0, done.err
    assert {"curves-town.png", "residuals-road.png", "error.png"} <= {p.name for p in tmp_path.iterdir()}


def test_a_machine_file_is_copied_once(thermoscope, tmp_path):
    """The file of the library, byte for byte; what lies there stays."""
    from geom import library

    assert thermoscope("machines", "--copy", "pmsm-m1", "--out", tmp_path).code == 0
    assert (tmp_path / "pmsm-m1.toml").read_bytes() == library()["pmsm-m1"].read_bytes()
    again = thermoscope("machines", "--copy", "pmsm-m1", "--out", tmp_path)
    assert again.code == 2
    assert "is there already" in again.err
