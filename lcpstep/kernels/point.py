"""The equations of a model with one contact at a single state, called from Python a few times per impact."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.acceleration import divide_by_mass, free_acceleration
from lcpstep.kernels.biases import bias
from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.vectors import copy, product
from lcpstep.pointers import after, inf


class Point:
    """Free acceleration, gap rates, response and bias at (t, q, v); states are contiguous arrays (n_q,) of floats."""

    def __init__(self, m: Any) -> None:
        n = m.n_q
        self.m, self.n = m, n
        self.numbers = np.zeros(n * n + 3 * n + 2)
        self.M = doubles(self.numbers)
        self.work = after(self.M, n * n)
        self.G = after(self.work, n)
        self.shifted = after(self.G, n)
        self.rate = after(self.shifted, n)
        self.out = after(self.rate, 1)

    def acceleration(self, t: float, q: Any, v: Any) -> Any:
        """M^-1 f, the acceleration without contact, (n_q,)."""
        a = np.zeros(self.n)
        free_acceleration(self.m, t, doubles(q), doubles(v), self.M, self.work, doubles(a))
        return a

    def rates(self, t: float, q: Any, v: Any) -> tuple[Any, float]:
        """G (n_q,) and gap velocity u = G v + g_t."""
        G = np.zeros(self.n)
        gap_rates(self.m, t, doubles(q), doubles(v), doubles(G), self.rate)
        return G, product(doubles(G), doubles(v), 0, self.n) + self.rate[0]

    def response(self, t: float, q: Any, v: Any) -> tuple[Any, float]:
        """M^-1 G^T (n_q,) and G M^-1 G^T."""
        MG, x, x_t = np.zeros(self.n), doubles(q), doubles(v)
        gap_rates(self.m, t, x, x_t, self.G, self.rate)
        copy(doubles(MG), self.G, self.n)
        divide_by_mass(self.m, t, x, x_t, self.M, self.work, doubles(MG))
        return MG, product(self.G, doubles(MG), 0, self.n)

    def gap_bias(self, t: float, q: Any, v: Any, low: float = -inf, high: float = inf) -> float:
        """The gap acceleration at v' = 0; low, high: the smooth interval of time that t lies in."""
        bias(self.m, t, low, high, doubles(q), doubles(v), self.shifted, self.G, self.rate, self.out)
        return self.out[0]
