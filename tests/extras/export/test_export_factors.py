"""Every law's input factor, written as sums of products, is the law's own; what has no such form is refused."""

import importlib
import pkgutil
from dataclasses import replace
from inspect import isabstract

import numpy as np
import pytest
from numpy.testing import assert_allclose

import lumped
from extras.export.document import factor
from extras.export.runtime.reference_solver import function
from extras.export.tables import expanded, factors
from geom.errors import InputError
from lumped.correlations.ducts import duct_film
from lumped.correlations.streams import streamed
from lumped.machine.air import Stirred
from lumped.machine.bases import Switched
from lumped.sources.inverter import InverterLoss, PulseLoss
from lumped.sources.layer_loss import by_dowell
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
from lumped.transfer.exchanger import Exchanger, Flow
from lumped.transfer.laws import CONSTANT, AtUsualTemperature, Fixed, InputPower, Law, Power, Scaled, WithTemperature
from lumped.transfer.properties import water
from lumped.transfer.reversal import Direction, OneWay
from lumped.transfer.thin_air import Slowed
from validation.effects.build import Shaped
from validation.effects.films.fouling import hours
from validation.effects.losses.added_loss import Ripple
from validation.parameters.model_form import ExponentError, exponent_derivative


def value(total, inputs):
    """At every instant, by the solver that is written beside an exported model."""
    products = factor(total)
    instants = [dict(zip(inputs, u)) for u in zip(*inputs.values())]
    return np.array(
        [sum(p["coefficient"] * np.prod([function(f, u) for f in p["functions"]]) for p in products) for u in instants]
    )


COPPER = EddyLoss(CopperLoss(0.01, ("id_A", "iq_A"), 1.5), (1.1, 0.02, 0.4), "speed_rpm", 4000.0)
MAP = MapLoss((0.0, 1000.0, 3000.0), (0.0, 50.0), ((0.0, 1.0), (5.0, 9.0), (20.0, 60.0)), torque="iq_A")
FOLLOWING = replace(MAP, powers=(("flow_l_min", 4.0, 1.5),))
COUNTER = Exchanger(300.0, Flow(60.0, "flow_l_min"), Flow(0.2, "speed_rpm"))
STREAM = streamed("flow_l_min", 4.0, lambda v, fluid: duct_film(v, 0.01, 1.0, fluid), water, 40.0, True, 0.1)
EXACT = [
    Fixed(3.0),
    InputPower(2.0, (("speed_rpm", 1000.0, 0.8), ("flow_l_min", 4.0, 0.5))),
    COPPER,
    MAP,
    FOLLOWING,
    CopperLoss(0.01, ("id_A",)),
    by_dowell(CopperLoss(0.01, ("id_A", "iq_A"), 1.5), "speed_rpm", 4, 3e-3, 0.8, 5),
    PowerLoss(((2.0, (("speed_rpm", 1000.0, 1.0),)), (3.0, (("id_A", 50.0, 2.0),)))),
    IronLoss(3.0, 2.0, "speed_rpm", 1000.0, "id_A", 100.0, 1.7, excess=0.3, frequency_exponent=1.2),
    IronLoss(3.0, 2.0, "speed_rpm", 1000.0),
    BrushLoss(2.0, "id_A"),
    BrushLoss(2.0, "id_A", 5.0, "speed_rpm", 900.0),
    MeasuredLoss(((1.0, ("power_W",)), (-0.1, ("speed_rpm", "iq_A")))),
    Scaled(COPPER, -1.0),
    Stirred(15.0, 0.4, 0.9, 0.01),
    STREAM,
    Switched(Fixed(4.0), "on", True),
    Switched(COPPER, "on", False),
    Direction(InputPower(2.0, ()), "signed", -1),
    OneWay(InputPower(2.0, (("flow_l_min", 4.0, 0.8),)), "flow_l_min", "here", "that"),
    WithTemperature(Fixed(2.0), exponent_derivative(Power(0.25))),
    WithTemperature(COPPER),
]
TABLES = [
    RippleLoss(300.0, "voltage_V", 1e-3, 8e3, 0.1),
    PulseLoss("voltage_V", 600.0, 1e-3, 8e3, 0.1),
    InverterLoss(("id_A", "iq_A"), 1.5, 0.8, 0.01, 8e3, 2e-3, 100.0, 600.0, 560.0, 20.0),
    COUNTER,
    AtUsualTemperature(STREAM),
    Slowed(InputPower(2.0, (("speed_rpm", 1000.0, 0.8),)), 0.6, ("speed_rpm",)),
    ExponentError(InputPower(2.0, (("speed_rpm", 1000.0, 0.8),)), "speed_rpm", {"speed_rpm": 1500.0}),
    ExponentError(MAP, "iq_A", {"speed_rpm": 1500.0, "iq_A": 30.0}),
    Shaped(Fixed(2.0), Ripple("chopper_Hz"), CONSTANT, ("chopper_Hz",)),
]
RANGES = {
    "speed_rpm": (0.0, 3000.0),
    "flow_l_min": (0.0, 12.0),
    "id_A": (-200.0, 0.0),
    "iq_A": (-50.0, 50.0),
    "power_W": (0.0, 9e3),
    "on": (0.0, 1.0),
    "signed": (-3.0, 3.0),
    "voltage_V": (-250.0, 250.0),
    "chopper_Hz": (600.0, 9e3),
}


def drawn(seed=1, n=400):
    rng = np.random.default_rng(seed)
    return {name: rng.uniform(*span, n) for name, span in RANGES.items()}


@pytest.mark.parametrize("law", EXACT, ids=lambda law: type(law).__name__)
def test_an_expansion_is_the_law(law):
    u = drawn()
    assert_allclose(value(expanded(law), u) * np.ones(400), law.factor(u) * np.ones(400), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("law", TABLES, ids=lambda law: type(law).__name__)
def test_a_table_is_as_close_as_it_says(law):
    """2e-4 of the largest factor for one input, 2e-3 for two (extras.export.tables)."""
    u = drawn()
    own = law.factor(u) * np.ones(400)
    assert_allclose(value(factors("x", law, RANGES), u), own, atol=2e-3 * np.abs(own).max())


def test_every_law_of_the_network_has_a_case():
    for module in pkgutil.walk_packages(lumped.__path__, "lumped."):
        importlib.import_module(module.name)
    laws = {c for c in subclasses(Law) if c.__module__.startswith("lumped.") and not isabstract(c)}
    assert laws == {type(law) for law in (*EXACT, *TABLES)} & laws


def subclasses(of):
    for one in of.__subclasses__():
        yield one
        yield from subclasses(one)


def test_laws_that_code_cannot_have_are_refused_by_name():
    with pytest.raises(InputError, match=r"--as: 'dust' follows the record's time.*thermoscope model remove"):
        factors("dust", Shaped(Fixed(1.0), hours, CONSTANT, ("time_s",)), RANGES)
    with pytest.raises(InputError, match=r"'one' follows 'running road'"):
        factors("one", InputPower(1.0, (("running road", 1.0, 1.0),)), RANGES)


def test_an_unknown_law_of_three_inputs_is_refused():
    law = Shaped(COPPER, lambda u: np.sin(u["id_A"] * u["iq_A"] + u["speed_rpm"]))
    assert expanded(law) is None
    with pytest.raises(InputError, match=r"Shaped of 'odd' follows 3 inputs at once \(id_A, iq_A, speed_rpm\)"):
        factors("odd", law, RANGES)
    with pytest.raises(InputError, match="too rough for a table"):
        factors("saw", Shaped(InputPower(1.0, (("signed", 1.0, 0.0),)), lambda u: np.sin(1e5 * u["signed"])), RANGES)
