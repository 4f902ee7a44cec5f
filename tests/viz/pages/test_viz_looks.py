"""The machine as the viewer draws it: few triangles, as large as the shapes of pictures, cut where they are."""

from dataclasses import replace

import numpy as np
import pytest
from small_motor import machine, motor
from viewer_pages import PLACE, TOP, document, recorded, tab, unpacked

from extras.portraits.dressed import dressed
from extras.portraits.looks import LOST, SHARES, STEP_M, coarse, packed_looks
from extras.portraits.portrait import framed
from geom import build_mesh, load_machine
from viz import split
from viz.rendering.cut import HALF
from viz.viewer.page import render

LARGE = ("series-dc-100kw", "tefc-industrial", "ipmsm-48s8p-jacket")
MACHINES = ("pmsm-m1", *(pytest.param(name, marks=pytest.mark.nightly) for name in LARGE))
COARSE_M = 0.15  # of the mesh: its nodes only say which part a corner is warm as
FAR = 0.01  # of the machine's size that a corner may leave the shape by: three pixels of three hundred


@pytest.fixture(scope="module", params=MACHINES)
def shown(request):
    one = load_machine(request.param)
    nodes = split(build_mesh(one, COARSE_M))
    return one, nodes, packed_looks(one, nodes), dressed(one)


def test_corners_are_warm_as_the_part_they_show(shown):
    """Both nodes of a corner are of its part; the nearer one tells more."""
    _, nodes, looks, _ = shown
    mix, triangles = unpacked(looks["mix"]), unpacked(looks["triangles"])
    part = np.repeat(np.arange(len(nodes.parts)), np.sum(looks["counts"], axis=1))
    assert len(part) == len(triangles)
    for k in range(3):
        assert (nodes.owner[mix[triangles[:, k], :2]] == part[:, None]).all()
    assert mix[:, 2].min() >= 0
    assert mix[:, 2].max() <= SHARES / 2


def test_nothing_is_drawn_in_the_quarter_that_is_cut_away(shown):
    """x < 0 < y, but for what is never cut: bolts and the like are left out there as a whole."""
    points = unpacked(shown[2]["points"])
    inside = (points[:, 0] < -STEP_M) & (points[:, 1] > STEP_M)
    whole = [b.shape.points for b in shown[3] if b.whole]
    reach = max((np.ptp(p[:, :2], axis=0).max() for p in whole), default=0.0)
    away = np.minimum(-points[inside, 0], points[inside, 1])
    assert away.size == 0 or away.max() <= reach


def test_the_frame_is_that_of_pictures(shown):
    one, _, looks, bodies = shown
    points = framed(one, bodies)
    assert looks["frame"] == [points.min(axis=0).tolist(), points.max(axis=0).tolist()]


def test_few_triangles_keep_shapes(shown):
    """A quarter of the triangles; corners stay within a hundredth of the machine, volumes within four."""
    bodies = shown[3]
    size = np.linalg.norm(np.ptp(np.concatenate([b.shape.points for b in bodies]), axis=0))
    few = [coarse(b) for b in bodies]
    assert sum(len(b.shape.triangles) for b in few) < 0.25 * sum(len(b.shape.triangles) for b in bodies)
    for body, less in zip(bodies, few, strict=True):
        assert np.abs(less.shape.points.min(axis=0) - body.shape.points.min(axis=0)).max() < FAR * size
        assert np.abs(less.shape.points.max(axis=0) - body.shape.points.max(axis=0)).max() < FAR * size
        assert less.shape.volume == pytest.approx(body.shape.volume, rel=LOST)


@pytest.mark.nightly
def test_the_page_opens_with_it_and_cuts_show_the_mesh(browser, tmp_path):
    """A part and its true temperature under the pointer either way; the machine fills the picture; a silent console."""
    nodes, one = split(motor(24)), recorded()
    (tmp_path / "v.html").write_text(render(document("motor", nodes, [one], PLACE, machine=machine())))
    with tab(browser, tmp_path / "v.html") as (page, said):
        assert page.input_value("#axis") == "3"
        seen = {}
        for axis in ("3", "0"):
            page.select_option("#axis", axis)
            page.wait_for_function("!viewer.dirty && viewer.smooth")
            found = page.evaluate(TOP)
            mine = one.fields[-1][nodes.of(found["name"])]
            assert mine.min() - 0.2 < found["value"] < mine.max() + 0.2
            seen[axis] = page.locator("#stage").screenshot()
        assert seen["3"] != seen["0"]
        wide, high = page.evaluate(EXTENT)
        assert 0.9 < max(wide / page.evaluate("FILL[0]"), high / page.evaluate("FILL[1]")) < 1.02
    assert said == []


EXTENT = """() => {  // shares of the picture that the machine's corners reach over
  const v = viewer, at = [];
  v.first();
  v.matrix();
  for (let i = 0; i < 8; i++) {
    const p = v.pixel({ xyz: [0, 1, 2].map((k) => v.frame[i >> k & 1][k]) });
    at.push([p[0] / $("gl").width, p[1] / $("gl").height]);
  }
  return [0, 1].map((k) => Math.max(...at.map((a) => a[k])) - Math.min(...at.map((a) => a[k])));
}"""


def test_the_same_machine_is_shaped_once(tmp_path, monkeypatch):
    """Kept by all that decides: temperatures do not; another section, place, cut or way to draw does."""
    one, nodes, shaped = machine(), split(motor(24)), []
    monkeypatch.setattr("extras.portraits.looks.dressed", lambda of: shaped.append(of) or dressed(of))
    first, again = (packed_looks(one, nodes, cache=tmp_path) for _ in range(2))
    assert (again, len(shaped)) == (first, 1)
    assert first == packed_looks(one, nodes)
    shaped.clear()
    packed_looks(replace(one, sections={**one.sections, "ratings": {}}), nodes, cache=tmp_path)
    packed_looks(one, replace(nodes, points=nodes.points * (1 + 1e-9)), cache=tmp_path)
    packed_looks(one, nodes, HALF, cache=tmp_path)
    monkeypatch.setattr("extras.portraits.looks.drawing_code", lambda: b"another way to draw")
    packed_looks(one, nodes, cache=tmp_path)
    assert len(shaped) == 4
    for file in tmp_path.glob("looks-*.json"):
        file.write_text("{")
    assert packed_looks(one, nodes, cache=tmp_path) == first  # what is damaged is made again


def test_a_computer_that_cannot_draw_makes_the_page_all_the_same(monkeypatch):
    """Shapes are cut by VTK's filters, which need no OpenGL."""
    monkeypatch.setattr("viz.rendering.gl.off_screen_window", lambda: None)
    nodes = split(motor(24))
    assert document("motor", nodes, [recorded()], PLACE, machine=machine())["looks"]["counts"]


@pytest.mark.nightly
def test_windows_are_opened_to_what_is_hidden_and_to_nothing_else(browser, tmp_path):
    """As it looks: the open shaft is seen from above and the housing's lower side is not; from below the other way."""
    nodes, one = split(motor(24)), recorded()
    place = {"T_housing": (0.0, -0.22, 0.3), "T_shaft": (-0.02, 0.02, 0.3)}
    (tmp_path / "v.html").write_text(render(document("motor", nodes, [one], place, machine=machine())))
    with tab(browser, tmp_path / "v.html") as (page, said):
        seen = {tilt: page.evaluate(WINDOWS, tilt) for tilt in (1.4, -1.4)}
    assert seen == {1.4: ["T_housing"], -1.4: ["T_shaft"]}
    assert said == []


WINDOWS = """(tilt) => {  // channels with a window, seen from above or below
  viewer.tilt = tilt;
  viewer.draw(SAMPLES);
  return [...viewer.behindOf].sort();
}"""
