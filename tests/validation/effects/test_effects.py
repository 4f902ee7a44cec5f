"""Claims that every effect of the catalogue makes, tested for all."""

import re
from functools import partial
from pkgutil import walk_packages

import numpy as np
import pytest
from everything import machine, scene, warm_test

import validation.effects as folder
from geom.errors import InputError
from lumped.integration.balance import balance
from lumped.model.network import Source
from lumped.transfer.terms_value import temperature_value
from measured.sensors.operators import setting
from validation.comparison.predict import heat_model, predict, record
from validation.effects import catalogue, effect, kinds
from validation.effects.above import Above
from validation.effects.during import During
from validation.effects.sensors.input_fault import InputFault

KINDS = kinds()
SHARED = {
    f"validation.effects.{name}"
    for name in ("above", "input_terms", "base", "build", "during", "time_window", "registry", "sites")
}


@pytest.fixture(scope="module")
def net():
    return machine()


@pytest.fixture(scope="module")
def before(net):
    return predict(net, warm_test(net), {}).y


WHILE = "warm:300-600s"  # some of the test
WHOLE = ("ambient.offset",)  # in a whole test only


def first(kind, net):
    places = KINDS[kind].places(scene(net))
    return KINDS[kind]("flange.right" if "flange.right" in places else places[0])


LASTING = [
    k
    for k, cls in KINDS.items()
    if k == "mass"
    or (
        cls.__module__.startswith("validation.effects.sensors.")
        and not issubclass(cls, InputFault)
        and not cls.temporary
    )
]


TERMS = (
    "loss.input@housing|speed_rpm^2 at 3000",
    "loss.input@rotor|speed_rpm at 3000 * current_A^2 at 200",
    "conductance.input@ambient|flange.right|vehicle_speed_mps^0.8 at 10",
    "conductance.input@housing|rotor|speed_rpm at 3000",
)


def every_effect():
    """Name and maker of one of every kind, of one of every kind that holds for a while, of laws above a level, and of
    what follows an input."""
    yield from ((kind, partial(first, kind)) for kind in KINDS)
    for kind in (k for k in KINDS if k not in LASTING):
        condition = "warm" if kind in WHOLE else WHILE
        yield f"{kind} in", lambda net, kind=kind, condition=condition: During.of(first(kind, net), condition)
    for target in ("loss:copper.winding.armature", "loss:iron.rotor", "film:housing", "film:poles:fan"):
        yield f"law {target}", lambda net, target=target: Above(f"{target}|current_A>150")
    for name in TERMS:
        yield name, lambda net, name=name: effect(name)


EVERY = [pytest.param(make, id=name) for name, make in every_effect()]


@pytest.mark.parametrize("kind", LASTING)
def test_what_cannot_hold_for_a_while_says_so(kind, net):
    with pytest.raises(InputError, match="cannot hold for a while"):
        During.of(first(kind, net), WHILE).extend(net)


def test_an_offset_of_a_boundary_follows_no_input(net):
    with pytest.raises(InputError, match=r"follows no input.*ambient\.offset@ambient in TEST"):
        effect("ambient.offset@ambient in speed_rpm", scene(net))


def added(bigger, net):
    return [*bigger.links[len(net.links) :], *bigger.sources[len(net.sources) :]]


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


@pytest.mark.parametrize("make", EVERY)
def test_neutral_is_identical_to_the_bit(make, net, before):
    bigger, parameter = grown(make(net), net)
    assert parameter.name == make(net).name
    np.testing.assert_array_equal(predict(bigger, warm_test(net), {parameter.name: parameter.neutral}).y, before)


@pytest.mark.parametrize("kind", KINDS)
def test_neutral_is_identical_at_every_place(kind, net, before):
    for place in KINDS[kind].places(scene(net)):
        bigger, parameter = grown(KINDS[kind](place), net)
        y = predict(bigger, warm_test(net), {parameter.name: parameter.neutral}).y
        np.testing.assert_array_equal(y, before, err_msg=place)


@pytest.mark.parametrize("make", EVERY)
def test_derivative_is_that_of_the_answer(make, net, before):
    """Against a one-sided difference; 1 % covers its own error where the answer is curved, a microkelvin what the two
    runs' own time steps differ by."""
    bigger, p = grown(make(net), net)
    step = 1e-4 * p.prior_sd * (p.sign or 1)
    J = predict(bigger, warm_test(net), {}, [p]).J[:, :, 0]
    difference = (predict(bigger, warm_test(net), {p.name: p.neutral + step}).y - before) / step
    assert np.abs(J).max() > 0.0
    np.testing.assert_allclose(J, difference, atol=max(0.01 * np.abs(J).max(), 1e-6 / abs(step)))


@pytest.mark.parametrize("kind", KINDS)
def test_patterns_conserve_heat_at_every_place(kind, net):
    """A new link carries nothing at uniform temperature and takes at one end what it gives at the other."""
    n, places = len(net.states), KINDS[kind].places(scene(net))
    assert places
    for bigger in (KINDS[kind](place).extend(net) for place in places):
        for link in bigger.links[len(net.links) :]:
            P = np.zeros((bigger.size, bigger.size))
            np.add.at(P, (link.rows, link.cols), link.vals)
            np.testing.assert_allclose(P.sum(axis=1), 0.0, atol=1e-12)
            inner = P[:n, :n].sum(axis=0) + P[:n, n:].sum(axis=1)
            np.testing.assert_allclose(inner.sum(), 0.0, atol=1e-12)
        for source in bigger.sources[len(net.sources) :]:
            assert source.weights.sum() == pytest.approx(1.0)


@pytest.mark.parametrize("make", EVERY)
def test_heat_is_conserved_at_a_usual_size(make, net):
    """In - out - stored along the run; what the effect adds carries some of it."""
    bigger, p = grown(make(net), net)
    test, values = warm_test(net), {p.name: p.neutral + p.prior_sd * (p.sign or 1)}
    heat = balance(*heat_record(bigger, test, values))
    assert np.abs(heat.residual).max() < 1e-4
    for one in added(bigger, net):
        carried = heat.through if one.name in heat.through else heat.injected
        assert np.abs(carried[one.name]).max() > 0.0


def heat_record(network, test, values):
    """What of an effect acts on heat, and the record with what acts on its boundaries."""
    bare, heat = heat_model(network, values)
    return bare, record(test, setting(network.parameters, values)), heat


def way(one, net):
    """+1 where an effect can only heat the machine, -1 where it can only cool it, 0 where it may do either: where its
    amplitude has either sign, or what it acts on is between two parts, or is not heat."""
    bigger, p = grown(one, net)
    names = [name for name, _ in p.targets]
    acted = [x for x in (*bigger.links, *bigger.sources) if x.name in names]
    signs = {p.sign * _heats(x, net) for x in acted}
    return signs.pop() if len(signs) == 1 else 0


def _heats(one, net):
    factor = np.broadcast_to(one.law.factor(warm_test(net).signals), warm_test(net).time.shape)
    sign = int(factor.min() >= 0.0) - int(factor.max() <= 0.0)
    if isinstance(one, Source):
        return sign
    return -sign * (one.kind == "stream" or bool(set(one.places) & set(net.boundaries)))


ONE_WAY = [k for k in KINDS if way(first(k, machine()), machine())]


def test_what_has_a_sign_heats_or_cools_unless_it_is_between_parts_or_no_heat():
    left = {k for k, cls in KINDS.items() if k not in ONE_WAY and cls.sign and not cls.fault}
    assert left == {"contact", "coupling", "gap.convection", "end.mixing", "mass", "copper.feedback"}


@pytest.mark.parametrize("kind", ONE_WAY)
def test_cooling_cools_and_heating_heats(kind, net):
    bigger, p = grown(first(kind, net), net)
    late = predict(bigger, warm_test(net), {}, [p]).J[-1, :, 0] * p.sign
    assert way(first(kind, net), net) * late[np.argmax(np.abs(late))] > 0


@pytest.mark.parametrize("name", TERMS[:3])
def test_a_loss_that_follows_an_input_heats_and_a_film_cools(name, net):
    bigger, p = grown(effect(name), net)
    late = predict(bigger, warm_test(net), {}, [p]).J[-1, :, 0]
    assert late[np.argmax(np.abs(late))] * (1.0 if name.startswith("loss") else -1.0) > 0.0
    (law,) = {one.law for one in added(bigger, net)}
    assert float(law.factor({f: level for f, _, level, _ in effect(name).parts()[1]})) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "name",
    [
        "loss.input@housing",
        "loss.input@housing|speed_rpm at 0",
        "loss.input@nowhere|speed_rpm at 3000",
        "loss.input@housing|wind at 3000",
    ],
)
def test_what_follows_an_input_says_what_is_wrong_with_its_place(name, net):
    with pytest.raises(InputError, match=r"is not a place|no place|unknown input"):
        effect(name, scene(net)).extend(net)


def test_a_conductance_is_told_at_rest_and_at_the_largest_input(net):
    """What is declared between the two at rest, and what comes on top of it."""
    declared = [x for x in net.links if set(x.places) == {"housing", "coolant"}] or net.links
    assert declared
    one = effect("conductance.input@coolant|housing|speed_rpm at 3000")
    words = one.words(5.0, net, {})
    rest, most = (float(x) for x in re.findall(r"([0-9.]+)(?= W/K at rest|(?= at speed_rpm))", words))
    assert most - rest == pytest.approx(5.0, abs=0.06)
    assert rest > 0.0


def test_a_warmer_winding_loses_more(net):
    """With the feedback of copper that the network lacks, above the reference of 20 degC."""
    bigger, p = grown(first("copper.feedback", net), net)
    late = predict(bigger, warm_test(net), {}, [p]).J[-1, :, 0]
    assert late.max() > 0.0
    assert late.min() > -1e-6 * late.max()


INPUT = {
    "rpm": ("speed_rpm", 1.0),
    "A": ("current_A", 1.0),
    "m/s": ("vehicle_speed_mps", 1.0),
    "kHz": ("switching_Hz", 1000.0),
    "degC": ("of the place", 1.0),
}


def condition(at):
    """{input: value} of words such as "1000 rpm and 100 A"."""
    terms = [term.split() for term in at.split(" and ")]
    return {INPUT[unit][0]: float(number) * INPUT[unit][1] for number, unit in terms}


@pytest.mark.parametrize("kind", [k for k, cls in KINDS.items() if cls.at and k != "convection.buoyant"])
def test_an_amplitude_is_what_the_effect_amounts_to_at_its_condition(kind, net):
    bigger, p = grown(first(kind, net), net)
    new = added(bigger, net)
    assert new
    at = condition(KINDS[kind].at)
    there = at.get("of the place", 20.0)
    watts = [float(one.law.factor(at)) * temperature_value(one.law.temperature, there, there) for one in new]
    assert watts == pytest.approx([1.0] * len(new))
    assert p.unit.endswith(f" at {KINDS[kind].at}")


def test_eddy_currents_in_copper_fall_with_its_resistivity(net):
    (loss,) = added(grown(first("copper.ac", net), net)[0], net)
    assert temperature_value(loss.law.temperature, 150.0, 0.0) == pytest.approx(1.0 / (1.0 + 0.00393 * 130.0))


def test_natural_convection_is_its_amplitude_at_the_rise_it_says(net):
    bigger, p = grown(first("convection.buoyant", net), net)
    (law,) = {link.law for link in bigger.links[len(net.links) :]}
    assert law.factor({}) * 40.0**law.temperature.exponent == pytest.approx(1.0)
    assert p.unit.endswith(" at 40 K")


@pytest.mark.parametrize("name", ["wind@flange.right", "convection@nowhere", "convection"])
def test_unknown_effects_say_what_would_be_right(name, net):
    with pytest.raises(InputError, match=r"known|it can sit"):
        effect(name, scene(net))


def test_catalogue_needs_what_was_recorded(net):
    from dataclasses import replace

    calm = replace(scene(net), inputs=frozenset({"current_A"}))
    assert "convection" not in {e.kind for e in catalogue(calm)}
    with pytest.raises(
        InputError, match=r"nowhere here; it needs: a column of vehicle_speed \(input vehicle_speed_mps\)"
    ):
        effect("convection@flange.right", calm)
