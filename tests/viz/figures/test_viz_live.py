"""Live figures carry the numbers they were given, on light and dark paper."""

import json
import shutil
import sys

import numpy as np
import pytest
from fictional import comparison
from PIL import Image

import viz.live
from extras.rating.designs import objective_space, parallel_coordinates
from geom.errors import InputError, MissingDependency
from viz.colours import DARK
from viz.live import against_input, confusion, parity, residuals, save, sensor
from viz.pages.html import BROWSERS

AIMED = ("peak_degC", "settling_s", "copper_W", "auxiliary_W")
DESIGNS = [
    {"design": f"design-{k}", "flow": 4.0 + k, **dict(zip(AIMED, (130.0 - k, 900.0, 80.0 - k, float(k**3))))}
    for k in range(3)
]
DRAW = {
    "sensor": lambda **o: sensor(comparison(before=True), "flange.right", **o),
    "residuals": lambda **o: residuals(comparison(), **o),
    "against_input": lambda **o: against_input(comparison(), "flange.right", "current_A", **o),
    "parity": lambda **o: parity(comparison(), **o),
    "confusion": lambda **o: confusion(["a@x", "b@y"], np.array([[1.0, -0.83], [-0.83, 1.0]]), **o),
    "parallel_coordinates": lambda **o: parallel_coordinates(DESIGNS, AIMED, {"flow": "flow (l/min)"}, **o),
    "objective_space": lambda **o: objective_space(DESIGNS, AIMED, **o),
}


def data(figure):
    return json.loads(json.dumps(figure.to_plotly_json()))["data"]


def named(figure, name):
    return next(trace for trace in data(figure) if trace.get("name") == name)


@pytest.mark.parametrize("name", DRAW)
def test_figure_is_plain_json_on_light_and_dark_paper(name):
    assert data(DRAW[name]())
    assert DRAW[name](theme=DARK).layout.paper_bgcolor == DARK.paper


def test_every_public_figure_is_tested_here_or_beside():
    beside = {"parallel_coordinates", "objective_space"}  # of extras.rating
    assert set(viz.live.__all__) | beside == {*DRAW, "save"}


def test_designs_are_lines_and_points():
    lines, points = data(DRAW["parallel_coordinates"]())[0], data(DRAW["objective_space"]())[0]
    assert [axis["label"] for axis in lines["dimensions"]][-2:] == ["pump and fan (W)", "flow (l/min)"]
    assert lines["dimensions"][-1]["values"] == [4.0, 5.0, 6.0]
    assert [points[a] for a in "xyz"] == [[130.0, 129.0, 128.0], [15.0] * 3, [0.0, 1.0, 8.0]]
    assert points["marker"]["color"] == [80.0, 79.0, 78.0]  # the objective that no axis shows


def test_sensor_shows_readings_model_and_their_difference():
    c = comparison(before=True)
    channel = next(x for x in c.channels if x.name == "flange.right")
    drawn = DRAW["sensor"]()
    np.testing.assert_allclose(named(drawn, "model")["y"], c.model["flange.right"][c.thin])
    np.testing.assert_allclose(named(drawn, "residual")["y"], c.residual(channel)[c.thin])
    np.testing.assert_allclose(named(drawn, "earlier model")["y"], c.before["flange.right"][c.thin])


def test_confusion_shows_sizes():
    np.testing.assert_allclose(data(DRAW["confusion"]())[0]["z"], [[1.0, 0.83], [0.83, 1.0]])


def test_parity_puts_a_right_model_on_the_line():
    trace = named(parity(comparison(wrong_K=0.0)), "yoke")
    assert np.abs(np.subtract(trace["x"], trace["y"])).max() < 1.5  # readings scatter by 0.3 K


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (lambda: sensor(comparison(), "nowhere"), "known: flange.left"),
        (lambda: against_input(comparison(), "yoke", "wind"), "known: current_A, ambient"),
    ],
)
def test_wrong_names_list_the_right_ones(draw, words):
    with pytest.raises(InputError, match=words):
        draw()


def test_html_needs_nothing_else(tmp_path):
    text = save(DRAW["parity"](), tmp_path / "p.html").read_text()
    assert "<script src=" not in text
    assert "measured" in text


def test_other_endings_are_refused(tmp_path):
    with pytest.raises(InputError, match="ends in"):
        save(DRAW["parity"](), tmp_path / "p.txt")


BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)


@pytest.mark.heavy
@pytest.mark.skipif(BROWSER is None, reason="needs a browser: apt-get install -y chromium")
def test_static_pictures_through_a_browser(tmp_path, monkeypatch):
    """The sheet is twice the figure's 700 x 500, and shows the points; the SVG carries the axes' words."""
    pytest.importorskip("kaleido", reason="needs kaleido: uv pip install kaleido")
    monkeypatch.setenv("BROWSER_PATH", BROWSER)
    picture = Image.open(save(DRAW["parity"](), tmp_path / "p.png")).convert("L")
    assert picture.size == (1400, 1000)
    assert np.asarray(picture).std() > 8
    drawing = save(DRAW["parity"](), tmp_path / "p.svg").read_text()
    assert drawing.startswith("<svg")
    assert "measured (°C)" in drawing


@pytest.mark.parametrize("lacking", ["browser", "kaleido"])
def test_without_a_browser_or_kaleido_the_error_says_what_to_install(lacking, tmp_path, monkeypatch):
    if lacking == "kaleido":
        monkeypatch.setitem(sys.modules, "kaleido", None)
    monkeypatch.setenv("BROWSER_PATH", str(tmp_path / "none"))
    with pytest.raises(MissingDependency, match="apt-get install -y chromium"):
        save(DRAW["parity"](), tmp_path / "p.png")
    assert not (tmp_path / "p.png").exists()
