"""What follows from an object alone is worked out once, and forgotten with it."""

import gc
from dataclasses import replace

import numpy as np

from lumped.integration.signals import Signals
from lumped.model.once import once
from lumped.transfer.laws import InputPower, Law
from measured.case import Test


class Thing:
    def __init__(self, size):
        self.size = size


def test_the_same_object_is_looked_at_once_and_an_equal_one_again():
    seen = []

    @once
    def doubled(of):
        seen.append(of.size)
        return 2 * of.size

    one, other = Thing(3), Thing(3)
    assert [doubled(one), doubled(one), doubled(other)] == [6, 6, 6]
    assert seen == [3, 3]


def test_what_has_gone_is_not_mistaken_for_what_took_its_place():
    @once
    def size(of):
        return of.size

    for k in range(50):
        assert size(Thing(k)) == k
        gc.collect(0)


def test_laws_of_the_same_input_share_how_it_runs_between_the_samples(monkeypatch):
    looked, moves = [], Signals._moves
    monkeypatch.setattr(Signals, "_moves", lambda given, names: looked.append(given.nt) or moves(given, names))
    time = np.linspace(0.0, 1.0, 50)
    given = Signals({"current_A": 10.0 + 90.0 * time, "speed_rpm": 100.0 * time}, time.size)
    squares = [InputPower(watts, (("current_A", 10.0, 2.0),)) for watts in (1.0, 3.0)]
    first, second = (given.curve("copper", law) for law in squares)
    given.curve("iron", InputPower(1.0, (("speed_rpm", 100.0, 1.5),)))
    assert looked == [50, 50]
    np.testing.assert_allclose(first.bulge[1:], -0.25 * (9.0 / 49.0) ** 2, rtol=1e-9)  # of a square
    np.testing.assert_allclose(second.bulge[1:], 3.0 * first.bulge[1:], rtol=1e-9)


def test_an_equal_law_has_the_factor_that_was_made_of_the_first():
    """Every fit makes the laws of its doubts anew."""
    given = Signals({"current_A": np.linspace(10.0, 100.0, 50)}, 50)
    first, second, other = (InputPower(2.0, (("current_A", 10.0, n),)) for n in (2.0, 2.0, 3.0))
    assert given.curve("copper", second) is given.curve("copper", first)
    assert given.curve("copper", other) is not given.curve("copper", first)


def test_a_test_with_other_sensors_blocks_or_boundaries_has_the_same_signals():
    time = np.arange(10.0)
    test = Test("a", "calibrate", time, {"current_A": time}, {"ambient": np.full(10, 20.0)}, ())
    alike = replace(test, boundaries={"ambient": time}, blocks=np.array([0, 5]), role="validate")
    assert alike.signals is test.signals
    others = replace(test, inputs={"current_A": 2.0 * time}), replace(test, time=2.0 * time), replace(test, name="b")
    assert not any(x.signals is test.signals for x in others)


class Wave(Law):
    """A law of the clock that asks for no other instant."""

    reads, by_instant = ("time_s",), True

    def factor(self, inputs):
        return np.sin(inputs["time_s"])


def test_a_law_of_the_instant_alone_is_made_stretch_by_stretch():
    """The whole of a long record is not made for it: it would stay in memory, once for each such law."""
    time, law = np.arange(1000.0), Wave()
    whole = Signals({"time_s": time}, time.size)
    part = whole.part(slice(300, 400))
    assert np.array_equal(part.factor("x", law), np.sin(time[300:400]))
    assert not whole._known
