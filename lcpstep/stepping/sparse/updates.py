"""Lines of a path in `path` for modes that change a contact at a time, from few factorisations.

The matrix B of the modes at hand differs in k rows, E, from the matrix B_0 that was factorised last, so

    u = u_0 + Z a,     Z = B_0^-1 E,     S a = (r - B u_0)_E,     S = (B Z)_E  of k rows and columns:

one more column of Z for a row that has not changed before, and a small dense system. Impulses and rates of all
contacts are linear in u; they alone are kept of u_0 and Z.

Source: A. Bjorck, Numerical Methods in Matrix Computations (Springer 2015), section 3.3.4 (Woodbury's formula).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lcpstep.lcp.factor import Singular

if TYPE_CHECKING:
    from lcpstep.stepping.sparse.path import Path

MOST = 48  # rows changed before the matrix is factorised anew
DRIFT = 1e-9  # relative: by how much lines may miss the point at which the modes have changed


class Lines:
    """Shifted impulses p and rates of the contacts' rows, (2, 2 n_c): at tau = 0, and what they change by with tau.

    rows     that have changed since the matrix was factorised;  Z_p, Z_rates : (MOST, 2 n_c)   of their columns
    """

    def __init__(self, path: Path) -> None:
        self.path, n_c = path, path.coupled.n_c
        self.Z_p, self.Z_rates = np.empty((2, MOST, 2 * n_c))
        self.factored: Any = None

    def at(self, tau: float, changed: int) -> tuple[Any, Any]:
        """The lines after the contact `changed` has got another mode at tau."""
        if self.factored is not None:
            n_c = self.path.coupled.n_c
            self.rows += [
                row for row in (changed, changed + n_c) if self.differs(row) and row not in self.rows
            ]
            if len(self.rows) <= MOST and self.updated(tau):
                return self.now
        return self.anew()

    def anew(self) -> tuple[Any, Any]:
        """The lines from new factors."""
        path = self.path
        p, rates = path.lines()
        self.rows: list[int] = []
        self.solved = 0
        self.factored = path.kinds(), path.coupled.factor(path.problem, path.modes)
        self.start = self.now = p[:, path.coupled.n_j :], rates[:, path.coupled.n_j :]
        return self.now

    def differs(self, row: int) -> bool:
        """Whether a row is another than in the matrix factorised."""
        (held, slide), (held_0, slide_0) = self.path.kinds(), self.factored[0]
        return bool(held[row] != held_0[row] or slide[row] != slide_0[row])

    def updated(self, tau: float) -> bool:
        """Whether the factors at hand give lines that go on where those before have ended."""
        self.solve_columns()
        rows, k = np.array(self.rows, dtype=np.intp), len(self.rows)
        held, slide = (kind[rows] for kind in self.path.kinds())
        carrier = rows % self.path.coupled.n_c
        (p_0, rates_0), (p_1, _) = self.start, self.now

        def left(p: Any, rates: Any) -> Any:
            return np.where(held, rates[:, rows], p[:, rows] + slide * p[:, carrier])

        try:
            a = np.linalg.solve(left(self.Z_p[:k], self.Z_rates[:k]).T, -left(p_0, rates_0).T).T
        except np.linalg.LinAlgError:
            return False
        self.now = p_0 + a @ self.Z_p[:k], rates_0 + a @ self.Z_rates[:k]
        before, after = (p[0] + tau * p[1] for p in (p_1, self.now[0]))
        return bool(np.max(np.abs(after - before)) <= DRIFT * np.max(np.abs(before)))

    def solve_columns(self) -> None:
        """Columns of Z for the rows that have none yet."""
        c, new = self.path.coupled, self.rows[self.solved :]
        if not new:
            return
        n, solve = c.n_q, self.factored[1]
        unit = np.zeros((n + c.n_r, len(new)))
        unit[n + c.n_j + np.array(new), np.arange(len(new))] = 1.0
        z = solve(unit)
        if not np.all(np.isfinite(z)):
            raise Singular
        rates, p = c.R @ z[:n] + c.proximal[:, None] * z[n:], z[n:]
        at = slice(self.solved, len(self.rows))
        self.Z_p[at], self.Z_rates[at] = p[c.n_j :].T, rates[c.n_j :].T
        self.solved = len(self.rows)
