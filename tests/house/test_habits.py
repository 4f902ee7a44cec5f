"""Files that a stranger looks for agree with the project they speak of."""

import re
import tomllib

import pytest


@pytest.fixture(scope="module")
def project(root):
    return tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_the_citation_names_the_version_and_licence_of_the_package(root, project):
    lines = (root / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    assert f"version: {project['version']}" in lines
    assert f"license: {project['license']}" in lines


def test_hosted_tests_run_every_version_that_is_promised(root, project):
    promised = [
        c.rpartition(" ")[2] for c in project["classifiers"] if c.startswith("Programming Language :: Python :: 3.")
    ]
    hosted = (root / ".github/workflows/ci.yml").read_text(encoding="utf-8")
    versions = ", ".join(f'"{version}"' for version in promised)
    assert f"python: [{versions}]" in hosted
    assert promised[0] == project["requires-python"].removeprefix(">=")


@pytest.mark.parametrize("command", [".venv/bin/ruff", "tests/house/test_words.py", "tests/house/test_rooms.py"])
def test_what_a_commit_runs_is_there(root, command):
    assert command in (root / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    assert command.startswith(".venv") or (root / command).is_file()


def test_the_tests_that_the_page_of_security_names_are_there(root):
    names = re.findall(r"test_\w+\.py", (root / "SECURITY.md").read_text(encoding="utf-8"))
    assert len(names) >= 5
    assert [name for name in names if not list((root / "tests").rglob(name))] == []
