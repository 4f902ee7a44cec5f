"""What every law claims: heat is conserved, a neutral one changes nothing, tangents are differences, limits are right.

Each is tried in a link, as a source and along a stream. A law without a case fails here.
"""

import numpy as np
import pytest
from law_cases import LAWS, LIMITS, LOSSES, NAMES, RECORD, TEMPERATURE_LIMITS, TEMPERATURES, TIME, every, inputs
from numpy.testing import assert_allclose, assert_array_equal

from lumped.integration.balance import balance
from lumped.integration.simulate import Record, simulate
from lumped.integration.steady import steady
from lumped.model.build import bare_network, node_link, node_source, stream
from lumped.model.network import Parameter
from lumped.numerics.terms import SMOOTH
from lumped.transfer.laws import Conductivity, Constant, Fixed, Law, Linear, Power, TemperatureLaw
from lumped.transfer.reversal import Direction
from lumped.transfer.terms_value import temperature_value

CLOSES = 1e-4  # of the heat: a hundredth of a kelvin of a rise of 100 K
WRONG = 1e-4  # K: a hundredth of what a step may be wrong by
FLOWS = [law for law in LOSSES if isinstance(law.temperature, Constant) and np.min(law.factor(inputs(TIME))) >= 0.0]


def kinds(laws):
    return [f"{type(law).__name__} {i}" for i, law in enumerate(laws)]


def around(*links, sources=(), parameters=()):
    """Two masses, heat into the first, a way out from the second; and two cells that a stream may pass."""
    net = bare_network("one law", {"a": 300.0, "b": 500.0, "cell1": 40.0, "cell2": 40.0}, ("ambient", "inlet"))
    built = [
        node_link(net, "beside", "link", "a", "b", Fixed(5.0)),
        node_link(net, "out", "link", "b", "ambient", Fixed(4.0)),
        node_link(net, "to cell 1", "link", "a", "cell1", Fixed(2.0)),
        node_link(net, "to cell 2", "link", "b", "cell2", Fixed(1.0)),
    ]
    heat = node_source(net, "heat", "iron", {"a": 1.0}, Fixed(60.0))
    return net.extended([*built, *(make(net) for make in links)], [heat, *(make(net) for make in sources)], parameters)


def linked(law):
    return {"links": (lambda n: node_link(n, "law", "film", "a", "b", law),)}


def injected(law):
    return {"sources": (lambda n: node_source(n, "law", "iron", {"b": 1.0}, law),)}


def streaming(law):
    return {"links": (lambda n: stream(n, "law", ("inlet", "cell1", "cell2"), law),)}


PARTS = {"link": (linked, LAWS), "source": (injected, LOSSES), "stream": (streaming, FLOWS)}
EACH = [
    pytest.param(put(law), id=f"{part} {name}")
    for part, (put, laws) in PARTS.items()
    for law, name in zip(laws, kinds(laws), strict=True)
]


def built(parts, parameters=()):
    return around(*parts.get("links", ()), sources=parts.get("sources", ()), parameters=parameters)


def test_every_law_has_a_case():
    assert {c.__name__ for c in every(Law) - {type(law) for law in LAWS}} == set()
    assert {c.__name__ for c in every(TemperatureLaw) - {type(law) for law in TEMPERATURES}} == set()
    assert set(LIMITS) == {type(law) for law in LAWS}
    assert set(TEMPERATURE_LIMITS) == {type(law) for law in TEMPERATURES}


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_two_bodies_alone_keep_their_heat_and_the_warmer_one_cools(law):
    """By the temperatures of a run alone. Where the coefficient is positive throughout, they meet and do not cross."""
    net = bare_network("alone", {"a": 300.0, "b": 500.0}, ("ambient",))
    net = net.extended([node_link(net, "law", "film", "a", "b", law)])
    start = {"a": 80.0, "b": 30.0}
    T = simulate(net, Record(TIME, RECORD.inputs, {"ambient": 18.0}, start), keep_states=True).z[:, :2]
    moved = np.abs(T[:, 0] - T[0, 0]).max()
    assert moved > 0.01
    assert_allclose(T @ net.C, 80.0 * 300.0 + 30.0 * 500.0, atol=1e-9 * 300.0 * moved + 1e-8)
    if np.min(law.factor(inputs(TIME))) >= 0.0:
        assert np.all(np.diff(T[:, 0]) <= WRONG)
        assert np.all(T[:, 0] >= T[:, 1] - WRONG)


def declared_heat(law):
    """Integral of the factor over the record, and what of it is not recorded: when within a sample a flow turns."""
    fine = np.linspace(0.0, TIME[-1], 200_001)
    u = {n: np.interp(fine, TIME, v) for n, v in inputs(TIME).items()}
    turns = np.count_nonzero(np.diff(np.sign(u[law.column]))) if isinstance(law, Direction) else 0
    return np.trapezoid(np.broadcast_to(law.factor(u), fine.shape), fine), (
        turns * np.diff(TIME).max() * np.max(law.factor(u))
    )


@pytest.mark.parametrize("law", LOSSES, ids=kinds(LOSSES))
def test_a_loss_warms_what_it_is_said_to_warm_and_nothing_else(law):
    """Bodies that nothing joins, against the closed form; with F the declared heat and a the coefficient (1/K),
    1 + a (T - reference) grows by exp(a F / C), or, of eddy currents, its square by 2 a F / C; what is not heated stays
    as it is."""
    net = bare_network("alone", {"a": 3e4, "b": 5e4, "c": 5e4}, ("ambient",))
    net = net.extended(sources=[node_source(net, "law", "iron", {"a": 0.4, "b": 0.6}, law, "b")])
    T = simulate(net, Record(TIME, RECORD.inputs, {"ambient": 18.0}, 60.0), keep_states=True).z[:, :3]
    (F, unsure), alpha = declared_heat(law), 0.0
    if isinstance(law.temperature, Linear | Conductivity):
        alpha = law.temperature.alpha
    above = 1.0 + alpha * (60.0 - law.temperature.reference) if alpha else 1.0
    rise = above * (np.expm1(0.6 * alpha * F / net.C[1]) / alpha if alpha else 0.6 * F / net.C[1])
    if isinstance(law.temperature, Conductivity):
        rise = (np.sqrt(above**2 + 2 * alpha * 0.6 * F / net.C[1]) - above) / alpha
    assert_allclose(T[-1, 1] - 60.0, rise, rtol=1e-3, atol=0.6 * unsure / net.C[1])
    assert_allclose((T[:, 0] - 60.0) * net.C[0] / 0.4, (T[:, 1] - 60.0) * net.C[1] / 0.6, rtol=1e-9, atol=1e-7)
    assert_array_equal(T[:, 2], 60.0)


@pytest.mark.parametrize("law", FLOWS, ids=kinds(FLOWS))
def test_a_stream_carries_away_what_it_is_given(law):
    assert np.abs(balance(built(streaming(law)), RECORD).residual).max() < CLOSES


@pytest.mark.parametrize("parts", EACH)
def test_at_amplitude_zero_nothing_changes_to_the_bit(parts):
    amplitude = Parameter("size", (("law", 1.0),), 0.0, mapping="amplitude", neutral=0.0)
    y = simulate(built(parts, [amplitude]), RECORD, keep_states=True).z
    assert_array_equal(y, simulate(around(), RECORD, keep_states=True).z)


@pytest.mark.parametrize("parts", EACH)
def test_the_tangent_is_the_difference(parts):
    """Of the discrete scheme on the same steps; fourth order, so that rounding and truncation are both near 1e-9."""
    net, h = built(parts, [Parameter("size", (("law", 1.0),))]), 1e-3
    rows = [net.place(node).mean for node in net.states]
    run = simulate(net, RECORD, None, rows, net.parameters)
    up, down, far, near = (
        simulate(net, RECORD, {"size": np.exp(k * h)}, rows, steps=run.steps).y for k in (1, -1, 2, -2)
    )
    dy = run.dy[:, :, 0]
    assert np.abs(dy).max() > 1e-4
    assert_allclose(dy, (8 * (up - down) - far + near) / (12 * h), atol=1e-6 * np.abs(dy).max())


@pytest.mark.parametrize(
    ("law", "at", "value"),
    [pytest.param(*case, id=f"{kind.__name__} {i}") for kind, cases in LIMITS.items() for i, case in enumerate(cases)],
)
def test_a_law_has_its_limits(law, at, value):
    samples = {n: np.full(3, u) for n, u in at.items()}
    assert_allclose(np.broadcast_to(law.factor(samples), 3), value, rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize(
    ("law", "hot", "cold", "value"),
    [
        pytest.param(*case, id=f"{kind.__name__} {i}")
        for kind, cases in TEMPERATURE_LIMITS.items()
        for i, case in enumerate(cases)
    ],
)
def test_a_temperature_law_has_its_limits(law, hot, cold, value):
    assert temperature_value(law, hot, cold) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("watts", [-30.0, 1e-3, 300.0])
@pytest.mark.parametrize("temperature", TEMPERATURES, ids=lambda law: type(law).__name__)
def test_the_compiled_law_is_the_law(temperature, watts):
    """A node rests where g (T - 20) is the heat; the kernel rounds the corner of a power at equal temperatures."""
    g, near = 3.0 / temperature_value(temperature, 60.0, 20.0), SMOOTH if isinstance(temperature, Power) else 1e-6
    net = bare_network("one", {"a": 300.0}, ("ambient",))
    links = [node_link(net, "law", "film", "a", "ambient", Fixed(g, temperature))]
    sources = [node_source(net, "heat", "iron", {"a": 1.0}, Fixed(watts))]
    T = steady(net.extended(links, sources), {"flow": 1.5}, {"ambient": 20.0})["a"]
    low, high = (g * temperature_value(temperature, x, 20.0) * (x - 20.0) for x in (T - near, T + near))
    assert low <= watts <= high
    assert np.sign(T - 20.0) == np.sign(watts)
