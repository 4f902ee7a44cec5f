"""How the kernel is compiled: once, cached beside the source, without the Python lock.

Inner functions have no Python entry of their own and allocate nothing: unpacking forty arrays in each, and counting
references to them, would cost most of the compile time.
"""

from typing import Any

from numba import njit

_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
_HIDDEN: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True, "_nrt": False}

entry = njit(**_OPTIONS)
inner = njit(**_OPTIONS, **_HIDDEN)
inner_reordered = njit(**_OPTIONS, **_HIDDEN, fastmath={"reassoc", "contract"})
