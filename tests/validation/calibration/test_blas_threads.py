"""One thread of BLAS inside, as many as before outside."""

import numpy as np  # noqa: F401  (loads the BLAS that is asked about)
from threadpoolctl import threadpool_info, threadpool_limits

from geom.one_thread import one_blas_thread


def threads():
    return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}


def test_one_thread_of_blas_inside_and_as_many_as_before_outside():
    with threadpool_limits(limits=2, user_api="blas"):
        assert one_blas_thread(threads)() == {1}
        assert threads() == {2}
