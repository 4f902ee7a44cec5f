"""What an installation cannot do without is free to be used with closed programs."""

import re
import sys
import tomllib
from importlib.metadata import metadata

import pytest

from scripts import licences


def required(root):
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    return [re.split(r"[<>=!\[ ;]", line)[0] for line in project["dependencies"]]


def licence(name):
    about = metadata(name)
    words = [about.get("License-Expression"), (about.get("License") or "").partition("\n")[0]]
    return " ".join(filter(None, [*words, *(c for c in about.get_all("Classifier") or [] if "License" in c)]))


def test_nothing_that_is_required_is_gpl(root):
    """Readers of TDMS and MF4 are LGPL: they are in the optional part [bench].

    imageio-ffmpeg calls itself BSD and brings a program under the GPL: it is in [video].
    """
    assert [name for name in required(root) if "GPL" in licence(name)] == []
    assert not {"nptdms", "asammdf", "imageio-ffmpeg"} & set(required(root))


@pytest.mark.parametrize("name", ["nptdms", "asammdf"])
def test_the_check_reads_licences(name):
    assert "GPL" in licence(name)


def test_nothing_that_the_core_brings_is_gpl():
    """Its own requirements, theirs, and so on."""
    core = licences.closure(licences.needed(None))
    assert {"numpy", "numba", "llvmlite"} <= core, "what is required by what is required is found"
    assert [name for name in core if "GPL" in f"{licences.licence(name)} {licence(name)}"] == []


@pytest.mark.skipif(sys.platform != "linux", reason="other systems bring other packages")
def test_the_table_of_licences_is_of_what_is_installed(root):
    """python scripts/licences.py writes it."""
    assert (root / "docs/reference/licences.md").read_text() == licences.page()


def test_every_licence_is_known():
    assert [name for name in licences.parts_of() if licences.licence(name) == "see its licence file"] == []
