"""A user's function as kernels call it: one signature, whatever it was written in.

    void f(double t, double *q, double *v, double *p, double *out, ptrdiff_t *sizes)

with t, q, v, p, out as `lagrangian` has them, matrices row by row. sizes: how many numbers q, v and p have, rows and
columns of `out` (0: a vector). A C function that knows its sizes may leave the last argument out. A function of a
first-order system gets its state as q, and no v.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.pointers import Doubles, after, callback_at, nan


class Function:
    """A user's function, or none.

    Parameters
    ----------
    address : int   of a C function, 0 where there is none; what lies there must outlive this object
    p : (n_p,)   parameters
    n_q, n_v : int   how many numbers it is called with
    shape : (rows,) or (rows, columns)   of what it fills in
    """

    def __init__(self, address: int, p: Any, n_q: int, n_v: int, shape: tuple[int, ...]) -> None:
        self.kept, self.given, self.address = p, address != 0, address
        self.f, self.p = callback_at(address), doubles(p)
        self.length = shape[0] * (shape[1] if len(shape) > 1 else 1)
        sizes = (n_q, n_v, len(p), shape[0], shape[1] if len(shape) > 1 else 0)
        if not cython.compiled:
            self.sizes = np.zeros(5, dtype=np.intp)
        for i in range(5):
            self.sizes[i] = sizes[i]

    def fill(self, t: float, q: Doubles, v: Doubles, out: Doubles) -> None:
        """Evaluate the function; what it leaves out, or where it fails, is not a number."""
        for i in range(self.length):
            out[i] = nan
        self.f(t, q, v, self.p, out, self.sizes)

    def sample(self, times: Any, q: Any, v: Any, out: Any) -> None:
        """The function at many times of one state, into out (times, ...); called from Python."""
        t, x, x_t, filled = doubles(times), doubles(q), doubles(v), doubles(out)
        for k in range(len(times)):
            self.fill(t[k], x, x_t, after(filled, k * self.length))


class Functions:
    """Several functions with the same arguments, by their number.

    Parameters
    ----------
    addresses : (k,) int   of C functions; what lies there must outlive this object
    p, n_q, n_v, shape   as for `Function`, the same for all
    """

    def __init__(self, addresses: Any, p: Any, n_q: int, n_v: int, shape: tuple[int, ...]) -> None:
        self.array = np.array(addresses, dtype=np.intp)
        self.like = Function(0, p, n_q, n_v, shape)
        self.addresses, self.length = indices(self.array), self.like.length

    def fill(self, k: int, t: float, q: Doubles, v: Doubles, out: Doubles) -> None:
        """Evaluate function k; what it leaves out, or where it fails, is not a number."""
        for i in range(self.length):
            out[i] = nan
        callback_at(self.addresses[k])(t, q, v, self.like.p, out, self.like.sizes)
