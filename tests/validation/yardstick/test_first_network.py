"""The first network learnt from readings: the machine's own links and losses, whatever is held out."""

from dataclasses import replace

import numpy as np
import pytest
from two_bodies import bench

from lumped.integration.simulate import Record, simulate
from measured.importing.starter import FirstNetwork
from measured.sensors.faults import broken_channels
from validation.yardstick.first_network import learn_network
from validation.yardstick.yardstick import free_network_terms

HEAT = 80.0  # W at full load, as `two_bodies` declares it


def first_of(case):
    """How much heat there is on average is all that a first network is told."""
    mean = float(np.mean([t.inputs["load"].mean() for t in case.usable]))
    return FirstNetwork("first", ["ambient"], {}, [], HEAT * mean)


@pytest.fixture(scope="module")
def case():
    sound = bench(held=())
    return replace(sound, tests=(*sound.tests[:2], replace(sound.tests[2], role="hold-out")))


@pytest.fixture(scope="module")
def learnt(case):
    return learn_network(case, first_of(case))


def terms(network):
    return {(frozenset(t.ends), t.of[0][0] if t.of else ""): t.value for t in network.terms}


def test_links_and_losses_are_those_of_the_machine(learnt):
    found = terms(learnt)
    assert set(found) == {
        (frozenset({"body", "core"}), ""),
        (frozenset({"body", "ambient"}), ""),
        (frozenset({"core"}), "load"),
    }
    assert found[frozenset({"body", "core"}), ""] == pytest.approx(4.0, rel=0.05)
    assert found[frozenset({"body", "ambient"}), ""] == pytest.approx(2.0, rel=0.05)


def test_capacities_are_those_of_the_machine(learnt):
    assert learnt.capacities["body"][0] == pytest.approx(4000.0, rel=0.05)
    assert learnt.capacities["core"][0] == pytest.approx(1500.0, rel=0.1)


def test_a_place_whose_sensor_is_plainly_broken_stays_in_the_network():
    """Nothing is learnt from it; a case that has no such place could not be compared."""
    case = bench(held=())
    stuck = [replace(c, y=np.where(np.arange(c.y.size) > 20, 900.0, c.y)) for c in case.tests[0].channels[1:]]
    tests = tuple(replace(t, channels=(t.channels[0], *stuck)) for t in case.tests)
    assert broken_channels(tests)
    first = replace(first_of(case), capacities=dict.fromkeys(("body", "core"), (3000.0, 1.0)))
    learnt = learn_network(replace(case, tests=tests), first)
    assert list(learnt.capacities) == ["body", "core"]
    assert any("core" in t.ends and len(t.ends) == 2 for t in learnt.terms)


@pytest.mark.parametrize("noise_K", [0.0, 0.05])
def test_of_one_recording_that_rests_at_first_the_rest_teaches(case, noise_K):
    """A third says nothing of heat; without noise its readings are not even known to be alive."""
    (test, *_), net = case.tests, case.model.network
    load = np.where(test.time < 0.4 * test.time[-1], 0.0, test.inputs["load"])
    rows = [net.places[c.place].mean for c in test.channels]
    y = simulate(net, Record(test.time, {"load": load}, test.boundaries, 20.0), {}, rows).y
    y = y + noise_K * np.random.default_rng(0).standard_normal(y.shape)
    channels = tuple(replace(c, y=y[:, i]) for i, c in enumerate(test.channels))
    one = replace(case, tests=(replace(test, inputs={"load": load}, channels=channels),))
    learnt = learn_network(one, first_of(one))
    assert learnt.learnt == ["noon"]


def test_held_out_readings_change_nothing(case, learnt):
    held = case.tests[2]
    bent = replace(held, channels=tuple(replace(c, y=c.y + 50.0) for c in held.channels))
    assert learn_network(replace(case, tests=(*case.tests[:2], bent)), first_of(case)).terms == learnt.terms


def test_a_held_out_test_without_the_input_takes_it_from_no_other(case, learnt):
    held = replace(case.tests[2], inputs={}, channels=case.tests[2].channels[:1])
    lacking = replace(case, tests=(*case.tests[:2], held))
    assert learn_network(lacking, first_of(case)).terms == learnt.terms
    assert free_network_terms(lacking) == free_network_terms(case)


def test_the_order_of_tests_and_sensors_changes_nothing(case, learnt):
    turned = tuple(replace(t, channels=t.channels[::-1]) for t in case.tests[::-1])
    other = terms(learn_network(replace(case, tests=turned), first_of(case)))
    assert other == pytest.approx(terms(learnt), rel=0.02)


def test_twice_the_heat_is_twice_of_everything(case, learnt):
    first = first_of(case)
    double = learn_network(case, replace(first, watts=2.0 * first.watts))
    assert terms(double) == pytest.approx({k: 2.0 * v for k, v in terms(learnt).items()})


def test_no_film_follows_a_current(case):
    """A current that runs whenever the load does would explain a film as well; films follow what moves."""
    network = replace(case.model.network, quantities={"load": "current"})
    learnt = learn_network(replace(case, model=replace(case.model, network=network)), first_of(case))
    assert not [t for t in learnt.terms if len(t.ends) == 2 and t.of]


def five_tests(change):
    """Four sound tests, and one that is changed."""
    sound, more = bench(held=()), bench(held=(), seed=1).tests[:2]
    every = (*(replace(t, name=f"next {t.name}") for t in more), *sound.tests)
    return replace(sound, tests=(*every[:-1], change(every[-1])))


def test_a_sensor_that_slipped_off_in_one_test_does_not_choose_the_network():
    def slipped(test):
        room, late = test.boundaries["ambient"], test.time > np.median(test.time)
        off = {c.name: np.where(late, room + 0.5 * (c.y - room), c.y) for c in test.channels if c.place == "body"}
        return replace(test, channels=tuple(replace(c, y=off.get(c.name, c.y)) for c in test.channels))

    case = five_tests(slipped)
    found = terms(learn_network(case, first_of(case)))
    assert found[frozenset({"body", "core"}), ""] == pytest.approx(4.0, rel=0.05)
    assert found[frozenset({"body", "ambient"}), ""] == pytest.approx(2.0, rel=0.05)


def test_a_test_in_which_the_machine_was_another_teaches_nothing():
    """Half the air in one of five: the others predict each other better without it."""

    def weaker(test):
        read = tuple(replace(c, y=20.0 + 1.8 * (c.y - 20.0)) for c in test.channels)
        return replace(test, channels=read)

    case = five_tests(weaker)
    network = learn_network(case, first_of(case))
    assert network.learnt == [t.name for t in case.tests[:-1]]
    found = terms(network)
    assert found[frozenset({"body", "core"}), ""] == pytest.approx(4.0, rel=0.05)
    assert found[frozenset({"body", "ambient"}), ""] == pytest.approx(2.0, rel=0.05)


def test_of_sound_tests_every_one_teaches():
    case = five_tests(lambda test: test)
    assert learn_network(case, first_of(case)).learnt == [t.name for t in case.tests]
