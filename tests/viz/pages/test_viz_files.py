"""Moving pictures and PDF: written by real encoders and printers, and read back."""

import re
import shutil

import numpy as np
import pytest
from PIL import Image
from small_motor import motor

from geom.errors import InputError
from viz import Report, animate, split, write_pdf, write_report

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
def test_what_opens_on_a_click_is_printed(tmp_path):
    places = [
        {"place": f"slot {k}", "mesh_K": 0.1, "condensation_K": 0.1, "time_K": 0.1, "total_K": 0.2} for k in range(300)
    ]
    pdf = write_pdf(write_report(Report("road-test", error_budget={"stand": places}), tmp_path / "report.html"))
    assert pdf is not None
    assert pdf.read_bytes().startswith(b"%PDF-")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf.read_bytes())) > 3  # 300 rows need that many, a closed section one


def test_without_a_converter_there_is_no_pdf(tmp_path, monkeypatch):
    monkeypatch.setattr("viz.pages.html.find_spec", lambda name: None)
    monkeypatch.setattr(shutil, "which", lambda name, **_: None)
    assert write_pdf(write_report(Report("road-test"), tmp_path / "report.html")) is None
    assert not (tmp_path / "report.pdf").exists()
