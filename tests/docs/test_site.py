"""The site builds strictly: no broken link, no missing picture, no page left out, every docstring found."""

import json
import os
import re
import subprocess
import sys

import pytest
from typer.main import get_command

from thermoscope.cli import whole_app

pytestmark = pytest.mark.heavy
LARGEST = 1e6  # bytes of the page of a shipped case

pytest.importorskip("material", reason="needs mkdocs-material: uv pip install mkdocs-material 'mkdocstrings[python]'")
pytest.importorskip("mkdocstrings")


@pytest.fixture(scope="module")
def site(root, tmp_path_factory):
    """The built site and what the build said."""
    out = tmp_path_factory.mktemp("site")
    quiet = {**os.environ, "NO_MKDOCS_2_WARNING": "1", "DISABLE_MKDOCS_2_WARNING": "true"}
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(out)]
    done = subprocess.run(command, cwd=root, env=quiet, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def test_reference_comes_from_the_docstrings(site):
    assert "Add effect" in (site / "reference" / "validation.html").read_text()


def test_gallery_shows_every_example(root, site):
    text = (site / "gallery.html").read_text()
    assert all(path.name in text for path in (root / "examples").glob("*.py"))


def test_a_machine_can_be_turned_in_the_browser(site):
    page = (site / "road-test-viewer.html").read_text()
    assert len(page.encode()) < LARGEST
    data = json.loads(page.partition('id="data">')[2].partition("</script>")[0])
    assert len(data["tests"]) == 5
    assert {"flange.right", "winding.armature.left"} <= {part["name"] for part in data["parts"]}
    assert "road-test-viewer.html" in (site / "gallery.html").read_text()


def test_pages_ask_no_other_computer_for_anything(site):
    """No font, script or style from elsewhere: the site can be read without a network."""
    for page in site.rglob("*.html"):
        found = re.findall(r'<(?:script|link|img)[^>]+(?:src|href)="(https?:)?//[^"]*"', page.read_text())
        assert found == [], page


def test_tutorial_commands_exist(root):
    """Every `thermoscope X` in the pages is a command."""
    known = set(get_command(whole_app()).commands)
    pages = [root / "docs" / "tutorial.md", *(root / "docs" / "how-to").glob("*.md")]
    used = {w for page in pages for w in re.findall(r"^thermoscope (\w+)", page.read_text(), re.M)}
    assert used
    assert used <= known
