"""The problems of the comparison: families that are known to be solvable, in several sizes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np


class Problem(NamedTuple):
    """W, b and where they are from; `symmetric` says that a quadratic programme may be tried."""

    family: str
    size: int  # as asked for; the friction problems have the next smaller multiple of 6 unknowns
    n: int
    W: Any
    b: Any
    symmetric: bool


def planted(W: Any, rng: Any) -> Any:
    """The b for which a random z, about half of it zero, is a solution."""
    n = len(W)
    z = np.maximum(rng.normal(size=n), 0.0)
    w = np.where(z > 0.0, 0.0, np.maximum(rng.normal(size=n), 0.0))
    return w - W @ z


def positive_definite(n: int, rng: Any) -> tuple[Any, Any]:
    G = rng.normal(size=(n, n))
    W = G @ G.T
    return W, planted(W, rng)


def rank_deficient(n: int, rng: Any) -> tuple[Any, Any]:
    """More contacts than degrees of freedom."""
    G = rng.normal(size=(n, (n + 1) // 2))
    W = G @ G.T
    return W, planted(W, rng)


def duplicated(n: int, rng: Any) -> tuple[Any, Any]:
    """Every contact about three times."""
    G = rng.normal(size=((n + 2) // 3, n))[rng.integers(0, (n + 2) // 3, n)]
    W = G @ G.T
    return W, planted(W, rng)


def nearly_parallel(n: int, rng: Any) -> tuple[Any, Any]:
    """Pairs of contacts whose normals differ by 1e-5."""
    G = np.repeat(rng.normal(size=((n + 1) // 2, n)), 2, axis=0)[:n] + 1e-5 * rng.normal(size=(n, n))
    W = G @ G.T
    return W, planted(W, rng)


def mass_ratio(n: int, rng: Any) -> tuple[Any, Any]:
    """Chain of beads with masses from 1e-4 to 1e4, all touching, thrown together."""
    inverse = 10.0 ** rng.uniform(-4, 4, n + 1)
    W = np.diag(inverse[:-1] + inverse[1:]) - np.diag(inverse[1:-1], 1) - np.diag(inverse[1:-1], -1)
    return W, np.diff(rng.normal(size=n + 1))


def column_at_rest(n: int, rng: Any) -> tuple[Any, Any]:
    """Column of equal beads on the ground: gravity closes the lowest gap only, the others are tied at zero."""
    W = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    W[0, 0] = 1.0
    b = np.zeros(n)
    b[0] = -1e-3
    return W, b


def friction(n: int, rng: Any) -> tuple[Any, Any]:
    """Coulomb friction by a pyramid of four sides (D. E. Stewart, J. C. Trinkle, IJNME 39 (1996) 2673)."""
    contacts = max(n // 6, 1)
    dof = max(3, 2 * contacts)
    normal = rng.normal(size=(contacts, dof))
    t, s = rng.normal(size=(contacts, dof)), rng.normal(size=(contacts, dof))
    tangent = np.stack((t, s, -t, -s), axis=1).reshape(4 * contacts, dof)
    sides = np.kron(np.eye(contacts), np.ones((4, 1)))
    J = np.vstack((normal, tangent))
    m = 6 * contacts
    W = np.zeros((m, m))
    W[: 5 * contacts, : 5 * contacts] = J @ J.T
    W[contacts : 5 * contacts, 5 * contacts :] = sides
    W[5 * contacts :, :contacts] = 0.5 * np.eye(contacts)
    W[5 * contacts :, contacts : 5 * contacts] = -sides.T
    return W, np.concatenate((J @ rng.normal(size=dof), np.zeros(contacts)))


def nonsymmetric(n: int, rng: Any) -> tuple[Any, Any]:
    """Positive definite but not symmetric."""
    W, _ = positive_definite(n, rng)
    A = rng.normal(size=(n, n)) * np.sqrt(n)
    W = W + A - A.T
    return W, planted(W, rng)


def z_matrix(n: int, rng: Any) -> tuple[Any, Any]:
    """Nonpositive off the diagonal, and diagonally dominant."""
    W = -rng.uniform(size=(n, n)) * (rng.uniform(size=(n, n)) < 0.2)
    np.fill_diagonal(W, 0.0)
    np.fill_diagonal(W, -W.sum(axis=1) + 0.1)
    return W, rng.normal(size=n)


def linear_programme(n: int, rng: Any) -> tuple[Any, Any]:
    """Optimality of a linear programme: W is skew."""
    rows = max(n // 2, 1)
    A = rng.normal(size=(rows, max(n - rows, 1)))
    x, y = np.maximum(rng.normal(size=A.shape[1]), 0.0), np.maximum(rng.normal(size=rows), 0.0)
    slack = np.where(y > 0, 0.0, rng.uniform(size=rows))
    cost = np.where(x > 0, 0.0, rng.uniform(size=A.shape[1])) + A.T @ y
    m = sum(A.shape)
    W = np.zeros((m, m))
    W[: A.shape[1], A.shape[1] :], W[A.shape[1] :, : A.shape[1]] = -A.T, A
    return W, np.concatenate((cost, slack - A @ x))


def game(n: int, rng: Any) -> tuple[Any, Any]:
    """Equilibria of a bimatrix game with positive costs (C. E. Lemke, J. T. Howson, SIAM J. 12 (1964) 413)."""
    k = max(n // 2, 1)
    W = np.zeros((2 * k, 2 * k))
    W[:k, k:], W[k:, :k] = rng.uniform(1, 2, (k, k)), rng.uniform(1, 2, (k, k))
    return W, -np.ones(2 * k)


def hilbert(n: int, rng: Any) -> tuple[Any, Any]:
    """Condition number 1e13 at n = 10, beyond rounding at 14."""
    i = np.arange(n)
    W = 1.0 / (i[:, None] + i + 1.0)
    return W, planted(W, rng)


def fathi(n: int, rng: Any) -> tuple[Any, Any]:
    """Exponentially many pivots for some rules (Y. Fathi, Math. Programming 17 (1979) 335)."""
    L = np.tril(2.0 * np.ones((n, n)), -1) + np.eye(n)
    return L @ L.T, -np.ones(n)


def murty(n: int, rng: Any) -> tuple[Any, Any]:
    """Exponentially many pivots for some rules (K. G. Murty, Math. Programming Study 7 (1978) 61)."""
    W = np.tril(2.0 * np.ones((n, n)), -1) + np.eye(n)
    return W, -np.cumsum(2.0 ** np.arange(n, 0, -1))


def wide_range(n: int, rng: Any) -> tuple[Any, Any]:
    """Positive definite, rows and columns in units from 1e-12 to 1e12."""
    W, b = positive_definite(n, rng)
    rows, columns = 10.0 ** rng.uniform(-12, 12, n), 10.0 ** rng.uniform(-12, 12, n)
    return rows[:, None] * W * columns, rows * b


Maker = Callable[[int, Any], tuple[Any, Any]]
FAMILIES: dict[str, tuple[Maker, bool, int]] = {  # maker, symmetric semidefinite, largest n
    "positive definite": (positive_definite, True, 500),
    "rank deficient": (rank_deficient, True, 500),
    "duplicated": (duplicated, True, 500),
    "nearly parallel": (nearly_parallel, True, 500),
    "mass ratio 1e8": (mass_ratio, True, 500),
    "column at rest": (column_at_rest, True, 500),
    "friction": (friction, False, 500),
    "nonsymmetric": (nonsymmetric, False, 500),
    "Z-matrix": (z_matrix, False, 500),
    "linear programme": (linear_programme, False, 500),
    "bimatrix game": (game, False, 100),
    "Hilbert": (hilbert, True, 10),
    "Fathi": (fathi, True, 100),
    "Murty": (murty, False, 30),
    "units 1e-12 to 1e12": (wide_range, False, 500),
}


def problems(sizes: tuple[int, ...], repeats: int, seed: int = 1) -> Iterator[Problem]:
    """All families in all sizes that make sense, each from its own random numbers."""
    for number, (family, (make, symmetric, largest)) in enumerate(FAMILIES.items()):
        for n in sizes:
            for repeat in range(repeats if n <= largest else 0):
                W, b = make(n, np.random.default_rng((seed, number, n, repeat)))
                yield Problem(family, n, len(b), W, b, symmetric)
