"""From NumPy's arrays to what kernels take: see `pointers`. Arrays come checked: contiguous, of the right dtype."""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.pointers import Doubles, Flags, Indices


def are_doubles(x: Any, dimensions: int) -> bool:
    """Whether x is a float64 array that kernels can take: contiguous, aligned, writeable, with so many dimensions."""
    return type(x) is np.ndarray and x.dtype == np.float64 and x.ndim == dimensions and x.flags.carray


def doubles(x: Any) -> Doubles:
    """The numbers of a contiguous float64 array."""
    return x.reshape(-1)


def indices(x: Any) -> Indices:
    """The indices of a contiguous intp array."""
    return x.reshape(-1)


def small_numbers(x: Any) -> Flags:
    """The numbers of a contiguous uint8 array."""
    return x.reshape(-1)
