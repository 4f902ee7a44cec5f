"""Shared by tests of pages: one browser for all tests of a file."""

import pytest
from viewer_pages import BROWSER, GL


@pytest.fixture(scope="module")
def browser():
    """Chromium with software GL: starting it costs a second, a page in it a tenth."""
    if BROWSER is None:
        pytest.skip("needs Chromium")
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as engine:
        running = engine.chromium.launch(executable_path=BROWSER, args=[*GL])
        yield running
        running.close()
