"""Many runs of one network: on all cores of this computer, or unchanged on a Dask cluster.

y = ensemble(network, record, members, rows)                            # threads: the kernel runs without Python's lock
with dask_cluster("tcp://10.0.0.5:8786") as executor:
    y = ensemble(network, record, members, rows, executor)
"""

import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np

from geom.arrays import Array
from geom.errors import InputError, MissingDependency
from lumped.integration.simulate import Record, simulate
from lumped.model.network import Network, Row

Members = Sequence[Mapping[str, float]]
CHUNKS = 8  # per worker: small enough that none waits long for the last


def ensemble(
    network: Network,
    record: Record,
    members: Members,
    rows: Sequence[Row],
    executor: Executor | None = None,
    chunk: int = 0,
) -> Array:
    """(n_members, nt, n_rows) degC: one run per set of parameter values.

    executor : any concurrent.futures.Executor; by default a thread per core.  chunk : members per task, 0 for a guess
    """
    if not members:
        return np.zeros((0, record.time.size, len(rows)))
    if executor is None:
        with ThreadPoolExecutor(os.cpu_count()) as threads:
            return ensemble(network, record, members, rows, threads, chunk)
    size = chunk or max(1, len(members) // (CHUNKS * (os.cpu_count() or 1)))
    parts = [members[i : i + size] for i in range(0, len(members), size)]
    jobs = [executor.submit(_some, network, record, part, rows) for part in parts]
    return np.concatenate([job.result() for job in jobs])


def _some(network: Network, record: Record, members: Members, rows: Sequence[Row]) -> Array:
    return np.stack([simulate(network, record, values, rows).y for values in members])


@contextmanager
def dask_cluster(address: str, wait_s: float = 10.0) -> Iterator[Executor]:
    """The workers of a Dask cluster (optional package `distributed`) as an executor; its workers need this package.

    wait_s : how long its scheduler may take to answer (s): a busy one takes seconds;  InputError: it does not
    """
    try:
        from distributed import Client
    except ImportError:
        raise MissingDependency("the package 'distributed' is not installed: pip install distributed") from None
    try:
        client = Client(address, timeout=wait_s)
    except OSError as fault:
        raise InputError(f"no Dask scheduler answers: {fault}", address, "tcp://HOST:8786 of a running one") from None
    with client:
        yield client.get_executor()
