"""The error budget against what it estimates: a finer mesh, a finer network, and what a declared network has."""

import json
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from library_machines import point_in
from small_case import small_case

from geom import load_machine
from lumped.build.fixed_coefficients import rated
from lumped.build.pipeline import Built, Meshing, build, coefficients_on, meshed
from lumped.build.rated_errors import HOT, Reader, at_rated_point, cached_errors, hot_rows
from lumped.condensation.error_budget import MonitoredPlaces
from lumped.condensation.reduction import Recipe
from lumped.integration.simulate import simulate as run_network
from lumped.machine.motor import rated_inputs
from measured.case import Case, Channel, Model, Test
from thermoscope.commands.test.compare import compare
from thermoscope.commands.use.simulate import simulate
from validation.comparison.error_budget import budgets_of
from validation.comparison.predict import record

pytestmark = pytest.mark.heavy

MACHINE, SIZE, SEGMENTS, AXIAL = "pmsm-m1-no-base", 0.1, 36, 0.12
RECIPE = Recipe(tolerance=0.05, shifts=(0.01,), random_points=1, max_states=60)
FEEDBACK = 1.4  # 1 / (1 - 0.39 % / K * 100 K / 1.4): copper that is too warm heats more; budgets hold losses fixed
SENSORS = {"T_winding": "winding", "T_end": "endcap.left"}


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="module")
def built(cache):
    return build(load_machine(MACHINE), SIZE, SEGMENTS, RECIPE, axial_m=AXIAL)


@pytest.fixture(scope="module")
def looks(built):
    places = built.network.places
    at = {"T_point": np.array(point_in(built.machine, "stator.core"))}
    return MonitoredPlaces({n: places[p].mean for n, p in SENSORS.items()}, {**SENSORS, "T_point": "stator.core"}, at)


@pytest.fixture(scope="module")
def found(built, looks):
    return at_rated_point(built, looks)


def test_every_sensor_and_every_heated_part_has_an_error(built, found):
    heated = {f"{HOT}{part}" for part in ("winding", "winding.left", "winding.right")}
    assert {*SENSORS, "T_point"} | heated <= found.mesh_K.keys()
    assert found.mesh_K.keys() == found.condensation_K.keys()
    assert min(found.mesh_K.values()) > 0.0


def test_a_mesh_twice_as_fine_lies_within_the_mesh_error(built, looks, found):
    asked = rated(built.machine, built.network, *coefficients_on(built.machine, built.mesh))
    finer = meshed(built.machine, Meshing(SIZE / 2, SEGMENTS, 2.0, AXIAL / 2)).field
    here, there = (Reader(f, built.network, asked, looks).read(asked.of_field(f)) for f in (built.field, finer))
    for name, error in found.mesh_K.items():
        assert abs(here[name] - there[name]) < error + 2e-3 * found.rise_K, name


def test_a_network_of_more_states_leaves_less(built, looks, found):
    """Steady, at nominal coefficients; the budget holds the worst of that, of a step of loss and of other points."""
    larger = build(built.machine, SIZE, SEGMENTS, replace(RECIPE, max_states=None, tolerance=0.01), axial_m=AXIAL)
    asked = rated(built.machine, built.network, *coefficients_on(built.machine, built.mesh))
    reader, T = Reader(built.field, built.network, asked, looks), asked.of_field(built.field)
    small, large = (reader.differences(T, asked.of_network(b.network, built.field)) for b in (built, larger))
    assert max(large.values()) < 0.5 * max(small.values())
    assert all(small[name] <= found.condensation_K[name] for name in small)


@dataclass(frozen=True)
class Opened:
    """What a budget is made of.  positions : of no sensor"""

    case: Case
    built: Built
    positions: dict = field(default_factory=dict)


@pytest.mark.nightly
def test_with_fitted_contacts_a_smaller_network_is_as_far_off_as_its_budget_says(built, looks):
    """Hot spots of two networks of one machine after three hours of rated losses, all contacts x5: further apart than
    the rated point and factors up to 2 tell, and within what a look at the model's own values does."""
    larger = build(built.machine, SIZE, SEGMENTS, replace(RECIPE, max_states=None, tolerance=0.01), axial_m=AXIAL)
    contacts = {p.name: 5.0 for p in built.network.parameters if p.name.startswith("contact.")}
    time = np.linspace(0.0, 10800.0, 91)
    load = rated_inputs(built.machine) | {"current_A": 10.0}  # on wood the rated current is too much for it
    inputs = {name: np.full(time.shape, x) for name, x in load.items()}
    sensor = Channel("T", "winding", looks.rows["T_winding"], np.full(time.shape, 50.0))
    run = Test("run", "calibrate", time, inputs, {"ambient": np.full(time.shape, 20.0)}, (sensor,))

    def left(of, values):
        sensor_of = replace(sensor, row=of.network.places["winding"].mean)
        case = Case("x", Model(of.network, values=values), (replace(run, channels=(sensor_of,)),))
        return {p.place: p.condensation_K for p in budgets_of(Opened(case, of), case.tests)["run"].places}

    def hot_spots(of):
        rows = hot_rows(of.network, cached_errors(of, looks))
        return dict(zip(rows, run_network(of.network, record(run, {}), contacts, [*rows.values()]).y.T, strict=True))

    fewer, more = hot_spots(built), hot_spots(larger)
    apart = {name: np.abs(T - more[name]).max() for name, T in fewer.items()}
    rated_only, here, beside = left(built, {}), left(built, contacts), left(larger, contacts)
    assert all(off <= FEEDBACK * (here[name] + beside[name]) for name, off in apart.items())
    assert any(off > FEEDBACK * (rated_only[name] + beside[name]) for name, off in apart.items())


@pytest.mark.parametrize("command", ["compare", "simulate"])
def test_a_declared_network_has_neither_mesh_nor_condensation(command, tmp_path, capsys):
    case = small_case(tmp_path)
    run = {"compare": lambda: compare(str(case), "-"), "simulate": lambda: simulate(str(case), None, None, "-")}
    run[command]()
    document = json.loads(capsys.readouterr().out)
    runs = {
        "compare": lambda: document["error_budget"].values(),
        "simulate": lambda: [r["error_budget"] for r in document["runs"]],
    }
    rows = [place for places in runs[command]() for place in places]
    assert rows
    for place in rows:
        assert (place["mesh_K"], place["condensation_K"]) == (None, None)
        assert place["place"].startswith("T_")
