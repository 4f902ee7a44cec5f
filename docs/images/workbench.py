"""Pictures of the workbench for the pages: python docs/images/workbench.py CASE

Serves a copy of the case, so that nothing of the case itself is changed. Needs playwright and Chromium.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

HERE = Path(__file__).resolve().parent
LONG = 3_600_000  # ms


def shot(page: Page, name: str) -> None:
    page.wait_for_timeout(2500)
    page.screenshot(path=HERE / f"workbench-{name}.png")


def story(page: Page, address: str) -> None:
    """Open, click the worst sensor, diagnose, add what is named."""
    page.set_default_timeout(LONG)
    page.goto(address)
    page.wait_for_selector("#sensors .sensor")
    page.wait_for_selector("#machine img[src^=blob], #machine canvas", state="attached")
    page.click("#sensors .sensor.chosen")
    shot(page, "sensor")
    page.click("#diagnose")
    page.wait_for_selector("#verdict")
    page.locator("#missing").scroll_into_view_if_needed()
    shot(page, "diagnosed")
    page.click("tr.named button, tr.group button")
    page.wait_for_selector("#outcome")
    page.evaluate("window.scrollTo(0, 0)")
    shot(page, "added")


def main() -> None:
    browser = next(filter(None, map(shutil.which, ("chromium", "google-chrome"))))
    with tempfile.TemporaryDirectory() as home, sync_playwright() as engine:
        case = shutil.copytree(sys.argv[1], Path(home) / "case", ignore=shutil.ignore_patterns("out"))
        command = [sys.executable, "-c", "from thermoscope.cli import main; main()", "serve", str(case), "--port", "0"]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        try:
            address = str(server.stdout.readline()).split()[1]  # type: ignore[union-attr]
            chromium = engine.chromium.launch(executable_path=browser, args=["--no-sandbox", "--disable-gpu"])
            story(chromium.new_page(viewport={"width": 1440, "height": 900}), address)
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
