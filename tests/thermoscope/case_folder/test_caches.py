"""Nothing is read, compared or built twice in a process, unless it has changed."""

import os
from collections import Counter

import pytest
from small_case import measured, write_csv

from thermoscope.case_folder import folder as case_folder
from thermoscope.case_folder.folder import load_case
from thermoscope.case_folder.runs import before_last, readings
from thermoscope.commands.model.calibrate import calibrate
from thermoscope.commands.show.pages import report
from thermoscope.commands.test.compare import compare
from validation.comparison import predict


@pytest.fixture
def reads(monkeypatch):
    """Recording -> how often it was read."""
    seen, read = Counter(), case_folder.load_table

    def counted(path, sheet):
        seen[path.stem] += 1
        return read(path, sheet)

    monkeypatch.setattr(case_folder, "load_table", counted)
    return seen


def test_a_recording_is_read_once_by_all_commands(case, reads, capsys):
    compare(str(case), None)
    calibrate(str(case), True, None)
    compare(str(case), None)
    report(str(case), None, None)
    assert dict(reads) == {"stand": 1, "road": 1, "town": 1}


def test_a_recording_that_changed_is_read_again(case, reads):
    before = load_case(case).case.tests[0].channels[0].y
    rows = measured(0, False, 6.0)
    rows[:, 4] += 1.0
    file = case / "tests" / "stand.csv"
    write_csv(file, rows)
    os.utime(file, ns=(file.stat().st_mtime_ns + 10**9,) * 2)
    after = load_case(case).case.tests[0].channels[0].y
    assert reads == {"stand": 2, "road": 1, "town": 1}
    assert abs((after - before).mean() - 1.0) < 0.1


def test_another_sheet_reads_the_recording_anew(case, reads):
    before = load_case(case).case.tests[0].time[-1]
    sheet = case / "tests" / "stand.toml"
    sheet.write_text(sheet.read_text().replace("[test]", "[test]\nto_s = 1500", 1))
    assert load_case(case).case.tests[0].time[-1] < before
    assert reads["stand"] == 2


def test_a_picture_of_one_test_judges_that_test_alone(case):
    """Its limits are those of the whole comparison, to rounding."""
    folder = load_case(case)
    chosen = folder.case.tests[-1]
    alone = folder.limits(chosen)
    assert "compared" not in vars(folder)
    assert alone == pytest.approx(folder.compared.limits[chosen.name], rel=1e-12)


def test_every_model_is_run_once_over_a_test_for_all_that_shows_its_readings(case, monkeypatch, capsys):
    """The model before its last step is one model, however often it is asked for."""
    calibrate(str(case), True, None)
    folder = load_case(case)

    def shown():
        models, tests = (folder.case, before_last(folder)), folder.case.tests
        return [T.tolist() for model in models for test in tests for T in readings(model, test).values()]

    first = shown()
    monkeypatch.setattr(predict, "simulate", None)  # no further run
    assert shown() == first
