"""Benchmarks, scripts and simulated machines find what they import: they run by hand, so nothing else would tell."""

import ast
import importlib

import pytest

ROOMS = {"extras", "fem", "geom", "lumped", "measured", "scripts", "simulated", "thermoscope", "validation", "viz"}


@pytest.mark.parametrize("folder", ["benchmarks", "scripts", "simulated"])
def test_what_scripts_import_is_there(root, folder):
    missing = []
    for file in sorted((root / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.partition(".")[0] in ROOMS:
                module = importlib.import_module(node.module)
                missing += [f"{file.name}: {node.module}.{a.name}" for a in node.names if not found(module, a.name)]
    assert missing == []


def found(module, name):
    """Whether a module has the name, or a module of that name in it."""
    try:
        return hasattr(module, name) or bool(importlib.import_module(f"{module.__name__}.{name}"))
    except ModuleNotFoundError:
        return False
