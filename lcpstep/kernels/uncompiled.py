"""User's functions that stay in Python: C functions around them, of the one signature of `lcpstep.kernels.function`.

An exception leaves `out` not-a-number and is noted (`callbacks.faults`), as in machine code; the run that meets the
number raises it. The run is slower by these functions alone.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from lagrangian.checks import said
from lagrangian.plain import python
from lcpstep.callbacks.faults import LOCAL, Callback, Fault, interrupted, name_of, note
from lcpstep.callbacks.functions import require
from lcpstep.callbacks.hearing import between, expect

C_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 4, ctypes.POINTER(ctypes.c_ssize_t))
ITEM, ALL_ONES = 8, 0xFF  # bytes of a number; of a not-a-number


class CalledBack:
    """A C function that calls f(t, q, v, p, out), or f(t, x, p, out) of first order; `address` is its own."""

    def __init__(self, f: Callback, first_order: bool = False) -> None:
        require(f)
        expect()
        self.f, self.name, self.first_order = python(f), name_of(f), first_order
        self.function = C_FUNCTION(self.call)
        self.address = int(ctypes.cast(self.function, ctypes.c_void_p).value or 0)

    @between
    def call(self, t: float, q: int, v: int, p: int, out: int, sizes: Any) -> None:
        """The function on copies of the numbers that C points to: what it keeps of them outlives the run."""
        n_q, n_v, n_p, rows, columns = sizes[:5]
        if interrupted():  # a method that has passed over it is to meet no other number
            ctypes.memset(out, ALL_ONES, ITEM * rows * (columns or 1))
            return
        x, x_t, own = numbers(q, n_q), numbers(v, n_v), numbers(p, n_p)
        given = (x, own) if self.first_order else (x, x_t, own)
        room = bytearray(ctypes.string_at(out, ITEM * rows * (columns or 1)))
        filled = np.frombuffer(room)
        try:
            LOCAL.asking = True
            self.f(t, *given, filled.reshape(rows, columns) if columns else filled)
            LOCAL.asking = False
        except BaseException as error:  # C passes none on
            LOCAL.asking = False
            ctypes.memset(out, ALL_ONES, len(room))
            note(Fault(self.name, t, x.copy(), x_t.copy(), said(error), error))
        else:
            ctypes.memmove(out, bytes(room), len(room))


def numbers(address: int, n: int) -> Any:
    """The n doubles at an address, in an array of their own that nobody can make writeable."""
    return np.frombuffer(ctypes.string_at(address, ITEM * n)) if n and address else np.zeros(0)
