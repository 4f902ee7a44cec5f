"""Extras stand on the face, `thermoscope` and `thermoscope.plugin`; the core finds them by entry point."""

import ast
import re
import tomllib
from importlib import import_module

import pytest

from thermoscope import plugin

FACE = {"thermoscope", "thermoscope.plugin"}


def names(root):
    return sorted(p.name for p in (root / "extras").iterdir() if (p / "__init__.py").exists())


def imported(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            yield node.module or ""
        elif isinstance(node, ast.Import):
            yield from (a.name for a in node.names)


def test_extras_import_the_face_alone(root, trees):
    """For types too. An import contract holds it as well; here a string that loads a module is no way round."""
    rooms = {f.relative_to(root).parts[0] for f in trees}
    past = {}
    for file, tree in trees.items():
        parts = file.relative_to(root).parts
        if parts[0] == "extras" and len(parts) > 2:
            mine = f"extras.{parts[1]}"
            used = {m for m in imported(tree) if m.partition(".")[0] in rooms and m not in FACE}
            if far := sorted(m for m in used if m != mine and not m.startswith(f"{mine}.")):
                past["/".join(parts)] = far
    assert past == {}


def test_the_core_names_no_extra(root, trees):
    """Neither by import nor in a text: what it takes of them comes by entry point."""
    core = {f: t for f, t in trees.items() if f.relative_to(root).parts[0] != "extras"}
    named = {str(f.relative_to(root)) for f, t in core.items() if any(m.startswith("extras") for m in imported(t))}
    assert named == set()


@pytest.mark.parametrize("name", dir(plugin))
def test_every_name_of_the_face_is_there(name):
    assert getattr(plugin, name) is not None


def test_every_name_of_the_face_is_used(root, trees):
    """What no extra asks for is not promised."""
    nodes = [n for f, t in trees.items() if f.relative_to(root).parts[0] == "extras" for n in ast.walk(t)]
    used = {n.attr for n in nodes if isinstance(n, ast.Attribute) and ast.unparse(n.value) == "th"}
    text = "".join(p.read_text(encoding="utf-8") for p in (root / "docs").rglob("*.md"))
    assert {name for name in set(dir(plugin)) - used if not re.search(rf"{name}", text)} == set()


def test_each_extra_is_installed_by_its_name(root):
    parts = tomllib.loads((root / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    every = re.search(r"\[(.*)\]", parts["all"][0])[1].split(",")
    assert set(names(root)) <= set(parts)
    assert set(names(root)) <= set(every)


def test_every_entry_point_is_there(root):
    groups = tomllib.loads((root / "pyproject.toml").read_text())["project"]["entry-points"]
    for points in groups.values():
        for where in points.values():
            module, _, name = where.partition(":")
            assert not name or hasattr(import_module(module), name), where
