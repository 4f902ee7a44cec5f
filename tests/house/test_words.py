"""Public names are terms of the field: docs/glossary.md lists words of our own that they have replaced."""

import ast
import re

import pytest

ROOMS = ("geom", "fem", "lumped", "validation", "viz", "thermoscope")
# How often a word is still in use; none may be added.
REMAINING = {"behind": 2, "bent": 1, "kept": 1, "strained": 1, "told": 2}


def own_words(root):
    section = (root / "docs/glossary.md").read_text().partition("## Names in the code")[2]
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \|$", section, re.MULTILINE)[1:]
    return {word for row in rows for word in row.split(", ")}


def public(root):
    """Every module, and every function, method and class without an underscore before its name."""
    for file in (f for room in ROOMS for f in sorted((root / room).rglob("*.py"))):
        yield file.stem
        tree = ast.parse(file.read_text())
        names = [n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.ClassDef)]
        yield from (name for name in names if not name.startswith("_"))


def words(name):
    """with_hats -> with, hats; BasisCache -> basis, cache."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)}


def counted(names, known):
    found = [word for name in names for word in words(name) & known]
    return {word: found.count(word) for word in sorted(set(found))}


def test_no_private_words_in_public_names(root):
    found = counted(public(root), own_words(root))
    assert {word: n for word, n in found.items() if n > REMAINING.get(word, 0)} == {}


@pytest.mark.parametrize("name", ["Shelf", "foretold", "latent_heat", "HandShelf", "is_kept"])
def test_the_check_sees_what_it_is_for(root, name):
    assert counted([name], own_words(root))
