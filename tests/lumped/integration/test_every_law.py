"""Heat is conserved under every law there is: in a link, as a source, along a stream. One without a case fails here."""

import importlib
import inspect
from pkgutil import walk_packages

import numpy as np
import pytest
from numpy.testing import assert_allclose

import lumped
import thermoscope
import validation
from lumped.declarations.separated import FilmOver, Share
from lumped.integration.balance import balance
from lumped.integration.simulate import Record
from lumped.machine.bases import Switched
from lumped.machine.laws import Interpolated
from lumped.model.build import bare_network, node_link, node_source, stream
from lumped.sources.loss_map import MapLoss
from lumped.sources.loss_measured import MeasuredLoss
from lumped.sources.losses import BrushLoss, CopperLoss, IronLoss, PowerLoss, RippleLoss
from lumped.transfer.exchanger import CellFilm, Exchanger, Flow, Rate
from lumped.transfer.laws import (
    CLOCK,
    CONSTANT,
    FILMS,
    Constant,
    FilmTable,
    Fixed,
    InputPower,
    Law,
    Linear,
    Power,
    Radiation,
    Scaled,
    Table,
    TemperatureLaw,
    WithTemperature,
)
from lumped.transfer.reversal import Direction, OneWay
from thermoscope.export.tables import ExponentRatio
from validation.calibration.model_form import ExponentError
from validation.effects.build import Shaped
from validation.effects.sensors.input_factor import Slope
from validation.effects.sensors.input_offset import Shift

CLOSES = 1e-4  # of the heat: a hundredth of a kelvin of a rise of 100 K
FORCED = InputPower(0.6, (("speed_rpm", 1000.0, 0.8),))
BY_FLOW = Flow(2.0, "flow")


def grid(value):
    return tuple(v * f for f in np.linspace(1.0, 1.2, FILMS) for v in value)


LAWS = [
    Fixed(0.8), FORCED, Interpolated("speed_rpm", (0.0, 500.0, 2000.0), (0.3, 0.5, 0.9)),
    Switched(FORCED, "switch", True), Switched(FORCED, "switch", False),
    FilmOver("speed_rpm", lambda x: (0.3 + 0.01 * np.sqrt(x), None), 4000.0),
    Share(FilmOver("speed_rpm", lambda x: (0.3, None), 4000.0), (0.0, 4000.0), (0.3, 0.7)),
    Scaled(Fixed(0.4), -1.0), MeasuredLoss(((1.0, ("electrical_W",)), (-np.pi / 30.0, ("torque_Nm", "speed_rpm")))),
    MapLoss((0.0, 4000.0), (0.0, 5.0), ((1.0, 2.0), (3.0, 5.0))), CopperLoss(0.02, ("current_A",)),
    PowerLoss(((2.0, (("speed_rpm", 1000.0, 1.5),)),)), IronLoss(1.0, 0.5, "speed_rpm", 1000.0, "current_A", 10.0),
    BrushLoss(0.2, "current_A", 0.5, "speed_rpm", 1000.0), RippleLoss(48.0, "voltage_V", 1e-3, 1e4, 0.05),
    Rate(BY_FLOW), Exchanger(1.0, BY_FLOW, Flow(3.0)), CellFilm((0.0, 2.0), (4.0, 9.0), BY_FLOW, 0.1, 0.2),
    OneWay(FORCED, "flow", "here", "so"), Direction(FORCED, "to_and_fro", 1), Direction(FORCED, "to_and_fro", -1),
    Shaped(FORCED, lambda u: np.asarray(u["current_A"]) / 20.0, CONSTANT, ("current_A",)),
    WithTemperature(FORCED, Power(0.25)),
    ExponentError(FORCED, "speed_rpm", {"speed_rpm": 1500.0}), 
    ExponentRatio(ExponentError(FORCED, "speed_rpm", {"speed_rpm": 1500.0})),
    Slope(FORCED, "speed_rpm"), Shift(IronLoss(1.0, 0.5, "speed_rpm", 1000.0), "speed_rpm"),
]  # fmt: skip
TEMPERATURES = [
    CONSTANT, Power(0.25), Radiation(), Linear(0.004, 20.0), Table((0.0, 10.0, 80.0), (1.0, 1.3, 1.8)),
    FilmTable((0.0, 5.0, 80.0), grid((1.0, 1.4, 2.0))),
]  # fmt: skip
LAWS += [Fixed(0.5, temperature) for temperature in TEMPERATURES]
NAMES = [f"{type(law).__name__}{f' {type(law.temperature).__name__}' * (type(law) is Fixed)} {i}"
         for i, law in enumerate(LAWS)]  # fmt: skip
LOSSES = [law for law in LAWS if isinstance(law.temperature, Constant | Linear)]


def every(base):
    """All classes that can be made, of all modules of the rooms with laws."""
    for room in (lumped, validation, thermoscope):
        for module in walk_packages(room.__path__, f"{room.__name__}."):
            if not module.name.endswith("__main__"):
                importlib.import_module(module.name)
    found, left = set(), [base]
    while left:
        one = left.pop()
        left += one.__subclasses__()
        ours = one.__module__.split(".")[0] in ("lumped", "validation", "thermoscope")
        if ours and one is not base and not inspect.isabstract(one):
            found.add(one)
    return found


def inputs(time):
    """As they come: varying, with a stop, one that turns round, one that is switched."""
    return {
        "speed_rpm": 1500.0 + 1400.0 * np.sin(time / 250.0) * (time < 900),
        "current_A": 10.0 + 4.0 * np.sin(time / 130.0),
        "flow": 1.5 + np.cos(time / 170.0), "to_and_fro": np.sin(time / 200.0), "switch": 1.0 * (time > 400.0),
        "electrical_W": 900.0 + time / 9.0, "torque_Nm": 2.0 + np.sin(time / 99.0), "voltage_V": 20.0 + time / 90.0,
        CLOCK: time,
    }  # fmt: skip


TIME = np.arange(0.0, 1300.0, 10.0)
RECORD = Record(TIME, {n: u for n, u in inputs(TIME).items() if n != CLOCK}, {"ambient": 18.0, "inlet": 25.0}, 60.0)


def around(*links, sources=()):
    """Two masses, heat into the first, a way out from the second; and two cells that a stream may pass."""
    net = bare_network("one law", {"a": 300.0, "b": 500.0, "cell1": 40.0, "cell2": 40.0}, ("ambient", "inlet"))
    built = [
        node_link(net, "beside", "link", "a", "b", Fixed(5.0)),
        node_link(net, "out", "link", "b", "ambient", Fixed(4.0)),
        node_link(net, "to cell 1", "link", "a", "cell1", Fixed(2.0)),
        node_link(net, "to cell 2", "link", "b", "cell2", Fixed(1.0)),
    ]  # fmt: skip
    heat = node_source(net, "heat", "iron", {"a": 1.0}, Fixed(60.0))
    return net.extended([*built, *(make(net) for make in links)], [heat, *(make(net) for make in sources)])


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_a_link_gives_at_one_end_what_it_takes_at_the_other(law):
    net = around(lambda n: node_link(n, "law", "film", "a", "b", law))
    heat = balance(net, RECORD)
    assert np.abs(heat.through["law"]).max() > 0.0
    assert np.abs(heat.residual).max() < CLOSES


@pytest.mark.parametrize("law", LOSSES, ids=lambda law: type(law).__name__)
def test_a_loss_is_found_again(law):
    net = around(sources=(lambda n: node_source(n, "law", "iron", {"b": 1.0}, law),))
    heat = balance(net, RECORD)
    assert np.abs(heat.residual).max() < CLOSES
    if isinstance(law.temperature, Constant):
        fine = np.linspace(0.0, TIME[-1], 200_001)
        u = {n: np.interp(fine, TIME, v) for n, v in inputs(TIME).items()}
        declared = np.trapezoid(np.broadcast_to(law.factor(u), fine.shape), fine)
        turns = np.count_nonzero(np.diff(np.sign(u[law.column]))) if isinstance(law, Direction) else 0
        within_a_sample = turns * np.diff(TIME).max() * np.max(law.factor(u))  # when a flow turns round is not recorded
        assert_allclose(heat.injected["law"][-1], declared, rtol=1e-3, atol=within_a_sample)


FLOWS = [law for law in LOSSES if isinstance(law.temperature, Constant) and np.min(law.factor(inputs(TIME))) >= 0.0]


@pytest.mark.parametrize("law", FLOWS, ids=lambda law: type(law).__name__)
def test_a_stream_carries_away_what_it_is_given(law):
    net = around(lambda n: stream(n, "stream:law", ("inlet", "cell1", "cell2"), law))
    assert np.abs(balance(net, RECORD).residual).max() < CLOSES


def test_every_law_has_a_case():
    assert {c.__name__ for c in every(Law) - {type(law) for law in LAWS}} == set()
    assert {c.__name__ for c in every(TemperatureLaw) - {type(law) for law in TEMPERATURES}} == set()
