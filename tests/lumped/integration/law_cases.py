"""One case for every law of a coefficient and every law of temperature, on inputs as they come."""

import importlib
import inspect
from pkgutil import walk_packages

import numpy as np

import fem
import lumped
import thermoscope
import validation
import viz
from extras.export.tables import ExponentRatio
from lumped.integration.simulate import Record
from lumped.machine.air import Stirred
from lumped.machine.bases import Switched
from lumped.sources.inverter import InverterLoss, PulseLoss
from lumped.sources.layer_loss import LayerLoss, by_dowell, from_map
from lumped.sources.loss_laws import (
    BrushLoss,
    CopperLoss,
    EddyLoss,
    IronLoss,
    MapLoss,
    MeasuredLoss,
    PowerLoss,
    RippleLoss,
)
from lumped.transfer.exchanger import Exchanger, Flow, counterflow
from lumped.transfer.laws import (
    CLOCK,
    CONSTANT,
    FILMS,
    AtUsualTemperature,
    Conductivity,
    Constant,
    FilmTable,
    Fixed,
    InputPower,
    Linear,
    Power,
    Radiation,
    Scaled,
    StreamTable,
    Table,
    WithTemperature,
)
from lumped.transfer.reversal import Direction, OneWay
from lumped.transfer.streamed import Streamed
from lumped.transfer.thin_air import Slowed
from validation.effects.build import Shaped
from validation.effects.sensors.input_fault import Shift, Slope
from validation.parameters.model_form import ExponentError


def inputs(time):
    """As they come: varying, with a stop, one that turns round, one that is switched."""
    return {
        "speed_rpm": 1500.0 + 1400.0 * np.sin(time / 250.0) * (time < 900),
        "current_A": 10.0 + 4.0 * np.sin(time / 130.0),
        "flow": 1.5 + np.cos(time / 170.0),
        "to_and_fro": np.sin(time / 200.0),
        "switch": 1.0 * (time > 400.0),
        "electrical_W": 900.0 + time / 9.0,
        "torque_Nm": 2.0 + np.sin(time / 99.0),
        "voltage_V": 20.0 + time / 90.0,
        CLOCK: time,
    }


TIME = np.arange(0.0, 1300.0, 10.0)
RECORD = Record(TIME, {n: u for n, u in inputs(TIME).items() if n != CLOCK}, {"ambient": 18.0, "inlet": 25.0}, 60.0)


FORCED = InputPower(0.6, (("speed_rpm", 1000.0, 0.8),))
BY_FLOW = Flow(2.0, "flow")


def grid(value):
    return tuple(v * f for f in np.linspace(1.0, 1.2, FILMS) for v in value)


def streams(stretch=0.0, still=None, exponent=3.0):
    """Three regimes over Re and a temperature."""
    total, number = np.array([-20.0, 40.0, 90.0, 160.0]), np.array([-4.0, -1.0, 0.0, 0.6, 1.2, 3.0])
    value = np.outer(1.0 + 0.002 * total, [0.3, 0.3, 0.4, 0.9, 1.2, 3.0])
    shift = tuple(-0.01 * (total - 80.0))
    values = tuple(value.ravel())
    return StreamTable("flow", 1.5, 80.0, tuple(total), shift, tuple(number), values, stretch, still, exponent)


STREAM = Streamed(0.9, streams())
LAWS = [
    Fixed(0.8),
    FORCED,
    Stirred(0.3, 0.1, 0.9, 0.01),
    STREAM,
    AtUsualTemperature(STREAM),
    Switched(FORCED, "switch", True),
    Switched(FORCED, "switch", False),
    Scaled(Fixed(0.4), -1.0),
    Slowed(FORCED, 0.6, ("speed_rpm",)),
    MeasuredLoss(((1.0, ("electrical_W",)), (-np.pi / 30.0, ("torque_Nm", "speed_rpm")))),
    MapLoss((0.0, 4000.0), (0.0, 5.0), ((1.0, 2.0), (3.0, 5.0))),
    CopperLoss(0.02, ("current_A",)),
    EddyLoss(CopperLoss(0.02, ("current_A",)), (1.0, 0.0, 0.4), "speed_rpm", 2000.0),
    by_dowell(CopperLoss(0.02, ("current_A",)), "speed_rpm", 4, 3e-3, 0.8, 5),
    from_map(CopperLoss(0.02, ("current_A",)), "speed_rpm", (0.0, 1000.0, 3000.0), (1.0, 1.1, 1.9)),
    PowerLoss(((2.0, (("speed_rpm", 1000.0, 1.5),)),)),
    IronLoss(1.0, 0.5, "speed_rpm", 1000.0, "current_A", 10.0),
    BrushLoss(0.2, "current_A", 0.5, "speed_rpm", 1000.0),
    RippleLoss(48.0, "voltage_V", 1e-3, 1e4, 0.05),
    InverterLoss(("current_A",), 3.0, 0.1, 0.01, 8e3, 1e-6, 10.0, 600.0, 560.0, 1.0),
    PulseLoss("voltage_V", 96.0, 1e-3, 1e4, 0.5),
    Exchanger(1.0, BY_FLOW, Flow(3.0)),
    OneWay(FORCED, "flow", "here", "so"),
    Direction(FORCED, "to_and_fro", 1),
    Direction(FORCED, "to_and_fro", -1),
    Shaped(FORCED, lambda u: np.asarray(u["current_A"]) / 20.0, CONSTANT, ("current_A",)),
    WithTemperature(FORCED, Power(0.25)),
    ExponentError(FORCED, "speed_rpm", {"speed_rpm": 1500.0}),
    ExponentRatio(ExponentError(FORCED, "speed_rpm", {"speed_rpm": 1500.0})),
    Slope(FORCED, "speed_rpm"),
    Shift(IronLoss(1.0, 0.5, "speed_rpm", 1000.0), "speed_rpm"),
]
TEMPERATURES = [
    CONSTANT,
    Power(0.25),
    Radiation(),
    Linear(0.004, 20.0),
    Conductivity(0.004, 20.0),
    Table((0.0, 10.0, 80.0), (1.0, 1.3, 1.8)),
    FilmTable((0.0, 5.0, 80.0), grid((1.0, 1.4, 2.0))),
    streams(),
    streams(2.0),
    streams(still=FilmTable((0.0, 5.0, 80.0), grid((0.2, 0.3, 0.5)))),
    streams(still=FilmTable((0.0, 5.0, 80.0), grid((0.2, 0.3, 0.5))), exponent=4.0),
]
LAWS += [Fixed(0.5, law) if type(law) is not StreamTable else Streamed(0.5, law) for law in TEMPERATURES]
NAMES = [
    f"{type(law).__name__}{f' {type(law.temperature).__name__}' * (type(law) is Fixed)} {i}"
    for i, law in enumerate(LAWS)
]
LOSSES = [law for law in LAWS if isinstance(law.temperature, Constant | Linear | Conductivity)]


ROOMS = (fem, lumped, validation, viz, thermoscope)


def every(base):
    """All classes that can be made, of all modules of the rooms with laws."""
    for room in ROOMS:
        for module in walk_packages(room.__path__, f"{room.__name__}."):
            if not module.name.endswith("__main__"):
                importlib.import_module(module.name)
    found, left = set(), [base]
    while left:
        one = left.pop()
        left += one.__subclasses__()
        ours = one.__module__.split(".")[0] in {room.__name__ for room in ROOMS}
        if ours and one is not base and not inspect.isabstract(one):
            found.add(one)
    return found


STEEP = ExponentError(InputPower(2.0, (("speed_rpm", 1000.0, 1.0),)), "speed_rpm", {"speed_rpm": 1000.0})
# law -> [(law, inputs, its factor there)]: at rest, at its ends, beyond them, where its formula is known by heart
LIMITS = {
    Fixed: [(Fixed(0.8), {}, 0.8)],
    InputPower: [
        (FORCED, {"speed_rpm": 0.0}, 0.0),
        (FORCED, {"speed_rpm": -1000.0}, 0.6),
        (InputPower(0.7, ()), {}, 0.7),
    ],
    Stirred: [(Stirred(4.0, 0.5, 1.0, 0.01), {"speed_rpm": -1e4}, 204.0)],
    Streamed: [(STREAM, {"flow": 2.0}, 0.9)],
    AtUsualTemperature: [
        (AtUsualTemperature(STREAM), {"flow": 1.0}, 0.9 * 0.4 * 1.16),
        (AtUsualTemperature(Fixed(0.8)), {}, 0.8),
    ],
    Switched: [
        (Switched(Fixed(2.0), "on", True), {"on": 1.0}, 2.0),
        (Switched(Fixed(2.0), "on", False), {"on": 1.0}, 0.0),
    ],
    Slowed: [(Slowed(FORCED, 0.5, ("speed_rpm",)), {"speed_rpm": 2000.0}, 0.6)],
    Scaled: [(Scaled(Fixed(0.4), -1.0), {}, -0.4)],
    MeasuredLoss: [  # what goes in leaves at the shaft
        (MeasuredLoss(((1.0, ("P",)), (-np.pi / 30.0, ("M", "n")))), {"P": 100.0 * np.pi, "M": 2.0, "n": 1500.0}, 0.0)
    ],
    MapLoss: [
        (MapLoss((0.0, 10.0), (0.0, 1.0), ((1.0, 2.0), (3.0, 5.0))), {"speed_rpm": 10.0, "torque_Nm": -1.0}, 5.0),
        (  # of currents, at twice its speed
            MapLoss((0.0, 1.0), (0.0, 1.0), ((1.0, 2.0), (3.0, 5.0)), "id_A", "iq_A", powers=(("n", 5.0, 2.0),)),
            {"id_A": -1.0, "iq_A": 1.0, "n": 10.0},
            20.0,
        ),
    ],
    CopperLoss: [(CopperLoss(0.02, ("I",), 3.0), {"I": -10.0}, 6.0)],
    EddyLoss: [  # the copper's once more where the resistance has doubled
        (EddyLoss(CopperLoss(0.02, ("I",)), (1.0, 0.0, 1.0), "n", 50.0), {"I": 10.0, "n": -50.0}, 2.0)
    ],
    LayerLoss: [  # the copper's: what alternating current adds is its law of temperature and speed
        (by_dowell(CopperLoss(0.02, ("I",)), "n", 4, 3e-3, 0.8, 5), {"I": 10.0, "n": 0.0}, 2.0),
        (from_map(CopperLoss(0.02, ("I",)), "n", (0.0, 50.0), (1.0, 2.0)), {"I": -10.0, "n": 50.0}, 2.0),
    ],
    PowerLoss: [(PowerLoss(((2.0, (("n", 10.0, 1.5),)), (1.0, ()))), {"n": 0.0}, 1.0)],
    IronLoss: [
        (IronLoss(1.0, 0.5, "n", 100.0, "I", 10.0), {"n": 100.0, "I": 0.0}, 0.0),
        (IronLoss(1.0, 0.5, "n", 100.0, "I", 10.0, excess=0.25), {"n": -100.0, "I": -10.0}, 1.75),
    ],
    BrushLoss: [(BrushLoss(2.0, "I", 9.0, "n", 100.0), {"I": -3.0, "n": 0.0}, 6.0)],
    RippleLoss: [(RippleLoss(48.0, "V", 1e-3, 1e4, 0.05), {"V": 60.0}, 0.0)],
    InverterLoss: [  # drivers alone; thresholds
        (InverterLoss(("I",), 1.5, 1.0, 0.1, 8e3, 1e-3, 10.0, 600.0, 560.0, 7.0), {"I": 0.0}, 7.0),
        (InverterLoss(("I",), 3.0, np.pi / 6.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0), {"I": 0.5**0.5}, 1.0),
    ],
    PulseLoss: [(PulseLoss("V", 48.0, 1e-3, 1e4, 0.05), {"V": 0.0}, 0.0)],
    Exchanger: [  # nothing flows; endless plates bring the lesser stream all the way; small ones are UA
        (Exchanger(1.0, BY_FLOW, Flow(3.0)), {"flow": 0.0}, 0.0),
        (Exchanger(1e5, BY_FLOW, Flow(3.0), counterflow), {"flow": 1.0}, 2.0),
        (Exchanger(1e-7, BY_FLOW, Flow(3.0)), {"flow": 1.0}, 1e-7),
    ],
    OneWay: [(OneWay(FORCED, "flow", "here", "so"), {"speed_rpm": 1000.0, "flow": 0.0}, 0.6)],
    Direction: [
        (Direction(Fixed(3.0), "q", 1), {"q": -1.0}, 0.0),
        (Direction(Fixed(3.0), "q", -1), {"q": -1.0}, 3.0),
        (Direction(Fixed(3.0), "q", -1), {"q": 0.0}, 0.0),
    ],
    Shaped: [(Shaped(Fixed(3.0), lambda u: u["x"]), {"x": 0.0}, 0.0)],
    WithTemperature: [(WithTemperature(Fixed(3.0), Power(0.25)), {}, 3.0)],
    ExponentError: [(STEEP, {"speed_rpm": 2000.0}, 4.0 * np.log(2.0))],
    ExponentRatio: [(ExponentRatio(STEEP), {"speed_rpm": 2000.0}, np.log(2.0))],
    Slope: [(Slope(STEEP.base, "speed_rpm"), {"speed_rpm": 1000.0}, 2.0)],
    Shift: [(Shift(STEEP.base, "speed_rpm"), {"speed_rpm": 1000.0}, 2e-3)],
}
FILM = next(law for law in TEMPERATURES if isinstance(law, FilmTable))
STILL = FILM.at(0.0, 80.0)
# temperature law -> [(law, hot, cold, its value)] in degC
TEMPERATURE_LIMITS = {
    Constant: [(CONSTANT, 90.0, 20.0, 1.0)],
    Power: [(Power(0.25), 20.0, 20.0, 0.0), (Power(0.25), 36.0, 20.0, 2.0), (Power(0.25), 20.0, 36.0, 2.0)],
    Radiation: [  # near equal temperatures 4 sigma T^3; against nothing sigma T^3
        (Radiation(), 20.0, 20.0, 4 * 5.670374419e-8 * 293.15**3),
        (Radiation(), 20.0, -273.15, 5.670374419e-8 * 293.15**3),
    ],
    Conductivity: [(Conductivity(0.004, 20.0), 20.0, 99.0, 1.0), (Conductivity(0.004, 20.0), 270.0, 99.0, 0.5)],
    Linear: [(Linear(0.004, 20.0), 20.0, 99.0, 1.0), (Linear(0.004, 20.0), 270.0, 99.0, 2.0)],
    Table: [
        (Table((0.0, 10.0), (1.0, 3.0)), 20.0, 20.0, 1.0),
        (Table((0.0, 10.0), (1.0, 3.0)), 20.0, 99.0, 3.0),
        (Table((-5.0, 10.0), (1.0, 3.0)), 20.0, 99.0, 1.0),
    ],
    StreamTable: [  # at 80 degC, at its usual input of 1.5; beside still air; N beyond all use, N of next to nothing
        (streams(), 40.0, 40.0, 1.16 * (0.4 + 0.5 * np.log(1.5) / 0.6)),
        (streams(1e9), 40.0, 40.0, streams().at(1.5, 80.0)),
        (streams(1e-14), 40.0, 40.0, streams().at(1.5, 80.0)),
        (streams(2.0), 40.0, 40.0, 0.75 * np.expm1(streams().at(1.5, 80.0) / 0.75)),
        (streams(still=FILM), 40.0, 40.0, np.cbrt(streams().at(1.5, 80.0) ** 3 + STILL**3) - STILL),
    ],
    FilmTable: [(FILM, -300.0, -300.0, 1.0), (FILM, 500.0, 500.0, 1.2), (FILM, 590.0, 410.0, 2.4)],
}
