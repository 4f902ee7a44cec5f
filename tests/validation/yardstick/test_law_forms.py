"""The form of a law comes from the readings: a power of one input, two regimes; and is told with its interval."""

from dataclasses import replace

import numpy as np
import pytest
from test_network_terms import bench, case
from test_suggestions import SILENT

from lumped.transfer.laws import InputPower
from validation.calibration.calibrate import no_progress
from validation.effects import effect
from validation.revision.improvement import Step, Supervisor, further_step, singletons
from validation.revision.revise import add
from validation.yardstick.network_terms import follows
from validation.yardstick.yardstick import free_network_terms


def bent(law):
    """A bench whose second body gives 1.4 W/K more to the room at the largest speed of the pump, by some law."""
    network = bench(pumped=1.4)
    return replace(network, links=tuple(replace(x, law=law) if x.name == "link:pumped" else x for x in network.links))


@pytest.mark.parametrize(
    ("shape", "place"), [(">0.5", "pump>1500 at 3000"), ("^0.5", "pump^0.5 at 3000"), ("^2", "pump^2 at 3000")]
)
def test_the_form_of_a_law_comes_from_the_readings(shape, place):
    law = effect(f"conductance.input@two|ambient|{place}").law()
    larger = replace(law, value=1.4) if isinstance(law, InputPower) else replace(law, base=InputPower(1.4, ()))
    some = case(bent(larger), bench(), speeds=5)
    assert f"pump{shape}" in {t.input for t in free_network_terms(some) if t.kind == "link"}


def test_a_law_sets_in_where_it_is_said_to():
    law = effect("conductance.input@two|ambient|pump>1500 at 3000").law()
    assert np.allclose(law.size({"pump": np.array([0.0, 1500.0, 2250.0, 3000.0])}), [0.0, 0.0, 0.5, 1.0])


def test_what_was_added_is_told_as_a_law_with_its_interval():
    name = "conductance.input@two|ambient|pump at 3000"
    step = add(case(bench(pumped=0.7), bench()), name)
    law = Step(step.after, {}, step).document()["laws"][name]  # as `improve` tells it
    assert law in step.why
    assert law.startswith("two to ambient: 0.7")
    assert "at pump 3000 [1.3" in law
    assert "(with pump to the power of 0.8" in law


def test_terms_that_need_each_other_are_added_in_one_step():
    some = case(bench(pumped=0.7), bench("one"))
    step, evidence = further_step(some, Supervisor(singletons, suggest=True), SILENT, 9.0, [], no_progress)
    assert step.effect == "loss.input@two|heater2 at 100 + conductance.input@two|ambient|pump at 3000"
    assert step.accepted
    assert "two to ambient" in evidence["free network"]


def test_a_loss_follows_a_speed_only_where_it_does_so_without_current():
    eddy = InputPower(1.0, (("id_A", 100.0, 2.0), ("speed_rpm", 4000.0, 2.0)))
    sizes = {"id_A": 100.0, "speed_rpm": 4000.0}
    assert follows(eddy, {"id_A", "speed_rpm"}, sizes)
    assert not follows(eddy, {"speed_rpm"}, sizes)
    assert not follows(eddy, {"iq_A"}, sizes)
