"""Contacts with friction and joints of a large sparse system: their impulses in one step, W never formed.

    A x = G^T p_N + T^T p_T + D^T p_J,        J x + b_J = 0
    0 <= G x + b_N  complementary to  p_N >= 0,      p_T = -mu p_N sign(T x + b_T)

A contact is open, sticks, or slides either way; for given modes all this is one sparse linear system,

    [ A   -D^T  -G^T  -T^T ]        J, and the rows of G of closed contacts and of T of those that stick, have a small
    [ J    d               ]        proximal diagonal d, which has factors for rows that say the same thing twice too;
    [ G          d         ]        refinement takes its effect away
    [ T        mu s    d   ]        rows of other impulses say what they are: p_N = 0, or p_T + s mu p_N = 0

solved by refinement down to rounding. Contacts whose answer does not fit their mode change it, all together as long
as that makes headway; then modes are found along a path (`path`), which is Lemke's method begun from a guess.
The answer is judged by its residuals before it is accepted.

Sources: P. Alart, A. Curnier, Comput. Methods Appl. Mech. Eng. 92 (1991) 353; M. Hintermueller, K. Ito, K. Kunisch,
SIAM J. Optim. 13 (2003) 865; `kernels.coulomb` for the law and its linear complementarity problem.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from lcpstep.lcp.factor import Patterned, Singular, Solve
from lcpstep.lcp.newton import PATIENCE, STRICT
from lcpstep.lcp.saddle import REFINED
from lcpstep.lcp.status import NOTHING, ROUNDING, TOLERANCE
from lcpstep.stepping.sparse.path import BACKWARDS, FORWARDS, OPEN, SIGN, STICK, Path
from lcpstep.stepping.steps import CONTRADICTION, largest

PROXIMAL = 1e-10, 1e-13  # d, relative to the mobility of a row; the second for heavy bodies on light ones
SMALLEST = 1e-300
REFINEMENTS, HEADWAY = 100, 0.9  # at most; the part of an error that may be left if another follows
CENTRES = 20  # proximal points


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

    def worst(self) -> float:
        """The larger residual."""
        return max(self.residual, self.joints)

    @property
    def solved(self) -> bool:
        """Whether no residual is larger than what `solve_lcp` calls solved."""
        return self.worst() <= TOLERANCE


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
        normal, tangent = self.n_j, self.n_j + self.n_c
        self.joints, self.normals, self.tangents = slice(normal), slice(normal, tangent), slice(tangent, None)
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
        self.kept: tuple[tuple[float, bytes], Solve] | None = None
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
        self.part, self.kept = PROXIMAL[0], None

    @property
    def proximal(self) -> Any:
        """The proximal diagonal (n_r,)."""
        return self.part * self.mobility

    def of_joints(self) -> Any:
        """Contacts (n_c,) whose normals the joints hold already: a velocity that these leave moves all other gaps.

        Any velocity without a pattern does: of fractions of multiples one may be the mean of its neighbours.
        """
        v, none = np.random.default_rng(0).uniform(-0.5, 0.5, self.n_q), np.zeros(self.n_c, dtype=bool)
        problem = Problem(self.R @ v, self.abs_R @ np.abs(v), none, none, np.zeros(self.n_c), 1.0)
        x = self.settle(problem, np.zeros(self.n_c, dtype=int), np.zeros(self.n_r)).x
        terms = (self.abs_R @ (np.abs(v) + np.abs(x)))[self.normals]
        return np.abs(self.G @ (v + x)) <= CONTRADICTION * terms

    def solve(self, problem: Problem, modes: Any, p: Any) -> Point:
        """The answer; modes (n_c,) and impulses p (n_r,): guesses of it."""
        modes = np.where(problem.active, modes, OPEN)
        modes = np.where(problem.rough, modes, np.minimum(modes, STICK))
        best = Point(modes, np.zeros(self.n_q), p, np.zeros(self.n_q), np.inf, 0.0, modes)
        with np.errstate(all="ignore"):
            for point in self.attempts(problem, modes, p):
                best = min(best, point, key=Point.worst)
                if best.solved:
                    break
            if best.solved and best.worst() > STRICT:
                # By the distance from the centre, which is less from here
                best = min(best, self.settle(problem, best.modes, best.p, best.p), key=Point.worst)
        return best

    def attempts(self, problem: Problem, modes: Any, p: Any) -> Iterator[Point]:
        """Answers for one set of modes after another."""
        for self.part in PROXIMAL:
            yield from self.attempts_by(problem, modes, p)

    def attempts_by(self, problem: Problem, modes: Any, p: Any) -> Iterator[Point]:
        """The same with one proximal diagonal."""
        point: Point | None = None
        guess = modes
        try:
            for point in self.exchange(problem, modes, p):
                yield point
            modes = modes if point is None else point.modes
            for _ in range(CENTRES):
                found = self.by_path(problem._replace(b=problem.b - self.proximal * p), modes, guess)
                if found is None:
                    return
                for point in self.exchange(problem, found, p, p):
                    yield point
                if point is None or np.array_equal(p, point.p):
                    return
                modes, p = point.modes, point.p
        except Singular:
            return

    def exchange(self, problem: Problem, modes: Any, p: Any, centre: Any = None) -> Iterator[Point]:
        """Change modes that do not fit, all together, while fewer and fewer do not; the best comes last."""
        fewest, patience, best = self.n_c + 1, PATIENCE, None
        while patience >= 0 and fewest > 0:
            try:
                point = self.settle(problem, modes, p, centre)
            except Singular:  # of slides that jam
                modes = np.minimum(modes, STICK)
                point = self.settle(problem, modes, p, centre)
            yield point
            count = int(np.count_nonzero(point.fitting != modes))
            best = point if best is None or count < fewest else best
            patience = PATIENCE if count < fewest else patience - 1
            fewest, modes = min(fewest, count), point.fitting
        if best is not None:
            yield best

    def by_path(self, problem: Problem, modes: Any, guess: Any) -> Any:
        """Modes by a path from the best that exchanges led to, or, where slides that jam mislead it, from others.

        The guess that the exchanges began with is the answer of a step before, whose slides do not jam.
        """
        starts = modes, guess, np.minimum(modes, STICK), np.zeros_like(modes)
        paths = (Path(self, problem, start).follow() for start in starts)
        return next((found for found in paths if found is not None), None)

    def held(self, problem: Problem, modes: Any) -> Any:
        """Rows whose rates vanish: all joints, closed contacts, and tangents of those that stick."""
        joints = np.ones(self.n_j, dtype=bool)
        return np.concatenate([joints, modes != OPEN, (modes == STICK) & problem.rough])

    def factor(self, problem: Problem, modes: Any) -> Solve:
        """Solver for the modes; the one used last is kept."""
        key = self.part, b"".join(x.tobytes() for x in (modes, problem.rough, problem.mu))
        if self.kept is None or self.kept[0] != key:
            held = self.held(problem, modes)
            diagonal = np.where(held, self.proximal, 1.0)
            parts = self.values, self.R.data * held[self.row], diagonal, SIGN[modes] * problem.mu
            self.kept = key, self.patterned.factor(np.concatenate(parts))
        return self.kept[1]

    def settle(self, problem: Problem, modes: Any, p: Any, centre: Any = None) -> Point:
        """The answer for the modes, refined down to rounding, and judged.

        With a centre (n_r,) the proximal diagonal stays, and draws the impulses to the centre: of rows that say the
        same thing twice none then grows against another.
        """
        solve, held, n = self.factor(problem, modes), self.held(problem, modes), self.n_q
        normals, tangents = self.normals, self.tangents
        slide, slides = SIGN[modes] * problem.mu, modes > STICK
        proximal = 0.0 if centre is None else self.proximal
        u, before = np.append(np.zeros(n), np.where(held, p, 0.0)), np.inf
        u[n:][tangents][slides] = -(slide * u[n:][normals])[slides]
        left, scale = np.append(-(self.L @ u), np.where(held, -problem.b, 0.0)), 0.0
        for _ in range(REFINEMENTS):
            u = u + solve(left)
            u[n:][tangents][slides] = -(slide * u[n:][normals])[slides]
            rates = self.R @ u[:n] + problem.b
            drawn = rates + proximal * (u[n:] - (p if centre is None else centre))
            left = np.append(-(self.L @ u), np.where(held, -drawn, 0.0))
            size_x, sizes, noise = self.sizes(problem, u)
            scale = scale or largest(problem.size + self.abs_R @ np.abs(u[:n])) + SMALLEST
            error = max(largest(left[:n] / size_x), largest(drawn[held]) / scale)
            if not REFINED < error < HEADWAY * before:
                break
            before = error
        away = relative(rates, sizes, noise)
        point = self.judged(problem, modes, u, size_x, away, largest(left[:n] / size_x))
        contradiction = self.contradiction(problem, u[:n], away * sizes, held)
        return point if contradiction <= CONTRADICTION else point._replace(residual=np.inf)

    def contradiction(self, problem: Problem, x: Any, rates: Any, held: Any) -> float:
        """The worst rate of a contact next to velocities, as impulses that grow against each other leave behind.

        Next to what such impulses move it would be nothing.
        """
        may_close = np.append(problem.active, np.zeros(self.n_c, dtype=bool))
        rates, held = rates[self.n_j :], held[self.n_j :]
        missed = np.where(held, np.abs(rates), np.where(may_close, -rates, 0.0))
        speeds = problem.size + self.abs_R @ (np.abs(x) + problem.speed)
        return float(np.max(missed / np.maximum(speeds[self.n_j :], SMALLEST), initial=0.0))

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
        x, p, N, T = u[: self.n_q], u[self.n_q :], self.normals, self.tangents
        p_N, p_T, away_N, away_T, shares = p[N], p[T], away[N], away[T], self.shares(size_x)
        closed, stick, s = modes != OPEN, (modes == STICK) & problem.rough, SIGN[modes]
        pulls = np.where(closed, np.maximum(-p_N, 0.0) * shares[N], 0.0)
        enters = np.where(problem.active & ~closed, np.maximum(-away_N, 0.0), 0.0)
        beyond = np.where(stick, np.maximum(np.abs(p_T) - problem.mu * p_N, 0.0) * shares[T], 0.0)
        turned = np.where(s != 0.0, np.maximum(-s * away_T, 0.0), 0.0)
        fitting = np.where(turned > STRICT, STICK, modes)
        fitting = np.where(beyond > STRICT, np.where(p_T < 0.0, FORWARDS, BACKWARDS), fitting)
        fitting = np.where(pulls > STRICT, OPEN, np.where(enters > STRICT, STICK, fitting))
        kinds = pulls, enters, beyond, turned, away_N[closed], away_T[stick]
        residual = max(defect, *map(largest, kinds)) if np.all(np.isfinite(size_x)) else np.inf
        return Point(modes, x, p, size_x, residual, largest(away[self.joints]), fitting)

    def shares(self, size_x: Any) -> Any:
        """The largest part that a unit impulse of each row has in an equation of x."""
        weighted = np.append(self.abs_R.data / size_x[self.R.indices], 0.0)
        felt = np.maximum.reduceat(weighted, self.R.indptr[:-1]) if self.n_r else np.zeros(0)
        return np.where(np.diff(self.R.indptr) > 0, felt, 0.0)


def relative(value: Any, size: Any, rounding: Any) -> Any:
    """Values next to the size of their terms; what is rounding counts as zero."""
    value = np.sign(value) * np.maximum(np.abs(value) - rounding, 0.0)
    return value / np.where(size > 0.0, size, 1.0)
