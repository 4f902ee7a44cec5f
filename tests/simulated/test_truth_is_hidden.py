"""The rooms know nothing of the generator, and the generator nothing of the rooms but the mesh."""

import ast
import tomllib

import pytest

ROOMS = ["geom", "fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras"]
FORBIDDEN = {"fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras"}


def imported(path):
    """Top-level names of every module a file imports, wherever in the file it does so."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module.split(".")[0])
    return names


@pytest.mark.parametrize("room", ROOMS)
def test_room_does_not_know_the_generator(root, room):
    files = [p for p in (root / room).rglob("*") if p.suffix in (".py", ".toml") and p.is_file()]
    assert files
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert "simulated." not in text, path
        assert "simulated/" not in text, path
        assert "truth.toml" not in text, path
        if path.suffix == ".py":
            assert "simulated" not in imported(path), path


def test_generator_shares_no_physics(root):
    files = list((root / "simulated").rglob("*.py"))
    assert files
    for path in files:
        assert not imported(path) & FORBIDDEN, path


def test_generator_takes_only_the_machine_from_geom(root):
    """geom describes the machine and meshes it; it knows no films, losses or solvers to borrow."""
    allowed = {
        *("geom", "geom.description", "geom.description.machine", "geom.meshing.mesh", "geom.description.part"),
        "geom.description.profile",
    }
    for path in (root / "simulated").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "geom":
                assert node.module in allowed, path


def test_generator_is_not_in_the_wheel(root):
    build = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["build"]["targets"]
    assert "simulated" not in build["wheel"]["only-include"]
    assert "simulated" not in build["wheel"]["sources"]


def test_case_does_not_tell_the_truth(root):
    """Neither the case's files nor its tests say where or what the hidden effect is."""
    for path in (root / "cases" / "road-test" / "tests").glob("*.toml"):
        text = path.read_text(encoding="utf-8")
        assert "wind" not in text.replace("winding", ""), path
        assert "shelter" not in text, path
