"""Inputs that are switched, and tests that are part of a recording."""

import numpy as np
import pandas as pd
import pytest
from small_case import small_case

from geom.errors import InputError
from measured.recordings.events import Events
from thermoscope.case_folder.folder import load_case


def edited(case, old, new):
    sheet = case / "tests" / "stand.toml"
    sheet.write_text(sheet.read_text().replace(old, new, 1))
    return load_case(case)


def test_the_mean_around_an_instant_is_exact():
    """Switched at 13 s: the instant at 10 s, half of 5 to 15 s, has seen 2 of 10 s; the first one half a step only."""
    events = Events(np.array([0.0, 13.0, 42.0]), np.array([0.0, 1.0, 0.0]))
    mean = events.mean(np.arange(0.0, 60.0, 10.0))
    assert mean == pytest.approx([0.0, 0.2, 1.0, 1.0, 0.7, 0.0])
    assert np.sum(mean) * 10 == pytest.approx(42 - 13)


@pytest.mark.parametrize("form", ["lines", "file"])
def test_a_fan_switched_in_a_case(tmp_path, form):
    case = small_case(tmp_path)
    (case / "tests" / "switched.csv").write_text("time_s,fan_on,valve\n0,off,1\n600,,0\n1000,on,\n2000,off,\n")
    said = {"lines": 'at_s = [0, 1000, 2000]\nvalue = ["off", "on", "off"]', "file": 'file = "switched.csv"'}
    test = edited(case, "[columns.current]", f"[events.fan_on]\n{said[form]}\n\n[columns.current]").case.tests[0]
    fan = test.inputs["fan_on"]
    assert fan[test.time < 980].max() == 0.0
    assert fan[(test.time > 1020) & (test.time < 1980)].min() == 1.0
    assert np.trapezoid(fan, test.time) == pytest.approx(1000.0, rel=1e-3)


def test_a_test_is_part_of_a_recording(tmp_path):
    """Cropped from 500 to 1500 s: what is left is the same readings, and events keep the recording's clock.

    Looked at as recorded, every 10 s: a shorter test asks for finer steps.
    """
    case = small_case(tmp_path)
    settings = case / "case.toml"
    settings.write_text(settings.read_text().replace("sample_s = 20", "sample_s = 10"))
    whole = load_case(case).case.tests[0]
    events = "[events.fan_on]\nat_s = [0, 1000]\nvalue = [0, 1]\n\n[columns.current]"
    edited(case, "[columns.current]", events)
    part = edited(case, 'time = "time_s"', 'time = "time_s"\nfrom_s = 500\nto_s = 1500').case.tests[0]
    assert part.time[0] == 0.0
    assert part.time[-1] == 1000.0
    inside = (whole.time >= 510) & (whole.time <= 1490)
    assert part.channels[0].y[1:-1] == pytest.approx(whole.channels[0].y[inside])
    assert part.inputs["fan_on"][part.time < 480].max() == 0.0
    assert part.inputs["fan_on"][part.time > 520].min() == 1.0


def test_a_current_between_instants_counts_by_its_heat(tmp_path):
    """100 A and none in turns: an instant between two rows has the root of their mean square."""
    file = small_case(tmp_path) / "tests" / "stand.csv"
    table = pd.read_csv(file)
    table["current"] = 100.0 * (table.index % 2)
    table.to_csv(file, index=False)
    current = load_case(file.parents[1]).case.tests[0].inputs["current_A"][1:-1]
    between = current[(current > 0.0) & (current < 100.0)]
    assert between.size > 9
    assert between == pytest.approx(100.0 / np.sqrt(2.0))


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("at_s = [10, 20]\nvalue = [0, 1]", "not at the start"),
        ("at_s = [0, 20]\nvalue = [0]", "one for each instant"),
        ("at_s = [0, 20, 20]\nvalue = [0, 1, 0]", "do not follow"),
        ('at_s = [0]\nvalue = ["maybe"]', "not a state"),
        ("at_s = [0]\nvalue = [true]", "not a state"),
    ],
)
def test_events_that_say_too_little_are_refused(tmp_path, lines, words):
    with pytest.raises(InputError, match=words):
        edited(small_case(tmp_path), "[columns.current]", f"[events.fan_on]\n{lines}\n\n[columns.current]")


@pytest.mark.parametrize("window", ["from_s = 9000", "from_s = 100\nto_s = 50", "to_s = 5"])
def test_windows_outside_the_recording_are_refused(tmp_path, window):
    with pytest.raises(InputError, match="to_s"):
        edited(small_case(tmp_path), 'time = "time_s"', f'time = "time_s"\n{window}')
