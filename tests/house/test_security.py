"""SECURITY.md: the tests it names are there."""

import re

import pytest


@pytest.fixture(scope="module")
def text(root):
    return (root / "SECURITY.md").read_text(encoding="utf-8")


def test_the_tests_it_names_are_there(text, root):
    names = re.findall(r"test_\w+\.py", text)
    assert len(names) >= 5
    assert [name for name in names if not list((root / "tests").rglob(name))] == []
