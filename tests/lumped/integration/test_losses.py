"""Losses: each law against its formula, and the sum injected against the sum declared."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_networks import boundaries, every_law, inputs

from geom.errors import InputError
from lumped.correlations import RangeWarning
from lumped.declarations.network import read_network
from lumped.integration.balance import audit
from lumped.integration.signals import Signals
from lumped.integration.simulate import Record, simulate
from lumped.sources.inverter import InverterLoss, PulseLoss
from lumped.sources.loss_laws import IronLoss, MapLoss, RippleLoss
from lumped.transfer.laws import Law

AT = {"speed_rpm": np.array([0.0, 1000.0, 2000.0]), "current_A": np.array([0.0, 100.0, 200.0])}


def test_iron_follows_frequency_and_flux_exponents():
    teeth = IronLoss(60.0, 40.0, "speed_rpm", 1000.0, "current_A", 100.0, 1.8, excess=20.0)
    assert_allclose(teeth.factor(AT), [0.0, 120.0, (60 * 2 + 40 * 4 + 20 * 2**1.5) * 2**1.8], rtol=1e-12)
    steinmetz = IronLoss(100.0, 0.0, "speed_rpm", 1000.0, frequency_exponent=1.5)
    assert_allclose(steinmetz.factor(AT), [0.0, 100.0, 100 * 2**1.5], rtol=1e-12)


def test_ripple_is_the_mean_square_of_the_triangle():
    """Sawtooth current between -dI/2 and dI/2 over one period, sampled finely; none at no voltage and at full."""
    law = RippleLoss(300.0, "voltage_V", 2e-3, 4000.0, 0.05)
    for volts in (40.0, 150.0, 260.0):
        D, T = volts / 300.0, 1 / 4000.0
        t = np.linspace(0.0, T, 20001)
        slope = np.where(t < D * T, (300.0 - volts) / 2e-3, -volts / 2e-3)
        i = np.concatenate([[0.0], np.cumsum(slope[:-1] * np.diff(t))])
        rms = np.trapezoid((i - np.trapezoid(i, t) / T) ** 2, t) / T
        assert law.factor({"voltage_V": volts}) == pytest.approx(0.05 * rms, rel=1e-3)
    assert_allclose(law.factor({"voltage_V": np.array([0.0, 300.0])}), 0.0, atol=1e-12)


class Seen(Law):
    """A bent factor that keeps what it was asked at."""

    reads = ("current_A",)

    def __init__(self):
        self.low, self.high = np.inf, -np.inf

    def factor(self, inputs):
        x = inputs["current_A"]
        self.low, self.high = min(self.low, x.min()), max(self.high, x.max())
        return np.abs(x) ** 1.7


@pytest.mark.parametrize("modulation", [0.1, 0.8, 1.15])
def test_pulses_make_the_ripple_that_their_flux_shows(modulation):
    """Space-vector pulses against a triangle, 400 angles of 1000 instants: flux of a phase less its mean, over L."""
    angle = 2 * np.pi * (np.arange(400) + 0.5)[:, None] / 400 - 2 * np.pi / 3 * np.arange(3)
    phase = 0.5 * modulation * np.cos(angle)
    phase -= 0.5 * (phase.max(axis=1) + phase.min(axis=1))[:, None]
    carrier = np.abs(2 * (np.arange(1000) + 0.5) / 1000 - 1) - 0.5
    legs = np.where(phase[:, :, None] > carrier, 0.5, -0.5)
    error = legs[:, 0] - legs.mean(axis=1)
    error -= error.mean(axis=1, keepdims=True)
    flux = np.cumsum(error, axis=1) / 1000
    flux -= flux.mean(axis=1, keepdims=True)
    law = PulseLoss("voltage_V", 560.0, 2e-3, 8e3, 0.3)
    watts = 3 * 0.3 * (560.0 / 2e-3 / 8e3) ** 2 * np.mean(flux**2)
    assert law.factor({"voltage_V": 280.0 * modulation}) == pytest.approx(watts, rel=0.01)


def test_pulses_beyond_their_supply_are_said():
    with pytest.warns(UserWarning, match=r"voltage_V = 400 V above 323\.3 V"):
        PulseLoss("voltage_V", 560.0, 2e-3, 8e3, 0.3).factor({"voltage_V": 400.0})


def test_an_inverter_loses_what_its_switches_do_over_a_period():
    """Three legs of one device each that carries |i|: V0 |i| + R i^2, and the energy of every pulse."""
    i = 40.0 * np.sin(2 * np.pi * (np.arange(10_000) + 0.5) / 10_000)
    leg = 0.9 * np.abs(i) + 0.02 * i**2 + 8e3 * 3e-3 * np.abs(i) / 50.0 * 560.0 / 600.0
    law = InverterLoss(("id_A", "iq_A"), 1.5, 0.9, 0.02, 8e3, 3e-3, 50.0, 600.0, 560.0, 12.0)
    assert law.factor({"id_A": -24.0, "iq_A": 32.0}) == pytest.approx(12.0 + 3 * np.mean(leg), rel=1e-6)


@pytest.mark.parametrize("apart", [1, 7])
def test_between_samples_a_law_sees_nothing_beyond_the_record(apart):
    """Inputs are straight lines, whether a run looks at every sample or at one in seven: parabolas are factors only."""
    time = np.arange(0.0, 841.0)
    current = 200.0 + 200.0 * np.sign(np.sin(time / 37.0)) * np.abs(np.cos(time / 5.0))
    law, inputs = Seen(), {"current_A": current}
    signals = Signals(inputs, time.size) if apart == 1 else Signals.recorded(inputs, time, time[::apart])
    bent = signals.curve("loss", law)
    assert (law.low, law.high) == (current.min(), current.max())
    assert np.abs(bent.bulge).max() > 0.0


def test_a_map_left_at_one_end_names_that_end():
    law = MapLoss((0.0, 1000.0), (0.0, 400.0), ((0.0, 1.0), (2.0, 3.0)), torque="current_A")
    with pytest.warns(RangeWarning, match=r"current_A = 400\.3 outside 0 to 400$"):
        law.factor({"speed_rpm": np.array([0.0, 500.0]), "current_A": np.array([0.35, 400.3])})


@pytest.mark.parametrize("step", [4.0, 30.0])
def test_injected_is_declared_between_the_samples_too(step):
    """Both along the run: what is left is what parabolas miss of the laws."""
    time = np.arange(0.0, 801.0, step)
    found = audit(every_law(), Record(time, inputs(time), boundaries(time), 60.0), {"relative": 0.4})
    assert found.residual < 1e-4
    assert found.mismatch < 1e-4


def test_what_a_network_declares_in_toml_is_what_it_injects():
    data = {
        "network": {"name": "n", "boundaries": ["ambient"]},
        "nodes": {"w": {"C_J_K": 500.0}, "s": {"C_J_K": 900.0}},
        "links": {"ws": {"between": ["w", "s"], "G_W_K": 10.0}, "sa": {"between": ["s", "ambient"], "G_W_K": 5.0}},
        "losses": {
            "map": {"kind": "map", "at": "s", "at_speed": [0, 2000], "at_torque": [0, 50], "P_W": [[0, 10], [40, 80]]},
            "teeth": {
                "kind": "iron",
                "at": "s",
                "hysteresis_W": 10,
                "excess_W": 5,
                "speed_at": 1000,
                "frequency_exponent": 1.2,
            },
        },
    }
    given = {"speed_rpm": 1000.0, "torque_Nm": 25.0}
    found = audit(read_network(data), Record(np.linspace(0, 100, 101), given, {"ambient": 20.0}))
    assert found.declared_J["loss:map"] == pytest.approx(32.5 * 100)
    assert found.declared_J["loss:teeth"] == pytest.approx(15.0 * 100)
    assert found.mismatch < 1e-6


def heated(**loss):
    return read_network(
        {
            "network": {"name": "n", "boundaries": ["ambient"]},
            "nodes": {"a": {"C_J_K": 900.0}},
            "links": {"out": {"between": ["a", "ambient"], "G_W_K": 1.0}},
            "losses": {"heat": {"at": "a", **loss}},
        }
    )


CONSTANT = {"kind": "constant", "P_W": 100.0, "reference_degC": 20.0}


@pytest.mark.parametrize(
    ("alpha", "says"), [(-0.01, "negative above 120 degC"), (-0.004, "above 270"), (0.02, "below -30")]
)
def test_a_coefficient_that_turns_heat_into_cooling_is_refused(alpha, says):
    """1 + alpha (T - 20) = 0 at 20 - 1/alpha: within what a machine sees, one message; beyond, none."""
    with pytest.raises(InputError, match=says):
        heated(**CONSTANT, alpha_1_K=alpha)
    assert heated(**CONSTANT, alpha_1_K=0.1 * alpha).sources[0].law.temperature.alpha == 0.1 * alpha


def test_copper_does_not_conduct_better_hot():
    with pytest.raises(InputError, match=r"alpha_1_K = -0\.00393"):
        heated(kind="copper", R20_ohm=0.1, currents=["current_A"], alpha_1_K=-0.00393)


def test_a_resistance_factor_below_zero_is_refused_with_the_speed():
    ac = {"input": "speed_rpm", "at": 1000.0, "coefficients": [1.0, -0.5]}
    network = heated(kind="copper", R20_ohm=0.1, currents=["current_A"], ac=ac)
    record = Record(
        np.arange(3.0), {"current_A": 10.0, "speed_rpm": np.array([0.0, 1000.0, 3000.0])}, {"ambient": 20.0}
    )
    with pytest.raises(InputError, match=r"resistance factor is -0\.5 at speed_rpm = 3000"):
        simulate(network, record)
