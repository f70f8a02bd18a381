"""What C and Python say differently, said once: kernels use these names, and run compiled and uncompiled.

A kernel takes the numbers of an array from their first on: a pointer once compiled, a flat array before. Matrices lie
row by row, W[i, j] at W[i * n + j]. In the `.pxd` file beside this one the same names are C's; `abs`, `max` and `min`
are those of two doubles.
"""

from __future__ import annotations

import builtins
import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

try:
    import cython
except ImportError as error:
    raise ImportError(
        "lcpstep is not built: install it (python -m pip install -e .), or install Cython to run it uncompiled"
    ) from error

Doubles = NDArray[np.float64]
Indices = NDArray[np.intp]
Flags = NDArray[np.uint8]
abs: Callable[[Any], Any] = builtins.abs
max: Callable[[Any, Any], Any] = builtins.max
min: Callable[[Any, Any], Any] = builtins.min
inf = float("inf")
nan = float("nan")


def after(x: Doubles, i: int) -> Doubles:
    """The numbers from x[i] on."""
    return x[i:]


def indices_after(x: Indices, i: int) -> Indices:
    """The indices from x[i] on."""
    return x[i:]


def bits(x: float) -> int:
    """A double as the integer of the same 64 bits."""
    return int(np.float64(x).view(np.int64))


def double_of(bits: int) -> float:
    """The double of these bits."""
    return float(np.int64(bits).view(np.float64))


def callback_at(address: int) -> Callable[..., None]:
    """The function with this address, of the signature that `lcpstep.kernels.function` describes."""
    f = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 5)(int(address))

    def call(t: float, *arrays: NDArray[Any]) -> None:
        f(t, *(x.ctypes.data for x in arrays))

    return call


def whole(x: float) -> int:
    """The whole number next to x on the way to zero."""
    return int(x)
