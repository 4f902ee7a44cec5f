"""The pages in docs/papers are those the scripts write now; the one with machines: tests/cases/test_pmsm.py."""

import re

import pytest
from paper_pages import differences

from scripts.papers.__main__ import HERE, PAGES


def test_page_is_current():
    assert differences("series-dc-cooling.md") == []


@pytest.mark.parametrize(("was", "now"), [("955 N m", "995 N m"), ("torque", "force")])
def test_a_number_or_a_word_that_changed_is_seen(was, now, monkeypatch):
    page = PAGES["series-dc-cooling.md"].text()
    monkeypatch.setattr(PAGES["series-dc-cooling.md"], "text", lambda: page.replace(was, now, 1))
    assert differences("series-dc-cooling.md") != []


@pytest.mark.parametrize("name", PAGES)
def test_pictures_are_there(name):
    for picture in re.findall(r"\(images/([^)]+)\)", (HERE / name).read_text(encoding="utf-8")):
        assert (HERE / "images" / picture).stat().st_size > 2000
