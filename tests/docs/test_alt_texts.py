"""Every picture of the pages has an alternative text: a few words of its own, and not the name of its file."""

import importlib.util
import re
from pathlib import PurePosixPath

import pytest

PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s]+)\)")
FEWEST = 4  # words; "figure 3" tells nobody what is in it


def silent(page):
    """(text, file) of pictures whose text is too short, names the file, or stands under another picture too."""
    found = PICTURE.findall(page)
    texts = [text for text, _ in found]
    return [
        (text, file)
        for text, file in found
        if len(text.split()) < FEWEST or text == PurePosixPath(file).stem or texts.count(text) > 1
    ]


def test_pages_describe_their_pictures(root):
    pages = {p: p.read_text() for p in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]}
    assert sum(len(PICTURE.findall(text)) for text in pages.values()) > 40
    assert {p.name: s for p, text in pages.items() if (s := silent(text))} == {}
    assert not any("<img" in text for text in pages.values())


def test_the_gallery_describes_its_pictures(root):
    pytest.importorskip("mkdocs")
    spec = importlib.util.spec_from_file_location("site_hooks", root / "docs" / "site" / "hooks.py")
    hooks = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(hooks)
    text = hooks.gallery(sorted((root / "examples").glob("*.py")))
    assert len(PICTURE.findall(text)) > 25
    assert silent(text) == []


def test_a_silent_picture_is_seen():
    assert len(silent("![](a.png) ![a](a.png) ![a motor is cut open](b.png)")) == 2
    assert len(silent("![a motor is cut open](a.png) ![a motor is cut open](b.png)")) == 2
