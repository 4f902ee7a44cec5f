"""What the page shows of a run on the bench, from the journal that the run writes."""

import json

import pytest

from extras.workbench import display as live
from thermoscope.plugin import DARK, LIGHT, BenchRun

HOT, SAFE = {"current_A": 8.0, "speed_rpm": 3000.0}, {"current_A": 0.0, "speed_rpm": 0.0}
LOOK = {"event": "odds", "over": ["T_core"], "unseen": ["windage@rotor"], "left_min": 12.4}
RUN = [
    {"event": "run", "drive": False},
    {"event": "begin", "begin_s": 5.0},
    LOOK | {"time_s": 65.0, "odds": [["nothing", 0.8], ["copper.ac@winding", 0.1]]},
    {"event": "set", "time_s": 65.0, "set_point": HOT, "minutes": 3.0, "nats": 0.1, "waits": True},
]
DONE = {"event": "done", "time_s": 95.0}
SURE = {"time_s": 305.0, "odds": [["copper.ac@winding", 0.95], ["nothing", 0.05]]}
END = [
    LOOK | SURE | {"stop": "AC copper loss at winding is missing"},
    {"event": "set", "time_s": 305.0, "set_point": SAFE, "minutes": 0.0, "nats": 0.0, "waits": False},
]


@pytest.fixture
def written(tmp_path):
    (tmp_path / "tests").mkdir()

    def write(*events):
        file = tmp_path / "tests" / "live.jsonl"
        file.write_text("".join(json.dumps(e) + "\n" for e in events) + '{"event": "odds", "cut')
        return file

    return write


def test_it_asks_for_the_next_set_point_until_that_is_there(written):
    state, _ = live.state_and_picture(written(*RUN), LIGHT)
    assert state["asks"]
    assert [(s["name"], s["value"]) for s in state["set"]] == [("current_A", "8"), ("speed_rpm", "3000")]
    assert (state["minutes"], state["left"], state["stop"]) == ("1", "about 12 min left", "")
    assert (state["over"], state["unseen"]) == ("T_core", ["windage at rotor"])
    assert not live.state_and_picture(written(*RUN, DONE), LIGHT)[0]["asks"]
    assert not live.state_and_picture(written({"event": "run", "drive": True}, *RUN[1:]), LIGHT)[0]["asks"]


def test_it_says_how_a_run_ended(written):
    state, figure = live.state_and_picture(written(*RUN, DONE, *END), DARK)
    assert (state["stop"], state["fault"], state["left"]) == ("AC copper loss at winding is missing", False, "")
    assert [o["cause"] for o in state["odds"]] == ["AC copper loss at winding", "nothing"]
    names = [line["name"] for line in figure["data"]]
    assert names == ["AC copper loss at winding", "nothing", "current (A), 100 % = 8", "speed (1/min), 100 % = 3000"]
    assert figure["layout"]["paper_bgcolor"] == DARK.paper
    state, _ = live.state_and_picture(written(*RUN, {"event": "fault", "what": "the line is gone"}), LIGHT)
    assert (state["stop"], state["fault"]) == ("the line is gone", True)


def test_before_the_first_look_there_is_nothing_to_show_and_done_is_said_beside_the_journal(written, tmp_path):
    assert live.newest(tmp_path) is None
    file = written(*RUN[:2])
    assert live.state_and_picture(file, LIGHT) is None
    assert live.newest(tmp_path) == file
    live.say_done(file)
    assert (tmp_path / "tests" / "live.done").exists()


def test_odds_and_set_points_are_in_per_cent_over_minutes(written):
    run = BenchRun([*RUN, *END])
    assert run.odds[0] == ("AC copper loss at winding", [1.0, 5.0], [10.0, 95.0])
    assert run.set_points[0] == ("current (A), 100 % = 8", [1.0, 5.0, 5.0], [100.0, 0.0, 0.0])
