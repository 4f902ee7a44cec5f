"""Folders are short enough to be read at a glance, and no modules import each other in a circle."""

import ast
from graphlib import CycleError, TopologicalSorter

import pytest

ROOMS = ("geom", "fem", "lumped", "validation", "viz", "thermoscope")
MOST = 15  # files of a folder beside its __init__: more do not fit on a screen


def modules(root):
    files = [f for room in ROOMS for f in sorted((root / room).rglob("*.py"))]
    return {".".join(f.relative_to(root).with_suffix("").parts).removesuffix(".__init__"): f for f in files}


def test_no_folder_is_long(root):
    folders = {f.parent for f in modules(root).values()}
    files = {str(d.relative_to(root)): len([*d.glob("*.py")]) - 1 for d in folders}
    assert {name: n for name, n in files.items() if n > MOST} == {}


def test_modules_import_each_other_one_way(root):
    known = modules(root)
    assert circle({name: set(imports(ast.parse(file.read_text()), known)) for name, file in known.items()}) == []


def imports(tree, known):
    """Modules that the code imports, inside functions too; what only types need does not count."""
    for node in run_time(tree):
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names if a.name in known)
        elif isinstance(node, ast.ImportFrom):
            wholes = [f"{node.module}.{a.name}" for a in node.names]
            yield from (w if w in known else node.module for w in wholes if w in known or node.module in known)


def run_time(node):
    for child in ast.iter_child_nodes(node):
        if not (isinstance(child, ast.If) and getattr(child.test, "id", "") == "TYPE_CHECKING"):
            yield child
            yield from run_time(child)


def circle(graph):
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return error.args[1]
    return []


@pytest.mark.parametrize("text", ["import b", "from b import x", "def f():\n    from b import x"])
def test_the_check_sees_a_circle(text):
    assert circle({"a": set(imports(ast.parse(text), {"a", "b"})), "b": {"a"}})
