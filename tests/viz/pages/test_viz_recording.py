"""The recording: valid to rerun's own checker, complete, refused when it does not fit."""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fictional import HISTORY, PLACES, POSITIONS, TIME, comparison
from small_motor import motor

from geom.errors import InputError
from viz.recordings.arrangement import blueprint, in_view, non_overlapping, outside_outline
from viz.recordings.recording import TIME as TIME_LINE, write_recording
from viz.rendering.nodes import split
from viz.rendering.scene import View

NODES = split(motor(12))
FRAMES = 7


def rrd(tmp, *words):
    """What rerun's own tool says of a recording, in a home of its own in which it keeps no statistics."""
    program = shutil.which("rerun", path=str(Path(sys.executable).parent)) or shutil.which("rerun")
    alone = {**os.environ, "HOME": str(tmp), "XDG_CONFIG_HOME": str(tmp), "XDG_RUNTIME_DIR": str(tmp)}
    subprocess.run([program, "analytics", "disable"], env=alone, capture_output=True, check=False)
    return subprocess.run([program, "rrd", *words], env=alone, capture_output=True, text=True)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    times = np.linspace(0.0, 3600.0, FRAMES)
    fields = 20.0 + 50.0 * (times / 3600.0)[:, None] * np.linspace(0.2, 1.0, NODES.size)
    path = tmp_path_factory.mktemp("rrd") / "road.rrd"
    return write_recording(
        path,
        NODES,
        replace(comparison(), events=((600.0, 1200.0),)),
        (times, fields),
        POSITIONS,
        history=HISTORY,
        revision_fields=np.stack([fields[-1] + k for k in (4.0, 2.0, 0.0)]),
        revision_residuals=[{"flange.right": K} for K in (-6.0, -6.0, 0.1)],
    )


@pytest.fixture(scope="module")
def chunks(recording):
    """(rows, entity, component) of every chunk, as rerun's own tool lists them."""
    found = re.findall(
        r"with (\d+) rows .* - (/\S+) - data columns: \[(.*)\]", rrd(recording.parent, "print", "-v", recording).stdout
    )
    return [(int(n), entity, columns.rsplit(":", 1)[-1]) for n, entity, columns in found]


def test_recording_is_valid_and_a_broken_one_is_not(recording, tmp_path):
    done = rrd(tmp_path, "verify", recording)
    assert done.returncode == 0, done.stderr
    broken = tmp_path / "broken.rrd"
    broken.write_bytes(recording.read_bytes()[:2000])
    assert rrd(tmp_path, "verify", broken).returncode != 0


def test_recording_holds_every_frame_and_revision(chunks):
    colours = sorted(n for n, entity, column in chunks if column == "vertex_colors")
    assert colours == [len(HISTORY) + 1, FRAMES]
    assert [n for n, entity, column in chunks if column == "vertex_positions"] == [1], "geometry is written once"


def test_every_revision_has_a_field_sensors_and_errors(recording):
    """Each of these has rows on the timeline `revision`."""
    on_revision = [
        chunk
        for chunk in rrd(recording.parent, "print", "-vvv", recording).stdout.split("Chunk")
        if "revision" in chunk
    ]
    for entity in ("/machine/field", "/machine/sensors", "/error/road-2", "/step"):
        assert any(entity in chunk for chunk in on_revision), entity


def test_every_sensor_has_its_curves_and_every_input(chunks):
    series = {entity for n, entity, column in chunks if column == "scalars" and n == len(TIME)}
    assert series == {"/inputs/current_A"} | {
        f"/{kind}" for p in PLACES for kind in (f"curves/{p}/measured", f"curves/{p}/model", f"residual/{p}")
    }


def test_colours_and_events_are_explained(chunks):
    """A bar with its marks; an event leaves a line where it begins and one where it ends."""
    entities = {entity for _, entity, _ in chunks}
    assert {"/scale/bar", "/scale/marks", "/legend", "/machine/names"} <= entities
    assert sum(n for n, entity, column in chunks if entity == "/events" and column == "text") == 2


def views(part):
    """Every view inside a part of a blueprint."""
    inside = getattr(part, "contents", None)
    return [v for one in inside for v in views(one)] if isinstance(inside, list | tuple) and inside else [part]


def test_it_opens_playing_with_all_that_explains_it_in_sight():
    """From the start of the test, again and again; machine, colour bar, residuals, inputs, events and revisions."""
    shown = blueprint(replace(comparison(), events=((600.0, 1200.0),)), PLACES[0], NODES.points, True)
    panel = shown.time_panel
    assert (panel.timeline, panel.play_state, panel.loop_mode) == (TIME_LINE, "playing", "all")
    origins = {view.origin for view in views(shown.root_container)}
    assert {"machine", "scale", "legend", "residual", "inputs", "events", "error", "step"} <= origins


def test_names_of_sensors_cover_none_before_them():
    """Two at one place, a third an eighth of the diagonal above, a fourth farther along than a name is wide."""
    diagonal = np.linalg.norm(np.ptp(NODES.points, axis=0))
    _, right, up = View().axes()
    places = np.array([[0.0, 0.0, 0.0], 0.01 * diagonal * right, 0.125 * diagonal * up, 0.2 * diagonal * right])
    assert non_overlapping(places, NODES.points) == [True, False, True, True]


def test_names_of_what_is_hidden_stand_beside_the_machine():
    """On the line from the middle through the sensor as it is first seen, beyond every point of the machine."""
    places = np.array([[0.01, 0.0, 0.3], [0.1, -0.1, 0.5], [-0.12, 0.1, 0.2]])
    at, outline = (in_view(points, NODES.points)[0] for points in (outside_outline(places, NODES.points), NODES.points))
    for end, before in zip(at, in_view(places, NODES.points)[0], strict=True):
        away = end / np.linalg.norm(end)
        assert away == pytest.approx(before / np.linalg.norm(before))
        assert (outline @ away).max() < end @ away


def test_fields_and_times_must_pair(tmp_path):
    with pytest.raises(InputError, match="3 times but 2 fields"):
        write_recording(
            tmp_path / "x.rrd", NODES, comparison(), (np.arange(3.0), np.full((2, NODES.size), 20.0)), POSITIONS
        )
    assert not (tmp_path / "x.rrd").exists()
