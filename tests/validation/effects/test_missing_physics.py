"""What a declared network lacks and can be told: copper without its coefficient, the air of a fan on the shaft."""

import tomllib

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from small_networks import MOTOR

from geom.constants import ALPHA_CU
from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate
from validation.effects import Scene, effect, kinds

SPEED = frozenset({"speed_rpm"})
LOSS = {
    "copper, no coefficient": 'kind = "copper"\ncurrents = ["current_A"]\nR20_ohm = 0.5\nalpha_1_K = 0',
    "constant": 'kind = "constant"\nP_W = 50\nof = { input = "current_A", at = 10, exponent = 2 }',
    "copper": 'kind = "copper"\ncurrents = ["current_A"]\nR20_ohm = 0.5',
    "constant, with coefficient": 'kind = "constant"\nP_W = 50\nalpha_1_K = 0.0039\nreference_degC = 20',
}


def motor(loss, at="winding"):
    return read_network(tomllib.loads(MOTOR + f'[losses.heat]\nat = "{at}"\n{LOSS[loss]}\n'))


def test_a_fan_blows_over_what_stands():
    """Housing and end shield of a closed machine, neither its rotor nor what is inside."""
    assert set(kinds()["convection.fan"].places(Scene(motor("copper"), SPEED))) == {"housing", "shield"}
    assert kinds()["convection.fan"].places(Scene(motor("copper"))) == ()
    assert kinds()["convection.fan"].places(Scene(motor("copper"), SPEED | {"fan_flow_m3h"})) == ()


def test_an_inverter_heats_what_turns_as_well():
    iron = '[losses.iron]\nat = "stator"\nkind = "iron"\nexcess_W = 50\nspeed_at = 3000\n'
    scene = Scene(read_network(tomllib.loads(MOTOR + iron)), SPEED | {"switching_Hz"})
    assert set(kinds()["iron.pwm"].places(scene)) == {"stator", "rotor"}


@pytest.mark.parametrize(("loss", "missing"), [(name, k < 2) for k, name in enumerate(LOSS)])
def test_a_winding_declared_without_coefficient_can_be_told_so(loss, missing):
    assert kinds()["copper.feedback"].places(Scene(motor(loss))) == (("heat",) if missing else ())


def test_losses_of_one_parameter_are_one_winding():
    """Slot and end turns that calibration moves together: one effect, which heats both as copper does."""
    half = '{}\n[losses.end]\nat = "winding"\nkind = "copper"\ncurrents = ["current_A"]\nR20_ohm = 0.5\nalpha_1_K = 0\n'
    shared = '[parameters.copper]\nacts_on = ["loss:heat", "loss:end"]\n'
    text = MOTOR + half.format(f'[losses.heat]\nat = "winding"\n{LOSS["copper, no coefficient"]}')
    one, two = (read_network(tomllib.loads(text + more)) for more in (shared, ""))
    assert kinds()["copper.feedback"].places(Scene(one)) == ("heat",)
    assert kinds()["copper.feedback"].places(Scene(two)) == ("heat", "end")
    both, single = (effect("copper.feedback@heat", Scene(n)).extend(n).parameters[-1] for n in (one, two))
    assert len(both.targets) == 2 * len(single.targets)


def test_heat_of_iron_is_no_copper():
    assert kinds()["copper.feedback"].places(Scene(motor("constant", at="stator"))) == ()


def measured(time, amps):
    """500 J/K on 2 W/K to air of 20 degC; a resistance of 0.5 ohm at 20 degC that follows its temperature."""

    def slope(t, T):
        copper = 0.5 * np.interp(t, time, amps) ** 2 * (1.0 + ALPHA_CU * (T - 20.0))
        return (copper - 2.0 * (T - 20.0)) / 500.0

    return solve_ivp(slope, (time[0], time[-1]), [20.0], "Radau", time, rtol=1e-9, atol=1e-9, max_step=30.0).y[0]


@pytest.mark.parametrize("loss", ["copper, no coefficient", "constant"])
def test_at_coppers_coefficient_the_effect_is_what_was_missing(loss):
    """Against the equation integrated by scipy, 0.1 K of some 60; without it the winding is more than 5 K off."""
    text = '[network]\nname = "coil"\nboundaries = ["ambient"]\n[nodes.winding]\nC_J_K = 500\n'
    text += '[links.out]\nbetween = ["winding", "ambient"]\nG_W_K = 2\n[losses.heat]\nat = "winding"\n' + LOSS[loss]
    network, time = read_network(tomllib.loads(text)), np.arange(0.0, 3000.0, 5.0)
    amps = np.where(time < 1500.0, 10.0, 16.0)
    told = effect("copper.feedback@heat", Scene(network)).extend(network)
    record = Record(time, {"current_A": amps}, {"ambient": 20.0})
    right, wrong = (
        simulate(told, record, {"copper.feedback@heat": a}, keep_states=True).z[:, 0] for a in (ALPHA_CU, 0)
    )
    assert np.abs(right - measured(time, amps)).max() < 0.1
    assert np.abs(wrong - measured(time, amps)).max() > 5.0
