"""How the kernel is compiled: once, cached beside the source, without the Python lock.

Nothing compiled here allocates or counts references, inner functions have no Python entry of their own, and array
expressions, of which there are none, are not rewritten: each would cost a good part of the compile time. Every inner
function costs some time besides its lines: few of them. Only entries are cached; their code holds all inner functions.
"""

from typing import Any

from numba import njit

_OPTIONS: dict[str, Any] = {
    "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True, "no_rewrites": True, "_nrt": False,
}  # fmt: skip

entry = njit(**_OPTIONS, cache=True)
_HIDDEN = {**_OPTIONS, "no_cpython_wrapper": True}
inner = njit(**_HIDDEN)
inner_reordered = njit(**_HIDDEN, fastmath={"reassoc", "contract"})
