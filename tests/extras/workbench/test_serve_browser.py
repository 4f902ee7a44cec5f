"""The workbench in a real browser, end to end: open, click the failing sensor, diagnose, add, undo, reload.

Screenshots are kept in out/screenshots.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urljoin

import pytest
from foreign_machines import motor_cad, whole
from test_serve_live import RUN as FIRST

from geom.machine_file import load_machine
from thermoscope.case_folder.history import load_history

LOOKS = [
    FIRST[2] | {"time_s": t, "odds": [["nothing", p], ["copper.ac@winding", 0.9 - p]]}
    for t, p in ((65, 0.8), (125, 0.5))
]
RUN = [*FIRST[:2], *(e | {"over": ["T_yoke"]} for e in LOOKS), FIRST[3]]

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
playwright = pytest.importorskip("playwright.sync_api", reason="needs playwright: uv pip install playwright")
pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(BROWSER is None, reason="needs a browser: apt-get install -y chromium"),
]
TESTS = Path(__file__).parents[2]
SERVER = TESTS / "shared" / "motor_case.py"
LONG = 400_000  # ms; a shared computer may be slow


@contextmanager
def workbench(home):
    """(address, case folder) of a running workbench, its machine a stand-in."""
    environment = {**os.environ, "THERMOSCOPE_CACHE": str(home / "cache")}
    process = subprocess.Popen(
        [sys.executable, str(SERVER), str(home)], stdout=subprocess.PIPE, text=True, env=environment
    )
    try:
        yield process.stdout.readline().strip(), home / "three"
    finally:
        process.terminate()
        process.wait(timeout=60)


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    with workbench(tmp_path_factory.mktemp("serve")) as running:
        yield running


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as engine:
        yield engine.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])


@pytest.fixture
def page(browser, served):
    """A fresh tab on the workbench; an error in the page's own code fails the test."""
    tab, faults = opened(browser, served[0])
    yield tab
    tab.context.close()
    assert faults == []


def opened(browser, address, width=1280, height=800, scheme="light"):
    viewport = {"width": width, "height": height}
    tab, faults = browser.new_context(viewport=viewport, color_scheme=scheme).new_page(), []
    tab.context.set_default_timeout(LONG)
    # a call that is under way while the page is left (reload) ends in a bare object: no error of the page
    tab.on("pageerror", lambda fault: str(fault) == "Object" or faults.append(str(fault)))
    tab.on("console", lambda said: "Content Security Policy" in said.text and faults.append(said.text))
    tab.goto(address)
    tab.wait_for_selector("#sensors .sensor")
    tab.wait_for_selector("#viewer")
    return tab, faults


def kept(root, page, name):
    folder = root / "out" / "screenshots"
    folder.mkdir(parents=True, exist_ok=True)
    page.wait_for_timeout(1500)  # the bars take 1.2 s to fall
    page.screenshot(path=folder / f"{name}.png")


def eventually(page, read, right):
    """What `read` says once it is right, or at the end as it is: the server changes the page piece by piece."""
    for _ in range(300):
        if right(value := read()):
            break
        page.wait_for_timeout(100)
    return value


def error(page, test):
    """The error of a test as the page shows it (K): the last number of its row."""
    return float(re.findall(r"\d+\.\d+", page.inner_text(f"#error-{test} .value"))[-1])


def test_the_whole_loop(root, page, served):
    """The error on the test that is never used must fall below its own tenth, come back with undo, and survive."""
    start = error(page, "town")
    kept(root, page, "1-opened")
    page.click("#sensor-T_flange")
    page.wait_for_function("document.querySelector('#curve').innerText.includes('flange')")
    assert page.get_attribute("#sensor-T_flange", "aria-pressed") == "true"
    kept(root, page, "2-sensor")

    page.click("#diagnose")
    page.wait_for_selector("#progress")
    page.click("#sensor-T_yoke")
    page.wait_for_selector("#sensor-T_yoke.chosen")
    page.wait_for_selector("#job:visible, #verdict:visible")  # answered during a calculation of some seconds
    page.wait_for_selector("#verdict")
    assert "forced convection by vehicle wind at flange" in page.inner_text("#verdict")
    kept(root, page, "3-diagnosed")

    page.click("#report")
    with page.context.expect_page() as opening:
        page.click("#report-link")
    assert "thermoscope show report: three" in opening.value.inner_text("h1")
    assert (served[1] / "out" / "report.html").is_file()
    opening.value.close()

    page.click("[id='add-convection@flange']")
    page.wait_for_selector("#outcome.good, #outcome.warn")
    assert "Found: " in page.inner_text("#outcome")
    assert eventually(page, lambda: error(page, "town"), lambda e: e < 0.1 * start) < 0.1 * start
    kept(root, page, "4-added")
    assert load_history(served[1] / "model.toml").last.effects == ("convection@flange",)

    page.click("#undo")
    page.wait_for_function("document.querySelector('#revision').innerText === 'revision 2'")
    same = pytest.approx(start)
    assert eventually(page, lambda: error(page, "town"), lambda e: e == same) == same
    page.wait_for_selector("#verdict:has-text('vehicle wind at flange')")  # the diagnosis of this very model is back
    kept(root, page, "5-undone")

    page.reload()
    page.wait_for_selector("#sensors .sensor")
    page.wait_for_function("document.querySelector('#revision').innerText === 'revision 2'")
    assert eventually(page, lambda: error(page, "town"), lambda e: e == same) == same
    assert [r.action for r in load_history(served[1] / "model.toml").revisions] == ["add", "step back"]


def test_keys_alone_do_everything(page):
    """Tab reaches the sensors and Enter chooses; j goes to the next one."""
    reached = []
    for _ in range(60):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("document.activeElement.id"))
        if reached[-1] == "sensor-T_winding":
            break
    assert {"calibrate", "report"} <= set(reached)
    page.keyboard.press("Enter")
    page.wait_for_selector("#sensor-T_winding.chosen")
    page.keyboard.press("j")
    page.wait_for_selector("#sensor-T_yoke.chosen")


def test_tabs_do_not_disturb_each_other(browser, served, page):
    other, faults = opened(browser, served[0])
    assert other.url != page.url
    page.click("#sensor-T_winding")
    page.wait_for_selector("#sensor-T_winding.chosen")
    assert other.get_attribute("#sensor-T_winding", "aria-pressed") == "false"
    other.click("[aria-label='dark page']")
    other.wait_for_selector(".v-theme--dark")
    assert page.locator(".v-theme--dark").count() == 0
    other.context.close()
    assert faults == []


def test_a_dark_browser_has_a_dark_page_at_once(browser, served):
    tab, faults = opened(browser, served[0], scheme="dark")
    tab.wait_for_selector(".v-theme--dark")
    tab.click("[aria-label='light page']")
    tab.wait_for_selector(".v-theme--light")
    tab.context.close()
    assert faults == []


SILENT = """() => [...document.querySelectorAll("img, canvas, svg")].filter((e) =>
  e.getClientRects().length && e.getBoundingClientRect().right > 0 && !e.alt && !e.ariaLabel
  && !e.closest("[role=img][aria-label], [aria-hidden=true]")).map((e) => e.outerHTML.slice(0, 200))"""
REACHED = """() => [...document.querySelectorAll("button, input, select, a")].filter((e) => {
  const box = e.getBoundingClientRect();
  return box.width && (box.left < -1 || box.right > innerWidth + 1) && !e.closest(".scroll");
}).map((e) => e.id || e.className)"""


@pytest.mark.parametrize("width", [800, 400])
def test_narrow_pages_lose_no_control(root, page, width):
    """Nothing reaches beyond the right edge, and every picture that is drawn says what it shows."""
    page.set_viewport_size({"width": width, "height": 800})
    wide = "document.documentElement.scrollWidth"  # the page takes its new places step by step
    assert eventually(page, lambda: page.evaluate(wide), lambda reach: reach <= width) <= width
    kept(root, page, f"7-{width}")
    assert page.evaluate(wide) <= width
    assert eventually(page, lambda: page.evaluate(REACHED), lambda found: found == []) == []
    assert eventually(page, lambda: page.evaluate(SILENT), lambda found: found == []) == []
    page.wait_for_selector("#viewer[title*='town']")
    page.wait_for_selector("#curve[aria-label*='T_flange']")


@pytest.mark.parametrize("width", [1200, 400])
def test_a_run_on_the_bench_is_followed_and_told_that_it_is_done(root, page, served, width):
    """Odds, the next set point with its button, what is over and unseen; on a phone too. The last run that is shown."""
    journal = served[1] / "tests" / "live.jsonl"
    page.set_viewport_size({"width": width, "height": 800})
    try:
        journal.write_text("".join(json.dumps(e) + "\n" for e in RUN))
        page.wait_for_selector("#live-done")
        assert "current_A = 8" in page.inner_text("#live-set")
        assert "T_yoke" in page.inner_text("#live-over")
        assert "windage at rotor" in page.inner_text("#live-unseen")
        assert "about 12 min left" in page.inner_text("#live-left")
        page.wait_for_selector("#live .js-plotly-plot .scatterlayer .trace")
        page.locator("#live").scroll_into_view_if_needed()
        kept(root, page, f"8-live-{width}")
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        assert eventually(page, lambda: page.evaluate(REACHED), lambda found: found == []) == []
        assert eventually(page, lambda: page.evaluate(SILENT), lambda found: found == []) == []
        page.click("#live-done")
        page.wait_for_selector("#live-done", state="detached")
        assert journal.with_suffix(".done").exists()
        with journal.open("a") as file:
            file.write(json.dumps(RUN[-2] | {"time_s": 300.0, "stop": "nothing is missing"}) + "\n")
        page.wait_for_selector("#live-stop")
    finally:
        journal.unlink()
        journal.with_suffix(".done").unlink(missing_ok=True)


DROP = """(contents) => {
  const files = new DataTransfer();
  for (const [name, text] of contents) files.items.add(new File([text], name));
  const event = (kind) => new DragEvent(kind, { dataTransfer: files, bubbles: true, cancelable: true });
  const over = document.querySelector("#errors").dispatchEvent(event("dragover"));
  return !over && !document.querySelector("#errors").dispatchEvent(event("drop"));
}"""
RECORD = "\n".join(
    ["time_s,I [A],wind [km/h],ambient,T_winding,channel 7"]
    + [f"{10 * k},80,12,20.5,{20 + 0.2 * k:.1f},{20 + 0.1 * k:.1f}" for k in range(200)]
)


def drop(page, *files):
    """Files by name and text, over the page and let go, as a browser tells it; taken over by the page, and read."""
    with page.expect_response(lambda answer: answer.url.endswith("recordings")) as answering:
        assert page.evaluate(DROP, [*files]), "else the browser leaves the page for the file"
    assert answering.value.status == 204


def test_machines_of_other_programs_are_imported_where_they_are_dropped(page, served, tmp_path):
    """Beside a recording too; a drawing without the length of its stack says what it lacks."""
    home, sheet = served[1].parent, whole()
    drawing = sheet.saved(tmp_path).read_text()
    sheet.space.add_text("stack_mm = 120")
    sized = sheet.saved(tmp_path, "sized.dxf").read_text()
    drop(page, ["small.mot", motor_cad()], ["sized.dxf", sized], ["beside.csv", RECORD])
    page.wait_for_selector("#imported")
    page.wait_for_selector("#dropped")
    assert page.inner_text("#dropped").startswith("beside.csv")
    for name in ("small", "sized"):
        assert str(home / f"{name}.toml") in page.inner_text("#imported")
        assert load_machine(home / f"{name}.toml").name == name
    drop(page, ["small.mot", motor_cad()])
    page.wait_for_selector("#error:has-text('is there already')")
    drop(page, ["drawn.dxf", drawing])
    page.wait_for_selector("#error:has-text('how long the stack is')")
    assert page.inner_text("#error").startswith("drawn.dxf: "), "not the folder in which it lay"


@pytest.mark.parametrize("name", ["case.toml", "network.toml", "part.step", "photo.png"])
def test_what_is_no_recording_is_said_by_its_name(page, served, name):
    case_file = served[1] / name
    drop(page, [name, case_file.read_text() if case_file.is_file() else "\0\1" * 99])
    page.wait_for_selector("#error")
    assert page.inner_text("#error").startswith(f"{name}: ")
    assert "it is not a record" in page.inner_text("#error")
    assert page.locator("#sensors .sensor").count() == 3, "the page goes on"


def test_dropped_files_become_a_case(page, served):
    """A channel dragged to its part, written, and opened in place of the old case: the last test of that server."""
    drop(page, ["own.csv", RECORD])
    page.wait_for_selector("#dropped")
    assert "T_winding" in page.inner_text("#part-winding")
    page.drag_and_drop("[id='column-channel 7']", "#part-flange")
    page.wait_for_function("document.querySelector('#part-flange').innerText.includes('channel 7')")
    page.select_option("select[aria-label='where T_winding is']", "yoke")  # by keyboard too
    page.wait_for_function("document.querySelector('#part-yoke').innerText.includes('T_winding')")
    page.click("#make-case")
    page.wait_for_selector("#open-made, #error")
    assert not page.is_visible("#error"), page.inner_text("#error")
    assert (served[1].parent / "own" / "case.toml").is_file()
    page.click("#open-made")
    page.wait_for_selector("#error-own")
    page.wait_for_function("document.querySelector('h1').innerText === 'own'")


@contextmanager
def drawn(browser, home, width=960, height=700):
    """A tab and the frame in which its browser draws the machine, in software; what either complains about is faults.

    In a small window: without a graphics card, each pixel of each frame costs processor time.
    """
    drawing = browser.browser_type.launch(executable_path=BROWSER, args=GL)
    with workbench(home) as (address, case):
        tab, faults = opened(drawing, address, width, height)
        tab.on("console", lambda message: message.type == "error" and faults.append(message.text))
        yield tab, faults, case
        drawing.close()


def framed(tab):
    """The frame of the machine that the page asks for, once it has drawn."""
    source = urljoin(tab.url, tab.get_attribute("#viewer", "src"))
    for _ in range(LONG // 100):
        frame = next((f for f in tab.frames if f.url == source), None)  # before it has gone there, the last machine's
        if frame is not None:
            break
        tab.wait_for_timeout(100)
    else:
        pytest.fail(f"no frame of the page went to {source}")
    until(frame, "window.viewer && viewer.frames > 0 && !viewer.dirty")
    return frame


def until(frame, expression):
    """Wait for it; the frame's policy lets nothing be evaluated from inside of it, so it is asked again and again."""
    for _ in range(LONG // 100):
        if frame.evaluate(expression):
            return
        frame.page.wait_for_timeout(100)
    pytest.fail(f"never came: {expression}")


GL = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PLACES = (
    "viewer.sensors.map((s) => [s.channel, ...viewer.pixel(s).map((v) => v * $('gl').clientWidth / $('gl').width)])"
)


def test_the_machine_is_drawn_by_the_browser_and_goes_along_with_the_page(root, tmp_path, browser):
    """Under the page's policy; what is chosen on either side is chosen on the other; plays, and follows the theme."""
    with drawn(browser, tmp_path) as (tab, faults, _):
        frame = framed(tab)
        assert frame.is_hidden("#fault")
        assert frame.is_hidden("#test")  # the page's own list stands above
        until(frame, "Boolean(data.errors && viewer.network)")  # they follow, and leave the machine as it is
        until(frame, "viewer.smooth && !viewer.dirty && !viewer.pending")  # else places are of the frame's size before
        assert tab.evaluate("trame.state.get('viewer_rest')")
        for channel, x, y in frame.evaluate(PLACES):
            box = tab.locator("#viewer").bounding_box()
            tab.mouse.click(box["x"] + x, box["y"] + y)
            tab.wait_for_selector(f"#sensor-{channel}.chosen")
        tab.keyboard.press("k")  # the frame has the focus, and no use for it
        tab.wait_for_selector(f".sensor.chosen:not(#sensor-{channel})")
        tab.click("#sensor-T_yoke")
        until(frame, "viewer.chosen === 'T_yoke'")
        assert "T_yoke" in frame.evaluate("viewer.labelled().map((s) => s.channel)")
        assert frame.evaluate("viewer.test.test") == tab.evaluate("document.querySelector('#viewer').dataset.test")
        other = next(t["name"] for t in tab.evaluate("trame.state.get('tests')") if t["name"] != "town")
        tab.evaluate("(name) => trame.state.set('test', name)", other)
        until(frame, f"viewer.test.test === {other!r}")
        turn = frame.evaluate("viewer.turn")
        tab.evaluate("document.activeElement.blur()")
        tab.keyboard.press("ArrowLeft")  # outside of the frame
        until(frame, f"viewer.turn < {turn}")
        tab.click("[aria-label='dark page']")
        until(frame, "document.documentElement.dataset.theme === 'dark'")
        frame.evaluate("viewer.move(0)")
        frame.click("#play")
        until(frame, "viewer.time > 0")
        kept(root, tab, "6-played")
        assert faults == []


def test_another_model_gets_another_machine(tmp_path, browser):
    """The page of the frame changes with the revision, and says meanwhile that it is being prepared."""
    with drawn(browser, tmp_path) as (tab, faults, _):
        first = tab.get_attribute("#viewer", "src")
        until(framed(tab), "viewer.complete")
        assert framed(tab).evaluate("data.revisions") == ["now"]
        tab.click("#calibrate")
        tab.wait_for_selector("#outcome")
        if tab.is_visible("#anyway"):
            tab.click("#anyway")
        tab.wait_for_function("(src) => document.querySelector('#viewer').getAttribute('src') !== src", arg=first)
        until(framed(tab), "data.revisions.length === 2")  # the first picture is of the model as it is
        assert faults == []
