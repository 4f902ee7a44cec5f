"""The doctor: every illness that is put into a sound case is found, by test and column, and a sound case has none."""

import numpy as np
import pytest
from command_line import answered
from input_cases import case_of, changed, edited


def asked(case):
    done = answered("doctor", case, "--json", "-")
    return done.code, done.document


def kelvin(table):
    table["T_flange"] += 273.15


def fahrenheit(table):
    table["T_flange"] = 1.8 * table["T_flange"] + 32.0


def frozen(table):
    table["T_flange"] = 20.0


def spike(table):
    table.loc[40, "T_flange"] += 60.0


def twins(table):
    table["T_flange"] = table["T_winding"]


def uneven(table):
    table["time_s"] += np.where(np.arange(len(table)) % 2, 9.0, 0.0)


def hole(table):
    table.drop(index=range(60, 69), inplace=True)


ILL = {
    kelvin: "kelvin",
    fahrenheit: "Fahrenheit",
    frozen: "frozen",
    spike: "leap",
    twins: "same readings",
    uneven: "unevenly",
    hole: "no rows from",
}


@pytest.mark.parametrize("ill", ILL, ids=lambda ill: ill.__name__)
def test_an_illness_is_found_with_its_test_and_a_cure(tmp_path, ill):
    case = case_of(tmp_path)
    changed(case, "stand", ill)
    answer, found = asked(case)
    mine = [f for f in found["doubts"] if ILL[ill] in f["what"]]
    assert answer == 1
    assert mine
    assert {f["test"] for f in mine} == {"stand"}
    assert all(f["cure"] for f in mine)


def test_a_sound_case_has_only_the_input_that_no_law_reads(tmp_path):
    _, found = asked(case_of(tmp_path))
    assert found["wrong"] == []
    assert [(f["where"], f["remark"]) for f in found["doubts"]] == [("vehicle_speed_mps", True)]


def test_hot_water_beside_rooms_that_differ_is_not_taken_for_fahrenheit(tmp_path):
    """55 is 12.8 degC as Fahrenheit: half-way between a room and the cold outside it, by chance."""
    case = case_of(tmp_path)

    def house(table):
        for name, start in (("T_flange", 55.0), ("T_winding", 3.0), ("T_yoke", 294.0), ("air", 12.0)):
            table[name] += start - table[name].iloc[0]

    changed(case, "stand", house)
    _, found = asked(case)
    assert [f for f in found["doubts"] if "Fahrenheit" in f["what"]] == []


def test_milliseconds_in_one_test_are_found_by_its_rows(tmp_path):
    case = case_of(tmp_path)
    changed(case, "stand", lambda table: table.__setitem__("time_s", 60.0 * table["time_s"]))
    _, found = asked(case)
    assert [f["test"] for f in found["doubts"] if "in the other tests" in f["what"]] == ["stand"]


def test_a_sensor_that_is_read_later_only_says_nothing_of_the_start(tmp_path):
    """A winding's resistance is read when it is hot: there are no first readings to start from."""
    case = case_of(tmp_path)
    changed(case, "stand", lambda table: table.__setitem__("T_winding", 60.0))
    late = [f["what"] for f in asked(case)[1]["doubts"] if f["where"] == "T_winding" and "starts at" in f["what"]]
    changed(case, "stand", lambda table: table.loc.__setitem__((slice(None, 3), "T_winding"), np.nan))
    _, found = asked(case)
    assert late
    assert [f for f in found["doubts"] if f["where"] == "T_winding" and "starts at" in f["what"]] == []


def test_two_names_for_one_recording(tmp_path):
    case = case_of(tmp_path)
    (case / "tests/town.csv").write_bytes((case / "tests/road.csv").read_bytes())
    _, found = asked(case)
    assert [f["test"] for f in found["doubts"] if "two names" in f["what"]] == ["road, town"]


def test_an_input_that_no_test_moves(tmp_path):
    case = case_of(tmp_path)
    for test in ("stand", "road", "town"):
        changed(case, test, lambda table: table.__setitem__("current", 100.0))
    _, found = asked(case)
    assert "current_A" in [f["where"] for f in found["doubts"] if "moves" in f["what"]]


def test_watts_that_are_kilowatts(tmp_path):
    """0.2 read as W where 200 W were meant cannot have warmed 11 kJ/K by tens of kelvin."""
    case = case_of(tmp_path)
    old = 'kind = "copper"\nR20_ohm = 0.02\ncurrents = ["current_A"]'
    new = 'kind = "constant"\nP_W = 1.0\nof = { input = "power_W", at = 1.0 }'
    edited(case / "network.toml", old, new)
    for test in ("stand", "road", "town"):
        sheet = case / "tests" / f"{test}.toml"
        edited(sheet, 'quantity = "current"\nunit = "A"', 'quantity = "power"\nunit = "W"')
        changed(case, test, lambda table: table.__setitem__("current", 2e-5 * table["current"] ** 2))
    _, found = asked(case)
    assert {f["test"] for f in found["doubts"] if "kW?" in f["what"]} == {"stand", "road", "town"}


def test_what_would_be_refused_is_told_for_every_test(tmp_path):
    case = case_of(tmp_path)
    for test in ("stand", "road"):
        changed(case, test, lambda table: table.drop(columns="T_yoke", inplace=True))
    answer, found = asked(case)
    assert answer == 2
    assert [f["test"] for f in found["wrong"]] == ["stand", "road"]


def test_compare_says_the_first_things_that_look_wrong(tmp_path):
    case = case_of(tmp_path)
    changed(case, "stand", spike)
    err = answered("compare", case, "--json", "-").err
    assert "note: stand, T_flange: 1 readings leap" in err
    assert "more such things" not in err


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda v: 10.0 * v, "tenths of a degree"),
        (lambda v: 40.0 - v, "wires swapped"),
        (lambda v: v.where(v.index % 200 == 0), "was read 2 times"),
    ],
)
def test_a_sensor_of_another_scale_or_hardly_read(tmp_path, change, words):
    case = case_of(tmp_path)
    changed(case, "stand", lambda table: table.__setitem__("T_flange", change(table["T_flange"])))
    _, found = asked(case)
    assert [(f["test"], f["where"]) for f in found["doubts"] if words in f["what"]] == [("stand", "T_flange")]


@pytest.mark.parametrize(
    ("name", "least", "doubted"),
    [
        ("T_flange", 18.5, False),
        ("T_flange", -15.0, True),
        ("T_suction pipe", -15.0, False),
        ("Verdampfer", -15.0, False),
    ],
)
def test_a_place_may_fall_as_far_as_its_surroundings_or_where_its_name_says_cold(tmp_path, name, least, doubted):
    """Beside parts that warm by tens of kelvin: wires that are swapped mirror that at the room."""
    case = case_of(tmp_path)

    def cooled(table):
        start, n = table["T_flange"].iloc[0], len(table)
        table["air"] = [min(start, 17.0)] * n
        table["T_flange"] = [max(least, start - 0.5 * k) for k in range(n)]
        table.rename(columns={"T_flange": name}, inplace=True)

    changed(case, "stand", cooled)
    edited(case / "tests" / "stand.toml", "columns.T_flange", f'columns."{name}"')
    found = [f for f in findings(case) if "wires swapped" in f["what"]]
    assert [f["where"] for f in found] == [name] * doubted


def hourly(table):
    """Rows an hour apart: a winding that was on for one of them is back by the next."""
    table["time_s"] *= 360.0
    table["current"] = [150.0 if i % 12 == 6 else 0.0 for i in table.index]
    for name, rise in (("T_winding", 70.0), ("T_yoke", 30.0), ("T_flange", 12.0)):
        table[name] = 21.3 + 273.15 * (name == "T_yoke") + rise * (table["current"] > 0.0) + 0.05 * (table.index % 3)


def findings(case):
    return [f for f in answered("doctor", case, "--json", "-").document["doubts"] if f["test"] == "stand"]


def test_a_room_may_stand_still(tmp_path):
    case = case_of(tmp_path)
    changed(case, "stand", lambda table: table.__setitem__("air", 21.5))
    assert not [f for f in findings(case) if "frozen" in f["what"]]
    assert "frozen" not in answered("compare", case).err


def test_it_may_be_cold_outside(tmp_path):
    """A tenth of where a machine starts is weather, ten times of it is none."""
    case = case_of(tmp_path)
    changed(case, "stand", lambda table: table.__setitem__("air", 0.1 * table["T_winding"].iloc[0]))
    assert not [f for f in findings(case) if "tenths" in f["what"]]
    changed(case, "stand", lambda table: table.__setitem__("air", 10.0 * table["T_winding"].iloc[0]))
    assert [f["where"] for f in findings(case) if "tenths" in f["what"]] == ["air"]


def test_heat_for_an_hour_between_hourly_rows_is_no_leap(tmp_path):
    case = case_of(tmp_path)
    changed(case, "stand", hourly)
    assert not [f for f in findings(case) if "leap" in f["what"]]
    changed(case, "stand", lambda table: table.__setitem__("T_flange", table["T_flange"] + 60.0 * (table.index == 40)))
    assert [f["where"] for f in findings(case) if "leap" in f["what"]] == ["T_flange"]
