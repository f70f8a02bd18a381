"""Rows of a sparse matrix, for kernels and from Python: products with vectors, and the sizes of their terms."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.pointers import Doubles, abs


class SparseRows:
    """Row i has value[e] in column[e], for e from begin[i] to begin[i + 1].

    Parameters
    ----------
    matrix : csr_array (m, n)
    """

    def __init__(self, matrix: Any) -> None:
        begin, column = np.array(matrix.indptr, dtype=np.intp), np.array(matrix.indices, dtype=np.intp)
        self.arrays = {"begin": begin, "column": column, "value": np.array(matrix.data, dtype=np.float64)}
        self.begin, self.column = indices(begin), indices(column)
        self.value = doubles(self.arrays["value"])
        self.m = matrix.shape[0]

    @cython.ccall
    def times(self, x: Any) -> Any:
        """A x, of a contiguous x (n,)."""
        target = np.zeros(self.m)
        add_products(self, self.m, 1.0, doubles(x), doubles(target))
        return target

    @cython.ccall
    def sizes(self, x: Any) -> Any:
        """|A| |x|: the sizes of the terms of A x."""
        target = np.zeros(self.m)
        add_sizes(self, self.m, doubles(x), doubles(target))
        return target

    def matrix(self, m: int, n: int) -> Any:
        """The first m rows, of n columns, as a csr_array."""
        from scipy.sparse import csr_array

        a, end = self.arrays, int(self.arrays["begin"][m])
        return csr_array((a["value"][:end], a["column"][:end], a["begin"][: m + 1]), shape=(m, n))


def add_products(A: SparseRows, m: int, factor: float, x: Doubles, target: Doubles) -> None:
    """Target += factor A x, in m rows."""
    for i in range(m):
        total = 0.0
        for e in range(A.begin[i], A.begin[i + 1]):
            total += A.value[e] * x[A.column[e]]
        target[i] += factor * total


def add_sizes(A: SparseRows, m: int, x: Doubles, target: Doubles) -> None:
    """Target += |A| |x|, in m rows."""
    for i in range(m):
        total = 0.0
        for e in range(A.begin[i], A.begin[i + 1]):
            total += abs(A.value[e] * x[A.column[e]])
        target[i] += total
