"""A small part of benchmarks/condensation.py on one coarse machine: errors, balances, and its own arithmetic."""

import json
from dataclasses import replace

import condensation
import numpy as np
import pytest
from condensation import after_step, energy, over_loads, unbalanced
from condensed.points import Pair

from geom import load_machine
from lumped.build.network_size import smallest_network
from lumped.condensation.reduction_error import Errors

pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def pair():
    return Pair.of(smallest_network(load_machine("pmsm-m1-no-base"), 2.0, size_m=0.1, segments=24))


def test_network_is_within_one_and_two_percent_whatever_changes(pair):
    points = list(pair.points())
    one = [p for p in points if p.group == "one film x10"][::14]
    contacts = [p for p in points if p.group == "contacts"][::7]
    for point in [p for p in points if p.group in ("nominal", "all films", "gap, flow")] + one + contacts + points[-1:]:
        z = pair.of_network(point)
        e = over_loads(pair.network, pair.of_field(point), z)
        assert e.mean < 1.0, (point.name, str(e))
        assert max(e.hot, e.point) < (3.0 if point.group == "random" else 2.0), (point.name, str(e))
        assert unbalanced(pair, point, z) < 1e-10
    assert energy(pair) < 1e-9


def test_after_a_step_of_loss(pair):
    seen = after_step(pair, next(pair.points()))
    assert next(iter(seen)) == "30 s"
    for time, e in seen.items():
        assert e.mean < 1.0, time
        assert max(e.hot, e.point) < 2.0, time


def test_a_network_of_means_only_is_seen_to_be_wrong(pair):
    point = next(pair.points())
    small = pair.smaller(len(pair.reduction.field.blocks))
    assert over_loads(small.network, small.of_field(point), small.of_network(point)).mean > 5.0


def test_a_missing_watt_is_seen(pair):
    point = next(pair.points())
    z = pair.of_network(point)
    z[pair.network.column("winding")] += 1e-3
    assert unbalanced(pair, point, z) > 1e-8
    assert unbalanced(replace(pair, watts=1.001 * pair.watts), point, pair.of_network(point)) > 1e-4


def rows(machine, mean):
    kinds = Errors(mean, 2 * mean, 3 * mean, "a", "b", "c", {})
    out = [condensation.row(machine, "unknowns of the field", "1", 5e4), condensation.row(machine, "states", "1", 300)]
    for group in condensation.GROUPS:
        out += condensation.error_rows(machine, group, {"x": kinds}, condensation.WANTED)
    return out


def test_table_has_a_line_per_machine():
    lines = condensation.accuracy_table([*rows("b", 0.2), *rows("a", 0.1)]).splitlines()
    assert lines[2].startswith("| a | 50000 | 300 | 0.1 / 0.2 / 0.3 |")
    assert lines[3].startswith("| b | 50000 | 300 | 0.2 / 0.4 / 0.6 |")


def test_rows_of_other_machines_stay(tmp_path):
    file = tmp_path / "rows.json"
    file.write_text(json.dumps({"rows": [*rows("a", 0.1), *rows("b", 0.2)]}))
    assert {r["case"] for r in condensation.kept(str(file), ["b"])} == {"a"}
    assert condensation.kept(str(tmp_path / "none.json"), []) == []
    assert np.isclose(condensation.kept(str(file), ["b"])[2]["ratio"], 0.1)
