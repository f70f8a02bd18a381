"""Complementarity problems whose matrix is a product with an inverse, W = G A^-1 G^T, without forming it:

    A x = r + G^T z,    w = G x + c,    0 <= z  complementary to  w >= 0

A (n, n) is sparse and positive definite (symmetric or not), G (m, n) sparse. W would be dense wherever A^-1 is, and
loses digits that A and G still have; here all factors are of the matrix

    [ A   -G_a^T ]
    [ G_a   D    ]

of the rows a with z > 0 and a small proximal diagonal D, which has factors for redundant rows too. A solution is
found as in `newton`: exchanges of the set a from a guess, and where they do not settle an interior point, whose
matrix has D = w / z on all rows. Residuals are formed from A, G, r and c, never from W.

Sources: M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865; S. J. Wright, Primal-Dual Interior-Point
Methods (1997), chapter 8; M. Benzi, G. H. Golub, J. Liesen, Acta Numerica 14 (2005) 1, sections 3 and 8.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from lcpstep.lcp.factor import Factoriser, General, Singular, Solve, factoriser
from lcpstep.lcp.interior import BACK_OFF, SMALLEST, STEPS, longest
from lcpstep.lcp.newton import PATIENCE, PROXIMAL, REFINEMENTS, STRICT
from lcpstep.lcp.status import TOLERANCE

PENALTY = (1e-11, 1e-9)  # d where x is found first: its rounding and its error fall alike in a refinement
ROUNDING = 4 * 2.2e-16  # of the terms that x is what they leave
NOTHING = 1e-20  # of the largest terms: as small as what proximal steps leave of a z that is zero
REFINED = 4e-16  # relative residual below which another refinement is idle


@dataclass(frozen=True, eq=False)
class Problem:
    """Right-hand sides r (n,) and c (m,); c_size (m,): the size of the terms that c is a sum of; rows (m,): those
    whose z may be positive. The others have z = 0, whatever their w.
    """

    r: Any
    c: Any
    c_size: Any
    rows: Any


class Point(NamedTuple):
    """Solution or attempt: x (n,), z and w (m,), the size of the terms of A x - r - G^T z and of w, its residual."""

    x: Any
    z: Any
    w: Any
    size_x: Any
    size_w: Any
    residual: float

    @property
    def solved(self) -> bool:
        """Whether the relative residual is at most that which `solve_lcp` calls solved."""
        return self.residual <= TOLERANCE


class Saddle:
    """The matrices A and G, factorised for one set of rows after another; the last factors are kept."""

    def __init__(self, A: Any, G: Any) -> None:
        from scipy.sparse import block_array, csr_array

        self.A, self.G = csr_array(A), csr_array(G)
        self.m, self.n = self.G.shape
        self.G_T = self.G.T.tocsr()
        self.abs_A, self.abs_G, self.abs_G_T = abs(self.A), abs(self.G), abs(self.G_T)
        self.diagonal = np.abs(self.A.diagonal())
        self.diagonal[self.diagonal == 0.0] = 1.0
        self.W_scale = self.G.power(2) @ (1.0 / self.diagonal)  # sizes of the diagonal of W
        self.W_scale[self.W_scale == 0.0] = 1.0
        K = block_array([[self.A, -self.G_T], [self.G, None]], format="csr") if self.m else self.A
        K.sort_indices()
        narrow = factoriser(K)
        self.factors: Factoriser = Penalised(self) if isinstance(narrow, General) else narrow
        self.proximal = PENALTY if isinstance(narrow, General) else PROXIMAL
        self.systems = 0
        self.kept: tuple[bytes, float, Solve] | None = None

    def solve(self, problem: Problem, chosen: Any, z: Any) -> Point:
        """The solution; chosen (m,): rows whose z may well be positive, z (m,): a guess of it."""
        with np.errstate(all="ignore"):  # a diverging attempt may overflow; its residual tells
            point = self.exchange(problem, chosen & problem.rows, z, self.proximal[0])
            if point.solved or not problem.rows.any():
                return point
            try:
                z, positive = self.interior_point(problem)
            except Singular:  # A itself
                return point
            candidates = [point] + [self.exchange(problem, positive, z, d) for d in self.proximal]
        return min(candidates, key=lambda p: p.residual)

    def exchange(self, problem: Problem, chosen: Any, z: Any, proximal: float) -> Point:
        """Exchange rows, from those chosen, until z and w have the right signs or no headway is made."""
        fewest, patience, best = self.m + 1, PATIENCE, None
        while patience >= 0 and fewest > 0:
            try:
                solve = self.factor(chosen, proximal)
            except Singular:
                break
            point = self.settle(problem, chosen, np.where(chosen, z, 0.0), solve)
            best = point if best is None or point.residual < best.residual else best
            leaves = chosen & (point.z < 0.0)
            if leaves.any():
                leaves &= self.shares(point) > STRICT
            enters = problem.rows & ~chosen & (point.w < -STRICT * point.size_w)
            wrong = int(np.count_nonzero(leaves) + np.count_nonzero(enters))
            patience = PATIENCE if wrong < fewest else patience - 1
            fewest = min(fewest, wrong)
            chosen = (chosen & ~leaves) | enters
        return best or self.judged(problem, np.zeros(self.n), np.zeros(self.m))

    def factor(self, chosen: Any, proximal: float) -> Solve:
        """Solver for the rows chosen; the one used last is kept."""
        key = np.packbits(chosen).tobytes()
        if self.kept is None or self.kept[:2] != (key, proximal):
            d = np.concatenate([np.zeros(self.n), proximal * self.W_scale])
            self.kept = (key, proximal, self.with_diagonal(chosen, d))
        return self.kept[2]

    def with_diagonal(self, chosen: Any, d: Any) -> Solve:
        """Factors of the matrix with the rows chosen and d on its diagonal."""
        self.systems += 1
        return self.factors.factor(np.concatenate([np.ones(self.n, dtype=bool), chosen]), d)

    def settle(self, problem: Problem, chosen: Any, z: Any, solve: Solve) -> Point:
        """Proximal steps towards A x = r + G^T z and, on the rows chosen, G x + c = 0, down to rounding."""
        x, before, scale = np.zeros(self.n), np.inf, 0.0
        defect_x, defect_w = problem.r + self.G_T @ z, np.where(chosen, -problem.c, 0.0)
        for _ in range(REFINEMENTS):
            change = solve(np.concatenate([defect_x, defect_w]))
            x, z = x + change[: self.n], z + change[self.n :]
            defect_x = problem.r + self.G_T @ z - self.A @ x
            defect_w = np.where(chosen, -(self.G @ x + problem.c), 0.0)
            size_x, size_w = self.sizes(problem, x, z)
            # of the first answer: x may be nothing but rounding in the end
            scale = scale or float(np.max(size_w, initial=0.0)) or 1.0
            error = max(largest(defect_x, size_x), float(np.max(np.abs(defect_w), initial=0.0)) / scale)
            if not REFINED < error < 0.5 * before:
                break
            before = error
        return self.judged(problem, x, z)

    def sizes(self, problem: Problem, x: Any, z: Any) -> tuple[Any, Any]:
        """Sizes of the terms that each row of the two equations is a sum of."""
        size_x = np.abs(problem.r) + self.abs_A @ np.abs(x) + self.abs_G_T @ np.abs(z)
        size_x = np.maximum(size_x, NOTHING * np.max(size_x))  # tails of a wave end in denormal numbers
        return size_x, self.abs_G @ np.abs(x) + problem.c_size

    def judged(self, problem: Problem, x: Any, z: Any) -> Point:
        """The point with its relative residual. What the rounding of x makes of w counts as zero."""
        size_x, size_w = self.sizes(problem, x, z)
        w = self.G @ x + problem.c
        rounding = ROUNDING * (self.abs_G @ (size_x / self.diagonal))
        w = np.sign(w) * np.maximum(np.abs(w) - rounding, 0.0)
        raw = Point(x, z, w, size_x, np.where(size_w > 0.0, size_w, 1.0), np.inf)
        if not (np.all(np.isfinite(size_x)) and np.all(np.isfinite(size_w))):
            return raw
        share, relative = self.shares(raw), w / raw.size_w
        defect = largest(problem.r + self.G_T @ z - self.A @ x, size_x)
        violation = np.where(z < 0.0, share, np.minimum(share, np.abs(relative)))
        violation = np.where(problem.rows, np.maximum(violation, -relative), 0.0)
        residual = max(defect, float(np.max(violation, initial=0.0)))
        return raw._replace(residual=residual)

    def shares(self, point: Point) -> Any:
        """Largest part that each |z| has in a row of A x = r + G^T z."""
        inverse = np.divide(1.0, point.size_x, out=np.zeros(self.n), where=point.size_x > 0.0)
        weighted = np.append(self.abs_G.data * inverse[self.abs_G.indices], 0.0)
        felt = np.maximum.reduceat(weighted, self.abs_G.indptr[:-1]) if self.m else np.zeros(0)
        return np.where(np.diff(self.abs_G.indptr) > 0, felt, 1.0) * np.abs(point.z)

    def interior_point(self, problem: Problem) -> tuple[Any, Any]:
        """Approximate z by Mehrotra's predictor and corrector, and the rows where it outweighs w; see `interior`."""
        rows = problem.rows
        chosen, count = np.flatnonzero(rows), np.count_nonzero(rows)
        x = self.factor(np.zeros(self.m, dtype=bool), self.proximal[0])(
            np.concatenate([problem.r, np.zeros(self.m)])
        )[: self.n]
        root = np.sqrt(self.W_scale)
        level = float(np.max(np.abs(self.G @ x + problem.c)[rows] / root[rows])) or 1.0
        z, w = np.where(rows, level / root, 0.0), np.where(rows, level * root, 1.0)
        for _ in range(STEPS):
            mu = float(z[chosen] @ w[chosen]) / count
            defect_x = problem.r + self.G_T @ z - self.A @ x
            defect = np.where(rows, self.G @ x + problem.c - w, 0.0)
            size_x, size_w = self.sizes(problem, x, z)
            size = np.max(size_w + self.abs_G @ (size_x / self.diagonal))
            if mu <= SMALLEST * level**2 and np.max(np.abs(defect)) <= SMALLEST * size:
                break
            ratio = w / np.where(rows, z, 1.0)
            try:
                solve = self.with_diagonal(rows, np.concatenate([np.zeros(self.n), ratio]))
            except Singular:
                break
            dz = solve(np.concatenate([defect_x, np.where(rows, -defect - w, 0.0)]))[self.n :]
            dw = -w - ratio * dz
            reach = min(longest(z[chosen], dz[chosen]), longest(w[chosen], dw[chosen]))
            ahead = float((z + reach * dz)[chosen] @ (w + reach * dw)[chosen])
            centre = (ahead / (count * mu)) ** 3
            target = (centre * mu - dz * dw) / np.where(rows, z, 1.0)
            change = solve(np.concatenate([defect_x, np.where(rows, target - w - defect, 0.0)]))
            dx, dz = change[: self.n], change[self.n :]
            dw = target - w - ratio * dz
            reach = min(
                1.0, BACK_OFF * min(longest(z[chosen], dz[chosen], 2.0), longest(w[chosen], dw[chosen], 2.0))
            )
            if not reach > 0.0 or not np.isfinite(change).all():
                break
            x, z = x + reach * dx, z + reach * dz
            w = np.where(rows, w + reach * dw, 1.0)
        return z, rows & (z * root > w / root)


class Penalised:
    """Factors for a graph without a narrow band: x from A + G_a^T D^-1 G_a, which needs no exchange of rows.

    A matrix with zeros on its diagonal would need them, and fill in.
    """

    def __init__(self, saddle: Saddle) -> None:
        self.saddle = saddle

    def factor(self, active: Any, d: Any) -> Solve:
        """See Factoriser."""
        from scipy.sparse import diags_array
        from scipy.sparse.linalg import splu

        s, chosen = self.saddle, np.flatnonzero(active[self.saddle.n :])
        inverse, G = 1.0 / d[s.n :][chosen], s.G[chosen]
        H = (s.A + G.T @ diags_array(inverse) @ G).tocsc()
        mode = {"SymmetricMode": True}
        try:
            lu = splu(H, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=mode)
        except RuntimeError:
            raise Singular from None

        def solve(rhs: Any) -> Any:
            rhs_x, rhs_w = rhs[: s.n], rhs[s.n :][chosen]
            x = lu.solve(rhs_x + G.T @ (inverse * rhs_w))
            z = np.zeros(s.m)
            z[chosen] = inverse * (rhs_w - G @ x)
            return np.concatenate([x, z])

        return solve


def largest(defect: Any, size: Any) -> float:
    """The largest defect next to the size of its row's terms."""
    return float(np.max(np.abs(defect) / np.where(size > 0.0, size, 1.0), initial=0.0))
