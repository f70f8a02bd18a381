"""What steps of one size multiply with.

    A = M + h theta C + h^2 theta^2 K,      X = A^-1 (G, T, D_J)^T,      W = (G, T, G_J) X

for a linear system; of a general one A is Newton's matrix (`implicit`). X and W are constant where the rows of all
contacts, tangents and joints are, and made anew in each step where they are not.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles

MATRICES = ("A_q", "A_v", "A_f", "X", "W")


class Plan:
    """Matrices of a step, row by row.

    h, theta
    slack                a predicted gap this small is closed: rounding must not open what rests
    constant             X and W are those of every step
    A_q : (n_q, n_q)     A^-1 h K
    A_v : (n_q, n_q)     A^-1 (h C + h^2 theta K)
    A_f : (n_q, n_q)     h A^-1
    X : (n, n_q)         A^-1 times the directions of the forces of all n rows
    W : (n, n)           Delassus matrix of all rows

    Parameters
    ----------
    h, theta, slack : float;  constant : bool;  matrices : dict of the five arrays, which are kept
    """

    def __init__(
        self, h: float, theta: float, slack: float, constant: bool, matrices: dict[str, Any]
    ) -> None:
        self.h, self.theta, self.slack, self.constant = h, theta, slack, constant
        self.matrices = {name: np.ascontiguousarray(matrices[name]) for name in MATRICES}
        self.A_q, self.A_v = doubles(self.matrices["A_q"]), doubles(self.matrices["A_v"])
        self.A_f = doubles(self.matrices["A_f"])
        self.X, self.W = doubles(self.matrices["X"]), doubles(self.matrices["W"])
