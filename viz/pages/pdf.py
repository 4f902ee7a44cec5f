"""A page as PDF, with whatever converter this computer has."""

from __future__ import annotations

import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "microsoft-edge")
QUIET = ["--headless", "--disable-gpu", "--no-sandbox", "--no-first-run", "--disable-extensions"]
QUIET += ["--no-pdf-header-footer"]
LONGEST_S = 180  # a browser that needs more hangs


def write_pdf(page: Path) -> Path | None:
    """Write PAGE.pdf beside an HTML page by WeasyPrint or a Chromium; None where there is neither."""
    pdf = page.with_suffix(".pdf")
    if find_spec("weasyprint") is not None:
        from weasyprint import HTML

        HTML(str(page)).write_pdf(str(pdf))
        return pdf
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    return None if browser is None else _printed(browser, page, pdf)


def _printed(browser: str, page: Path, pdf: Path) -> Path | None:
    """By a browser without a window, its profile in a folder that is thrown away; None if it fails."""
    with TemporaryDirectory() as profile:
        files = [f"--user-data-dir={profile}", f"--print-to-pdf={pdf.resolve()}", page.resolve().as_uri()]
        process = subprocess.run([browser, *QUIET, *files], capture_output=True, timeout=LONGEST_S, check=False)
    return pdf if process.returncode == 0 and pdf.is_file() else None
