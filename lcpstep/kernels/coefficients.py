"""Coefficients of friction: those of contacts that slide, which may depend on the sliding velocity, and of those
that stick.

    mu(t, q, u)   of a contact that slides with velocity u: constant, or a callback (Stribeck)
    mu_s >= mu    of one that sticks: constant, or mu at u = 0

Source: B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.function import Function
from lcpstep.kernels.vectors import clear, copy
from lcpstep.pointers import Doubles, after, indices_after, inf


class Coefficients:
    """Coefficients of friction of all contacts at the state last measured.

    sliding, sticking : (n_c,)
    varies   they depend on the sliding velocities
    two      they differ, or may: what sticks is tried with more than what slides has
    rough : (n_c,)   1 for contacts that have any friction, or may have
    wrong, slip      the contact whose coefficient was negative or no number, or -1; its sliding velocity then
    tried : (n_c,)   what has been tried of them in a step, see `stiction`

    Parameters
    ----------
    mu : (n_c,), or the address of a C function that fills them, None without friction;  mu_s : (n_c,) or None
    p : (n_p,) parameters;  n_q, n_c : int;  kept : what must outlive this object
    """

    def __init__(self, mu: Any, mu_s: Any, p: Any, n_q: int, n_c: int, kept: Any) -> None:
        self.varies, self.n_c = isinstance(mu, int), n_c
        self.fixed, self.kept = mu_s is not None, kept
        self.numbers = np.zeros((3, n_c))
        self.sliding = doubles(self.numbers)
        self.sticking, self.rest = after(self.sliding, n_c), after(self.sliding, 2 * n_c)
        self.wrong, self.slip = -1, 0.0
        self.function = Function(mu if self.varies else 0, p, n_q, n_c, (n_c,))
        if not self.varies and mu is not None:
            self.numbers[:2] = mu
        if self.fixed:
            self.numbers[1] = mu_s
        self.marks = np.zeros(2 * n_c, dtype=np.intp)
        self.rough, self.two = indices(self.marks), self.varies
        self.tried = indices_after(self.rough, n_c)
        for c in range(self.n_c):
            self.rough[c] = self.varies or self.sticking[c] > 0.0
            self.two = self.two or self.sticking[c] > self.sliding[c]

    def measure(self, t: float, q: Doubles, u: Doubles) -> bool:
        """Those at the sliding velocities u, 0 of what sticks; False where one is negative or no number."""
        if not self.varies:
            return True
        self.function.fill(t, q, u, self.sliding)
        if not self.fixed:
            clear(self.rest, self.n_c)
            self.function.fill(t, q, self.rest, self.sticking)
        self.wrong = -1
        for c in range(self.n_c):
            if not (0.0 <= self.sliding[c] < inf and 0.0 <= self.sticking[c] < inf):
                self.wrong, self.slip = c, u[c]
        return self.wrong < 0

    def measured(self, t: float, q: Any, u: Any) -> Any:
        """`measure` from Python: the coefficients (2, n_c) of what slides and of what sticks, or None."""
        return self.numbers[:2].copy() if self.measure(t, doubles(q), doubles(u)) else None

    def fault(self) -> str:
        """Which coefficient is none, in words; "" if all are."""
        if self.wrong < 0:
            return ""
        mu, at = self.numbers[0, self.wrong], f"contact {self.wrong} at sliding velocity {self.slip:.9g}"
        return f"friction.mu: expected coefficients >= 0, got {mu:.9g} of {at},"

    def use(self, mu: Doubles) -> None:
        """The coefficients of what slides into `mu`."""
        copy(mu, self.sliding, self.n_c)
