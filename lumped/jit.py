"""How the kernel is compiled: once, cached beside the source, without the Python lock.

Nothing compiled here allocates or counts references, and inner functions have no Python entry of their own: either
would cost a good part of the compile time. Only entries are cached; their code holds that of all inner functions.
"""

from typing import Any

from numba import njit

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True, "_nrt": False}

entry = njit(**_OPTIONS, cache=True)
_HIDDEN = {**_OPTIONS, "no_cpython_wrapper": True}
inner = njit(**_HIDDEN)
inner_reordered = njit(**_HIDDEN, fastmath={"reassoc", "contract"})
