"""Shared by all tests: one thread per process, files of long tests first, the command line, the small case."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

# Byte code is kept, though containers often ask for none: every worker, and every program that a test starts, would
# compile all code anew.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# The same random examples on every run: a test that fails, fails for everyone.
settings.register_profile("repeatable", derandomize=True)
settings.load_profile("repeatable")

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder of the checkout."""
    return ROOT


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files with heavy tests begin: one that begins last keeps one of two workers waiting for its end.

    First of all the rules of the house, which run no network: in a new checkout one worker compiles the kernels
    meanwhile, and the other finds them.
    """
    heavy = {item.path for item in items if item.get_closest_marker("heavy")}
    items.sort(key=lambda item: (item.path not in heavy, item.path.parent.name != "house"))


@pytest.fixture(scope="session", autouse=True)
def run_cache(tmp_path_factory) -> Iterator[Path]:
    """The cache of this run, of all workers: found by content, so that solids, meshes and shapes are made once.

    The user's own is neither read nor filled: a test that passes for what lies there fails elsewhere.
    """
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "cache"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("THERMOSCOPE_CACHE", str(folder))
        yield folder


@pytest.fixture(scope="session")
def thermoscope():
    """thermoscope(*words, cwd=folder) -> Answer of the command line, in this process: starting one costs seconds."""
    from command_line import answered

    return answered


@pytest.fixture
def contents():
    """contents(folder) -> every file and its bytes."""
    from command_line import contents

    return contents


@pytest.fixture
def case(tmp_path) -> Path:
    """A case whose model lacks convection at the flange."""
    from small_case import small_case

    return small_case(tmp_path)
