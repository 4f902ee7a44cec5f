"""Every number of every file: no number, not finite or beyond its bounds is refused by key; the limits are not."""

import math
from functools import cache

import pytest
import tomlkit
from command_line import refusal
from input_cases import ROOT, case_of, documented, key_of, numbers, put, shipped

from geom.errors import InputError
from geom.machine_file import machine_from
from lumped.declarations.network import load_network, read_network
from lumped.schemas.bounds import KEYS, UNITS, Bounds, bounds
from measured.recordings.sheet import read_sheet
from thermoscope.case_folder.cycle import load_cycle

NO_NUMBER = {"nan": math.nan, "huge": 10**400, "word": "12", "true": True}
NETWORKS = {"documented": documented(), "tclab": shipped("cases/tclab/network.toml")}
NETWORKS |= {p.stem: shipped(str(p.relative_to(ROOT))) for p in sorted(ROOT.glob("benchmarks/hidden/machines/*.toml"))}
SHEET = {
    "test": {"time": "time_s", "filter_s": 9.0, "max_gap_s": 30.0, "initial": 21.0},
    "columns": {
        "T": {
            "quantity": "temperature",
            "unit": "degC",
            "place": "x",
            "sigma_K": 0.3,
            "lag_s": 9.0,
            "position_mm": [1.0, 2.0, 3.0],
        },
        "R": {
            "quantity": "resistance",
            "unit": "ohm",
            "place": "x",
            "coefficient_percent_K": [0.39, 0.4],
            "reference_degC": 20.0,
            "cold": {"reading": 2.0, "at_degC": 20.0},
            "meter": {"percent": 0.2, "offset": 0.1, "resolution": 0.1, "range": [0.1, 4.0]},
        },
    },
    "means": {"M": {"of": ["T"], "place": "x", "sigma_K": 0.3, "lag_s": 9.0}},
    "inputs": {"current_A": 8.0},
    "boundaries": {"ambient": 21.0},
    "recorders": {"daq": {"file": "daq.csv", "shift_s": 3.0, "limit_s": 60.0}},
}
CYCLE = {
    "cycle": {"initial_degC": 20.0},
    "boundaries": {"ambient": 20.0},
    "load": {"current_A": 100.0},
    "duty": {"type": "S3", "period_s": 600.0, "duty_percent": 40.0, "cycles": 3, "step_s": 10.0},
}
MACHINE = shipped("geom/machines/pmsm-m1.toml") | {"bases": {"bench": "own", "plate": "pmsm-m1-plate"}}
DOCUMENTS = {"sheet": SHEET, "cycle": CYCLE}


def distinct():
    """One way to every key of every section of the networks."""
    seen = set()
    for name, document in NETWORKS.items():
        for way in numbers(document):
            mark = (way[0], *(key for key in way[2:] if isinstance(key, str)))
            if mark not in seen and way[0] not in ("parameters",):
                seen.add(mark)
                yield name, way


WAYS = list(distinct())
MARK = "here"


@cache
def written(name, way):
    """The document as TOML with MARK in place of a number: writing it takes longer than reading and refusing it."""
    return tomlkit.dumps(put(DOCUMENTS[name], way, MARK))


def with_value(name, way, value):
    """The document as TOML with a value in place of a number."""
    text = written(name, way)
    assert text.count(f'"{MARK}"') == 1
    return text.replace(f'"{MARK}"', tomlkit.item(value).as_string())


def test_the_documents_are_right():
    for document in NETWORKS.values():
        read_network(document)
    read_sheet(SHEET, "sheet.toml")


@pytest.fixture(scope="module")
def tested(tmp_path_factory):
    return case_of(tmp_path_factory.mktemp("tested"))


@pytest.mark.parametrize("value", [math.nan, "12"])
@pytest.mark.parametrize(("name", "way"), WAYS, ids=[f"{n}:{'.'.join(map(str, w))}" for n, w in WAYS])
def test_no_number_of_a_network_is_refused_by_file_and_key(name, way, value):
    with pytest.raises(InputError, match=key_of(way)) as fault:
        read_network(put(NETWORKS[name], way, value))
    assert "network.toml" in str(fault.value)


@pytest.mark.parametrize("value", NO_NUMBER.values(), ids=NO_NUMBER)
@pytest.mark.parametrize("way", list(numbers(SHEET)), ids=lambda way: ".".join(map(str, way)))
def test_no_number_of_a_sheet_is_refused_by_file_and_key(tested, way, value):
    file = tested / "tests/stand.toml"
    file.write_text(with_value("sheet", way, value))
    message = refusal(tested, "test", "compare", tested)
    assert str(file) in message
    assert key_of(way) in message


@pytest.mark.parametrize("value", NO_NUMBER.values(), ids=NO_NUMBER)
@pytest.mark.parametrize("way", list(numbers(CYCLE)), ids=lambda way: ".".join(map(str, way)))
def test_no_number_of_a_cycle_is_refused_by_file_and_key(tested, way, value):
    file = tested / "cycle.toml"
    file.write_text(with_value("cycle", way, value))
    network = load_network(tested / "network.toml")
    with pytest.raises(InputError, match=key_of(way)) as fault:
        load_cycle(file, network, {})
    assert str(file) in str(fault.value)


@pytest.mark.parametrize("value", NO_NUMBER.values(), ids=NO_NUMBER)
@pytest.mark.parametrize("way", list(numbers(MACHINE["geometry"])), ids=lambda way: ".".join(map(str, way)))
def test_no_number_of_a_geometry_is_refused_by_key(way, value):
    with pytest.raises(InputError, match=key_of(way)):
        machine_from(put(MACHINE, ("geometry", *way), value))


@pytest.mark.parametrize("key", [*KEYS, *UNITS])
def test_limits_are_allowed_and_what_is_beyond_is_not(key):
    allowed = bounds(key)
    for value in (allowed.low, allowed.high):
        assert allowed.hold(value)
    for value in (math.nextafter(allowed.low, -math.inf), math.nextafter(allowed.high, math.inf), math.nan):
        assert not allowed.hold(value)


def test_a_key_has_the_bounds_of_its_unit():
    assert bounds("stator_C_J_K") == UNITS["J_K"]
    assert bounds("housing_h_W_m2K") == UNITS["W_m2K"]
    assert bounds("anything_degC").low == -100.0


def test_a_count_has_no_fraction():
    assert Bounds(1, 9, whole=True).hold(8.0)
    assert not Bounds(1, 9, whole=True).hold(2.5)
