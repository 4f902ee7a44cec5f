"""Claims that every effect of the catalogue makes, tested for all."""

from pkgutil import walk_packages

import numpy as np
import pytest
from everything import machine, scene, warm_test

import validation.effects as folder
from geom.errors import InputError
from lumped.transfer.laws import InputPower
from validation.comparison.predict import predict
from validation.effects import catalogue, effect, kinds

KINDS = kinds()
COOLING = [
    "convection",
    "convection.constant",
    "convection.fan",
    "convection.buoyant",
    "radiation",
    "conduction.bench",
    "coolant",
    "conduction.shaft",
    "conduction.cable",
]
HEATING = ["iron", "windage", "bearing.friction", "brush.drop", "brush.friction", "loss.winding", "loss.rotor",
           "loss.constant", "iron.pwm", "copper.ac", "copper.feedback"]  # fmt: skip
SHARED = {
    f"validation.effects.{name}"
    for name in (
        "above", "base", "build", "during", "time_window", "registry", "sites", "losses.added_loss",
        "films.ambient_film", "sensors.reading_fault", "sensors.input_fault",
    )
}  # fmt: skip


@pytest.fixture(scope="module")
def net():
    return machine()


@pytest.fixture(scope="module")
def before(net):
    return predict(net, warm_test(net), {}).y


def first(kind, net):
    places = KINDS[kind].places(scene(net))
    return KINDS[kind]("flange.right" if "flange.right" in places else places[0])


def grown(one, net):
    bigger = one.extend(net)
    return bigger, bigger.parameters[-1]


def test_every_file_is_in_the_catalogue():
    modules = {m.name for m in walk_packages(folder.__path__, "validation.effects.") if not m.ispkg}
    assert modules - SHARED == {cls.__module__ for cls in KINDS.values()}
    assert len(KINDS) >= 24


@pytest.mark.parametrize("kind", KINDS)
def test_declares_itself(kind):
    cls = KINDS[kind]
    assert all(getattr(cls, word) for word in ("title", "unit", "source", "isolating_test", "confused_with", "__doc__"))
    assert cls.low <= cls.neutral <= cls.high
    assert cls.sign == 0 or cls.sign * min(cls.typical, key=abs) > 0


@pytest.mark.parametrize("kind", KINDS)
def test_neutral_is_identical_to_the_bit(kind, net, before):
    bigger, parameter = grown(first(kind, net), net)
    assert parameter.name == first(kind, net).name
    np.testing.assert_array_equal(predict(bigger, warm_test(net), {parameter.name: parameter.neutral}).y, before)


@pytest.mark.parametrize("kind", KINDS)
def test_derivative_is_that_of_the_answer(kind, net, before):
    """Against a one-sided difference; 1 % covers its own error where the answer is curved, a microkelvin what the two
    runs' own time steps differ by."""
    bigger, p = grown(first(kind, net), net)
    step = 1e-4 * p.prior_sd * (p.sign or 1)
    J = predict(bigger, warm_test(net), {}, [p]).J[:, :, 0]
    difference = (predict(bigger, warm_test(net), {p.name: p.neutral + step}).y - before) / step
    assert np.abs(J).max() > 0.0
    np.testing.assert_allclose(J, difference, atol=max(0.01 * np.abs(J).max(), 1e-6 / abs(step)))


@pytest.mark.parametrize("kind", KINDS)
def test_heat_is_conserved(kind, net):
    """A new link carries nothing at uniform temperature and takes at one end what it gives at the other."""
    bigger, _ = grown(first(kind, net), net)
    n = len(bigger.states)
    for link in bigger.links[len(net.links) :]:
        P = np.zeros((bigger.size, bigger.size))
        np.add.at(P, (link.rows, link.cols), link.vals)
        np.testing.assert_allclose(P.sum(axis=1), 0.0, atol=1e-12)
        inner = P[:n, :n].sum(axis=0) + P[:n, n:].sum(axis=1)
        np.testing.assert_allclose(inner.sum(), 0.0, atol=1e-12)
    for source in bigger.sources[len(net.sources) :]:
        assert source.weights.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(("kind", "way"), [(k, -1) for k in COOLING] + [(k, 1) for k in HEATING])
def test_cooling_cools_and_heating_heats(kind, way, net):
    bigger, p = grown(first(kind, net), net)
    late = predict(bigger, warm_test(net), {}, [p]).J[-1, :, 0]
    assert way * late[np.argmax(np.abs(late))] > 0


INPUT = {"rpm": ("speed_rpm", 1.0), "A": ("current_A", 1.0), "m/s": ("vehicle_speed_mps", 1.0),
         "kHz": ("switching_Hz", 1000.0)}  # fmt: skip


def condition(at):
    """{input: value} of words such as "1000 rpm and 100 A"."""
    terms = [term.split() for term in at.split(" and ")]
    return {INPUT[unit][0]: float(number) * INPUT[unit][1] for number, unit in terms}


@pytest.mark.parametrize("kind", [k for k, cls in KINDS.items() if cls.at and k != "convection.buoyant"])
def test_an_amplitude_is_what_the_effect_amounts_to_at_its_condition(kind, net):
    bigger, p = grown(first(kind, net), net)
    new = [*bigger.links[len(net.links) :], *bigger.sources[len(net.sources) :]]
    at = condition(KINDS[kind].at)
    assert [float(one.law.factor(at)) for one in new] == pytest.approx([1.0] * len(new))
    assert p.unit.endswith(f" at {KINDS[kind].at}")


def test_natural_convection_is_its_amplitude_at_the_rise_it_says(net):
    bigger, p = grown(first("convection.buoyant", net), net)
    (law,) = {link.law for link in bigger.links[len(net.links) :]}
    assert law.factor({}) * 40.0**law.temperature.exponent == pytest.approx(1.0)
    assert p.unit.endswith(" at 40 K")


@pytest.mark.parametrize("kind", [k for k, cls in KINDS.items() if not cls.at])
def test_what_scales_with_an_input_says_at_which(kind, net):
    bigger, _ = grown(first(kind, net), net)
    new = [*bigger.links[len(net.links) :], *bigger.sources[len(net.sources) :]]
    assert not [one.name for one in new if isinstance(one.law, InputPower)]


def test_place_of_a_part_with_faces_is_its_name(net):
    one = effect("convection@flange.right", scene(net)).extend(net)
    assert one.parameters[-1].unit == "W/m2/K at 10 m/s"
    assert effect("convection@housing", scene(net)).extend(net).parameters[-1].unit == "W/K at 10 m/s"


@pytest.mark.parametrize("name", ["wind@flange.right", "convection@nowhere", "convection"])
def test_unknown_effects_say_what_would_be_right(name, net):
    with pytest.raises(InputError, match=r"known|it can sit"):
        effect(name, scene(net))


def test_catalogue_needs_what_was_recorded(net):
    from dataclasses import replace

    calm = replace(scene(net), inputs=frozenset({"current_A"}))
    assert "convection" not in {e.kind for e in catalogue(calm)}
