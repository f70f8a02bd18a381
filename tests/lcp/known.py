"""Problems from the literature, each with its source; `solution` where it is unique."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Known(NamedTuple):
    name: str
    W: Any
    b: Any
    solution: Any = None


def murty(n: int) -> Known:
    """Exponential for least-index pivoting: K. G. Murty, Math. Programming Study 7 (1978) 61."""
    W = np.tril(2.0 * np.ones((n, n)), -1) + np.eye(n)
    b = -np.cumsum(2.0 ** np.arange(n, 0, -1))
    return Known(f"Murty {n}", W, b, np.eye(n)[0] * 2.0**n)


def fathi(n: int) -> Known:
    """Exponential, symmetric positive definite: Y. Fathi, Math. Programming 17 (1979) 335."""
    L = np.tril(2.0 * np.ones((n, n)), -1) + np.eye(n)
    return Known(f"Fathi {n}", L @ L.T, -np.ones(n), np.eye(n)[0])


def chandrasekaran(n: int) -> Known:
    """Z-matrix of a chain: R. Chandrasekaran, Opsearch 7 (1970) 263."""
    W = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    b = -np.ones(n)
    return Known(f"chain {n}", W, b, np.linalg.solve(W, -b))


def hilbert(n: int) -> Known:
    i = np.arange(n)
    W = 1.0 / (i[:, None] + i + 1.0)
    return Known(f"Hilbert {n}", W, -W @ (i % 2.0) + (i + 1) % 2)


KNOWN = [
    *(murty(n) for n in (1, 2, 3, 10, 20, 30)),
    *(fathi(n) for n in (2, 8, 24, 60)),
    *(chandrasekaran(n) for n in (3, 50)),
    *(hilbert(n) for n in (3, 6, 9, 12)),
    # M. M. Kostreva, Math. Programming 16 (1979) 127: principal pivoting cycles on this P-matrix
    Known("Kostreva", [[1.0, 2, 0], [0, 1, 2], [2, 0, 1]], [-1.0, -1, -1], np.ones(3) / 3),
    # R. W. Cottle, J.-S. Pang, R. E. Stone (1992), examples 1.3.1 ff. and 4.3
    Known("Cottle-Pang-Stone identity", np.eye(3), [-1.0, 2, 0], [1.0, 0, 0]),
    Known("symmetric definite", [[2.0, 1], [1, 2]], [-5.0, -6], [4 / 3, 7 / 3]),
    Known("positive semidefinite", [[1.0, -1], [-1, 1]], [-1.0, 2]),
    Known("skew", [[0.0, 1], [-1, 0]], [-1.0, 2]),
    Known("P-matrix, not definite", [[1.0, 5], [0, 1]], [-1.0, -2]),
    Known("copositive-plus", [[1.0, 2, 1], [2, 1, 3], [1, 3, 1]], [-2.0, -3, -1]),
    # K. G. Murty, Linear Complementarity (1988), example 2.10: Lemke's method ends in a ray, yet z = (2, 4)
    Known("Murty's ray with a solution", [[-1.5, 2], [-4, 4]], [-5.0, 17]),
    Known("two solutions", [[-1.0, 0], [0, 1]], [1.0, -1]),
    # ties: all b alike, and degenerate answers
    Known("all alike", np.eye(5) + 1.0, -np.ones(5), np.ones(5) / 6),
    Known("degenerate", [[1.0, 1, 0], [1, 1, 0], [0, 0, 1]], [-1.0, -1, 0]),
    Known("zero b", [[0.0, 1], [1, 0]], [0.0, 0]),
    Known("zero W", np.zeros((2, 2)), [0.0, 3], [0.0, 0]),
    Known("mass ratio 1e8", [[1 + 1e8, -1e8, 0], [-1e8, 2e8, -1e8], [0, -1e8, 1e8 + 1]], [-1.0, -2, 1]),
]

INFEASIBLE = [
    Known("negative number", [[-1.0]], [-1.0]),
    Known("zero number", [[0.0]], [-1.0]),
    Known("one pushes on nothing", [[1.0, -1], [-1, 1]], [-1.0, -1]),
    Known("negative identity", -np.eye(4), [1.0, -1, 1, 1]),
    Known("skew, no feasible point", [[0.0, -1], [1, 0]], [-1.0, 1]),
    Known("duplicated contact, contradictory", np.ones((3, 3)) * -1.0, [-1.0, -2, 3]),
    Known("rank one", np.outer([1.0, 2, -3, 0], [1, 2, -3, 0]), [1.0, 1, 1, -1]),
]


def nilpotent(n: int) -> Known:
    """Feasible, no solution: row 0 needs z_1 > 0, but w_1 = 1 always. Cottle, Pang, Stone (1992), section 3.1."""
    W, b = np.eye(n), np.ones(n)
    W[0, 0], W[0, 1], W[1, 1], b[0] = 0.0, 1.0, 0.0, -1.0
    return Known(f"nilpotent in {n}", W, b)


UNSOLVABLE = [nilpotent(2), nilpotent(3), nilpotent(12)]
