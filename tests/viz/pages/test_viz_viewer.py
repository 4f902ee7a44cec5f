"""The page in the browser: it draws it without complaint, and mouse, fingers and keys do what the page says."""

import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_motor import RADII, motor
from viewer_pages import BROWSER, NODES, PLACE, TOP, document, mapped, recorded, still, tab, warming, write_viewer

from extras.portraits.looks import packed_looks
from geom import build_mesh, load_machine
from viz import split
from viz.rendering.flux import nodal_flux
from viz.viewer.page import ERROR, Earlier, machine_document, render, temperature_document
from viz.viewer.part_shapes import ERROR_K

pytestmark = pytest.mark.nightly
LARGEST = 1e6  # bytes of a page
CASE_MESH_M = 0.06  # size of the elements of a case, see lumped.build.pipeline.build


def paced(nodes, times: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Ten patterns in every part, each at a pace of its own: parts of a condensed network have no more."""
    x, y, z = (nodes.points / np.abs(nodes.points).max(axis=0)).T
    patterns = np.stack([np.ones_like(x), x, y, z, x * y, y * z, x * z, x * x, y * y, z * z])
    fields = np.zeros((len(times), nodes.size))
    for part in range(len(nodes.parts)):
        K, tau = rng.normal(0.0, 5.0, len(patterns)), rng.uniform(300.0, 3000.0, len(patterns))
        own = nodes.owner == part
        fields[:, own] = (K * (1 - np.exp(-times[:, None] / tau))) @ patterns[:, own]
    return fields


@pytest.fixture(scope="module")
def meshed():
    """A machine and the nodes of a mesh as fine as that of its case."""
    machine = load_machine("series-dc-100kw")
    return machine, split(build_mesh(machine, CASE_MESH_M))


@pytest.fixture(scope="module")
def shipped(meshed):
    """Its page, with five tests of an hour and three models each."""
    (machine, nodes), rng = meshed, np.random.default_rng(2)
    times = np.linspace(0.0, 3600.0, 61)
    readings = recorded().comparison.model
    tests = []
    for _ in range(5):
        now, before, first = (paced(nodes, times, rng) for _ in range(3))
        tests.append(replace(recorded(), times=times, fields=now, before=before, earlier=(Earlier(first, readings),)))
    return render(document("motor", nodes, tests, PLACE, revisions=["2", "1", "0"], machine=machine))


def test_the_page_of_a_shipped_machine_is_small(shipped):
    assert len(shipped.encode()) < LARGEST


def test_the_script_leaves_time_for_sixty_pictures_a_second(browser, shipped, tmp_path):
    """Turned and at another instant: the script alone, in the quietest of twenty pictures; GL works beside it."""
    (tmp_path / "v.html").write_text(shipped, encoding="utf-8")
    with tab(browser, tmp_path / "v.html", 1280, 800) as (page, said):
        spent = page.evaluate(SPENT)
    assert said == []
    assert 0.0 < spent["turn"] < SIXTIETH_MS
    assert 0.0 < spent["move"] < SIXTIETH_MS


@pytest.mark.parametrize("moved", [False, True])
def test_what_follows_the_first_picture_leaves_what_was_chosen(browser, meshed, tmp_path, moved):
    """First one test on the mesh; then every test and the machine as it looks. A test may be wanted before it is there,
    and a machine that was turned or cut meanwhile stays so."""
    (machine, nodes), times = meshed, np.linspace(0.0, 3600.0, 61)
    one = replace(recorded(before=False), times=times, fields=paced(nodes, times, np.random.default_rng(3)))
    two = replace(one, comparison=replace(one.comparison, test=replace(one.comparison.test, name="later")))
    early = temperature_document(nodes, [one], PLACE, None, ["now"], None)
    (tmp_path / "v.html").write_text(render(machine_document("m", nodes, None, None) | early), encoding="utf-8")
    every = temperature_document(nodes, [one, two], PLACE, None, ["now"], (-100.0, 200.0))
    with tab(browser, tmp_path / "v.html") as (page, said):
        assert page.evaluate("[viewer.test.test, $('axis').value, $('test').options.length]") == ["hour", "0", 1]
        page.evaluate("viewer.want('later'); viewer.judged({ later: { T_shaft: 0.5 } });")
        if moved:
            page.select_option("#axis", "2")
            page.keyboard.press("ArrowLeft")
        page.evaluate("(rest) => viewer.more(rest)", {"looks": packed_looks(machine, nodes), **every})
        page.wait_for_function("!viewer.dirty && viewer.smooth")
        assert page.evaluate("[viewer.test.test, $('axis').value, $('test').value]") == [
            "later",
            "2" if moved else "3",
            "1",
        ]
        assert page.evaluate("viewer.turn < TURN") == moved
        assert page.evaluate("viewer.test.sensors.find((s) => s.channel === 'T_shaft').limit") == 0.5
        assert page.evaluate("[viewer.range[0], viewer.range[1]]") == [every["marks"][0], every["marks"][-1]]
        assert page.evaluate("$('axis').options[0].disabled") is False
    assert said == []


SIXTIETH_MS = 1000.0 / 60.0
SPENT = """async () => {
  const v = viewer, quietest = async (act) => {
    let best = Infinity;
    for (let i = 0; i < 20; i++) {
      await new Promise(requestAnimationFrame);
      const begun = performance.now();
      act(i); v.draw(1);
      best = Math.min(best, performance.now() - begun);
    }
    return best;
  };
  v.tick = () => {};
  return { turn: await quietest(() => { v.turn += 0.05; }), move: await quietest((i) => v.move(i / 20)) };
}"""


def test_windows_need_a_few_triangles_and_show_what_all_would(browser, shipped, tmp_path):
    """The shipped motor uncut: pixel for pixel, from less than half of the triangles."""
    (tmp_path / "v.html").write_text(shipped, encoding="utf-8")
    with tab(browser, tmp_path / "v.html") as (page, _):
        page.select_option("#axis", "-1")
        page.wait_for_function("!viewer.dirty && viewer.smooth")
        page.evaluate(f"() => {{ window.few = ({DRAWN})(true); }}")
        assert 0 < page.evaluate(f"{CORNERS}(viewer.behind)") < 0.5 * page.evaluate(f"{CORNERS}(viewer.whole)")
        page.evaluate("() => { viewer.through = () => viewer.whole; }")
        assert page.evaluate(f"() => {{ const [a, b] = [few, ({DRAWN})(true)]; {CHANGED} }}") == []


CORNERS = "((mesh) => mesh.spans.flat().reduce((n, [, count]) => n + count, 0))"


def test_a_browser_draws_it_without_complaint(browser, tmp_path):
    """A part and its true temperature under the pointer, other colours at another time, nothing on the console."""
    file, one = tmp_path / "viewer.html", recorded()
    write_viewer(file, "motor", NODES, [one], PLACE)
    with tab(browser, file) as (page, said):
        found = page.evaluate("viewer.pick($('gl').clientWidth * 0.45, $('gl').clientHeight * 0.5)")
        assert found["name"] in NODES.parts
        mine = one.fields[-1][NODES.of(found["name"])]
        assert mine.min() - 0.2 < found["value"] < mine.max() + 0.2
        late = page.locator("#stage").screenshot()
        page.evaluate("viewer.move(0)")
        page.wait_for_function("!viewer.dirty")
        assert page.locator("#stage").screenshot() != late
        assert "at 0 min" in page.inner_text("#title")
        page.keyboard.press(" ")
        page.wait_for_function("viewer.time > 0")
        page.keyboard.press(" ")
        page.select_option("#layer", "1")
        page.wait_for_function("!viewer.dirty && viewer.smooth")
        assert page.inner_text("#unit") == "K"
        for sensor in page.evaluate("viewer.sensors.map((s) => [s.name, ...viewer.pixel(s)])"):
            page.mouse.move(*sensor[1:])
            assert sensor[0] in page.inner_text("#hover")
    assert said == []


def test_fingers_turn_it_bring_it_nearer_and_choose_a_sensor(browser, tmp_path):
    """Touches as the browser's own protocol sends them: one finger drags, two spread, one taps a dot."""
    write_viewer(tmp_path / "v.html", "motor", NODES, [recorded()], PLACE)
    with tab(browser, tmp_path / "v.html") as (page, said):
        screen = page.context.new_cdp_session(page)
        screen.send("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})

        def touched(*steps):
            """Fingers down at the first step's points, along the others, and up."""
            for kind, points in zip(("touchStart", *["touchMove"] * (len(steps) - 1)), steps, strict=True):
                fingers = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)]
                screen.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": fingers})
            screen.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

        before = page.evaluate(POSE)
        touched([(200, 300)], [(230, 300)], [(280, 340)])
        dragged = page.evaluate(POSE)
        assert dragged["turn"] == pytest.approx(before["turn"] - 0.008 * 80)
        assert dragged["tilt"] == pytest.approx(before["tilt"] + 0.008 * 40)
        assert dragged["zoom"] == before["zoom"]
        touched([(200, 300), (300, 300)], [(150, 300), (350, 300)])
        spread = page.evaluate(POSE)
        assert spread["zoom"] == pytest.approx(2 * before["zoom"])
        assert spread["turn"] == dragged["turn"]
        page.evaluate("() => { viewer.first(); viewer.draw(1); }")
        for channel, x, y in page.evaluate(DOTS):
            touched([(x, y)])
            assert page.evaluate("viewer.chosen") == channel
    assert said == []


def test_keys_alone_turn_step_play_and_choose(browser, tmp_path):
    """Tab reaches the machine and every control; each key does what the page says of it."""
    write_viewer(tmp_path / "v.html", "motor", NODES, [recorded()], PLACE)
    with tab(browser, tmp_path / "v.html") as (page, said):
        page.keyboard.press("Tab")
        assert page.evaluate("document.activeElement.id") == "gl"
        first = page.evaluate(POSE)
        for key, what, sign in KEYS:
            before = page.evaluate(POSE)[what]
            page.keyboard.press(key)
            assert np.sign(page.evaluate(POSE)[what] - before) == sign, key
        page.keyboard.press("0")
        back = page.evaluate(POSE)
        assert [back[k] for k in ("turn", "tilt", "zoom")] == pytest.approx(
            [first[k] for k in ("turn", "tilt", "zoom")]
        )
        reached = set()
        for _ in range(40):
            page.keyboard.press("Tab")
            reached.add(page.evaluate("document.activeElement.id || document.activeElement.textContent"))
            if "shaft" in page.evaluate("document.activeElement.textContent"):
                break
        assert {"play", "time", "test", "layer", "axis", "cut"} <= reached
        page.keyboard.press("Enter")
        assert page.evaluate("viewer.chosen") == "T_shaft"
        assert "shaft" in page.evaluate("document.activeElement.textContent")  # the list is drawn anew, the place stays
    assert said == []


POSE = "({ turn: viewer.turn, tilt: viewer.tilt, zoom: viewer.zoom, time: viewer.time })"
DOTS = "viewer.sensors.map((s) => [s.channel, ...viewer.pixel(s).map((v) => v * $('gl').clientWidth / $('gl').width)])"
KEYS = (("ArrowLeft", "turn", -1), ("ArrowRight", "turn", 1), ("ArrowUp", "tilt", 1), ("ArrowDown", "tilt", -1))
KEYS += (("+", "zoom", 1), ("-", "zoom", -1), (",", "time", -1), (".", "time", 1))


def test_parts_are_ghosted_and_hidden_and_the_cut_is_the_true_section(browser, tmp_path):
    """What lay on top is no longer under the pointer; the cut shaft has the area of its polygon, in the plane."""
    write_viewer(tmp_path / "v.html", "motor", NODES, [recorded()], PLACE)
    with tab(browser, tmp_path / "v.html") as (page, said):
        page.click("text=Parts: shown, ghost, hidden")
        page.select_option("#axis", "-1")
        top, pictures = page.evaluate(TOP)["name"], {}
        for state in ("shown", "ghost", "hidden"):
            button = page.locator("#parts button", has_text=top)
            assert button.inner_text().endswith(state)
            page.wait_for_function("!viewer.dirty && viewer.smooth")
            assert (page.evaluate(TOP)["name"] == top) == (state == "shown")
            pictures[state] = page.locator("#stage").screenshot()
            button.click()
        page.wait_for_function("!viewer.dirty && viewer.smooth")
        assert page.locator("#stage").screenshot() == pictures["shown"]
        assert len(set(pictures.values())) == 3
        assert np.ptp(section(page, "2", 0.4), axis=(0, 1))[2] == pytest.approx(0.0, abs=1e-6)
        area = np.linalg.norm(np.cross(*np.moveaxis(np.diff(section(page, "2", 0.4, "shaft"), axis=1), 1, 0)), axis=1)
        assert area.sum() / 2 == pytest.approx(24 / 2 * RADII[1] ** 2 * np.sin(2 * np.pi / 24), rel=1e-3)
    assert said == []


def test_what_hides_a_labelled_sensor_is_ghosted_around_it(browser, tmp_path):
    """The shaft's lies inside: without its window other pixels, and only those around labelled sensors."""
    write_viewer(tmp_path / "v.html", "motor", NODES, [recorded()], PLACE)
    with tab(browser, tmp_path / "v.html") as (page, _):
        page.select_option("#axis", "-1")
        still(page)
        changed = np.array(page.evaluate(f"() => {{ const [a, b] = [true, false].map({DRAWN}); {CHANGED} }}"))
        wide, near = page.evaluate("[viewer.gl.drawingBufferWidth, WINDOW]")
        places = page.evaluate("viewer.sensors.map((s) => [viewer.pixel(s)[0], $('gl').height - viewer.pixel(s)[1]])")
    at = np.stack([changed % wide, changed // wide], axis=1)
    away = np.linalg.norm(at[:, None] - np.array(places), axis=2)
    assert (away.min(axis=1) < near + 1).all()
    assert (away[:, list(PLACE).index("T_shaft")] < near).sum() > near**2


# Which pixels differ: compared in the page, as half a million numbers take seconds to come here.
CHANGED = """if (a.length !== b.length) throw new Error("pictures of different sizes");
  return a.map((pixel, i) => (pixel === b[i] ? -1 : i)).filter((i) => i >= 0);"""
DRAWN = """(windows) => {  // one number per pixel, from the lower left
  const v = viewer, gl = v.gl;
  if (!windows) v.labelled = () => [];
  v.draw(SAMPLES);
  const size = gl.drawingBufferWidth * gl.drawingBufferHeight, out = new Uint8Array(4 * size);
  gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, out);
  return Array.from({ length: size }, (_, i) => out[4 * i] + 256 * out[4 * i + 1] + 65536 * out[4 * i + 2]);
}"""


def test_a_browser_without_gl_says_so_in_one_message(browser, tmp_path):
    write_viewer(tmp_path / "v.html", "motor", NODES, [recorded()], PLACE)
    without = browser.browser_type.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-3d-apis"])
    page, faults = without.new_page(), []
    page.on("pageerror", lambda fault: faults.append(str(fault)))
    page.goto((tmp_path / "v.html").as_uri())
    page.wait_for_selector("#fault:visible")
    assert "no WebGL 2" in page.inner_text("#fault")
    assert page.inner_text("#title") == "motor"
    without.close()
    assert faults == []


def section(page, axis: str, share: float, part: str | None = None) -> np.ndarray:
    """(n, 3, 3) m: corners of the triangles in the page's cut across an axis, of one part or all."""
    page.select_option("#axis", axis)
    page.evaluate("(v) => { $('cut').value = 1000 * v; $('cut').oninput(); }", share)
    rows = np.array(page.evaluate(SECTION)).reshape(-1, 9)[:, :3]
    first, count = (0, len(rows)) if part is None else page.evaluate("viewer.section.spans")[NODES.parts.index(part)]
    return rows[first : first + count].reshape(-1, 3, 3)


SECTION = """(() => {
  const v = viewer, out = new Float32Array(9 * v.section.spans.reduce((n, [, count]) => n + count, 0));
  v.gl.bindBuffer(v.gl.ARRAY_BUFFER, v.section.buffer); v.gl.getBufferSubData(v.gl.ARRAY_BUFFER, 0, out);
  return Array.from(out);
})()"""


def test_the_browser_mixes_the_same_heat_flux(browser, tmp_path):
    """Node by node within what rounding of the shapes leaves: 0.1 K over the shortest edge."""
    one, k = recorded(before=False), {part: (2.0 + i, 30.0 + i) for i, part in enumerate(NODES.parts)}
    file = tmp_path / "viewer.html"
    file.write_text(render(document("motor", NODES, [one], PLACE, k)), encoding="utf-8")
    expected = nodal_flux(NODES, one.fields[-1], k)
    with tab(browser, file) as (page, _):
        page.select_option("#layer", "2")
        assert page.inner_text("#unit") == "kW/m²"
        found = np.array(page.evaluate("Array.from(viewer.values)"))[: 2 * NODES.size : 2]
        assert page.evaluate("viewer.range[1]") >= np.quantile(expected, 0.95)
    assert np.abs(found - expected).max() < 0.02 * expected.max()


INSIDE = """() => [...document.querySelectorAll("button, input, select")].filter((e) => {
  const box = e.getBoundingClientRect();
  return box.width && (box.left < 0 || box.right > innerWidth);
}).map((e) => e.id)"""
OVERLAPS = """() => {
  const boxes = [...document.querySelectorAll("#network text, #network circle")]
    .filter((e) => e.getAttribute("visibility") !== "hidden").map((e) => e.getBoundingClientRect());
  return boxes.filter((a, i) => boxes.some((b, j) => i < j && a.left < b.right && b.left < a.right && a.top < b.bottom
    && b.top < a.bottom)).length;
}"""


def test_errors_and_network_stand_in_the_page_at_every_width(browser, tmp_path):
    """Painted and hatched as the map says, the network beside or below, no control out of sight, a silent console."""
    one = mapped()
    page_text = render(document("motor", NODES, [one], PLACE, mesh=motor(24)))
    (tmp_path / "v.html").write_text(page_text, encoding="utf-8")
    residual = {c.name: one.comparison.residual(c) for c in one.comparison.channels}
    expected = one.error_map.at(residual)[:, -1]
    with tab(browser, tmp_path / "v.html", 1280, 700) as (page, said):
        assert page.is_visible("#network")
        page.select_option("#layer", "3")  # waits until it is there: the first picture does without
        page.wait_for_function("!viewer.dirty")
        assert said == []
        found = np.array(page.evaluate("Array.from(viewer.values)"))[: 2 * NODES.size : 2]
        assert np.abs(found - expected).max() < 2 * ERROR * max(abs(r[-1]) for r in residual.values())
        assert "measured − model" in page.get_attribute("#gl", "aria-label")
        assert page.is_visible("#guess")
        guessed = {share: page.evaluate(GUESS, share) for share in (0.05, 0.95)}
        assert guessed == {0.05: False, 0.95: True}
        assert "120 W" in page.evaluate("document.querySelector('#network line title').textContent")
        for width in (1280, 800, 400):
            page.set_viewport_size({"width": width, "height": 700})
            page.set_checked("#networked", True)
            still(page)
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            assert page.evaluate(INSIDE) == []
            assert page.evaluate(OVERLAPS) == 0
    assert said == []


GUESS = """(share) => {  // the pointer on the section, that share of the machine's length along its axis
  const v = viewer, z = v.low[2] + share * (v.high[2] - v.low[2]);
  for (let y = 0.95; y > 0; y -= 0.01) {
    const p = v.pixel({ xyz: [v.middle[0], y * v.high[1], z] }), scale = $("gl").width / $("gl").clientWidth;
    const hit = v.pick(p[0] / scale, p[1] / scale);
    if (hit) return hit.guess;
  }
}"""


COLUMN = """(share) => {  // of the picture's height that is drawn over at that share of its width
  const c = $("over"), x = Math.round(share * c.width) - 1;
  const copy = new OffscreenCanvas(2, c.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(c, -x, 0);
  const rows = copy.getImageData(0, 0, 2, c.height).data;
  let drawn = 0;
  for (let i = 3; i < rows.length; i += 8) drawn += rows[i] > 60 || rows[i + 4] > 60;
  return drawn / c.height;
}"""


def test_a_line_stands_between_two_revisions_and_three_labels_on_a_small_page(browser, tmp_path):
    text = render(document("motor", NODES, [recorded()], PLACE, revisions=["2: a", "1: b"]))
    (tmp_path / "v.html").write_text(text, encoding="utf-8")
    with tab(browser, tmp_path / "v.html", 900, 600) as (page, said):
        column = []
        for place in (0, 300, 700):
            page.evaluate("(place) => { $('wipe').value = place; $('wipe').oninput(); }", place)
            page.wait_for_function("!viewer.dirty && viewer.smooth")
            column.append([page.evaluate(COLUMN, share) for share in (0.3, 0.7)])
        assert all(share < 0.5 for share in column[0])
        assert column[1][0] > 0.85 > 0.5 > column[1][1]
        assert column[2][1] > 0.85 > 0.5 > column[2][0]
        page.evaluate("viewer.sensors = Array(9).fill(viewer.sensors[0])")
        assert page.evaluate("viewer.labelled().length") == 6
        page.set_viewport_size({"width": 400, "height": 600})
        still(page)
        assert page.evaluate("viewer.labelled().length") == 3
    assert said == []


LABELS = """(tilt) => {  // boxes of the labels as they are drawn, in pixels of the page
  const c = $("over").getContext("2d"), boxes = [], scale = $("over").width / $("over").clientWidth;
  const fill = CanvasRenderingContext2D.prototype.fillRect;
  c.fillRect = function (...box) { boxes.push(box.map((v) => v / scale)); fill.apply(this, box); };
  viewer.tilt = tilt; viewer.zoom = 1.5; viewer.draw(4);
  delete c.fillRect;
  return boxes;
}"""


def test_labels_stand_inside_the_picture_and_clear_of_the_title(browser, tmp_path):
    """In a low picture, turned so that sensors come near its upper edge."""
    write_viewer(tmp_path / "v.html", "a motor with a name " * 3, NODES, [recorded()], PLACE)
    with tab(browser, tmp_path / "v.html", 1000, 300) as (page, said):
        title = page.evaluate("[$('title').offsetWidth, $('title').offsetHeight]")
        boxes = [box for tilt in np.linspace(-1.4, 1.4, 15) for box in page.evaluate(LABELS, float(tilt))]
        high = page.evaluate("$('gl').clientHeight")
    assert len(boxes) > 15
    assert [box for box in boxes if box[1] < 0 or box[1] + box[3] > high] == []
    assert [box for box in boxes if box[0] < title[0] and box[1] < title[1]] == []
    assert said == []


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
@pytest.mark.parametrize(("left", "right"), [(1, 0), (2, 1), (0, 2)])
def test_any_two_revisions_stand_left_and_right_of_the_line(tmp_path, left, right):
    """The page's own script, run by node: what it would draw on each side, and the residuals of the right one."""
    one = recorded()
    read = {n: y + 2.0 for n, y in one.comparison.model.items()}
    one = replace(
        one, comparison=replace(one.comparison, before=one.comparison.model), earlier=(Earlier(warming(40.0), read),)
    )
    page = tmp_path / "page.html"
    page.write_text(render(document("motor", NODES, [one], PLACE, revisions=["2: a", "1: b", "0: as it was"])))
    script = Path(__file__).with_name("viewer_in_node.js")
    done = subprocess.run(["node", script, page, str(left), str(right)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    drawn = json.loads(done.stdout)
    values = np.array(drawn["values"]).reshape(-1, 2)
    for side, state in ((0, right), (1, left)):
        assert np.abs(values[:, side] - one.states[state][-1]).max() < 2 * ERROR_K
    assert drawn["residuals"] == pytest.approx([3.0 if right == 2 else 5.0] * len(PLACE), abs=0.02)
