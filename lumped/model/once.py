"""What follows from an object alone is worked out once, as long as the object lives."""

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import ref

T = TypeVar("T")
R = TypeVar("R")


def once(work: Callable[[T], R]) -> Callable[[T], R]:
    """`work` of one argument that is never changed, such as a network: the same object is looked at once.

    By identity, since a comparison would cost more than the work. Results must not hold their argument.
    """
    results: dict[int, tuple[ref[T], R]] = {}

    @wraps(work)
    def remembered(of: T) -> R:
        entry = results.get(id(of))
        if entry is not None and entry[0]() is of:
            return entry[1]
        result, key = work(of), id(of)
        results[key] = ref(of, lambda _: results.pop(key, None)), result
        return result

    return remembered
