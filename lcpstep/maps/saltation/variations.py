"""A motion with contacts and its derivative by its state, under modes that are held, as a kernel.

    x' = F(t, x),    J' = F_x J

F_x by differences of fourth order; where rows, masses and coefficients never change, F is linear in x, and F_x is
made once.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.events.codes import RELATIVE_STEP, SLIDES
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.held import right_hand_side
from lcpstep.events.contacts.state import Rubbing
from lcpstep.kernels.flow import derivative_rates, follow
from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.vectors import clear, copy, largest, product
from lcpstep.pointers import Doubles, abs, after, max

TOLERANCE = 1e-12  # of state and derivative
BESIDE = 3.0  # steps of the differences: a sliding velocity that they leave its sign


class Variations(RungeKutta):
    """A state in units of its own, and its derivative by the first one: n_x + n_x^2 numbers.

    s                the contacts, whose modes are held
    n_x, steady      numbers in a state; whether the field is linear in them
    unit, scale : (n_x,)   of the numbers of a state; lengths over which the field is smooth
    F_x : (n_x, n_x)
    x, beside, F : (n_x,)  the state, one beside it, and rates

    Parameters
    ----------
    s   as above;  unit : (n_x,) array
    """

    def __init__(self, s: Rubbing, unit: Any) -> None:
        n = 2 * s.n_q
        super().__init__(n + n * n, 0, TOLERANCE, TOLERANCE, False)
        self.s, self.n_x, self.steady = s, n, s.constant and s.model.linear
        self.vectors, self.matrix = np.zeros((5, n)), np.zeros((n, n))
        self.vectors[0] = unit
        self.unit = doubles(self.vectors)
        self.scale, self.x = after(self.unit, n), after(self.unit, 2 * n)
        self.beside, self.F = after(self.unit, 3 * n), after(self.unit, 4 * n)
        self.F_x = doubles(self.matrix)

    @cython.ccall
    def start(self, t: float, x: Any, scale: Any) -> None:
        """Begin at the state x (n_x,), whose modes are held; scale : (n_x,) lengths that steps are a share of."""
        n, given = self.n_x, doubles(x)
        copy(self.scale, doubles(scale), n)
        clear(self.y, n + n * n)
        for i in range(n):
            self.y[i] = given[i] / self.unit[i]
            self.y[n + i * n + i] = 1.0
        if self.steady:  # exact to rounding over any length, from anywhere
            clear(self.beside, n)
            for i in range(n):
                self.scale[i] = 1.0 / RELATIVE_STEP
            differentiate(self, t)

    @cython.ccall
    def go_on(self, a: float, b: float) -> int:
        """Go on from a to b; a status."""
        return follow(self, a, b)

    @cython.ccall
    def reached(self) -> Any:
        """The state (n_x,) and its derivative (n_x, n_x)."""
        n = self.n_x
        return self.state[:n] * self.vectors[0], self.state[n:].reshape(n, n).copy()

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """F and F_x J; False where the rows cannot be held."""
        n = self.n_x
        for i in range(n):
            self.x[i] = y[i] * self.unit[i]
        if not self.steady:
            copy(self.beside, self.x, n)
            if self.s.coefficients.varies and not step_aside(self.s, t, self.x, self.beside):
                return False
            if not differentiate(self, t):
                return False
        if not right_hand_side(self.s, t, self.x, self.F):
            return False
        for i in range(n):
            dy[i] = self.F[i] / self.unit[i]
        derivative_rates(self.F_x, after(y, n), after(dy, n), n)
        return True


def differentiate(w: Variations, t: float) -> bool:
    """F_x at the state `beside`; False where a row cannot be held beside it."""
    n = w.n_x
    clear(w.F_x, n * n)
    for j in range(n):
        here, d, known = w.beside[j], RELATIVE_STEP * w.scale[j], True
        for k in range(4):
            place = k - 2 if k < 2 else k - 1  # -2, -1, 1, 2
            weight = (8.0 if abs(place) == 1 else -1.0) * (1.0 if place > 0 else -1.0) / (12.0 * d)
            w.beside[j] = here + place * d
            known = known and right_hand_side(w.s, t, w.beside, w.F)
            for i in range(n):
                w.F_x[i * n + j] += weight * w.F[i]
        w.beside[j] = here
        if not known:
            return False
    return True


def step_aside(s: Rubbing, t: float, x: Doubles, beside: Doubles) -> bool:
    """Have contacts slide so fast in `beside` that differences leave their sign: coefficients bend at rest."""
    n = s.n_q
    if not measure(s, t, x):
        return False
    size, v = max(1.0, largest(x, 0.0, 2 * n)), after(beside, n)
    for c in range(s.n_c):
        row = s.n_j + s.n_c + c
        T, length, square = after(s.R, row * n), 0.0, 0.0
        for k in range(n):
            length += abs(T[k])
            square += T[k] * T[k]
        slides = s.direction[c] * (product(s.R, v, row, n) + s.rate[row])
        missing = BESIDE * RELATIVE_STEP * size * length - slides
        if s.mode[c] == SLIDES and missing > 0.0:
            for k in range(n):
                v[k] += s.direction[c] * missing * T[k] / square
    return True
