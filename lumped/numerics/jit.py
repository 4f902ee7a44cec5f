"""How the kernel is compiled: once, cached beside the source, without the Python lock.

Nothing compiled here allocates or counts references, inner functions have no Python entry of their own, and array
expressions, of which there are none, are not rewritten: each would cost a good part of the compile time. Every inner
function costs some time besides its lines, because it is optimised alone and once more in each that calls it: those
called from one place are pasted there (but for the tangents, which then run slower). Only entries are cached; their
code holds all inner functions: it is stale when any of their files has changed, which numba alone does not look at.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from numba import njit
from numba.core.compiler import Compiler
from numba.core.runtime import rtsys

_OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",
    "no_cfunc_wrapper": True,
    "no_rewrites": True,
    "_nrt": False,
}

_NEWEST = max(path.stat().st_mtime_ns for path in Path(__file__).parent.glob("*.py"))


def entry(function: Callable[..., Any]) -> Any:
    """Compiled and cached until its own file, or any of this folder, changes."""
    compiled = njit(**_OPTIONS, cache=True)(function)
    cache = compiled._cache
    if (file := getattr(cache, "_cache_file", None)) is not None:
        file._source_stamp = (file._source_stamp, _NEWEST)
        cache.load_overload = partial(_loaded, cache)
    return compiled


def _loaded(cache: Any, signature: Any, target: Any) -> Any:
    """What is cached for a signature, without all that numba can compile: listing that takes longer than a run."""
    rtsys.initialize(target)
    with cache._guard_against_spurious_io_errors():
        return cache._load_overload(signature, target)


_HIDDEN = {**_OPTIONS, "no_cpython_wrapper": True}
inner = njit(**_HIDDEN)
pasted = njit(**_HIDDEN, inline="always")
inner_reordered = njit(**_HIDDEN, fastmath={"reassoc", "contract"})


class _NoAlias(Compiler):
    """What is written is none of what is read: else a processor would have to look before every loop."""

    def define_pipelines(self) -> Any:
        self.state.flags.noalias = True
        return super().define_pipelines()


inner_noalias = njit(**_HIDDEN, fastmath={"reassoc", "contract"}, pipeline_class=_NoAlias)  # for arrays that are apart
inner_finite = njit(**_HIDDEN, fastmath={"reassoc", "contract", "nnan", "nsz"})
