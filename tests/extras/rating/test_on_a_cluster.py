"""optimise and fleet on a Dask scheduler with two worker processes: the same answer as in this process."""

import json
from pathlib import Path

import pytest
from small_case import small_case
from typer.testing import CliRunner

from simulated.fleet import written
from thermoscope.cli import whole_app

distributed = pytest.importorskip("distributed")
pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module")
def cluster():
    """Address of a scheduler and its two workers, whose processes live as long as the tests of this module."""
    options = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with distributed.LocalCluster(**options) as running:
        yield running


def document(file: Path, *arguments: object) -> dict:
    done = CliRunner().invoke(whole_app(), ["use", *map(str, arguments), "--json", str(file)])
    assert done.exit_code == 0, done.exception
    return json.loads(file.read_text())


def tasks(cluster) -> int:
    """How many tasks the workers have run since they started."""
    with distributed.Client(cluster.scheduler_address) as client:
        return sum(client.run(lambda dask_worker: dask_worker.state.executed_count).values())


def test_an_optimisation_is_the_same_on_a_cluster(cluster, tmp_path):
    """Same seed, same designs, judged in other processes."""
    case, found, before = small_case(tmp_path), {}, tasks(cluster)
    given = ["--limit", "winding=400", "--vary", "current_A=40:90", "--at", "ambient=20", "--population", "12"]
    for word, more in (("here", []), ("there", ["--cluster", cluster.scheduler_address])):
        out = ["--generations", "3", "--out", tmp_path / word]
        found[word] = document(tmp_path / f"{word}.json", "optimise", case, *given, *out, *more)
    assert found["there"]["designs"] == found["here"]["designs"]
    assert tasks(cluster) - before >= 3  # at least one a generation


def test_a_fleet_is_the_same_on_a_cluster(cluster, tmp_path):
    (case, fleet), before = written(tmp_path, 4, None, None, months=("2026-01",)), tasks(cluster)
    here = document(tmp_path / "here.json", "fleet", case, fleet)
    there = document(tmp_path / "there.json", "fleet", case, fleet, "--cluster", cluster.scheduler_address)
    assert there == here
    assert len(there["units"]) == 4
    assert tasks(cluster) - before == 4  # one a recording
