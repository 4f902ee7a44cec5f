"""What has a type says it: `Any` is for values out of files and for objects of libraries without types."""

import ast

import pytest

OURS = """
machine part prism geometry g mesh field block trace reduction network built case test record folder evidence fit
effect sensor channel surface jacket prisms usual fluid link source place parameter profile tests run diagnosis
"""


def untyped(tree):
    """Parameters and fields under one of these names whose type is `Any`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.arg) and node.annotation is not None:
            name, kind = node.arg, node.annotation
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            name, kind = node.target.id, node.annotation
        else:
            continue
        if name in OURS.split() and ast.unparse(kind) == "Any":
            yield f"{name}, line {node.lineno}"


def test_what_is_ours_is_typed(root, trees):
    found = {str(f.relative_to(root)): list(untyped(tree)) for f, tree in trees.items()}
    assert {name: lines for name, lines in found.items() if lines} == {}


@pytest.mark.parametrize("text", ["def f(machine: Any): ...", "class C:\n    field: Any", "network: Any = 1"])
def test_the_check_sees_what_it_is_for(text):
    assert list(untyped(ast.parse(text)))
