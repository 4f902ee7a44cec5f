"""Events on the command line: found, added as a column beside the test, undone; a question answered, taken back."""

import json
import shutil

import numpy as np
import pytest
from small_case import HEADER, measured, small_case

from geom.errors import InputError
from thermoscope.case_folder.history import load_history
from thermoscope.commands.explain.answer import answer
from thermoscope.commands.explain.diagnose import diagnose
from thermoscope.commands.model import revise
from thermoscope.commands.open_case import open_case

LID = (1000.0, 1500.0)


@pytest.fixture(scope="module")
def opened_lid(tmp_path_factory):
    """A case without wind in whose second test a lid is open for a while, diagnosed; folder and document."""
    folder = tmp_path_factory.mktemp("events")
    case = small_case(folder, 0.0)
    rows = measured(1, True, 0.0)
    dt, extra = 10.0, np.zeros(3)
    for k in range(1, len(rows)):  # the flange cools by 8 W/K more, and its neighbours follow it
        w, y, f = extra
        own = 8.0 * (rows[k, 6] + f - 20.0) if LID[0] <= rows[k, 0] < LID[1] else 0.0
        flow = np.array([-8.0 * (w - y), 8.0 * (w - y) - 6.0 * (y - f) - 3.0 * y, 6.0 * (y - f) - 1.5 * f - own])
        extra = extra + dt * flow / np.array([2000.0, 6000.0, 3000.0])
        rows[k, 4:] += extra
    lines = [HEADER, *(",".join(f"{v:.3f}" for v in row) for row in rows)]
    (case / "tests" / "road.csv").write_text("\n".join(lines) + "\n")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(folder / "cache"))
        diagnose(str(case), str(folder / "found.json"))
    return case, json.loads((folder / "found.json").read_text())


def test_the_lid_is_found_with_its_times(opened_lid):
    best = opened_lid[1]["odds"][0]
    assert best["effects"][0].startswith("convection.constant@flange in road:")
    assert (best["begin_s"], best["end_s"]) == pytest.approx(LID, abs=40.0)
    assert opened_lid[1]["events"][0]["spans"][0]["test"] == "road"


def test_an_event_is_added_as_a_column_and_undone(opened_lid, capsys):
    case, found = opened_lid
    file, recording = case / "tests" / "road.derived.csv", (case / "tests" / "road.csv").read_bytes()
    assert revise.add(str(case), ["event@1"], False, None) == 0
    header, *rows = file.read_text().splitlines()
    assert header.startswith("time_s,")
    open_ = np.array([[float(x) for x in row.split(",")] for row in rows])
    assert np.trapezoid(open_[:, 1], open_[:, 0]) == pytest.approx(LID[1] - LID[0], abs=80.0)
    assert (case / "tests" / "road.csv").read_bytes() == recording
    assert load_history(case / "model.toml").last.effects[0] == found["events"][0]["effect"]
    revise.undo(str(case), 0, None)
    assert not file.exists()
    assert load_history(case / "model.toml").last.effects == ()
    capsys.readouterr()


def test_events_are_added_from_a_diagnosis_that_left_something_out(opened_lid, tmp_path):
    case = shutil.copytree(opened_lid[0], tmp_path / "three")
    assert diagnose(str(case), str(tmp_path / "found.json"), ["sensors", "time.offset"]) == 0
    found = json.loads((tmp_path / "found.json").read_text())
    assert found["without"] == ["sensors", "time.offset"]
    kinds = {name.partition("@")[0] for row in found["odds"] for name in row["effects"]}
    assert not any(kind.startswith("sensor.") or kind == "time.offset" for kind in kinds)
    assert revise.meant(open_case(str(case), lambda message: None), "event@1") == found["events"][0]["effect"]


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("event@9", "no event '9'"),
        ("loss.constant@flange in noon", "unknown test or event"),
        ("loss.constant@flange in road:900-5000s", "outside the record"),
    ],
)
def test_an_event_that_cannot_be_is_refused(opened_lid, name, says):
    with pytest.raises(InputError, match=says):
        revise.add(str(opened_lid[0]), [name], False, None)


def test_a_file_of_the_users_stays(opened_lid):
    file = opened_lid[0] / "tests" / "stand.derived.csv"
    file.write_text("mine,too\n1,2\n")
    with pytest.raises(InputError, match="it stays"):
        revise.undo(str(opened_lid[0]), 0, None)
    file.unlink()


def test_an_answer_is_kept_and_taken_back(opened_lid, capsys):
    case = str(opened_lid[0])
    before = load_history(opened_lid[0] / "model.toml").last
    answer(case, "no", "road", None)
    last = load_history(opened_lid[0] / "model.toml").last
    assert (last.action, last.answers, last.values) == ("answer", {"road": False}, before.values)
    revise.undo(case, None, None)
    assert load_history(opened_lid[0] / "model.toml").last.answers == {}
    capsys.readouterr()


def test_how_well_a_boundary_is_known_is_kept_with_its_reason(opened_lid, capsys):
    case, file = str(opened_lid[0]), opened_lid[0] / "model.toml"
    answer(case, "ambient", None, None, "checked in an ice bath: 0.1 K")
    last = load_history(file).last
    assert (last.why, last.answers) == ("ambient is known to 0.1 K: checked in an ice bath", {"boundary:ambient": 0.1})
    assert open_case(case, lambda message: None).case.doubt["boundary:ambient"] == 0.1
    revise.undo(case, None, None)
    assert load_history(file).last.answers == {}
    capsys.readouterr()


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (("ambient", None, None, "5 K"), "does not narrow"),
        (("ambiant", None, None, "0.1 K"), "did you mean"),
        (("ambient", None, None, "well"), "for example"),
        (("yes", "road:0-9000s", None), "outside the record"),
    ],
)
def test_what_is_no_answer_is_refused(opened_lid, given, says):
    with pytest.raises(InputError, match=says):
        answer(str(opened_lid[0]), *given)
