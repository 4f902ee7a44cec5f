"""Moving pictures, PDF and pictures of a recording: written by real encoders, printers and viewers, and read back."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from fictional import HISTORY, POSITIONS, comparison
from PIL import Image
from rerun_pictures import snapshots
from small_motor import motor

from geom.errors import InputError
from thermoscope.check import findings
from viz import Report, animate, split, write_pdf, write_recording, write_report

NODES = split(motor(16))
FIELDS = np.stack([np.full(NODES.size, T) for T in (25.0, 60.0, 95.0)])
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


def test_mp4_has_every_frame(tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="needs imageio-ffmpeg: uv pip install imageio-ffmpeg")
    path = animate(NODES, [0.0, 600.0, 1200.0], FIELDS, tmp_path / "warm.mp4", frames_per_second=3.0)
    frames, seconds = ffmpeg.count_frames_and_secs(str(path))
    assert frames == 3
    assert seconds == pytest.approx(1.0, abs=0.4)  # the encoder rounds the last frame's duration


def test_words_of_later_pictures_have_the_font_of_the_first(tmp_path):
    """VTK draws a second headline as soon as it is there, with whatever font it has by then. Equal pictures are one."""
    file = animate(NODES, [0.0, 600.0], FIELDS[[0, 0]], tmp_path / "warm.gif", titles=["12 min", "12 min"])
    with Image.open(file) as film:
        assert getattr(film, "n_frames", 1) == 1


def test_other_endings_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"\.gif or \.mp4"):
        animate(NODES, [0.0], FIELDS[:1], tmp_path / "warm.avi")


@pytest.mark.heavy
@pytest.mark.skipif(BROWSER is None, reason="needs a browser: apt-get install -y chromium")
def test_report_is_printed(tmp_path):
    pdf = write_pdf(write_report(Report("road-test", "A test of the printer."), tmp_path / "report.html"))
    assert pdf is not None
    assert pdf.read_bytes().startswith(b"%PDF-")
    assert pdf.stat().st_size > 5000


def test_without_a_converter_there_is_no_pdf(tmp_path, monkeypatch):
    monkeypatch.setattr("viz.pages.pdf.find_spec", lambda name: None)
    monkeypatch.setattr(shutil, "which", lambda name, **_: None)
    assert write_pdf(write_report(Report("road-test"), tmp_path / "report.html")) is None
    assert not (tmp_path / "report.pdf").exists()


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """Three fields over the test, and one per revision: cold, hot, warm."""
    ends = np.stack([np.full(NODES.size, T) for T in (30.0, 95.0, 60.0)])
    off = [{"flange.right": -6.0}, {"flange.right": -6.0}, {"flange.right": 0.1}]
    return write_recording(
        tmp_path_factory.mktemp("rrd") / "a.rrd",
        NODES,
        comparison(),
        (np.array([0.0, 1800.0, 3600.0]), FIELDS),
        POSITIONS,
        history=HISTORY,
        revision_fields=ends,
        revision_residuals=off,
    )


def test_every_revision_has_a_field_sensors_and_errors(recording):
    """Read back with rerun's own tool: each of these has rows on the timeline `revision`."""
    program = shutil.which("rerun", path=str(Path(sys.executable).parent))
    shown = subprocess.run([program, "rrd", "print", "-vvv", str(recording)], capture_output=True, text=True).stdout
    chunks = [c for c in shown.split("Chunk") if "revision" in c]
    for entity in ("/machine/field", "/machine/sensors", "/error/road-2", "/step"):
        assert any(entity in c for c in chunks), entity


def ended(group: int, tries: int = 300) -> bool:
    """Whether no process of a group is left, or soon will be."""
    for _ in range(tries):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False


@pytest.mark.heavy
def test_the_viewer_shows_it_and_ends(recording, tmp_path, monkeypatch):
    started, popen = [], subprocess.Popen
    monkeypatch.setattr(subprocess, "Popen", lambda *a, **k: started.append(popen(*a, **k)) or started[-1])
    if not next(f for f in findings() if f.name == "Vulkan driver").present:
        pytest.skip("needs a Vulkan driver: apt-get install -y libvulkan1 mesa-vulkan-drivers")
    cold, hot = snapshots(
        recording, {tmp_path / "0.png": ("test_time", 0.0), tmp_path / "1.png": ("test_time", 3600.0)}
    )
    a, b = (np.asarray(Image.open(p).convert("RGB")).astype(int) for p in (cold, hot))
    assert a.std() > 10
    assert np.abs(a - b).mean() > 1
    assert ended(started[-1].pid)  # the program and the viewer it started
