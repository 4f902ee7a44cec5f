"""What a page of the viewer holds: the fields it was made from, in few shapes and few bytes."""

import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from viewer_pages import NODES, PLACE, document, mapped, mixed, recorded, unpacked, warming, write_viewer

from viz.rendering.flux import nodal_flux
from viz.viewer.page import ERROR, SHARE, STEP_K, packed_maps, render
from viz.viewer.part_shapes import BLOCK, ERROR_K, low_rank, packed_fields, packed_integers, packed_numbers


def test_mixed_shapes_are_the_fields():
    fields = warming(60.0)
    found = low_rank(fields)
    assert len(found.shapes) < len(fields)
    assert np.abs(found.fields() - fields).max() <= ERROR_K


def test_every_part_mixes_its_own_shapes_to_the_fields():
    """Parts out of step with each other: the machine as a whole needs more shapes than any part does."""
    fields = warming(60.0)
    packed = packed_fields(fields, NODES, ERROR_K, STEP_K)
    assert len(packed["blocks"]) == len(NODES.parts)
    assert max(block["columns"] - 1 for block in packed["blocks"]) < len(low_rank(fields).shapes)
    assert np.abs(mixed(packed) - fields).max() < 1.5 * ERROR_K


def test_no_fewer_principal_shapes_would_do():
    """Against the singular value decomposition, over more nodes than are looked at together."""
    rng = np.random.default_rng(0)
    fields = 50.0 + (rng.standard_normal((40, 12)) * np.logspace(1, -3, 12)) @ rng.standard_normal((12, 2 * BLOCK + 7))
    rest = fields - fields.mean(axis=0)
    u, s, v = np.linalg.svd(rest, full_matrices=False)
    errors = [np.abs(rest - (u[:, :r] * s[:r]) @ v[:r]).max() for r in range(13)]
    found = low_rank(fields)
    assert np.abs(found.fields() - fields).max() <= ERROR_K
    assert len(found.shapes) == next(r for r, error in enumerate(errors) if error <= ERROR_K) > 3


def test_a_field_that_stays_needs_no_shape():
    assert len(low_rank(np.full((3, 5), 20.0)).shapes) == 0


def test_packing_loses_no_whole_number_and_half_a_step_of_others():
    rng = np.random.default_rng(1)
    whole = rng.integers(0, 70_000, (50, 4))
    assert (unpacked(packed_integers(whole)) == whole).all()
    numbers = rng.normal(0.0, 3.0, (50, 3))
    assert np.abs(unpacked(packed_numbers(numbers)) - numbers).max() <= np.ptp(numbers, axis=0).max() / 65535 / 2 * 1.01


def test_packing_keeps_what_is_not_known():
    numbers = np.array([[np.nan, 1.0, np.nan], [2.0, np.nan, np.nan], [3.0, 5.0, np.nan]])
    assert unpacked(packed_numbers(numbers, 0.5)) == pytest.approx(numbers, nan_ok=True)


@pytest.mark.parametrize("before", [True, False])
def test_the_page_holds_the_fields_it_was_made_from(before):
    one = recorded(before)
    held = document("motor", NODES, [one], PLACE)
    found, states = mixed(held["fields"]), held["tests"][0]["states"]
    assert len(states) == 1 + before
    for first, fields in zip(states, one.states, strict=True):
        assert np.abs(found[first : first + len(fields)] - fields).max() < 1.5 * ERROR_K
    assert np.abs(unpacked(held["points"]) - NODES.points).max() < 1e-5


@pytest.mark.skipif(shutil.which("node") is None, reason="needs node")
def test_a_base_that_it_does_not_stand_on_is_not_drawn(tmp_path):
    """By what the first test says: its part is there in others."""
    first = replace(recorded(), absent=NODES.parts[1:2])
    page = tmp_path / "v.html"
    page.write_text(render(document("m", NODES, [first, recorded()], PLACE)), encoding="utf-8")
    script = Path(__file__).with_name("viewer_in_node.js")
    found = subprocess.run(["node", script, page, "0", "0"], capture_output=True, text=True, check=True)
    assert json.loads(found.stdout)["opacities"] == [float(name != NODES.parts[1]) for name in NODES.parts]


def test_what_a_name_holds_is_never_run(tmp_path):
    page = write_viewer(tmp_path / "v.html", "</script><script>x", NODES, [recorded()], PLACE).read_text()
    assert "</script><script>x" not in page
    assert "http://" not in page
    assert "https://" not in page


def test_flux_of_a_linear_field_is_the_conductivity_times_its_slope():
    """Fourier: 100 K/m along the axis and 50 K/m across it in parts of their own conductivities, to rounding."""
    k = {part: (2.0 + i, 30.0 + i) for i, part in enumerate(NODES.parts)}
    across, along = np.array(list(k.values()))[NODES.owner].T
    assert nodal_flux(NODES, 100.0 * NODES.points[:, 2], k) == pytest.approx(0.1 * along)
    assert nodal_flux(NODES, 50.0 * NODES.points[:, 1], k) == pytest.approx(0.05 * across)


def test_errors_between_sensors_are_told_by_residuals():
    """The packed map is the map within two hundredths of a residual; silent sensors tell nothing."""
    one = mapped()
    packed = packed_maps([one.error_map], NODES)
    assert np.abs(mixed(packed["gains"]).T - one.error_map.gain).max() < 1.5 * ERROR
    assert np.abs(mixed(packed["told"])[0] - one.error_map.explained).max() < 1.5 * SHARE
    silent = one.error_map.at({name: np.array([np.nan]) for name in PLACE})
    assert (silent == 0.0).all()
