"""Three bases, three machines: what was hidden in M1 is recovered, M2 and M3 are predicted, a wrong base is named."""

import subprocess
import sys
import tomllib

import numpy as np
import pytest

from geom.errors import InputError
from lumped.steady import steady
from thermoscope.folder import load_case
from validation.calibrate import calibrated
from validation.fitting import working
from validation.predict import thermal
from validation.procedure.carry import carried, settled
from validation.procedure.repeats import repeats
from validation.procedure.which_base import which_base

GAP, BENCH, PLATE = "link.slot.liner-stator.core", "link.stator.core-base.bench.0", "link.stator.core-base.plate.0"


@pytest.fixture(scope="module")
def bases(root):
    return load_case(root / "cases" / "pmsm-bases")


@pytest.fixture(scope="module")
def truth(root):
    return tomllib.loads((root / "simulated" / "pmsm.truth.toml").read_text(encoding="utf-8"))


def test_networks_are_those_of_the_descriptions(root):
    """The committed networks are what the script writes now, to a thousandth: libraries round areas differently."""
    done = subprocess.run(
        [sys.executable, "-c", "from scripts.pmsm_cases import *\nfor p, d in documents().items():\n"
         " assert close(tomllib.loads(p.read_text()), tomllib.loads(text(d))), p"],
        cwd=root, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", ["wood", "plate", "bench", "bench-2", "bench-3", "m2", "m3"])
def test_runs_balanced(truth, name):
    assert abs(truth[name]["imbalance"]) < 1e-5
    assert abs(truth[name]["cooling_imbalance"]) < 1e-4


def test_temperatures_are_right_within_their_uncertainty(bases, truth):
    """What resistance and back-EMF say at switching off against the true means: within 95 %, and not exact."""
    for test in bases.case.tests:
        for channel, key in zip(test.channels, ("winding_degC", "magnets_degC")):
            read = channel.y[np.isfinite(channel.y)][-1]
            assert 0.0 < abs(read - truth[test.name][key]) < 2.5 * channel.sigma_K, (test.name, channel.name)


@pytest.fixture(scope="module")
def fitted(bases):
    """M1 calibrated anew on wood, plate and bench, and 30 draws of its parameters from their joint uncertainty."""
    network, unknowns = working(bases.case)
    fit = calibrated(network, [t for t in bases.case.tests if t.role == "calibrate"], unknowns, {})
    random, root = np.random.default_rng(0), np.linalg.cholesky(fit.covariance)
    drawn = [fit.theta + root @ random.standard_normal(fit.theta.size) for _ in range(30)]
    return thermal(network), fit, [unknowns.values(np.clip(theta, *unknowns.bounds)) for theta in drawn]


def base_path(network, test, values, base):
    """Heat into a base per kelvin between laminations and ambient (W/K), at the test's end."""
    known = {p.name for p in network.parameters}
    inputs, air = {n: float(v[-1]) for n, v in test.inputs.items()}, float(test.boundaries["ambient"][-1])
    state = steady(network, inputs, {"ambient": air}, {k: v for k, v in values.items() if k in known})
    name = f"stator.core-base.{base}.0"
    link = next(one for one in network.links if one.name == f"link:{name}")
    G = float(np.ravel(link.law.factor({n: np.array([v]) for n, v in inputs.items()}))[0]) * values[f"link.{name}"]
    return G * (state["stator.core"] - state[f"base.{base}.0"]) / (state["stator.core"] - air)


@pytest.mark.parametrize(("number", "base"), [(1, "plate"), (2, "bench")])
def test_calibrated_base_holds_the_truth(bases, truth, fitted, number, base):
    """What a base carries off, by 30 draws of the fit: the hidden value lies within their 95 %."""
    network, _, draws = fitted
    test = bases.case.tests[number]
    low, high = np.percentile([base_path(network, test, values, base) for values in draws], [2.5, 97.5])
    assert low < truth[base]["base_path_W_K"] < high


def test_calibrated_gap_and_film_hold_the_truth(bases, truth):
    """The hidden multipliers lie in the 95 % intervals of the model's last calibration."""
    drawn, found = truth["drawn"], bases.history.last.intervals
    assert found[GAP][0] < drawn["conductivity.slot.gap"] < found[GAP][1]
    low, high = found["emissivity"]
    assert low < drawn["emissivity.body"] / 0.85 < high


def test_calibration_is_that_of_the_data(bases, fitted):
    """Calibrating again from the start gives the committed values, within a tenth of their intervals."""
    last = bases.history.last
    for name in (GAP, BENCH, PLATE, "convection"):
        low, high = last.intervals[name]
        assert fitted[1].values[name] == pytest.approx(last.values[name], abs=0.1 * (high - low))


def test_simulation_agrees_on_the_bases(bases):
    rows = settled(bases.case)
    assert {r.test for r in rows} == {t.name for t in bases.case.tests}
    assert all(r.within for r in rows), [r.document() for r in rows if not r.within]


@pytest.mark.parametrize("name", ["m2", "m3"])
def test_machines_that_were_not_used_are_predicted(root, bases, name):
    """Difference below the measurement's worst case with M1's values, and closer than without them."""
    other = load_case(root / "cases" / "pmsm-machines" / name).case
    found, plain = carried(bases.case, other), settled(other)
    assert "convection" in found.parameters
    assert found.agrees, [r.document() for r in found.rows]
    assert sum(abs(r.difference_K) for r in found.rows) < sum(abs(r.difference_K) for r in plain)


def test_three_equal_tests_repeat(bases):
    rises = []
    for test in bases.case.tests[2:]:
        channel = test.channels[0]
        at = np.flatnonzero(np.isfinite(channel.y))[-1]
        rises.append(channel.y[at] - test.boundaries["ambient"][at])
    assert repeats(rises, bases.case.tests[2].channels[0].sigma_K).repeat


SWITCHES = ("on_plate", "on_bench")


@pytest.mark.parametrize(("test", "right"), [("wood", ""), ("plate", "on_plate"), ("bench", "on_bench")])
def test_wrong_base_is_seen_as_such(bases, test, right):
    """With the films as calibrated, a base forgotten or invented is excluded and the right one is not.

    Plate and bench differ by 4 K only, which these meters do not tell apart in every test: that is not asked for.
    """
    found = {h.base: h for h in which_base(bases.case, test, SWITCHES)}
    assert not found[right].excluded
    wrong = SWITCHES if right == "" else ("",)
    assert all(found[base].excluded for base in wrong)
    assert all(np.sign(found[base].offset_K) == (-1 if right == "" else 1) for base in wrong)


def test_unknown_test_or_switch(bases):
    with pytest.raises(InputError, match="tests: wood, plate"):
        which_base(bases.case, "grass", SWITCHES)
