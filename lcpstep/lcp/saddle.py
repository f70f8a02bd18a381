"""Complementarity problems whose matrix is a product with an inverse, W = G A^-1 G^T, without forming it:

    A x = r + G^T z,    w = G x + c,    0 <= z  complementary to  w >= 0

A (n, n) is sparse and positive definite (symmetric or not), G (m, n) sparse. W would be dense wherever A^-1 is, and
loses digits that A and G still have; here all factors are of the matrix

    [ A   -G_a^T ]
    [ G_a   D    ]

of the rows a with z > 0 and a small proximal diagonal D, which has factors for redundant rows too. A solution is
found as in `newton`: exchanges of the set a from a guess, and where they do not settle an interior point, whose
matrix has D = w / z on all rows. Residuals are formed from A, G, r and c, never from W.

Where A falls into blocks, as for bodies that only contacts connect, what no row with w < 0 reaches is left out of all
this: it moves by x = A^-1 r (`part`). The vectors of what is left are worked on by kernels (`attempt`).

Sources: M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865; S. J. Wright, Primal-Dual Interior-Point
Methods (1997), chapter 8; M. Benzi, G. H. Golub, J. Liesen, Acta Numerica 14 (2005) 1, sections 3 and 8.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from lcpstep.lcp.attempt import Attempt
from lcpstep.lcp.factor import Singular, Solve, banded, factoriser, narrow_order
from lcpstep.lcp.interior import BACK_OFF, SMALLEST, STEPS, longest
from lcpstep.lcp.newton import PATIENCE, PROXIMAL
from lcpstep.lcp.part import Part
from lcpstep.lcp.sparse_rows import SparseRows
from lcpstep.lcp.status import TOLERANCE

PENALTY = (1e-11, 1e-9)  # d where x is found first: its rounding and its error fall alike in a refinement
REFINEMENTS = 50  # at most; each at least halves the error, or is the last
REFINED = 4e-16  # relative residual below which another refinement is idle


@dataclass(frozen=True, eq=False)
class Problem:
    """Right-hand sides r (n,) and c (m,); c_size (m,): the size of the terms that c is a sum of; rows (m,): those
    whose z may be positive. The others have z = 0, whatever their w. free (n,): A^-1 r, if it is known.
    """

    r: Any
    c: Any
    c_size: Any
    rows: Any
    free: Any = None


class Point(NamedTuple):
    """Solution or attempt: x (n,), z (m,), and its relative residual."""

    x: Any
    z: Any
    residual: float

    @property
    def solved(self) -> bool:
        """Whether the relative residual is at most that which `solve_lcp` calls solved."""
        return self.residual <= TOLERANCE


class Saddle:
    """The matrices A and G, and the part of the last problem, factorised for the rows that were chosen last."""

    def __init__(self, A: Any, G: Any) -> None:
        from scipy.sparse import block_array, csr_array
        from scipy.sparse.csgraph import connected_components

        self.A, self.G = csr_array(A), csr_array(G)
        self.m, self.n = self.G.shape
        G_T = self.G.T.tocsr()
        self.A_rows, self.G_rows, self.G_columns = SparseRows(self.A), SparseRows(self.G), SparseRows(G_T)
        self.diagonal = np.abs(self.A.diagonal())
        self.diagonal[self.diagonal == 0.0] = 1.0
        mobility = self.G.power(2) @ (1.0 / self.diagonal)
        mobility[mobility == 0.0] = 1.0
        K = block_array([[self.A, -G_T], [self.G, None]], format="csr") if self.m else self.A
        K.sort_indices()
        order, self.half_bandwidth = narrow_order(K)
        self.narrow = order is not None
        self.proximal = PROXIMAL if self.narrow else PENALTY
        n_blocks, block = connected_components(self.A, directed=False)
        self.of_blocks = self.A.diagonal() if n_blocks == self.n else None  # all there is of blocks of one
        order = order if self.narrow else np.arange(self.n + self.m)
        self.part = Part(self.A_rows, self.G_rows, self.G_columns, block, order)
        self.attempt = Attempt(self.part, self.diagonal, mobility)
        self.systems = 0
        self.kept: tuple[bytes, float, Solve] | None = None

    def solve(self, problem: Problem, chosen: Any, z: Any) -> Point:
        """The solution; chosen (m,): rows whose z may well be positive, z (m,): a guess of it."""
        with np.errstate(all="ignore"):  # a diverging attempt may overflow; its residual tells
            free = self.free(problem.r) if problem.free is None else problem.free
            if self.part.choose(problem.rows.view(np.uint8), self.G_rows.times(free) + problem.c):
                self.kept = None
            point = Point(np.array(free), np.zeros(self.m), 0.0)
            if self.part.m > 0:
                x, z, residual = self.solve_part(problem, free, chosen, z)
                point.x[self.coordinates], point.z[self.rows] = x, z
                point = point._replace(residual=residual)
            return point if np.isfinite(point.x).all() else point._replace(residual=np.inf)

    def free(self, r: Any) -> Any:
        """A^-1 r; not a number where A is singular."""
        if self.of_blocks is not None:
            return r / self.of_blocks
        try:
            x = self.A_solve(r)
        except Singular:
            return np.full(self.n, np.nan)
        return x + self.A_solve(r - self.A_rows.times(x))

    @functools.cached_property
    def A_solve(self) -> Solve:
        """Solver for A alone."""
        return factoriser(self.A).factor(np.ones(self.n, dtype=bool), np.zeros(self.n))

    @property
    def coordinates(self) -> Any:
        """Those of the part."""
        return self.part.lists["coordinates"][: self.part.n]

    @property
    def mobility(self) -> Any:
        """Sizes of the diagonal of W in the part."""
        return self.attempt.arrays["mobility"][: self.part.m]

    @property
    def rows(self) -> Any:
        """Those of the part."""
        return self.part.lists["rows"][: self.part.m]

    def solve_part(self, problem: Problem, free: Any, chosen: Any, z: Any) -> Point:
        """The solution of the part."""
        a, rows = self.attempt, self.rows
        a.pose(problem.r, problem.c, problem.c_size)
        point = self.exchange(chosen[rows], z[rows], self.proximal[0])
        if point.solved:
            return point
        try:
            z, positive = self.interior_point(free[self.coordinates])
        except Singular:  # A itself
            return point
        candidates = [point] + [self.exchange(positive, z, d) for d in self.proximal]
        return min(candidates, key=lambda p: p.residual)

    def exchange(self, chosen: Any, z: Any, proximal: float) -> Point:
        """Exchange rows, from those chosen, until z and w have the right signs or no headway is made."""
        a, n, m = self.attempt, self.part.n, self.part.m
        marks, numbers = a.marks[:m], a.arrays
        marks[:] = chosen
        fewest, patience, best = m + 1, PATIENCE, Point(np.zeros(n), np.zeros(m), np.inf)
        while patience >= 0 and fewest > 0:
            try:
                solve = self.factor(marks, proximal)
            except Singular:
                break
            numbers["z"][:m] = z
            self.settle(solve)
            if a.residual < best.residual:
                best = Point(numbers["x"][:n].copy(), numbers["z"][:m].copy(), a.residual)
            wrong = a.exchange()
            patience = PATIENCE if wrong < fewest else patience - 1
            fewest = min(fewest, wrong)
        return best

    def factor(self, chosen: Any, proximal: float) -> Solve:
        """Solver for the rows chosen; the one used last is kept."""
        key = chosen.tobytes()
        if self.kept is None or self.kept[:2] != (key, proximal):
            self.kept = (
                key,
                proximal,
                self.with_diagonal(chosen, proximal * self.attempt.arrays["mobility"]),
            )
        return self.kept[2]

    def with_diagonal(self, chosen: Any, d: Any) -> Solve:
        """Factors of the matrix with the rows chosen and d on its diagonal."""
        self.systems += 1
        if not self.narrow:
            return penalised(self.part, chosen, d)
        k = self.half_bandwidth
        storage = np.zeros((self.part.n + self.part.m, 3 * k + 1))
        self.part.fill(chosen, d, k, storage)
        return banded(storage, k)

    def settle(self, solve: Solve) -> None:
        """Proximal steps towards A x = r + G^T z and, on the rows chosen, G x + c = 0, down to rounding."""
        a, before = self.attempt, np.inf
        defect = a.arrays["defect"][: self.part.n + self.part.m]
        a.begin()
        for _ in range(REFINEMENTS):
            error = a.change(solve(defect))
            if not REFINED < error < 0.5 * before:
                break
            before = error
        a.judge()

    def interior_point(self, x: Any) -> tuple[Any, Any]:
        """Approximate z by Mehrotra's predictor and corrector, and the rows where it outweighs w; see `interior`.

        x : the answer without rows
        """
        a, lists, n, m = self.attempt, self.part.lists, self.part.n, self.part.m
        at_x, at_w, rows = lists["x_place"][:n], lists["w_place"][:m], np.ones(m, dtype=np.uint8)
        root, rhs = np.sqrt(self.mobility), np.zeros(n + m)
        a.put(x, np.zeros(m))
        level = float(np.max(np.abs(a.arrays["w"][:m]) / root)) or 1.0
        if not np.isfinite(level):
            raise Singular
        z, w = level / root, level * root
        for _ in range(STEPS):
            size, mu = a.put(x, z), float(z @ w) / m
            defect_x, defect = a.arrays["defect"][at_x], a.arrays["w"][:m] - w
            if mu <= SMALLEST * level**2 and np.max(np.abs(defect)) <= SMALLEST * size:
                break
            ratio = w / z
            try:
                solve = self.with_diagonal(rows, ratio)
            except Singular:
                break
            rhs[at_x], rhs[at_w] = defect_x, -defect - w
            dz = solve(rhs)[at_w]
            dw = -w - ratio * dz
            reach = min(longest(z, dz), longest(w, dw))
            ahead = float((z + reach * dz) @ (w + reach * dw))
            centre = (ahead / (m * mu)) ** 3
            target = (centre * mu - dz * dw) / z
            rhs[at_x], rhs[at_w] = defect_x, target - w - defect
            change = solve(rhs)
            dx, dz = change[at_x], change[at_w]
            dw = target - w - ratio * dz
            reach = min(1.0, BACK_OFF * min(longest(z, dz, 2.0), longest(w, dw, 2.0)))
            if not reach > 0.0 or not np.isfinite(change).all():
                break
            x, z, w = x + reach * dx, z + reach * dz, w + reach * dw
        return z, z * root > w / root


def penalised(part: Part, chosen: Any, d: Any) -> Solve:
    """Solver for a graph without a narrow band: x from A + G_a^T D^-1 G_a, which needs no exchange of rows.

    A matrix with zeros on its diagonal would need them, and fill in.
    """
    from scipy.sparse import diags_array
    from scipy.sparse.linalg import splu

    n, m, rows = part.n, part.m, np.flatnonzero(chosen)
    inverse, G = 1.0 / d[rows], part.G.matrix(m, n)[rows]
    H = (part.A.matrix(n, n) + G.T @ diags_array(inverse) @ G).tocsc()
    mode = {"SymmetricMode": True}
    try:
        lu = splu(H, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=mode)
    except RuntimeError:
        raise Singular from None

    def solve(rhs: Any) -> Any:
        rhs_x, rhs_w = rhs[:n], rhs[n:][rows]
        x = lu.solve(rhs_x + G.T @ (inverse * rhs_w))
        z = np.zeros(m)
        z[rows] = inverse * (rhs_w - G @ x)
        return np.concatenate([x, z])

    return solve
