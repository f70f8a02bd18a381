"""One array for many: its numbers handed out piece by piece, as kernels. Who takes them keeps the array."""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles, indices
from lcpstep.pointers import Doubles, Indices, after, indices_after


@cython.final
class Shelf:
    """Numbers of which the first that are not taken yet begin at `rest`; x : array of doubles, one piece."""

    def __init__(self, x: Any) -> None:
        self.rest = doubles(x)

    def take(self, n: int) -> Doubles:
        """The next n numbers."""
        x = self.rest
        self.rest = after(x, n)
        return x


@cython.final
class IndexShelf:
    """The same of indices."""

    def __init__(self, x: Any) -> None:
        self.rest = indices(x)

    def take(self, n: int) -> Indices:
        """The next n indices."""
        x = self.rest
        self.rest = indices_after(x, n)
        return x
