"""SECURITY.md: its limits are those of the code, and the tests it names are there."""

import re
from importlib import import_module

import pytest


@pytest.fixture(scope="module")
def text(root):
    return (root / "SECURITY.md").read_text(encoding="utf-8")


def test_limits_are_those_of_the_code(text):
    rows = re.findall(r"^\| .*? \| (\S+) \| \S+ \| `([\w.]+):(\w+)` \|$", text, re.M)
    assert len(rows) == text.partition("## Limits")[2].count("` |")
    assert {(where, name): float(limit) for limit, where, name in rows} == {
        (where, name): getattr(import_module(where), name) for _, where, name in rows
    }


def test_the_tests_it_names_are_there(text, root):
    names = re.findall(r"test_\w+\.py", text)
    assert len(names) >= 5
    assert [name for name in names if not list((root / "tests").rglob(name))] == []
