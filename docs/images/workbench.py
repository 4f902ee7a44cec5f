"""Walks through the workbench and keeps pictures for the pages: python docs/images/workbench.py CASE [FOLDER]

Calibrate (unless it is), click the failing sensor's dot; then by keyboard alone diagnose, add what is named, report and
undo; reload. Prints how long each step took. Serves a copy of the case, so that nothing of the case itself is changed.
Needs playwright and Chromium.
"""

import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PIL import Image
from PIL.PngImagePlugin import PngInfo
from playwright.sync_api import Frame, Page, sync_playwright

HERE = Path(__file__).resolve().parent
LONG = 3_600_000  # ms
OTHER = "T_flange_left_degC"  # chosen first; the model is right there
GL = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


class Walk:
    """A page of the workbench, the folder for its pictures, and a clock."""

    def __init__(self, page: Page, folder: Path) -> None:
        self.page, self.folder, self.begun = page, folder, time.perf_counter()

    def took(self, step: str) -> None:
        """Print the time since the last step."""
        now = time.perf_counter()
        print(f"{step:40s} {now - self.begun:7.2f} s", flush=True)
        self.begun = now

    def shot(self, name: str) -> None:
        """A picture of the page's top, after the bars have fallen; the clock starts again."""
        if name != "diagnosed":
            self.page.evaluate("window.scrollTo(0, 0)")
        self.page.mouse.move(1, 1)  # else what it points at covers the machine
        self.page.wait_for_timeout(2500)
        self.page.wait_for_selector("#preparing", state="detached")
        machine(self.page)
        png, info = self.folder / f"workbench-{name}.png", PngInfo()
        self.page.screenshot(path=png)
        info.add_itxt("errors", self.page.inner_text("#errors"))  # for a test that compares it with the text
        Image.open(png).convert("RGB").save(png, optimize=True, pnginfo=info)
        self.begun = time.perf_counter()

    def tab_to(self, button: str) -> None:
        """Press Tab until the button has the focus."""
        for _ in range(200):
            self.page.keyboard.press("Tab")
            if self.page.evaluate("q => document.activeElement.matches(q)", button):
                return
        raise SystemExit(f"Tab does not reach {button}")

    def step(self, key: str, what: str) -> None:
        """Press a key that changes the model, keep the result whatever it is, wait until it is shown."""
        before = self.page.inner_text("#revision")
        self.page.keyboard.press(key)
        self.page.wait_for_selector("#outcome")
        self.took(what)
        if self.page.is_visible("#anyway"):
            self.page.click("#anyway")
        self.page.wait_for_function("old => document.querySelector('#revision').innerText !== old", arg=before)


def machine(page: Page) -> Frame:
    """The frame in which the browser draws, once a smooth picture stands still."""
    frame = page.wait_for_selector("#viewer").content_frame()
    assert frame is not None
    while not frame.evaluate("window.viewer && viewer.smooth && !viewer.dirty"):
        page.wait_for_timeout(100)
    return frame


def clicked(walk: Walk, sensor: str) -> None:
    """Click a sensor's dot on the machine; time the click to its curves."""
    frame, box = machine(walk.page), walk.page.locator("#viewer").bounding_box()
    assert box is not None
    walk.page.click(f"#sensor-{OTHER}")
    x, y = frame.evaluate(PLACE, sensor)
    walk.begun = time.perf_counter()
    walk.page.mouse.click(box["x"] + x, box["y"] + y)
    words = sensor.removeprefix("T_").removesuffix("_degC").replace("_", " ")
    walk.page.wait_for_function("name => document.querySelector('#curve').innerText.includes(name)", arg=words)
    walk.took("click on its dot to its curves")


PLACE = """(channel) => viewer.pixel(viewer.sensors.find((s) => s.channel === channel))
  .map((v) => v * $("gl").clientWidth / $("gl").width)"""


def story(walk: Walk, address: str) -> None:
    """All of it, at 1280 x 800."""
    page = walk.page
    page.set_default_timeout(LONG)
    page.goto(address)
    page.wait_for_selector("#sensors .sensor")
    walk.took("open")
    machine(page)
    walk.took("its machine, smooth")
    if page.inner_text("#revision") == "revision 0":
        walk.tab_to("#calibrate")
        walk.step("Enter", "calibrate")
    walk.shot("opened")
    clicked(walk, "T_flange_right_degC")
    walk.shot("sensor")
    page.keyboard.press("d")
    page.wait_for_selector("#verdict")
    walk.took("diagnose")
    page.evaluate("document.querySelector('#missing').scrollIntoView({block: 'start'})")
    walk.shot("diagnosed")
    walk.tab_to("tr.named button, tr.group button")
    walk.step("Enter", "add")
    walk.shot("added")
    reported(walk)
    walk.step("u", "undo")
    walk.shot("undone")
    undone = page.inner_text("#errors")
    page.reload()
    page.wait_for_selector("#sensors .sensor")
    walk.took("reload")
    if page.inner_text("#errors").split("(hold-out)")[-1].split("→")[-1] not in undone:
        raise SystemExit("the errors after a reload are others than before")
    page.click("[aria-label='dark page']")
    walk.shot("dark")


def reported(walk: Walk) -> None:
    """Write the report and open it in a tab of its own."""
    walk.page.keyboard.press("r")
    walk.page.wait_for_selector("#report-link")
    walk.took("report")
    with walk.page.context.expect_page() as opening:
        walk.page.click("#report-link")
    opening.value.screenshot(path=walk.folder / "workbench-report.png", full_page=True)
    opening.value.close()
    walk.page.evaluate("document.activeElement.blur()")


def main() -> None:
    browser = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))))
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else HERE
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as home, sync_playwright() as engine:
        case = shutil.copytree(sys.argv[1], Path(home) / "case", ignore=shutil.ignore_patterns("out"))
        program = [sys.executable, "-c", "from thermoscope.cli import main; main()"]
        command = [*program, "show", "serve", str(case), "--port", "0"]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            address = str(server.stdout.readline()).split()[1]  # type: ignore[union-attr]
            chromium = engine.chromium.launch(executable_path=browser, args=GL)
            story(Walk(chromium.new_page(viewport={"width": 1280, "height": 800}), folder), address)
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
