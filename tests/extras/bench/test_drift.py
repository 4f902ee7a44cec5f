"""One test against another: one body whose rise P / G and time constant C / G are known; what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from extras.bench.measuring.drift import drift
from geom.errors import InputError
from lumped.model.build import bare_network, node_link, node_row, node_source
from lumped.transfer.laws import Fixed
from measured.case import Case, Channel, Model, Test

TIME = np.arange(0.0, 18001.0, 60.0)
C, G, P = 6e4, 20.0, 1000.0  # 50 K after 50 min


def network():
    """One body of 60 kJ/K that 20 W/K hold: 1000 W warm it by 50 K."""
    net = bare_network("body", {"body": C}, ["ambient"])
    film = node_link(net, "film", "link", "body", "ambient", Fixed(G))
    return net.extended([film], [node_source(net, "heat", "constant", {"body": 1.0}, Fixed(P))])


def run_of(name, air=20.0, film=1.0, heat=1.0, sensors=1, time=TIME, start=0.0, current=8.0):
    """The closed form, read to 0.05 K; start : K above the air"""
    rise = heat * P / (film * G) + (start - heat * P / (film * G)) * np.exp(-time * film * G / C)
    noise = 0.05 * np.random.default_rng(len(name)).standard_normal((sensors, time.size))
    channels = [Channel(f"T{k}", "body", node_row(0), air + rise + noise[k], 0.3) for k in range(sensors)]
    inputs = {"current_A": np.full(time.size, current)}
    return Test(name, "calibrate", time, inputs, {"ambient": np.full(time.size, air)}, tuple(channels), air + start)


def found(later, earlier):
    return drift(Case("body", Model(network()), (earlier, later)), later, earlier)


def rise_and_time(result):
    return result.sensors[0].changes


@pytest.mark.parametrize(("air", "start"), [(20.0, 0.0), (31.0, 0.0), (20.0, 15.0)])
def test_equal_tests_are_equal_at_another_ambient_and_start(air, start):
    result = found(run_of("later", air, start=start), run_of("earlier"))
    assert result.verdict == "equal"
    assert all(abs(c.change) < c.U95 < 0.05 for c in result.changes)
    assert "equal within uncertainty" in result.sentence
    assert result.document()["part"] is None


def test_a_record_against_itself_differs_by_nothing():
    one = run_of("one")
    assert [c.change for c in found(one, one).changes] == pytest.approx([0.0, 0.0], abs=1e-12)


def test_a_poorer_film_lengthens_rise_and_time_constant_alike():
    """Both are 1 / 0.9 of what they were."""
    result = found(run_of("later", film=0.9), run_of("earlier"))
    for change in rise_and_time(result):
        assert change.change == pytest.approx(1 / 0.9 - 1, abs=change.U95)
        assert change.verdict == "changed"
    assert "it cools less" in result.sentence
    rise, slow = rise_and_time(result)
    assert (rise.before, slow.before) == pytest.approx((P / G, C / G / 60), rel=0.03)  # after 6 time constants


def test_more_heat_leaves_the_time_constant():
    rise, slow = rise_and_time(found(run_of("later", heat=1.08), run_of("earlier")))
    assert rise.change == pytest.approx(0.08, abs=rise.U95)
    assert (rise.verdict, slow.verdict) == ("changed", "equal")


def test_what_changed_is_named_and_the_rest_is_not():
    earlier, later = (run_of(name, sensors=4) for name in ("earlier", "later"))
    warm = replace(later.channels[2], place="shell", y=20.0 + 1.2 * (later.channels[2].y - 20.0))
    cells = [*later.channels[:2], warm, later.channels[3]]
    before = [replace(c, place="shell") if c.name == "T2" else c for c in earlier.channels]
    result = found(replace(later, channels=tuple(cells)), replace(earlier, channels=tuple(before)))
    assert result.document()["part"] == "shell"
    assert {c.place for c in result.changes if c.verdict == "changed"} == {"shell"}


def test_a_test_shorter_than_the_time_constant_cannot_tell():
    """20 min of a rise that takes 50: what it ends at is extrapolated."""
    short = TIME[:21]
    result = found(run_of("later", time=short), run_of("earlier"))
    assert result.verdict == "cannot tell"
    assert "cannot tell" in result.sentence


def test_sensors_are_the_same_by_place_where_names_differ():
    later = run_of("later")
    other = replace(later, channels=(replace(later.channels[0], name="R_later"),))
    assert rise_and_time(found(other, run_of("earlier")))[0].channel == "R_later"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"inputs": {"current_A": np.full(TIME.size, 16.0)}}, "current_A is 16 here, and 8 in earlier"),
        ({"inputs": {"current_A": np.linspace(4.0, 8.0, TIME.size)}}, "its load varies"),
        ({"inputs": {"torque_Nm": np.full(TIME.size, 8.0)}}, "current_A, torque_Nm: only in one"),
        ({"channels": (Channel("T", "shell", node_row(0), 20.0 + TIME, 0.3),)}, "has no sensor where earlier has one"),
        ({"channels": (Channel("T0", "body", node_row(0), np.where(TIME < 300, 20.0, np.nan), 0.3),)}, "fewer than 8"),
    ],
)
def test_what_is_refused(change, words):
    with pytest.raises(InputError, match=words):
        found(replace(run_of("later"), **change), run_of("earlier"))
