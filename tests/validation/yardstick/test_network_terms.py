"""What a free network needs and nothing declared gives is a hypothesis of the diagnosis."""

from dataclasses import replace

import numpy as np
import pytest

from lumped.declarations.network import read_network
from lumped.integration.simulate import Record, simulate
from measured.case import Case, Channel, Model, Test
from validation.diagnosis import diagnose
from validation.inference.evidence import calibrated_case, candidates, scored
from validation.yardstick.network_terms import network_terms

LEVELS = {"heater1": 100.0, "heater2": 100.0, "pump": 3000.0}


def bench(second="two", pumped=0.0, joint=0.0):
    """Two heated bodies in a room; the second heater on one of them.

    pumped, joint : W/K of the second onto the room, and between the two, at the largest speed of a pump
    """
    follows = {"of": {"input": "pump", "at": 3000.0, "exponent": 0.8}}
    links = {
        "joint": {"between": ["one", "two"], "G_W_K": 0.4, "prior_sd": 0.3},
        "film1": {"between": ["one", "ambient"], "G_W_K": 0.8, "prior_sd": 0.3},
        "film2": {"between": ["two", "ambient"], "G_W_K": 0.7, "prior_sd": 0.3},
    }
    if pumped:
        links["pumped"] = {"between": ["two", "ambient"], "G_W_K": pumped, **follows}
    if joint:
        links["stirred"] = {"between": ["one", "two"], "G_W_K": joint, **follows}

    def heater(name, at, watts):
        of = {"input": name, "at": 100.0, "exponent": 1.0}
        return {"kind": "constant", "at": at, "P_W": watts, "prior_sd": 0.1, "of": of}

    return read_network(
        {
            "network": {"name": "bench", "boundaries": ["ambient"], "settles_s": 1000},
            "nodes": {n: {"C_J_K": C, "prior_sd": 0.1} for n, C in (("one", 800), ("two", 600))},
            "links": links,
            "losses": {"h1": heater("heater1", "one", 30.0), "h2": heater("heater2", second, 20.0)},
        }
    )


def case(truth, model, role="calibrate", speeds=3):
    """Three tests of the truth, the last in a role of its own, held against a model; inputs take so many values."""
    rng, tests = np.random.default_rng(0), []
    for name in ("first", "second", "third"):
        time = np.arange(0.0, 4000.0, 40.0)
        inputs = {
            n: u * rng.choice(np.linspace(0.0, 1.0, speeds), 8)[(time / 500.0).astype(int)] for n, u in LEVELS.items()
        }
        around = {"ambient": np.full_like(time, 20.0)}
        test = Test(name, role if name == "third" else "calibrate", time, inputs, around, (), 20.0)
        rows = [truth.places[p].mean for p in ("one", "two")]
        y = simulate(truth, Record(time, test.signals, around, 20.0), {}, rows).y
        y = y + 0.1 * rng.standard_normal(y.shape)
        channels = (Channel(p, p, r, y[:, i], 0.3) for i, (p, r) in enumerate(zip(("one", "two"), rows, strict=True)))
        tests.append(replace(test, channels=tuple(channels)))
    return Case("bench", Model(model), tuple(tests))


def offered(some):
    return network_terms(some, scored(some, candidates(some), calibrated_case(some)))


def test_a_loss_declared_at_another_place_is_found_where_it_is():
    """The model has both heaters on the first body."""
    said = diagnose(case(bench(), bench("one")), plan=False)
    first = next(c for c in said.candidates if c.effect == said.named[0])
    assert first.effect == "loss.input@two|heater2 at 100"
    assert first.value == pytest.approx(20.0, rel=0.05)
    assert first.unit == "W at heater2 100"


def test_a_film_that_follows_an_input_is_told_at_rest_and_at_most():
    said = diagnose(case(bench(pumped=0.7), bench()), plan=False)
    assert said.named == ("conductance.input@two|ambient|pump at 3000",)
    assert "two to ambient: 0.7" in said.words
    assert "W/K at rest, 1.4" in said.words


@pytest.mark.parametrize(
    ("truth", "model", "names"),
    [
        (bench(joint=2.0), bench(), {"conductance.input@one|two|pump at 3000"}),
        (bench(), bench(), set()),
        (bench(pumped=0.7), bench(pumped=0.2), set()),  # its law is there, of another size
    ],
    ids=["a link", "nothing", "what is declared"],
)
def test_only_what_nothing_declared_follows_is_offered(truth, model, names):
    assert {e.name for e in offered(case(truth, model))} == names


def test_no_film_follows_a_current():
    model = replace(bench(), quantities={"pump": "current"})
    assert offered(case(bench(pumped=0.7), model)) == {}


def test_what_is_held_out_has_no_say():
    some = case(bench(), bench("one"), "hold-out")
    held = some.tests[2]
    bent = replace(held, channels=tuple(replace(c, y=c.y[::-1] + 50.0) for c in held.channels))
    assert offered(some) == offered(replace(some, tests=(*some.tests[:2], bent))) != {}
