"""Where the solvers are not built: a C function that calls the plain Python one, for kernels that numba compiles."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable
from typing import Any

import numpy as np

DOUBLES = ctypes.POINTER(ctypes.c_double)
C_SOLVER = ctypes.CFUNCTYPE(ctypes.c_ssize_t, DOUBLES, DOUBLES, DOUBLES, ctypes.c_ssize_t, ctypes.py_object)


def address_of(solver: Callable[..., int]) -> int:
    """Address of a solver f(W, b, z, n, work) that is called as Python."""
    return int(ctypes.cast(c_function(solver), ctypes.c_void_p).value or 0)


@functools.cache
def c_function(solver: Callable[..., int]) -> Any:
    """The C function; kept, for it must live as long as its address is used."""

    def call(W: Any, b: Any, z: Any, n: int, work: Any) -> int:
        arrays = (np.ctypeslib.as_array(x, (length,)) for x, length in ((W, n * n), (b, n), (z, n)))
        return solver(*arrays, n, work)

    return C_SOLVER(call)
