"""How large what is missing usually is comes from the machine: its losses, and its settling time through its films."""

from dataclasses import replace

import numpy as np
import pytest
from two_bodies import bench

from measured.doubt import FORM
from validation.effects import effect
from validation.effects.build import SHARE, conductance_scale, power_scale
from validation.inference.evidence import calibrated_case, scored
from validation.parameters.unknowns import working

LOSS_W, G_JOINT, G_FILM, C_BODY, C_CORE = 80.0, 4.0, 2.0, 4000.0, 1500.0  # of `two_bodies`


def unsaid():
    """The bench without a word on how long it takes to settle."""
    case = bench((), 0.0)
    return replace(case, model=replace(case.model, network=replace(case.model.network, settles_s=0.0)))


def test_settling_time_and_losses_are_those_of_the_usual_inputs():
    case = unsaid()
    network, load = working(case)[0], np.concatenate([t.inputs["load"] for t in case.tests])
    K = np.array([[G_JOINT + G_FILM, -G_JOINT], [-G_JOINT, G_JOINT]])
    slowest = 1.0 / np.linalg.eigvals(np.diag([1.0 / C_BODY, 1.0 / C_CORE]) @ K).min()
    assert network.settles_s == pytest.approx(slowest, rel=1e-6)
    assert network.losses_W == pytest.approx(LOSS_W * np.sqrt(np.mean(load**2)), rel=1e-6)
    assert conductance_scale(network) == pytest.approx((C_BODY + C_CORE) / slowest, rel=1e-6)
    assert power_scale(network) == pytest.approx(SHARE * network.losses_W)


def test_what_is_declared_stands():
    assert working(bench((), 0.0))[0].settles_s == 2000.0


def test_a_missing_loss_is_as_large_in_a_machine_of_ten_times_the_capacity():
    """Its prior is a share of the losses, however heavy the machine is."""
    light = unsaid()
    heavy = replace(
        light, model=replace(light.model, network=replace(light.model.network, C=10.0 * light.model.network.C))
    )
    sizes = []
    for case in (light, heavy):
        e = scored(case, [effect("loss.constant@body")], calibrated_case(case))
        sizes.append(float(e.scale[0]))
        assert sizes[-1] == pytest.approx(FORM["heat size"] * power_scale(e.network))
    assert sizes[0] == pytest.approx(sizes[1])
