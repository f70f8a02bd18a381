"""Contacts with friction and joints of a large sparse system: their impulses in one step, W never formed.

    A x = G^T p_N + T^T p_T + D^T p_J,        J x + b_J = 0
    0 <= G x + b_N  complementary to  p_N >= 0,      p_T = -mu p_N sign(T x + b_T)

A contact is open, sticks, or slides either way; for given modes all this is one sparse linear system,

    [ A   -D^T  -G^T  -T^T ]        J, and the rows of G of closed contacts and of T of those that stick, have a small
    [ J    d               ]        proximal diagonal d, which has factors for rows that say the same thing twice too;
    [ G          d         ]        refinement takes its effect away
    [ T        mu s    d   ]        rows of other impulses say what they are: p_N = 0, or p_T + s mu p_N = 0

solved by refinement down to rounding. Contacts whose answer does not fit their mode change it, all together as long
as that makes headway; then those that are in doubt get their modes by Lemke's method, from a small dense problem in
which the others keep theirs. The answer is judged by its residuals before it is accepted.

Sources: P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353; M. Hintermueller, K. Ito, K. Kunisch,
SIAM J. Optim. 13 (2003) 865; `kernels.coulomb` for the law and its linear complementarity problem.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from lcpstep.lcp import solve_lcp
from lcpstep.lcp.factor import Patterned, Singular, Solve
from lcpstep.lcp.newton import PATIENCE, STRICT
from lcpstep.lcp.saddle import NOTHING, REFINED, ROUNDING
from lcpstep.lcp.status import TOLERANCE

OPEN, STICK, FORWARDS, BACKWARDS = range(4)  # modes; the last two slide
SIGN = np.array([0.0, 0.0, 1.0, -1.0])  # of the sliding velocity
PROXIMAL = 1e-10  # d, relative to the mobility of a row
SMALLEST = 1e-300
REFINEMENTS = 20
EXCHANGES = 60
AT_LIMIT = 1e-9  # of the friction that a contact can give: at its limit
FEW = 60  # contacts whose dense problem may be handed to Lemke's method


class Problem(NamedTuple):
    """Right-hand sides of one problem; rows are those of joints, normals and tangents, in this order.

    b, size : (n_r,)   rates of the rows at x = 0, and the sizes of their terms
    active, rough : (n_c,)   contacts that may close; those of them with friction
    mu : (n_c,)   zero of those without;  speed : the largest, up to whose rounding all velocities are known
    """

    b: Any
    size: Any
    active: Any
    rough: Any
    mu: Any
    speed: float


class Point(NamedTuple):
    """An attempt: modes, x, impulses of all rows, sizes of the terms of A x; residuals, modes that fit better."""

    modes: Any
    x: Any
    p: Any
    size_x: Any
    residual: float
    joints: float  # residual of the joints alone
    fitting: Any

    @property
    def solved(self) -> bool:
        """Whether no residual is larger than what `solve_lcp` calls solved."""
        return max(self.residual, self.joints) <= TOLERANCE


class Coupled:
    """The matrices of a system, factorised for one set of modes after another.

    L, R    [A, -rows^T] with the joints' rows of forces, D;  all rows, with J

    Parameters
    ----------
    A : (n_q, n_q), G, T : (n_c, n_q)   sparse; T has rows of zeros where no contact has friction
    J : (n_j, n_q)   sparse, with the pattern of all J and D to come
    """

    def __init__(self, A: Any, G: Any, T: Any, J: Any) -> None:
        from scipy.sparse import csr_array, vstack

        self.n_q, self.n_c, self.n_j = A.shape[0], G.shape[0], J.shape[0]
        self.A, self.G, self.T = A, G, T
        self.diagonal, self.row_sums = np.abs(A.diagonal()), abs(A) @ np.ones(self.n_q)
        self.R = csr_array(vstack([J, G, T], format="csr"))
        self.abs_R, self.n_r = abs(self.R), self.R.shape[0]
        self.row = np.repeat(np.arange(self.n_r), np.diff(self.R.indptr))
        total, entry = self.n_q + self.n_r, A.tocoo()
        across = self.n_q + self.row
        rows, columns = np.append(entry.row, self.R.indices), np.append(entry.col, across)
        self.L = csr_array((np.arange(1.0, len(rows) + 1.0), (rows, columns)), shape=(self.n_q, total))
        self.entry = self.L.data.astype(np.intp) - 1
        self.abs_L = self.L.copy()
        diagonal, normal = np.arange(self.n_q, total), np.arange(self.n_c) + self.n_q + self.n_j
        self.patterned = Patterned(
            np.concatenate([rows, across, diagonal, normal + self.n_c]),
            np.concatenate([columns, self.R.indices, diagonal, normal]), total,
        )  # fmt: skip
        self.kept: tuple[bytes, Solve] | None = None
        self.turn(J.data, J.data)

    def turn(self, J: Any, D: Any) -> None:
        """Take other entries of the joints' rows, and of those that their forces act along."""
        contacts = np.append(self.G.data, self.T.data)
        self.R.data, forces = np.append(J, contacts), np.append(D, contacts)
        self.abs_R.data = np.abs(self.R.data)
        self.values = np.append(self.A.data, -forces)
        self.L.data = self.values[self.entry]
        self.abs_L.data = np.abs(self.L.data)
        weighted = np.abs(self.R.data * forces) / self.diagonal[self.R.indices]
        self.mobility = np.bincount(self.row, weights=weighted, minlength=self.n_r)
        self.mobility[self.mobility == 0.0] = 1.0
        self.kept = None

    def solve(self, problem: Problem, modes: Any, p: Any) -> Point:
        """The answer; modes (n_c,) and impulses p (n_r,): guesses of it."""
        modes = np.where(problem.active, modes, OPEN)
        modes = np.where(problem.rough, modes, np.minimum(modes, STICK))
        best: Point | None = None
        with np.errstate(all="ignore"):
            for point in self.attempts(problem, modes, p):
                best = point if best is None or point.residual < best.residual else best
                if best.solved:
                    break
        return best or Point(modes, np.zeros(self.n_q), p, np.zeros(self.n_q), np.inf, 0.0, modes)

    def attempts(self, problem: Problem, modes: Any, p: Any) -> Iterator[Point]:
        """Answers for one set of modes after another."""
        try:
            yield from self.exchange(problem, modes, p)
            if 0 < np.count_nonzero(problem.active) <= FEW:
                yield self.settle(problem, *self.by_lemke(problem, modes, p, problem.active))
        except Singular:
            return

    def exchange(self, problem: Problem, modes: Any, p: Any) -> Iterator[Point]:
        """Change modes that do not fit: all together while fewer and fewer do not, then those in doubt by Lemke."""
        fewest, patience, doubt, before = self.n_c + 1, PATIENCE, np.zeros(self.n_c, dtype=bool), False
        for _ in range(EXCHANGES):
            try:
                point = self.settle(problem, modes, p)
            except Singular:  # of slides that jam
                modes = np.minimum(modes, STICK)
                point = self.settle(problem, modes, p)
            yield point
            wrong = point.fitting != modes
            count = int(np.count_nonzero(wrong))
            if count == 0:
                return
            patience = PATIENCE if count < fewest else patience - 1
            fewest = min(fewest, count)
            if patience >= 0:
                modes = point.fitting
            else:
                known = np.count_nonzero(doubt)
                doubt |= wrong | before
                if np.count_nonzero(doubt) == known:
                    doubt = self.around(problem, modes, doubt)
                if np.count_nonzero(doubt) in (known, *range(FEW + 1, self.n_c + 1)):
                    return
                modes, p = self.by_lemke(problem, modes, p, doubt)
            before = wrong

    def held(self, problem: Problem, modes: Any) -> Any:
        """Rows whose rates vanish: all joints, closed contacts, and tangents of those that stick."""
        joints = np.ones(self.n_j, dtype=bool)
        return np.concatenate([joints, modes != OPEN, (modes == STICK) & problem.rough])

    def factor(self, problem: Problem, modes: Any) -> Solve:
        """Solver for the modes; the one used last is kept."""
        key = modes.tobytes() + problem.rough.tobytes()
        if self.kept is None or self.kept[0] != key:
            held = self.held(problem, modes)
            diagonal = np.where(held, PROXIMAL * self.mobility, 1.0)
            parts = self.values, self.R.data * held[self.row], diagonal, SIGN[modes] * problem.mu
            self.kept = key, self.patterned.factor(np.concatenate(parts))
        return self.kept[1]

    def settle(self, problem: Problem, modes: Any, p: Any) -> Point:
        """The answer for the modes, refined down to rounding, and judged."""
        solve, held, n = self.factor(problem, modes), self.held(problem, modes), self.n_q
        tangents, slide = slice(self.n_r - self.n_c, None), SIGN[modes] * problem.mu
        normals, slides = slice(self.n_j, self.n_r - self.n_c), modes > STICK
        u, before = np.append(np.zeros(n), np.where(held, p, 0.0)), np.inf
        u[n:][tangents][slides] = -(slide * u[n:][normals])[slides]
        left = np.append(-(self.L @ u), np.where(held, -problem.b, 0.0))
        for _ in range(REFINEMENTS):
            change = solve(left)
            u = u + change
            u[n:][tangents][slides] = -(slide * u[n:][normals])[slides]
            rates = self.R @ u[:n] + problem.b
            left = np.append(-(self.L @ u), np.where(held, -rates, 0.0))
            size_x, sizes, noise = self.sizes(problem, u)
            away = relative(rates, sizes, noise)
            error = max(largest(left[:n] / size_x), largest(away[held]))
            if not REFINED < error < 0.5 * before:
                break
            before = error
        point = self.judged(problem, modes, u, size_x, away, largest(left[:n] / size_x))
        if error > TOLERANCE and np.array_equal(point.fitting, modes):
            return point._replace(fitting=self.gives_way(problem, point, change[n:]))
        return point

    def sizes(self, problem: Problem, u: Any) -> tuple[Any, Any, Any]:
        """Sizes of the terms of A x and of the rates, and what the rounding of x makes of rates."""
        size_x = self.abs_L @ np.abs(u)
        size_x = np.maximum(size_x, ROUNDING * problem.speed * self.row_sums)
        size_x = np.maximum(size_x, NOTHING * np.max(size_x)) + SMALLEST
        terms = np.abs(u[: self.n_q]) + size_x / self.diagonal
        found = self.abs_R @ np.column_stack([terms, ROUNDING * (terms + problem.speed)])
        return size_x, problem.size + found[:, 0], found[:, 1]

    def judged(self, problem: Problem, modes: Any, u: Any, size_x: Any, away: Any, defect: float) -> Point:
        """The point with its residuals, and the modes that would fit."""
        x, p, cuts = u[: self.n_q], u[self.n_q :], (self.n_j, self.n_j + self.n_c)
        _, p_N, p_T = np.split(p, cuts)
        away_J, away_N, away_T = np.split(away, cuts)
        _, share_N, share_T = np.split(self.shares(size_x), cuts)
        closed, stick, s = modes != OPEN, (modes == STICK) & problem.rough, SIGN[modes]
        pulls = np.where(closed, np.maximum(-p_N, 0.0) * share_N, 0.0)
        enters = np.where(problem.active & ~closed, np.maximum(-away_N, 0.0), 0.0)
        beyond = np.where(stick, np.maximum(np.abs(p_T) - problem.mu * p_N, 0.0) * share_T, 0.0)
        turned = np.where(s != 0.0, np.maximum(-s * away_T, 0.0), 0.0)
        fitting = np.where(turned > STRICT, STICK, modes)
        fitting = np.where(beyond > STRICT, np.where(p_T < 0.0, FORWARDS, BACKWARDS), fitting)
        fitting = np.where(pulls > STRICT, OPEN, np.where(enters > STRICT, STICK, fitting))
        kinds = pulls, enters, beyond, turned, away_N[closed], away_T[stick]
        residual = max(defect, *map(largest, kinds)) if np.all(np.isfinite(size_x)) else np.inf
        return Point(modes, x, p, size_x, residual, largest(away_J), fitting)

    def gives_way(self, problem: Problem, point: Point, change: Any) -> Any:
        """Modes where rows that are held contradict each other, as rods and sticking hinges in one line do.

        Their impulses grow against each other along `change` until the first contact opens or begins to slide.
        """
        cuts = self.n_j, self.n_j + self.n_c
        _, p_N, p_T = np.split(point.p, cuts)
        _, d_N, d_T = np.split(change, cuts)
        stick, limit, growth = (point.modes == STICK) & problem.rough, problem.mu * p_N, problem.mu * d_N
        ways = (
            (BACKWARDS, stick, limit - p_T, d_T - growth), (FORWARDS, stick, limit + p_T, -d_T - growth),
            (OPEN, point.modes != OPEN, p_N, -d_N),
        )  # fmt: skip
        reach = np.array(
            [np.where(may & (speed > 0.0), room / speed, np.inf) for _, may, room, speed in ways]
        )
        way, contact = np.unravel_index(int(np.argmin(reach)), reach.shape)
        modes = point.modes.copy()
        if np.isfinite(reach[way, contact]):
            modes[contact] = ways[way][0]
        return modes

    def shares(self, size_x: Any) -> Any:
        """The largest part that a unit impulse of each row has in an equation of x."""
        weighted = np.append(self.abs_R.data / size_x[self.R.indices], 0.0)
        felt = np.maximum.reduceat(weighted, self.R.indptr[:-1]) if self.n_r else np.zeros(0)
        return np.where(np.diff(self.R.indptr) > 0, felt, 0.0)

    def by_lemke(self, problem: Problem, modes: Any, p: Any, doubt: Any) -> tuple[Any, Any]:
        """Modes of the contacts in doubt by Lemke's method, from their dense problem, the other modes kept.

        For the problem see `kernels.coulomb`. Its impulses are among those that do the same, and within their limits.
        Where it has no answer modes and impulses stay as they are.
        """
        contacts, rough = np.flatnonzero(doubt), np.flatnonzero(doubt & problem.rough)
        others, n, a, f = np.where(doubt, OPEN, modes), self.n_q, len(contacts), len(rough)
        rows = self.n_j + np.append(contacts, self.n_c + rough)
        solve, held, H = self.factor(problem, others), self.held(problem, others), self.R[rows].toarray()
        X = np.column_stack([solve(np.append(h, np.zeros(self.n_r)))[:n] for h in H])
        x = solve(np.append(np.zeros(n), np.where(held, -problem.b, 0.0)))[:n]
        W, b = H @ X, problem.b[rows] + H @ x
        carrier, mu, m = np.searchsorted(contacts, rough), problem.mu[rough], a + f
        M = np.zeros((m + f, m + f))
        M[:m, :m] = W
        M[:m, carrier] -= W[:, a:] * mu
        M[a:m, m:] = np.eye(f)
        M[m + np.arange(f), carrier], M[m:, a:m] = 2.0 * mu, -np.eye(f)
        answer = solve_lcp(M, np.append(b, np.zeros(f)), method="lemke")
        if not answer.solved:
            return modes, p
        z, found = answer.z, others.copy()
        found[contacts] = np.where(z[:a] > 0.0, STICK, OPEN)
        right, left = z[a:m], 2.0 * mu * z[carrier] - z[a:m]  # what is missing to either limit
        moving = np.minimum(np.abs(right), np.abs(left)) <= AT_LIMIT * (np.abs(right) + np.abs(left))
        slides = np.where(np.abs(right) <= np.abs(left), FORWARDS, BACKWARDS)
        found[rough] = np.where(moving & (found[rough] != OPEN), slides, found[rough])
        given = np.zeros(self.n_r)
        given[rows[:a]], given[rows[a:]] = z[:a], z[a:m] - mu * z[carrier]
        u = solve(np.append(np.zeros(n), np.where(held, -problem.b, given)))
        return found, u[n:]

    def around(self, problem: Problem, modes: Any, doubt: Any) -> Any:
        """The contacts in doubt, and as many others that impulses of these move most."""
        solve, others = self.factor(problem, np.where(doubt, OPEN, modes)), problem.active & ~doubt
        normals = self.R[self.n_j : self.n_j + self.n_c]
        pushed = normals.T @ np.where(doubt, 1.0, 0.0)
        moved = np.abs(normals @ solve(np.append(pushed, np.zeros(self.n_r)))[: self.n_q])
        most = np.argsort(np.where(others, -moved, 1.0))[
            : min(np.count_nonzero(doubt), np.count_nonzero(others))
        ]
        doubt = doubt.copy()
        doubt[most] = True
        return doubt


def relative(value: Any, size: Any, rounding: Any) -> Any:
    """Values next to the size of their terms; what is rounding counts as zero."""
    value = np.sign(value) * np.maximum(np.abs(value) - rounding, 0.0)
    return value / np.where(size > 0.0, size, 1.0)


def largest(values: Any) -> float:
    """The largest size of numbers."""
    return float(np.max(np.abs(values), initial=0.0))
