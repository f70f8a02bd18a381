"""Factors of W + diag(d) on a set of indices, with the library that suits the structure of W.

    tridiagonal   LAPACK's LDL^T, if symmetric
    narrow band   LAPACK's band LU, after reverse Cuthill-McKee reordering if that makes the band narrow
    sparse        SuperLU, ordered by minimum degree
    dense         LAPACK's LU

They return a function that solves for a right-hand side of full length; off the set the answer is zero.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from lcpstep.lcp.problem import is_sparse

NARROW = 30  # half-bandwidth up to which the band is factorised as such

Solve = Callable[[Any], Any]


class Singular(ArithmeticError):
    """The matrix has no factors."""


class Factoriser(Protocol):
    """What the Newton methods need of a matrix."""

    def factor(self, active: Any, d: Any) -> Solve:
        """Solver for W + diag(d) restricted to the indices where active is True; raises Singular."""


def factoriser(W: Any) -> Factoriser:
    """The factoriser that suits W."""
    if not is_sparse(W):
        return Dense(W)
    k = half_bandwidth(W)
    if k <= 1 < W.shape[0] and (W.diagonal(1) == W.diagonal(-1)).all():
        return Tridiagonal(W)
    if k <= NARROW:
        return Banded(W, None)
    order, k = narrow_order(W)
    return General(W) if order is None else Banded(W[order][:, order], order)


def narrow_order(W: Any) -> tuple[Any, int]:
    """An order in which a CSR matrix is a narrow band, or None, and its half bandwidth then."""
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    natural = np.arange(W.shape[0]), half_bandwidth(W)
    if natural[1] <= NARROW:
        return natural
    order = reverse_cuthill_mckee(abs(W), symmetric_mode=False)  # it adds the transpose: nothing may cancel
    k = half_bandwidth(W[order][:, order])
    return (order if k <= NARROW else None), k


def banded(storage: Any, k: int) -> Solve:
    """Solver for a band of half bandwidth k in LAPACK's storage, transposed (n, 3 k + 1).

    Storage and right-hand sides are overwritten.
    """
    from scipy.linalg import lapack

    lu, pivots, info = lapack.dgbtrf(storage.T, k, k, overwrite_ab=True)
    if info != 0:
        raise Singular
    return lambda rhs: lapack.dgbtrs(lu, k, k, rhs, pivots, overwrite_b=True)[0]


class Patterned:
    """Matrices whose entries change and keep their places: order and storage are found once.

    Parameters
    ----------
    rows, columns : (n_e,)   places of the entries, none twice
    n : int   rows of the matrix
    """

    def __init__(self, rows: Any, columns: Any, n: int) -> None:
        from scipy.sparse import csc_array
        from scipy.sparse.csgraph import reverse_cuthill_mckee

        numbered = csc_array((np.arange(1.0, len(rows) + 1.0), (rows, columns)), shape=(n, n))
        self.n, self.entry = n, numbered.data.astype(np.intp) - 1  # which entry stands where in the columns
        self.indices, self.indptr = numbered.indices, numbered.indptr
        self.order = reverse_cuthill_mckee(numbered.tocsr(), symmetric_mode=False)
        place = np.empty(n, dtype=np.intp)
        place[self.order] = np.arange(n)
        row, column = place[rows], place[columns]
        self.k = k = int(np.max(np.abs(row - column), initial=0))
        self.flat = column * (3 * k + 1) + 2 * k + row - column  # in LAPACK's storage of the band, transposed

    def factor(self, values: Any) -> Solve:
        """Solver for the matrix with these entries, of one right-hand side or columns of them; raises Singular."""
        return self._banded(values) if self.k <= NARROW else self._sparse(values)

    def _banded(self, values: Any) -> Solve:
        k, n = self.k, self.n
        storage = np.zeros((n, 3 * k + 1))
        storage.ravel()[self.flat] = values
        within = banded(storage, k)

        def solve(rhs: Any) -> Any:
            x = np.empty(rhs.shape)
            x[self.order] = within(rhs[self.order])
            return x

        return solve

    def _sparse(self, values: Any) -> Solve:
        from scipy.sparse import csc_array
        from scipy.sparse.linalg import splu

        try:
            matrix = csc_array((values[self.entry], self.indices, self.indptr), shape=(self.n, self.n))
            solve: Solve = splu(matrix).solve
        except RuntimeError:
            raise Singular from None
        return solve


def half_bandwidth(W: Any) -> int:
    """Largest |i - j| of an entry of a CSR matrix."""
    rows = np.repeat(np.arange(W.shape[0]), np.diff(W.indptr))
    return int(np.max(np.abs(rows - W.indices), initial=0))


class Dense:
    """LAPACK on a dense submatrix."""

    def __init__(self, W: Any) -> None:
        self.W = W

    def factor(self, active: Any, d: Any) -> Solve:
        """See Factoriser."""
        from scipy.linalg import lapack

        chosen = np.flatnonzero(active)
        if len(chosen) == 0:
            return np.zeros_like
        A = self.W[np.ix_(chosen, chosen)]
        A[np.diag_indices_from(A)] += d[chosen]
        lu, pivots, info = lapack.dgetrf(A, overwrite_a=True)
        if info != 0:
            raise Singular
        return lambda rhs: spread(lapack.dgetrs(lu, pivots, rhs[chosen])[0], chosen, len(rhs))


class General:
    """SuperLU on a sparse submatrix."""

    def __init__(self, W: Any) -> None:
        self.W = W

    def factor(self, active: Any, d: Any) -> Solve:
        """See Factoriser."""
        from scipy.sparse import diags_array
        from scipy.sparse.linalg import splu

        chosen = np.flatnonzero(active)
        if len(chosen) == 0:
            return np.zeros_like
        part = self.W if len(chosen) == len(active) else self.W[chosen][:, chosen]
        try:
            lu = splu((part + diags_array(d[chosen])).tocsc(), permc_spec="MMD_AT_PLUS_A")
        except RuntimeError:
            raise Singular from None
        return lambda rhs: spread(lu.solve(rhs[chosen]), chosen, len(rhs))


class Tridiagonal:
    """LAPACK on a symmetric tridiagonal matrix; indices off the set have a row of the unit matrix."""

    def __init__(self, W: Any) -> None:
        self.diagonal, self.next = W.diagonal(), W.diagonal(1)

    def factor(self, active: Any, d: Any) -> Solve:
        """See Factoriser."""
        from scipy.linalg import lapack

        middle = np.where(active, self.diagonal + d, 1.0)
        beside = np.where(active[1:] & active[:-1], self.next, 0.0)
        D, L, info = lapack.dpttrf(middle, beside, overwrite_d=True, overwrite_e=True)
        if info != 0:
            raise Singular
        return lambda rhs: lapack.dpttrs(D, L, np.where(active, rhs, 0.0), overwrite_b=True)[0]


class Banded:
    """LAPACK on the band; indices off the set keep their place, with a row of the unit matrix."""

    def __init__(self, W: Any, order: Any) -> None:
        n, k = W.shape[0], half_bandwidth(W)
        self.k, self.order = k, slice(None) if order is None else order
        self.band = np.zeros((n, 2 * k + 1))  # band[j] holds column j of W, from row j - k to j + k
        rows = np.repeat(np.arange(n), np.diff(W.indptr))
        self.band[W.indices, k + rows - W.indices] = W.data

    def factor(self, active: Any, d: Any) -> Solve:
        """See Factoriser."""
        k, n = self.k, len(active)
        inside, shift = active[self.order], d[self.order]
        storage = np.zeros((n, 3 * k + 1))  # LAPACK's form, transposed; k more rows for the fill-in
        storage[:, k:] = self.band
        if not inside.all():
            padded = np.zeros(n + 2 * k, dtype=bool)
            padded[k : k + n] = inside
            for offset in range(2 * k + 1):
                storage[:, k + offset] *= inside & padded[offset : offset + n]
        storage[:, 2 * k] += np.where(inside, shift, 1.0)
        within = banded(storage, k)

        def solve(rhs: Any) -> Any:
            x = np.empty(n)
            x[self.order] = within(np.where(inside, rhs[self.order], 0.0))
            return x

        return solve


def spread(part: Any, chosen: Any, n: int) -> Any:
    """The vector of length n with these values at the chosen indices."""
    x = np.zeros(n)
    x[chosen] = part
    return x
