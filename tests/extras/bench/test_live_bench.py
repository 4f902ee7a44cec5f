"""A bench that steers itself: what it stores, what stops it, what it asks for, and that it names what was hidden.

The plant is `simulated.bench`, another model than the network that explains it.
"""

import json
import queue
import shutil
import socket
import subprocess
import threading
import time
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import tomlkit
from command_line import answered
from jsonschema import Draft202012Validator

from extras.bench.live.assessment import MOST_ROWS, Assessment, thinned, without_stuck
from extras.bench.live.planning import Rival, choices, information, undetectable, unresolved
from extras.bench.live.session import Session
from extras.bench.live.settings import read_bench
from extras.bench.live.sources import Parser, source_of
from extras.bench.live.steering import Steering
from extras.bench.live.store import BenchError, Store
from lumped.schemas.schema import schema
from simulated.bench.kinds import KINDS, write_case
from simulated.bench.plant import Plant, drawn
from thermoscope import InputError
from thermoscope.plugin import Channel, Test, load_case

ROW = {"time_s": 5.0, "current_A": 0.0, "speed_rpm": 0.0, "T_ambient": 20.0, "T_plate": 20.0}
ROW |= {"T_winding": 20.0, "T_core": 20.0, "T_housing": 20.0}
HOT = {"current_A": 5.6, "speed_rpm": 3000.0}


def bench_of(case, **changes):
    return replace(read_bench(case, load_case(case, untested=True).case.model.network), **changes)


@pytest.fixture
def case(tmp_path):
    return write_case("servo", tmp_path / "servo")


@pytest.fixture(autouse=True)
def closed(monkeypatch):
    """Every file that a test's stores hold, at its end."""
    stores, usual = [], Store.__init__
    monkeypatch.setattr(Store, "__init__", lambda self, *a, **k: stores.append(self) or usual(self, *a, **k))
    yield
    for store in (s for s in stores if hasattr(s, "journal")):
        store.close()


@pytest.fixture
def steering(case):
    return Steering(bench_of(case), Store(case, "live", "tests/columns.toml", sync=False))


def driven(case, plant, most_min, **changes):
    """Steers a plant in simulated time; the last thought, and the store's rows."""
    steering = Steering(bench_of(case, **changes), Store(case, "live", "tests/columns.toml", sync=False))
    thought = None
    while plant.time < 60.0 * most_min and not (thought and thought.stop):
        row = plant.row()
        for s in steering.row(row) if row else ():
            plant.apply(s)
        if steering.is_due:
            thought = steering.think(case)
            for s in steering.apply(thought):
                plant.apply(s)
    steering.store.close()
    return thought


def looked_at(case, kind, minutes):
    """A run of a machine that lacks nothing, and what is thought of it after some minutes."""
    driven(case, Plant(drawn(kind, 7, "nothing")), minutes)
    steering = Steering(bench_of(case), Store(case, "live", "tests/columns.toml", sync=False))
    return steering, steering.think(case).assessment


def test_it_names_what_is_hidden_and_its_rows_are_a_test(case):
    plant = Plant(drawn("servo", 100, "copper.ac@winding"))
    thought = driven(case, plant, 60, every_s=120.0)
    assert thought.stop == "AC copper loss at winding is missing"
    assert [t.name for t in load_case(case).case.tests] == ["live"]
    assert all(plant.hottest[x.place] <= x.most_C for x in bench_of(case).limits)
    events = [json.loads(line)["event"] for line in (case / "tests" / "live.jsonl").read_text().splitlines()]
    assert events[0] == "begin"
    assert {"odds", "set"} <= set(events)


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_has_a_case_that_opens_and_a_bench_that_fits_its_schema(kind, tmp_path):
    case = write_case(kind, tmp_path / kind)
    bench = bench_of(case)
    assert all(set(s) == {k.name for k in bench.knobs} for s in bench.set_points({}))
    assert faults(tomllib.loads((case / "bench.toml").read_text())) == []


def test_set_points_get_no_hotter_than_the_limits(case):
    steering, assessment = looked_at(case, "servo", 2.0)
    cool = tuple(replace(x, most_C=45.0) for x in steering.bench.limits)
    options = choices(assessment, replace(steering.bench, limits=cool), steering.now)
    assert options
    assert all(T <= 45.0 for c in options for T in c.hottest.values())
    assert max(c.set_point["current_A"] for c in options) < max(steering.bench.knobs[0].levels)


def test_one_cooling_is_changed_at_a_time(tmp_path):
    bench = bench_of(write_case("blower", tmp_path / "blower"))
    fan = bench.knobs[2]
    two = replace(bench, knobs=(*bench.knobs, replace(fan, name="pump_share")))
    now = {**two.safe, "fan_share": 1.0, "pump_share": 1.0}
    assert all((s["fan_share"] != 1.0) + (s["pump_share"] != 1.0) <= 1 for s in two.set_points(now))


def test_what_even_every_set_point_cannot_show_is_out_of_sight(tmp_path):
    """Of a housing that water cools, still air takes a hundredth of the heat: its film could be anything."""
    case = write_case("jacket", tmp_path / "jacket")
    steering, assessment = looked_at(case, "jacket", 3.0)
    hidden = undetectable(assessment, steering.bench, steering.now, unresolved(assessment, steering.bench), 180.0)
    assert "convection.constant@housing" in hidden
    assert {"copper.ac@winding", "windage@rotor"} & set(hidden) == set()
    assert set(hidden) <= set(assessment.unseen)


def test_what_a_model_gets_wrong_counts_in_a_plan(case, monkeypatch):
    """A plan that is looked at again promises other than by tangents alone: its model error is not zero."""
    steering, assessment = looked_at(case, "servo", 2.0)
    doubted = [c for c in choices(assessment, steering.bench, steering.now) if c.minutes == 10.0]
    monkeypatch.setattr("extras.bench.live.planning.CHECKED", 0)
    plain = {str(c.set_point): c.nats for c in choices(assessment, steering.bench, steering.now) if c.minutes == 10.0}
    assert max(abs(c.nats / plain[str(c.set_point)] - 1.0) for c in doubted) > 0.1


def test_an_answer_that_changes_is_a_gain(steering, case):
    odds = [("nothing", 0.9), ("windage@rotor", 0.1)]
    one, other = (Assessment(tuple(x), (), (), None, None) for x in (odds, [("windage@rotor", 0.6), ("nothing", 0.4)]))
    assert one.gain_over(dict(odds)) == 0.0
    # 0.6 ln(0.6 / 0.1) + 0.4 ln(0.4 / 0.9), though the odds are less sure than before
    assert other.gain_over(dict(odds)) == pytest.approx(0.7507, abs=1e-4)


def test_information_is_what_two_far_and_two_equal_hypotheses_give():
    # one reading of one parameter: equal predictions tell nothing, far ones all of ln 2 (Cover and Thomas, 2.4)
    def rival(mean, lead):
        return Rival(0.5, lead, (0,), np.array([mean]), np.array([[1e-6]]))

    J = np.ones((4, 1))
    assert information(J, [rival(0.0, "a"), rival(0.0, "b")]) == pytest.approx(0.0, abs=1e-9)
    assert information(J, [rival(0.0, "a"), rival(100.0, "b")]) == pytest.approx(np.log(2.0))
    near = information(J, [rival(0.0, "a"), rival(1.0, "b")])  # D = 4 / 8: a lower bound of what is there to know
    assert near == pytest.approx(-np.log(0.5 + 0.5 * np.exp(-0.5)), rel=1e-3)


def test_a_run_goes_on_from_its_last_row_and_drops_half_a_row(case):
    store = Store(case, "live", "tests/columns.toml")
    steering = Steering(bench_of(case), store)
    for i in range(3):
        steering.row({**ROW, "time_s": 5.0 * (i + 1)})
    store.close()
    path = case / "tests" / "live.csv"
    before = path.read_text()
    path.write_text(f"{before}20,0,0,2")
    again = Steering(bench_of(case), Store(case, "live", "tests/columns.toml"))
    assert again.time == 15.0
    assert again.row({**ROW, "time_s": 10.0}, replay=True) == []  # a recording that is read again from its start
    again.row({**ROW, "time_s": 20.0})
    assert path.read_text() == before + before.splitlines()[-1].replace("15,", "20,", 1) + "\n"


def test_a_page_says_done_and_a_run_that_is_killed_waits_on(case, steering):
    steering.row(ROW)
    steering._set(HOT, 3.0)
    steering.store.close()
    store = Store(case, "live", "tests/columns.toml")
    again = Steering(bench_of(case), store)
    assert (again.now, again.obeyed, again.time) == (HOT, False, 5.0)
    assert not store.hears_done()
    (case / "tests" / "live.done").touch()
    assert store.hears_done()
    assert not store.hears_done()
    again.done()
    assert [e["event"] for e in store.events()] == ["begin", "set", "done"]
    store.close()
    assert Steering(bench_of(case), Store(case, "live", "tests/columns.toml")).obeyed


SLIPS = {
    "unknown key": lambda d: d["set"]["current_A"].update(colour=1),
    "no levels": lambda d: d["set"]["current_A"].update(levels=[]),
    "no limits": lambda d: d.pop("limits"),
    "no sheet": lambda d: d.pop("sheet"),
    "no rate": lambda d: d["set"]["current_A"].pop("rate_per_s"),
    "a rate of zero": lambda d: d["set"]["current_A"].update(rate_per_s=0),
    "text for a number": lambda d: d["limits"]["winding"].update(most_C="130"),
    "a hot spot below its mean": lambda d: d["limits"]["winding"].update(hot_spot=0.5),
    "a look in no time": lambda d: d.update(every_s=0),
    "a number for a flag": lambda d: d["set"]["current_A"].update(cooling=1),
}


@pytest.mark.parametrize("slip", SLIPS.values(), ids=SLIPS)
def test_what_the_schema_refuses_the_reader_refuses(slip, case):
    file = case / "bench.toml"
    data = tomllib.loads(file.read_text())
    slip(data)
    assert faults(data)
    file.write_text(tomlkit.dumps(data))
    with pytest.raises(InputError):
        bench_of(case)


def faults(data):
    return [e.message for e in Draft202012Validator(schema("bench")).iter_errors(data)]


def test_two_writers_are_refused(case, steering):
    with pytest.raises(InputError, match="is written by another run"):
        Store(case, "live", "tests/columns.toml")


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"time_s": 4.0}, "out of order"),
        ({"time_s": -9000.0}, "jumps back"),
        ({"time_s": 9000.0}, "clock jumps"),
        ({"time_s": float("nan")}, "without a time"),
        ({"time_s": 10.0, "T_winding": 131.0}, "T_winding reads 131.0 degC"),
        ({"time_s": 10.0, "current_A": 9.0}, "current_A reads 9"),
        ({"time_s": 10.0, "extra": 1.0}, "column 'extra' is new"),
    ],
)
def test_a_fault_sets_the_bench_safe_and_says_one_thing(case, steering, change, what):
    steering.row(ROW)
    steering._set(HOT, 3.0)
    source = Scripted([json.dumps({k: None if v != v else v for k, v in {**ROW, **change}.items()})])
    with pytest.raises(BenchError, match=what):
        Session(steering, source, case, True, lambda line: None, False).run()
    assert json.loads(source.sent[-1]) == {"set": {"current_A": 0.0, "speed_rpm": 0.0}}
    assert (case / "tests" / "live.csv").read_text().count("\n") >= 2


class Scripted:
    """A source of given lines; silence after them."""

    def __init__(self, lines):
        self.where, self.lines, self.sent = "script", list(lines), []
        self.send = self.sent.append

    def line(self, timeout):
        if not self.lines:
            time.sleep(0.01)
            raise queue.Empty
        return self.lines.pop(0)

    def set(self, set_point):
        self.send(json.dumps({"set": set_point}))


def test_a_plant_that_stops_answering(case, steering):
    steering.bench = replace(steering.bench, silence_s=0.1)
    source = Scripted([json.dumps(ROW)])
    with pytest.raises(BenchError, match="no row for"):
        Session(steering, source, case, True, lambda line: None, False).run()
    assert source.sent


def test_whatever_breaks_leaves_the_bench_safe(case, steering, monkeypatch):
    source = Scripted([json.dumps({**ROW, "time_s": 5.0 * i}) for i in range(1, 30)])

    def broken(path):
        raise ZeroDivisionError

    monkeypatch.setattr(steering, "think", broken)
    with pytest.raises(ZeroDivisionError):
        Session(steering, source, case, True, lambda line: None, False).run()
    assert json.loads(source.sent[-1]) == {"set": {"current_A": 0.0, "speed_rpm": 0.0}}


def test_set_points_change_no_faster_than_they_may(steering):
    steering.row(ROW)
    steering._set(HOT, 3.0)
    (after,) = steering.row({**ROW, "time_s": 5.5})
    rate = {k.name: k.rate_per_s for k in steering.bench.knobs}
    assert after["current_A"] <= 1.6 * rate["current_A"]
    assert after["speed_rpm"] <= 1.6 * rate["speed_rpm"]


def test_fast_rows_and_equal_places_are_averaged():
    time, y = np.arange(8000) * 0.1, np.arange(8000.0)
    one = Channel("a", "core", None, y, 0.5)
    both = (one, replace(one, name="b", y=y + 2.0))
    test = Test("live", "calibrate", time, {"current_A": y}, {"ambient": 20.0}, both)
    small = thinned(test)
    assert small.time.size <= MOST_ROWS
    (channel,) = small.channels
    assert np.allclose(channel.y, np.interp(small.time, time, y) + 1.0)  # the mean of a straight line is at mid-block
    assert np.allclose(small.inputs["current_A"], np.interp(small.time, time, y))


def test_a_dead_sensor_stays_over_when_its_rows_are_averaged():
    """The mean of three equal readings may differ from them in its last digit."""
    time = np.arange(0.0, 600.0, 5.0)
    dead = np.where(time < 100.0, 30.0 + 0.01 * time, np.where(time % 2 < 1, 40.8, np.nextafter(40.8, 41.0)))
    channels = (Channel("a", "core", None, dead, 0.5), Channel("b", "winding", None, 20.0 + 0.02 * time, 0.5))
    live, over = without_stuck(Test("live", "calibrate", time, {"current_A": time}, {"ambient": 20.0}, channels))
    assert over == ("a",)
    assert not np.isfinite(live.channels[0].y[time > 105.0]).any()


def test_rows_come_as_cells_and_as_objects():
    parser = Parser("x", [])
    assert parser.row("time_s,T\n") is None
    assert parser.row("1,20.5\n") == {"time_s": 1.0, "T": 20.5}
    assert parser.row('{"time_s": 2, "T": 21}') == {"time_s": 2.0, "T": 21.0}
    with pytest.raises(BenchError, match="3 cells"):
        parser.row("1,2,3")
    with pytest.raises(BenchError, match="is not a row"):
        parser.row("{")


def test_a_line_that_breaks_is_said(case, steering):
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]

        def serve():
            link, _ = server.accept()
            link.sendall(json.dumps(ROW).encode() + b"\n")
            time.sleep(0.5)
            link.close()

        threading.Thread(target=serve, daemon=True).start()
        session = Session(steering, source_of(f"tcp://127.0.0.1:{port}"), case, True, lambda line: None, False)
        with pytest.raises(BenchError, match="is gone: closed by the other side"):
            session.run()
    with pytest.raises(InputError, match="no bench answers"):
        source_of(f"tcp://127.0.0.1:{port}")


def test_a_recording_that_grows_no_more_ends_without_an_answer(case, tmp_path):
    rows = tmp_path / "rows.csv"
    plant = Plant(drawn("servo", 7, "nothing"))
    lines = [row for _ in range(30) if (row := plant.row())]
    rows.write_text("\n".join([",".join(lines[0]), *(",".join(map(str, r.values())) for r in lines), ""]))
    file = case / "bench.toml"
    file.write_text(f"silence_s = 1\n{file.read_text()}")
    answer = answered("bench", "live", case, "--follow", rows, "--out", tmp_path, "--json", "-")
    document = answer.document
    assert answer.code == 1
    assert document["stop"] == "the rows are at their end"
    assert document["odds"][0]["cause"] == "nothing"
    assert (tmp_path / "live-odds.png").exists()
    refused = answered("bench", "live", case, "--follow", rows, "--drive")
    assert refused.code == 2
    assert "set points cannot go to a file" in refused.err


@pytest.mark.skipif(not shutil.which("mosquitto", path="/usr/sbin:/usr/bin"), reason="no broker here")
def test_rows_and_set_points_go_by_a_broker_and_it_may_be_gone(case, steering):
    aiomqtt = pytest.importorskip("aiomqtt")
    import asyncio

    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    broker = subprocess.Popen([shutil.which("mosquitto", path="/usr/sbin:/usr/bin"), "-p", str(port)])
    try:
        source = _patiently(f"mqtt://127.0.0.1:{port}/bench")

        async def talk():
            async with aiomqtt.Client("127.0.0.1", port) as client:
                await client.subscribe("bench/set")
                await client.publish("bench/rows", json.dumps(ROW))
                assert json.loads(await asyncio.to_thread(source.line, 30.0)) == ROW
                await asyncio.to_thread(source.set, HOT)
                async for message in client.messages:
                    return json.loads(message.payload)

        assert asyncio.run(talk()) == {"set": HOT}
        broker.terminate()
        with pytest.raises(BenchError, match="is gone"):
            Session(steering, source, case, True, lambda line: None, False).run()
    finally:
        broker.kill()
        broker.wait()
    with pytest.raises(InputError, match="no broker answers"):
        source_of(f"mqtt://127.0.0.1:{port}/bench")


def _patiently(where):
    for _ in range(50):
        try:
            return source_of(where)
        except InputError:
            time.sleep(0.1)
    raise AssertionError("no broker")


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('place = "winding"', 'place = "nowhere"', "place"),
        ("[set.current_A]", "[set.current]", "measured by no column"),
    ],
)
def test_a_wrong_bench_file_is_one_message(case, old, new, what):
    file = case / "bench.toml"
    file.write_text(file.read_text().replace(old, new, 1))
    with pytest.raises(InputError, match=what):
        bench_of(case)
