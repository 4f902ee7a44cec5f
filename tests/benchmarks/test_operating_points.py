"""Random operating points against correlations called directly: one machine, one circuit's coolant, every surface.

All machines, all coolants and 200 points of each: benchmarks/operating_points.py.
"""

from types import SimpleNamespace

import numpy as np
import operating_points
import pytest
from drawn.table_ends import COOLANTS, ends, every_table
from operating_points import ALLOWED, subjects, worst

from lumped.transfer.ranges import within_silence


@pytest.mark.parametrize("machine", ["tefc-industrial", "series-dc-100kw-air", "ipmsm-48s8p-jacket"])
def test_no_film_of_a_machine_is_off_anywhere(machine, monkeypatch):
    """0 to 3 times the speed, 0 to 4 times the flow, -40 to 150 degC: gap, jacket, faces, end space, fan's air."""
    monkeypatch.setattr(operating_points, "AT_REST", ())
    with within_silence():
        found = worst(operating_points.machine_points(machine, 5, np.random.default_rng(7)))
    assert len(found) >= 3
    assert max(off for off, _ in found.values()) < ALLOWED, found


def test_no_circuit_and_no_declared_film_is_off_and_heat_closes(monkeypatch):
    branches = {"two branches": operating_points.CIRCUITS["two branches"]}
    monkeypatch.setattr(operating_points, "CIRCUITS", branches)
    with within_silence():
        found = worst(subjects(4, ["pmsm-m1-no-base"], [COOLANTS[1]]))
    assert {"circuit, films", "circuit, shares of branches", "declared film", "still air"} <= {
        kind for kind, _ in found
    }
    assert max(off for off, _ in found.values()) < ALLOWED, found
    assert max(off for (kind, _), (off, _) in found.items() if kind.endswith("at rest")) < 1e-9


@pytest.mark.parametrize(
    ("branches", "coolant", "seed"), [("three branches", COOLANTS[1], 1), ("two branches", COOLANTS[2], 48)]
)
def test_beside_the_kinks_of_friction_branches_are_not_off(branches, coolant, seed, monkeypatch):
    """Where one of several branches turns turbulent, its share moves the films of all."""
    monkeypatch.setattr(operating_points, "STEADY", 0)
    data = {"coolant": coolant, "passes": operating_points.CIRCUITS[branches]}
    kinds = dict(operating_points.circuit_points(branches, data, 150, np.random.default_rng(seed)))
    found = worst(((kind, ""), pair) for kind in ("films", "shares of branches") for pair in kinds[kind])
    assert found["films", ""][0] < 0.01
    assert found["shares of branches", ""][0] < 0.002


def test_a_coolant_is_followed_until_it_freezes(monkeypatch):
    """Propylene glycol of 40 % by volume is liquid 1 K below the last step of the grid of temperatures."""
    monkeypatch.setattr(operating_points, "STEADY", 0)
    cold = SimpleNamespace(uniform=lambda low, high: -20.9 if low == -40.0 else 0.5 * (low + high))
    data = {"coolant": COOLANTS[2], "passes": operating_points.CIRCUITS["a coil"]}
    kinds = dict(operating_points.circuit_points("a coil", data, 1, cold))
    assert worst((("films", ""), pair) for pair in kinds["films"])["films", ""] == (pytest.approx(0.0, abs=0.002), 1)


def test_what_leaves_the_range_of_a_correlation_is_told_and_nothing_else():
    """Oil below 14 degC by its Prandtl number, fast streams by Reynolds' and small rises by Rayleigh's."""
    found = ends(every_table(["tefc-industrial-radial", "series-dc-100kw-air"], [COOLANTS[3]]), 12)
    assert {"duct_film", "schmidt_helical", "mcadams_plate", "elenbaas", "heiles", "taylor_film"} <= set(found)
    assert sum(outside for _, outside, _, _ in found.values()) >= 20
    assert [name for name, (_, _, silent, wrong) in found.items() if silent or wrong] == []
