"""Pictures are real: they show something, follow the field, and share a scale in pairs."""

from dataclasses import replace

import numpy as np
import pytest
from fictional import POSITIONS, comparison
from PIL import Image
from small_motor import motor

import viz.rendering.gl
from geom.errors import MissingDependency
from viz import cutaway, machine_row, pair, sensors, split
from viz.colours import VERDICT, heat

NODES = split(motor(24))
FIELD = 40.0 + 60.0 * np.exp(-(((np.hypot(*NODES.points[:, :2].T) - 0.1) / 0.06) ** 2))


def pixels(path):
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def test_picture_is_full_size_and_not_blank(tmp_path):
    cutaway(NODES, FIELD, limits=(20.0, 120.0), png=tmp_path / "plain.png").close()
    plain = pixels(tmp_path / "plain.png")
    assert plain.shape == (800, 1280, 3)
    machine = (plain < 250).any(axis=2)
    assert 0.1 < machine.mean() < 0.8
    assert plain[machine].std() > 20


def test_pair_of_equal_fields_is_equal_and_of_unequal_ones_is_not(tmp_path):
    """One scale for both: a field 30 K below the other must not look the same."""
    for name, other in (("same", FIELD), ("other", FIELD - 30.0)):
        pair(NODES, FIELD, other, png=tmp_path / f"{name}.png").close()
    same, other = pixels(tmp_path / "same.png")[80:], pixels(tmp_path / "other.png")[80:]
    assert np.abs(same[:, :530] - same[:, 640:1170]).mean() < 1.0
    assert np.abs(other[:, :530] - other[:, 640:1170]).mean() > 5.0


def test_machines_in_a_row_are_as_large_as_each_other_and_on_one_scale(tmp_path):
    """A machine of half the size is half as wide, and one that is colder is painted colder."""
    half = replace(NODES, points=0.5 * NODES.points)
    machine_row([(NODES, FIELD, "whole"), (half, FIELD - 30.0, "half")], png=tmp_path / "row.png").close()
    panels = np.split(pixels(tmp_path / "row.png")[80:, :1280], 2, axis=1)
    machines = [panel[:, :520].min(axis=2) < 250 for panel in panels]
    widths = [np.ptp(np.flatnonzero(m.any(axis=0))) for m in machines]
    assert widths[1] / widths[0] == pytest.approx(0.5, abs=0.03)
    red = [panel[:, :520][m][:, 0].mean() for panel, m in zip(panels, machines, strict=True)]
    assert red[0] > red[1] + 20


def test_sensors_are_marked_in_the_colour_of_their_residual(tmp_path):
    marked = sensors(comparison(), POSITIONS)
    assert {s.name: s.verdict for s in marked}["flange.right"] == "cold"
    cutaway(NODES, FIELD, sensors=marked, png=tmp_path / "s.png").close()
    seen = pixels(tmp_path / "s.png")
    for verdict in ("cold", "within"):
        colour = np.array([int(VERDICT[verdict][i : i + 2], 16) for i in (1, 3, 5)])
        assert (np.abs(seen - colour).max(axis=2) < 6).sum() > 500


def test_colour_scale_rises_evenly_in_lightness():
    """sRGB relative luminance (WCAG) is monotone along the scale and never below 0.09."""
    rgb = heat()(np.linspace(0, 1, 64))[:, :3]
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    luminance = linear @ [0.2126, 0.7152, 0.0722]
    assert (np.diff(luminance) > 0).all()
    assert luminance[0] > 0.09


def test_without_gl_the_error_names_the_command(monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkNoSuchWindow")
    viz.rendering.gl.off_screen_window.cache_clear()
    try:
        with pytest.raises(MissingDependency, match="apt-get install -y libegl1"):
            viz.rendering.gl.require_gl()
    finally:
        viz.rendering.gl.off_screen_window.cache_clear()
