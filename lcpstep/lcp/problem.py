"""The linear complementarity problem and what a solver says about it.

    find z >= 0 with w = W z + b >= 0 and z^T w = 0

R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (1992). Arrays are checked and
converted here, once: a wrong question is a ValueError that names the argument.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from lcpstep.lcp.judged import residual
from lcpstep.lcp.status import SOLVED, Status

FLOAT = np.dtype(np.float64)


class Ray(NamedTuple):
    """Certificate of Status.RAY: with a covering vector d > 0, for every t >= 0,

        z + t dz >= 0,    w = W (z + t dz) + b + (z_0 + t dz_0) d >= 0,    (z + t dz)^T w = 0,

    so the path of pivots ends at infinity. z, dz, d : (n,) in the units of z and w; z_0, dz_0 : numbers >= 0.
    """  # fmt: skip

    z: Any
    dz: Any
    z_0: float
    dz_0: float
    d: Any


class Solution(NamedTuple):
    """What a solver found.

    Attributes
    ----------
    z, w : (n,) arrays, w = W z + b; a solution when `solved`, else the last attempt
    status : Status
    iterations : int     pivots, Newton steps, sweeps or whatever the method counts
    residual : float     judged from W, b and z alone, without a unit; see `lcpstep.lcp.residual`
    method : str         the method that the answer is from
    certificate :        a Ray for Status.RAY; for Status.INFEASIBLE an array y >= 0 with W^T y <= 0 and
                         b^T y < 0, which proves that no z >= 0 has W z + b >= 0; else None
    """

    z: Any
    w: Any
    status: Status
    iterations: int
    residual: float
    method: str
    certificate: Any = None

    @property
    def solved(self) -> bool:
        """Whether the residual is at most the tolerance that was asked for."""
        return self.status == SOLVED


@dataclass(frozen=True, slots=True)
class LCP:
    """A linear complementarity problem, checked: W (n, n) dense or sparse, b (n,), float64 and finite."""

    W: Any
    b: Any

    def __post_init__(self) -> None:
        W, b = as_arrays(self.W, self.b)
        check_finite(W, b)
        object.__setattr__(self, "W", W)
        object.__setattr__(self, "b", b)

    def residual(self, z: Any) -> float:
        """Judged residual of z; see `lcpstep.lcp.residual`."""
        return residual(self.W, self.b, z)


def is_sparse(W: Any) -> bool:
    """Whether W is a scipy.sparse matrix, asked without importing scipy."""
    return hasattr(W, "tocsr")


def as_arrays(W: Any, b: Any) -> tuple[Any, Any]:
    """W and b as float64 arrays in C order (a sparse W as CSR) of matching shapes; copied only if need be."""
    W = _sparse_matrix(W) if is_sparse(W) else as_array(W, "W", 2)
    b = as_array(b, "b", 1)
    if W.shape[0] != W.shape[1]:
        raise ValueError(f"W must be square, not of shape {W.shape}")
    if W.shape[0] != b.shape[0]:
        raise ValueError(f"b must have the length of W, {W.shape[0]}, not {b.shape[0]}")
    return W, b


def as_array(a: Any, name: str, ndim: int) -> Any:
    """The argument as a float64 array in C order that a kernel can take."""
    if type(a) is np.ndarray and a.dtype is FLOAT and a.ndim == ndim and a.flags.carray:
        return a
    try:
        array = np.asarray(a)
    except ValueError as error:
        raise ValueError(f"{name} is not a rectangular array: {error}") from None
    if array.dtype.kind not in "biuf":
        raise ValueError(f"{name} must be real numbers, not {array.dtype}")
    if array.ndim != ndim:
        if array.size == 0 and np.size(a) == 0 and array.ndim < ndim:
            return np.empty((0,) * ndim)
        raise ValueError(f"{name} must have {ndim} dimension(s), not {array.ndim}")
    return np.array(array, dtype=float, order="C")


def _sparse_matrix(W: Any) -> Any:
    """CSR with sorted indices and without duplicates; the caller's matrix is left as it is."""
    if W.dtype.kind not in "biuf":
        raise ValueError(f"W must be real numbers, not {W.dtype}")
    if W.ndim != 2:
        raise ValueError(f"W must have 2 dimensions, not {W.ndim}")
    matrix = W.tocsr().astype(float, copy=False)
    if not matrix.has_canonical_format:
        matrix = matrix.copy()
        matrix.sum_duplicates()
    return matrix


def check_finite(W: Any, b: Any) -> None:
    """ValueError naming the argument that holds NaN or infinity."""
    for name, values in (("W", W.data if is_sparse(W) else W), ("b", b)):
        if not np.isfinite(values).all():
            raise ValueError(f"{name} contains NaN or infinity")


def limits(tol: float, max_iterations: int | None) -> int | None:
    """How many iterations can be made, None if nobody says; ValueError unless an answer can be within `tol`."""
    try:
        possible = bool(tol >= 0.0)
    except (TypeError, ValueError):
        possible = False
    if not possible:
        raise ValueError(f"tol must be a number >= 0, not {tol!r}")
    if max_iterations is None:
        return None
    try:
        most = int(max_iterations)
    except (TypeError, ValueError, OverflowError):
        most = -1
    if most < 0 or most != max_iterations or isinstance(max_iterations, (bool, np.bool_)):
        raise ValueError(f"max_iterations must be an integer >= 0, not {max_iterations!r}")
    return most


def as_guess(guess: Any, n: int) -> Any:
    """A starting point: a fresh (n,) array from an array or a Solution, zeros from None."""
    if guess is None:
        return np.zeros(n)
    z = as_array(guess.z if isinstance(guess, Solution) else guess, "guess", 1)
    if z.shape[0] != n:
        raise ValueError(f"guess must have the length of b, {n}, not {z.shape[0]}")
    if not np.isfinite(z).all():
        raise ValueError("guess contains NaN or infinity")
    return z.copy()
