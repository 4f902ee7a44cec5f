"""The pages in docs/papers are those the scripts write now."""

import re

import numpy as np
import pytest

from scripts.papers.__main__ import HERE, PAGES

NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


@pytest.mark.parametrize("name", PAGES)
def test_page_is_current(name):
    """The same words, and numbers within half a percent or 0.2: processors differ in the last digits of a fit."""
    written, now = (HERE / name).read_text(encoding="utf-8"), PAGES[name].text()
    assert NUMBER.sub("#", written) == NUMBER.sub("#", now)
    a, b = (np.array([float(x) for x in NUMBER.findall(text)]) for text in (written, now))
    assert np.all(np.abs(a - b) <= 0.2 + 5e-3 * np.abs(b))


@pytest.mark.parametrize("name", PAGES)
def test_pictures_are_there(name):
    for picture in re.findall(r"\(images/([^)]+)\)", (HERE / name).read_text(encoding="utf-8")):
        assert (HERE / "images" / picture).stat().st_size > 2000
