"""From NumPy's arrays to what kernels take: see `pointers`. Arrays come checked: contiguous, of the right dtype."""

from __future__ import annotations

from typing import Any

from lcpstep.pointers import Doubles, Indices


def doubles(x: Any) -> Doubles:
    """The numbers of a contiguous float64 array."""
    return x.reshape(-1)


def indices(x: Any) -> Indices:
    """The indices of a contiguous intp array."""
    return x.reshape(-1)
