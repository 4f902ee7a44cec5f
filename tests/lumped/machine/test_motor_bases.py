"""One machine on several bases: each switch gives the network of that base, none the bare machine."""

from pathlib import Path

import numpy as np
import pytest
from bare_networks import means_only

from geom import library, load_machine
from geom.errors import InputError
from geom.machine_file import machine_from
from lumped.build.pipeline import build, prepared
from lumped.condensation.reduction import Recipe
from lumped.integration.balance import balance
from lumped.integration.simulate import Record
from lumped.integration.steady import steady
from lumped.machine.bases import unused

LOAD = {"current_A": 8.0, "speed_rpm": 0.0}
FEW = Recipe(tolerance=0.02, shifts=(), random_points=0)  # learned at the machine's own coefficients, where it is used
PLACES = ("winding.copper", "magnets", "stator.core")


def sections(**bases):
    import tomllib

    return {**tomllib.loads(Path(library()["pmsm-m1"]).read_text(encoding="utf-8")), "bases": bases}


def coarse(machine):
    """What is compared here is the same on any mesh."""
    return build(machine, 0.1, 36, FEW).network


@pytest.fixture(scope="module")
def both():
    return coarse(machine_from(sections(bench="own", plate="pmsm-m1-plate"), "both.toml"))


def rest(network, **switches):
    rows = [network.places[p].mean for p in PLACES]
    return steady(network, {**LOAD, **switches}, {"ambient": 20.0}, None, rows)


@pytest.mark.parametrize(
    ("on", "off"), [((1, 0), ["foot.plate", "base.plate"]), ((0, 1), ["foot", "base"]), ((0, 0), 4), ((None, None), [])]
)
def test_bases_it_does_not_stand_on(on, off):
    machine = machine_from(sections(bench="own", plate="pmsm-m1-plate"), "both.toml")
    inputs = {f"on_{name}": np.full(3, x) for name, x in zip(("bench", "plate"), on, strict=True) if x is not None}
    found = unused(machine, inputs)
    assert len(found) == off if off == 4 else found == off
    assert unused(load_machine("pmsm-m1"), inputs) == []


@pytest.mark.heavy
@pytest.mark.parametrize(("name", "on"), [("pmsm-m1", (1, 0)), ("pmsm-m1-plate", (0, 1))])
def test_on_one_base_it_is_that_machine(both, name, on):
    """Within 1 % of the rise: the mesh has other layers, and the other foot's print meets the air."""
    alone = rest(coarse(load_machine(name))).y - 20.0
    together = rest(both, on_bench=on[0], on_plate=on[1]).y - 20.0
    assert together == pytest.approx(alone, rel=0.01)


def test_a_foot_that_is_not_there_takes_no_heat(both):
    state = rest(both, on_bench=0, on_plate=0)
    for part in ("foot", "base", "foot.plate", "base.plate"):
        assert state[part] == pytest.approx(20.0, abs=1e-6)
    assert state["stator.core"] > rest(both, on_bench=1, on_plate=0)["stator.core"] + 5.0


def test_bare_machine_has_the_outer_area_of_one_without_base(both):
    """The face and both footprints together are the face of the machine that was drawn without a base."""
    prints = [both.places[name].area for name in ("stator.core.outer", "foot.print", "foot.plate.print")]
    bare = means_only(prepared(load_machine("pmsm-m1-no-base"), 0.1, 36)).places["stator.core.outer"].area
    assert sum(prints) == pytest.approx(bare, rel=1e-3)


def test_heat_is_conserved_when_a_base_is_taken_away(both):
    time = np.array([0.0, 3600.0, 3600.0, 7200.0])
    on = np.array([1.0, 1.0, 0.0, 0.0])
    inputs = {"current_A": np.full(4, 8.0), "speed_rpm": np.zeros(4), "on_bench": on, "on_plate": np.zeros(4)}
    found = balance(both, Record(time, inputs, {"ambient": np.full(4, 20.0)}, 20.0))
    assert np.abs(found.residual).max() < 1e-5  # the balance has a quadrature of its own
    assert found.power("film:foot.print:natural")[0] == 0.0
    assert found.power("film:foot.print:natural")[-1] > 0.0


@pytest.mark.parametrize(
    ("bases", "right"),
    [
        ({"bench": "own", "plate": "pmsm-m2-plate"}, "differs in"),
        ({"bench": "own", "plate": "pmsm-m1-no-base"}, "differs in"),
        ({"plate": "pmsm-m1-plate"}, "one base 'own'"),
    ],
)
def test_impossible_bases_are_refused(bases, right):
    with pytest.raises(InputError, match=right):
        machine_from(sections(**bases), "both.toml")
