"""Ensembles: the same numbers in threads, in turn and on a Dask cluster."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from small_networks import boundaries, every_law, inputs

from geom.errors import InputError
from lumped.integration.ensemble import dask_cluster, ensemble
from lumped.integration.simulate import Record, simulate

NETWORK = every_law()
TIME = np.arange(0.0, 300.0, 5.0)
RECORD = Record(TIME, inputs(TIME), boundaries(TIME), 40.0)
ROWS = [NETWORK.place("a").mean, NETWORK.place("skin").mean]
MEMBERS = [{"log copper": x, "log table": 2 - x} for x in np.linspace(0.5, 1.5, 23)]


@pytest.fixture(scope="module")
def in_turn():
    return np.stack([simulate(NETWORK, RECORD, m, ROWS).y for m in MEMBERS])


@pytest.mark.parametrize("chunk", [0, 5])
def test_threads_give_the_same_to_the_bit(in_turn, chunk):
    assert_array_equal(ensemble(NETWORK, RECORD, MEMBERS, ROWS, chunk=chunk), in_turn)


def test_a_dask_cluster_gives_the_same_to_the_bit(in_turn):
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 1, "threads_per_worker": 2, "processes": False, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, dask_cluster(cluster.scheduler_address) as executor:
        assert_array_equal(ensemble(NETWORK, RECORD, MEMBERS, ROWS, executor), in_turn)


def test_a_cluster_that_does_not_answer_is_named():
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match="no Dask scheduler"), dask_cluster("tcp://127.0.0.1:1", 0.2):
        pass
