"""One thread of BLAS: matrices of a diagnosis, and most fronts of a field, are small, and threads would mostly wait for
each other. A build of `pmsm-m1` takes 2.5 times as long with two.
"""

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

P = ParamSpec("P")
R = TypeVar("R")


def one_blas_thread(work: Callable[P, R]) -> Callable[P, R]:
    """`work` with one thread of BLAS, whatever the environment allows; afterwards as before."""

    @wraps(work)
    def alone(*args: P.args, **kwargs: P.kwargs) -> R:
        with threadpool_limits(limits=1, user_api="blas"):
            return work(*args, **kwargs)

    return alone
