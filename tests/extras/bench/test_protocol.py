"""The guided procedure: a good record gives temperatures, a wrong one is refused for the right reason."""

from dataclasses import replace

import numpy as np
import pytest

from extras.bench.measuring.protocol import Cold, Hot, Record, protocol

BETA, ALPHA, COLD_C = 0.3925e-2, -0.105e-2, 21.0
COOLING = tuple((t, 0.52 * (1 + BETA * (60.0 + 12.0 * np.exp(-t / 150.0)))) for t in np.arange(25.0, 330.0, 15.0))
WARMING = tuple((m, 70.0 - 49.0 * np.exp(-m / 60.0)) for m in np.arange(0.0, 600.0, 2.0))
COLD = Cold(21.2, COLD_C, 0.52, 290.0, 383.0, range_high=4.0, hours_since_run=20.0)
HOT = Hot(22.0, COOLING, 290.0 * (1 + ALPHA * 50.0), 383.0, range_high=4.0)
GOOD = Record(7.0, COLD, WARMING, 0.5, HOT)


def states(record):
    return {s.name: s.state for s in protocol(record).steps}


def test_good_record_gives_temperatures():
    found = protocol(GOOD)
    assert set(states(GOOD).values()) == {"done"}
    assert found.complete
    assert found.temperatures["winding, exponentials"] == pytest.approx(COLD_C + 72.0, abs=0.1)
    assert found.winding.value == pytest.approx(72.0, abs=0.1)
    assert found.magnets.value == pytest.approx(50.0)
    assert found.temperatures["winding, IEC 60034-1"] == pytest.approx(COLD_C + 60 + 12 * np.exp(-25 / 150))


def test_what_is_to_do_next():
    nothing = protocol(Record(7.0))
    assert [s.state for s in nothing.steps] == ["to do"] * 6
    assert [s.name for s in nothing.steps][:2] == ["room temperature", "cold resistance"]
    started = states(Record(7.0, COLD))
    assert started["cold back-EMF"] == "done"
    assert started["constant load"] == "to do"


def changed(**keys):
    part = {k: v for k, v in keys.items() if k in ("warming", "rated_kW")}
    cold = {k: v for k, v in keys.items() if k in Cold.__dataclass_fields__ and k not in ("volt", "rpm")}
    hot = {k.removeprefix("hot_"): v for k, v in keys.items() if k.startswith("hot_")}
    return replace(GOOD, cold=replace(COLD, **cold), hot=replace(HOT, **hot), **part)


@pytest.mark.parametrize(
    ("record", "step", "words"),
    [
        (changed(machine_C=24.0), "room temperature", "2.8 K off the room"),
        (changed(range_high=40.0), "cold resistance", "resolution 0.02"),
        (changed(warming=WARMING[:60]), "constant load", "K/h"),
        (changed(warming=WARMING[:20]), "constant load", "an hour at least"),
        (changed(warming=WARMING[:91:15]), "constant load", "K/h"),  # a reading every half hour, to 180 min
        (changed(hot_cooling=tuple((t + 60, R) for t, R in COOLING)), "hot resistance", "60 s is the latest"),
        (changed(hot_cooling=tuple((t, 0.5) for t, _ in COOLING)), "hot resistance", "not above the cold"),
        (changed(hot_range_high=40.0), "hot resistance", "resolution 0.02"),
        (changed(hot_volt=295.0), "hot back-EMF", "not below the cold"),
        (changed(hot_rpm=None), "hot back-EMF", "needs its speed"),
    ],
)
def test_what_would_be_wrong_is_refused(record, step, words):
    found = protocol(record)
    assert [s.name for s in found.refused] == [step]
    assert words in found.refused[0].words
    assert found.winding is None
    assert not found.temperatures


@pytest.mark.parametrize(
    ("record", "step"),
    [
        (changed(hours_since_run=3.0), "room temperature"),
        (changed(hot_cooling=COOLING[:3]), "hot resistance"),
        (changed(hot_rpm=350.0, hot_volt=290.0 * (1 + ALPHA * 50.0) * 350 / 383), "hot back-EMF"),
    ],
)
def test_what_is_doubtful_is_said_and_used(record, step):
    assert states(record)[step] == "doubtful"
    assert protocol(record).magnets.value == pytest.approx(50.0)


def test_larger_machines_may_be_read_later():
    late = tuple((t + 60, R) for t, R in COOLING)
    assert states(changed(rated_kW=150.0, hot_cooling=late))["hot resistance"] == "done"
