"""Whatever stands at any place of a file, or is left out: it is accepted, or refused in one message, never more."""

import copy
import datetime
import tomllib

import pytest
import tomlkit
from input_cases import case_of, documented, original, put, shipped
from test_numbers import SHEET

from extras.bench.heat_run.judgement import judged
from extras.bench.heat_run.record import read_heat_run
from extras.bench.measuring.protocol import protocol
from extras.bench.measuring.record_file import read_record
from geom.errors import InputError, ThermoscopeError
from geom.machine_file import machine_from
from lumped.declarations.network import load_network, read_network
from measured.recordings.sheet import read_sheet
from thermoscope.case_folder.cycle import load_cycle
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.history import History, Revision, load_history, save_history

OTHER = [3, "word", True, [], {"x": "y"}, [[1, 2], [3]], datetime.date(2020, 1, 1), ""]
DUTY = {
    "cycle": {"description": "x"},
    "load": {"current_A": 100},
    "boundaries": {"ambient": 20},
    "inputs": {"x": 1.0},
    "duty": {"type": "S3", "period_s": 600, "duty_percent": 40, "cycles": 3, "step_s": 10},
}
RECORD = {
    "machine": {"rated_kW": 7.0},
    "cold": {
        "room_degC": 21.0,
        "machine_degC": 21.0,
        "resistance_ohm": 2.0,
        "emf_V": 100.0,
        "speed_rpm": 383.0,
        "range_ohm": 4.0,
        "hours_since_run": 20.0,
    },
    "load": {"readings": [[0, 20.0], [10, 30.0], [20, 35.0]], "resolution_K": 0.5},
    "hot": {"ambient_degC": 21.0, "readings": [[10, 2.5], [20, 2.4], [30, 2.35]]},
    "coefficients": {"beta_percent_K": [0.39, 0.4]},
    "meters": {"resistance": {"percent": 0.2}},
}
HEAT_RUN = RECORD | {
    "heat_run": {"title": "a", "class": "F", "duty": "S1", "fan": False, "material": "copper", "thermometer_K": 0.5},
    "site": {"altitude_m": 2000, "coolant_degC": 45.0},
    "test_site": {"altitude_m": 100},
    "etd": {"degC": [80.0, 90.0], "limit_K": 1.0},
    "superposition": [{"name": "a", "sign": 1, "rise_K": 40.0, "sd_K": 1.0}],
    "power_30min": {"readings": [[0, 7.1], [1800, 7.0]]},
    "limit": {"K": 100.0, "source": "b"},
    "names": {"tested": "c"},
    "meters": {"resistance": {"range": [0.4, 4.0], "percent": 0.2, "offset": 0.002}},
}
STEP = Revision(
    0,
    "add",
    (),
    "",
    {"link.yoke-air": 1.1},
    {"link.yoke-air": (1.0, 1.2)},
    {"stand": (1.0, 0.5)},
    "why",
    {"score": 1.0},
)


def ways(document, way=()):
    """To everything in a document."""
    for key, value in document.items() if isinstance(document, dict) else enumerate(document):
        yield (*way, key)
        if isinstance(value, dict | list):
            yield from ways(value, (*way, key))


def without(document, way):
    out = copy.deepcopy(document)
    place = out
    for key in way[:-1]:
        place = place[key]
    del place[way[-1]]
    return out


def wrong(document, way):
    yield from (put(document, way, value) for value in OTHER)
    yield without(document, way)


def accepted_or_refused(read, document, way, file=""):
    """file : what every message has to name"""
    for spoilt in wrong(document, way):
        message = file
        try:
            read(spoilt)
        except ThermoscopeError as fault:
            message = str(fault)
        assert file in message
        assert len(message) < 1500
        assert "\n" not in message


def through_file(read, file):
    """Read what a document looks like as a file; what TOML cannot write is not a case."""

    def written(document):
        try:
            file.write_text(tomlkit.dumps(document))
        except (TypeError, ValueError, AttributeError):
            return
        read(file)

    return written


def named(document):
    return {"argvalues": list(ways(document)), "ids": [".".join(map(str, way)) for way in ways(document)]}


NETWORK = documented()


@pytest.mark.parametrize("way", **named(NETWORK))
def test_network(way):
    accepted_or_refused(read_network, NETWORK, way, "network.toml")


@pytest.mark.parametrize("way", **named(SHEET))
def test_sheet(way):
    accepted_or_refused(lambda document: read_sheet(document, "sheet.toml"), SHEET, way, "sheet.toml")


MACHINE = shipped("geom/machines/pmsm-m1.toml") | {"bases": {"bench": "own", "plate": "pmsm-m1-plate"}}
OUTSIDE = [way for way in ways(MACHINE) if way[0] != "geometry" and len(way) < 3]


@pytest.mark.parametrize("way", OUTSIDE, ids=[".".join(way) for way in OUTSIDE])
def test_machine(way):
    accepted_or_refused(lambda document: machine_from(document, "machine.toml"), MACHINE, way)


CASE = {
    "case": {"name": "x", "description": "x", "network": "network.toml", "sample_s": 20, "model_error_K": 0.1},
    "calibration": {"free": ["link.*"]},
    "tests": {
        "stand": {"role": "calibrate", "file": "tests/stand.csv", "sheet": "tests/stand.toml", "frees": ["link.*"]}
    },
}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return case_of(tmp_path_factory.mktemp("case"))


@pytest.mark.parametrize("way", **named(CASE))
def test_case(case, way):
    accepted_or_refused(through_file(lambda file: load_case(case), case / "case.toml"), CASE, way)


MODEL = tomllib.loads(
    tomlkit.dumps({"revision": [{"number": 1, **{k: v for k, v in STEP.document().items() if k != "number"}}]})
)


@pytest.mark.parametrize("way", **named(MODEL))
def test_model(tmp_path, way):
    accepted_or_refused(through_file(load_history, tmp_path / "model.toml"), MODEL, way)


@pytest.mark.parametrize("way", **named(DUTY))
def test_cycle(tmp_path, way):
    network = load_network(original() / "network.toml")
    read = through_file(lambda file: load_cycle(file, network, {}), tmp_path / "cycle.toml")
    accepted_or_refused(read, DUTY, way)


@pytest.mark.parametrize("way", **named(RECORD))
def test_record(tmp_path, way):
    read = through_file(lambda file: protocol(read_record(file)), tmp_path / "record.toml")
    accepted_or_refused(read, RECORD, way)


@pytest.mark.parametrize("way", **named(HEAT_RUN))
def test_heat_run(tmp_path, way):
    read = through_file(lambda file: judged(read_heat_run(file, lambda message: None)), tmp_path / "heat-run.toml")
    accepted_or_refused(read, HEAT_RUN, way)


def test_the_documents_are_right(tmp_path, case):
    (case / "case.toml").write_text(tomlkit.dumps(CASE))
    load_case(case)
    assert save_history(tmp_path / "model.toml", History().and_then(STEP), History()).last.number == 1
    (tmp_path / "cycle.toml").write_text(tomlkit.dumps(DUTY))
    load_cycle(tmp_path / "cycle.toml", load_network(case / "network.toml"), {})
    (tmp_path / "record.toml").write_text(tomlkit.dumps(RECORD))
    assert protocol(read_record(tmp_path / "record.toml")).steps
    (tmp_path / "heat-run.toml").write_text(tomlkit.dumps(HEAT_RUN))
    assert judged(read_heat_run(tmp_path / "heat-run.toml", lambda message: None))["rises"]


def test_tables_in_tables_without_end_are_one_message(tmp_path):
    file = tmp_path / "network.toml"
    file.write_text(f"[{'.'.join(['a'] * 20_000)}]\nb = 1\n")
    with pytest.raises(InputError, match="not readable as TOML"):
        load_network(file)
