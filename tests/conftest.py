"""Shared by all tests: one thread per process, tiers, files of long tests first, the command line, the small case."""

import json
import os
import sys
from collections import Counter
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


PARTS = 5  # of the nightly tests: as many landings until each has run
DURATIONS = ROOT / "tests" / "durations.json"
spent: Counter[str] = Counter()  # file -> seconds of its tests


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--turn", type=int, metavar="N", help=f"of the nightly tests only part N modulo {PARTS}")
    parser.addoption("--record", action="store_true", help=f"keep how long every file took in {DURATIONS.name}")


def file_of(item: pytest.Item | pytest.TestReport) -> str:
    return item.nodeid.split("::")[0]


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    spent[file_of(report)] += report.duration


def pytest_sessionfinish(session: pytest.Session) -> None:
    if session.config.getoption("--record") and "PYTEST_XDIST_WORKER" not in os.environ:
        known = durations()
        kept = {file: seconds for file, seconds in known.items() if (ROOT / file).exists()}
        least = known if session.config.getoption("--turn") is not None else {}  # of a part of its tests
        kept |= {f: max(round(seconds, 1), least.get(f, 0.0)) for f, seconds in spent.items() if seconds >= 0.5}
        DURATIONS.write_text(json.dumps(dict(sorted(kept.items(), key=lambda pair: -pair[1])), indent=0) + "\n")


def durations() -> dict[str, float]:
    """File -> seconds of its tests."""
    return json.loads(DURATIONS.read_text()) if DURATIONS.exists() else {}


def turns(files: set[str], seconds: dict[str, float]) -> dict[str, int]:
    """File of nightly tests -> its turn: the longest first, each to the turn with the least to do so far."""
    out, load = {}, [0.0] * PARTS
    for file in sorted(files, key=lambda file: (-seconds.get(file, 0.0), file)):
        out[file] = load.index(min(load))
        load[out[file]] += seconds.get(file, 1.0)
    return out


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Of the nightly tests those whose turn it is; files with heavy tests begin, the longest of them first.

    A long file that begins last keeps one of two workers waiting for its end.  First of all the rules of the house,
    which run no network: in a new checkout one worker compiles the kernels meanwhile, and the other finds them.
    """
    seconds = durations()
    turn, nightly = config.getoption("--turn"), [item for item in items if item.get_closest_marker("nightly")]
    for item in nightly:  # a new warning of a browser or a wheel's installer is no reason to stop a landing
        item.add_marker(pytest.mark.filterwarnings("default"))
    if turn is not None:
        turn_of = turns({file_of(item) for item in nightly}, seconds)
        later = {item for item in nightly if turn_of[file_of(item)] != turn % PARTS}
        config.hook.pytest_deselected(items=list(later))
        items[:] = [item for item in items if item not in later]
    heavy = {i.path for i in items if i.get_closest_marker("heavy") or i.get_closest_marker("nightly")}
    items.sort(key=lambda i: (i.path not in heavy, i.path.parent.name != "house", -seconds.get(file_of(i), 0.0)))


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
