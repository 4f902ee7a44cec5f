"""What the model misses, painted: zero in the middle of its scale, and stripes just where readings tell little."""

import numpy as np
import pytest
from PIL import Image
from small_motor import motor

from extras.portraits.portrait import portrait
from geom import load_machine
from viz import Sensor, cutaway, misses, split, uncertainty
from viz.machine.animation import Pulses
from viz.machine.misses import CAPTION, GUESS, pixels
from viz.rendering import scene
from viz.rendering.cut import cut_away
from viz.rendering.scene import NOTE, View

NODES = split(motor(24))
ERROR = np.linspace(-3.0, 1.0, NODES.size)


def drawn(told, png):
    p = misses(NODES, ERROR, told, title="hour", png=png)
    out = p.actors, p.scalar_bars["K"].lookup_table.scalar_range, p.actors["footnote"].GetInput()
    p.close()
    return out, np.asarray(Image.open(png).convert("RGB")).astype(int)


def test_stripes_stand_where_it_is_a_guess_and_only_there(tmp_path):
    right = NODES.points[:, 2] > 0.4
    (all_told, limits, said), plain = drawn(np.ones(NODES.size), tmp_path / "a.png")
    (half_told, _, _), hatched = drawn(np.where(right, GUESS / 2, 1.0), tmp_path / "b.png")
    assert limits[0] == -limits[1]
    printed = [actor.GetInput() for actor in all_told.values() if hasattr(actor, "GetInput") and hasattr(actor, "prop")]
    assert f"−{limits[1]:.0f}" in printed
    assert not any("-" in str(words) for words in printed)
    assert said == CAPTION
    assert "hatched" not in all_told
    assert "hatched" in half_told
    changed = (np.abs(hatched - plain).max(axis=2) > 20).any(axis=0)
    columns = np.flatnonzero(changed)
    assert len(columns) > 100
    assert columns.min() > 0.4 * plain.shape[1]  # z runs to the right


def test_a_band_begins_at_zero_and_is_darker_where_less_is_known(tmp_path):
    """z runs to the right, and the band with it; paper is white."""
    half95 = 1.0 + 9.0 * NODES.points[:, 2] / NODES.points[:, 2].max()
    p = uncertainty(NODES, half95, title="hour", png=tmp_path / "u.png")
    assert p.scalar_bars["± K"].lookup_table.scalar_range == (0.0, 10.0)
    p.close()
    grey = np.asarray(Image.open(tmp_path / "u.png").convert("L")).astype(float)[:, :1100]
    machine = np.where(grey < 235.0, grey, np.nan)
    columns = np.flatnonzero(np.isfinite(machine).sum(axis=0) > 100)
    some = len(columns) // 4
    left, right = (np.nanmedian(machine[:, c]) for c in (columns[:some], columns[-some:]))
    assert right < left - 20.0


SENSORS = [Sensor("shaft", (0.0, 0.0, 0.3), 5.0, 1.0), Sensor("yoke", (0.1, -0.1, 0.3), 1.0, 1.0)]
FOOTED = {
    "misses": lambda: misses(NODES, ERROR, np.ones(NODES.size), sensors=SENSORS, title="hour"),
    "uncertainty": lambda: uncertainty(NODES, 1.0 + ERROR**2, sensors=SENSORS, title="hour"),
    "field": lambda: cutaway(NODES, 20.0 + ERROR, sensors=SENSORS, title="hour"),
    "machine": lambda: portrait(load_machine("series-dc-100kw"), title="motor"),
}


@pytest.mark.parametrize("kind", FOOTED)
def test_what_is_said_below_touches_nothing(kind):
    """The machine stays above its footnote, and nothing is drawn through it: the depths of the view are its own."""
    p = FOOTED[kind]()
    p.render()
    said = p.actors["footnote"].GetInput()
    meshes = [a.mapper.dataset for a in p.actors.values() if hasattr(getattr(a, "mapper", None), "dataset")]
    solid = max(meshes, key=lambda data: data.n_points).points
    near = p.camera.clipping_range[0]
    closest = ((np.array(p.camera.position) - solid) @ -np.array(p.camera.direction)).min()
    lowest = pixels(p, np.asarray(solid, float))[:, 1].min() / p.window_size[1]
    p.close()
    assert lowest > NOTE
    assert near > 0.5 * closest
    assert kind == "machine" or "hollow dots" in said
    assert kind != "misses" or CAPTION in said


@pytest.mark.parametrize(("residual_K", "pulses"), [(5.0, True), (-5.0, True), (0.2, False)])
def test_a_sensor_pulses_if_the_model_misses_it(residual_K, pulses):
    surface = cut_away(NODES)
    p = scene.plotter(size=(320, 200))
    scene.look(p, surface.points, View())
    row = [Sensor("housing", (0.0, 0.22, 0.3), residual_K, 1.0)]
    dots = Pulses(p, surface, row)
    sizes = []
    for second in (0.0, 0.4):
        dots.show(row, second)
        assert ("pulse" in p.actors) == pulses
        sizes += [p.actors["pulse"].prop.point_size] if pulses else []
    p.close()
    assert len(set(sizes)) == len(sizes)
