"""What a step works in: what it multiplies with, where the motion of a scene is, and the rows of its constraints.

    A = M + h theta C + h^2 theta^2 K,      X = A^-1 (G, T, D_J)^T,      W = (G, T, G_J) X

for a linear system; of a general one A is Newton's matrix (`implicit`). X and W are constant where the rows of all
contacts, tangents and joints are, and made anew in each step where they are not.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.coefficients import Coefficients
from lcpstep.kernels.coulomb import ContactProblem
from lcpstep.kernels.model import Model
from lcpstep.pointers import after, indices_after
from lcpstep.shelf import Shelf
from lcpstep.stepping.theta_method.joint_rows import Elimination

VECTORS, SQUARES = 10, 4  # of n_q numbers, and of n_q^2
MATRICES = ("A_q", "A_v", "A_f", "X", "W")


class Plan:
    """Matrices of a step, row by row.

    h, theta
    slack                positions off joints and in obstacles by this little need no projection; not `State.slack`
    constant             X and W are those of every step
    stiff                C or K is not zero: without them A^-1 has entries where M^-1 does, and A_q and A_v have none
    A_q : (n_q, n_q)     A^-1 h K
    A_v : (n_q, n_q)     A^-1 (h C + h^2 theta K)
    A_f : (n_q, n_q)     h A^-1
    X : (n, n_q)         A^-1 times the directions of the forces of all n rows
    W : (n, n)           Delassus matrix of all rows

    Parameters
    ----------
    h, theta, slack : float;  constant, stiff : bool;  matrices : dict of the five arrays, which are kept
    """

    def __init__(
        self, h: float, theta: float, slack: float, constant: bool, stiff: bool, matrices: dict[str, Any]
    ) -> None:
        self.h, self.theta, self.slack, self.constant, self.stiff = h, theta, slack, constant, stiff
        self.matrices = {name: np.ascontiguousarray(matrices[name]) for name in MATRICES}
        self.A_q, self.A_v = doubles(self.matrices["A_q"]), doubles(self.matrices["A_v"])
        self.A_f = doubles(self.matrices["A_f"])
        self.X, self.W = doubles(self.matrices["X"]), doubles(self.matrices["W"])


class State:
    """Position, velocity, gaps and forces; and the work space of a step.

    n_q, n_c
    q, v, force      (n_q,) force: F(t), of a general system f(t, q, v)
    g, u, closed     (n_c,) gaps and their velocities; 0 open, 1 struck in the last step, 2 closed for several steps
    sticks           (n_c,) 1 for contacts that the last step kept from sliding
    far              (n_c,) size of the largest terms of closed gaps since these closed
    slack            (n_c,) predicted gaps this small are closed: rounding must not open what rests
    impulse          (n,) of all rows since the last kept state
    n_moving         how many numbers q, v, force, g, u and impulse are, in one piece in this order
    next_q, next_v, next_force, v_free    at the end of the step; the velocity without contact
    q_between, v_between                  a state within it
    R, try_v, try_q, try_f, M, M_start, A, J, pivots    of Newton's iteration, see `implicit`
    active           contacts that take part in the step at hand
    steps, problems, forces, iteration    taken; complementarity problems; evaluations of forces; of Newton
    changed  by how much the last iteration has changed v
    moved    by how much more than rounding of q it has moved q; 0 where two v take turns that are alike
    opened   the gap that steps may have opened above a contact which lasts: 0 of steps of one size
    record   what is kept of the motion

    Parameters
    ----------
    q, v : (n_q,);  n_c, n : int   contacts and rows
    """

    def __init__(self, q: Any, v: Any, n_c: int, n: int) -> None:
        self.n_q, self.n_c, n_q = len(q), n_c, len(q)
        self.n_moving, self.arrays = 3 * n_q + 2 * n_c + n, dict[str, Any]()
        self.numbers, self.marks = np.zeros(self.n_moving), np.zeros(2 * n_c + n_q, dtype=np.intp)
        x, first = self.arrays, 0
        for name, size in (("q", n_q), ("v", n_q), ("force", n_q), ("g", n_c), ("u", n_c), ("impulse", n)):
            x[name], first = self.numbers[first : first + size], first + size
        x["q"][:], x["v"][:] = q, v
        self.q, self.v, self.force = doubles(self.numbers), doubles(x["v"]), doubles(x["force"])
        self.g, self.u, self.impulse = doubles(x["g"]), doubles(x["u"]), doubles(x["impulse"])
        self.closed = indices(self.marks)
        self.sticks, self.pivots = indices_after(self.closed, n_c), indices_after(self.closed, 2 * n_c)
        self.active = self.steps = self.problems = self.forces = self.iteration = 0
        self.changed = self.moved = self.opened = 0.0
        self.record: Any = None
        self.work = np.zeros((VECTORS + SQUARES * n_q) * n_q + 2 * n_c)
        work = Shelf(self.work)
        self.next_force, self.next_q, self.next_v, self.v_free = (
            work.take(n_q),
            work.take(n_q),
            work.take(n_q),
            work.take(n_q),
        )
        self.q_between, self.v_between, self.R, self.try_v = (
            work.take(n_q),
            work.take(n_q),
            work.take(n_q),
            work.take(n_q),
        )
        self.try_q, self.try_f, self.M = work.take(n_q), work.take(n_q), work.take(n_q * n_q)
        self.M_start, self.A, self.J = work.take(n_q * n_q), work.take(n_q * n_q), work.take(n_q * n_q)
        self.far, self.slack = work.take(n_c), work.take(n_c)
        x["slack"] = self.work[len(self.work) - n_c :]


class Blows:
    """The blow at hand of a step, and those that have gone before it within the step: see `blows`.

    v, u, sliding           velocity, gap and sliding velocities before it: those of the step, or own_v, ...
    least                   contacts no faster than this do not rebound
    several                 blows follow one another in the step at hand
    taken, last             how many have been struck; no other is to follow
    ends, u_before : (n_c,) the next one is the last; gap velocities some blows ago
    fastest                 approach in any of them
    ids : (n_c,), n_a       all active contacts
    slow                    as fast the forces of the step could make any of them: faster ones strike, or separate
    p : (n,)                impulses of all rows so far
    """

    def __init__(self, n_q: int, n_c: int, n_t: int, n: int) -> None:
        self.several, self.last, self.ends, self.least = False, False, False, -1.0
        self.taken, self.n_a, self.fastest, self.slow = 0, 0, 0.0, 0.0
        self.kept = np.zeros(n_q + 2 * n_c + n_t + n), np.zeros(n_c, dtype=np.intp)
        self.ids, self.own_v = indices(self.kept[1]), doubles(self.kept[0])
        self.own_u, self.own_sliding = after(self.own_v, n_q), after(self.own_v, n_q + n_c)
        self.p = after(self.own_sliding, n_t)
        self.u_before = after(self.p, n)
        self.v, self.u, self.sliding = self.own_v, self.own_u, self.own_sliding

    def begin(self, s: State, rows: Rows) -> None:
        """Before the first blow of a step is what the forces make of its start; pointers, which follow every step."""
        self.v, self.u, self.sliding, self.taken = s.v_free, s.u, rows.sliding, 0


class Rows:
    """Joints and tangents of a scene, and the rows of a step: all normals first, then tangents, then joints.

    joints, tangents       models, their rows in the place of the contacts': see `lcpstep.model`
    coefficients           of friction
    n_c, n_t, n_j, n       contacts, tangents (none or n_c), joints, and all of them
    n_f                    tangents that take part in the step at hand
    projected, turning     positions are repaired; joints' rows change
    external, solved       the contacts' problems are handed out (NEED_LCP); one has come back, in problem.impulse:
                           the step is begun again, and nothing is predicted anew
    H : (n, n_q)           rows of the velocities: H v + H_t is the rate; T and J: those of tangents and of joints
    H_t : (n,)             likewise T_t, J_t
    J_start : (n_j, n_q)   at the start of the step
    D : (n_j, n_q)         directions of the joints' forces
    p : (n,)               impulses
    sliding : (n_t,)       sliding velocities at the start of the step;  at_rest : the same, 0 of what sticks
    tangent_restitution : (n_c,);  in_turn    see `kernels.energetic`
    failed : (n_j,)        1 for joints that contradict others
    left_out : (n_c,)      contacts that bear nothing by turns in the step at hand
    reached, answers, mobilities, masses    whom a blow reaches, see `reached`: (n,); M^-1 H^T, (n, n_q); of each row
                           its own, (n,); factors of M, (n_q, n_q); nothing with one coefficient of friction
    problem                of the contacts, with `ids`, the rows that take part
    elimination            of the joints
    blows                  that follow one another in a step

    Of the projection:
    near : (n_c,)          contacts that it looks at
    gaps, entered : (n_c,)    gaps now, and before it
    joint_gaps : (n_j,)
    M, Y, S, push          mass, (n_q, n_q); M^-1 H^T, (n, n_q); H M^-1 H^T, (n, n); multipliers, (n,)

    G : (n_c, n_q), J_there : (n_j, n_q), G_t, J_t_there, S_there    rows on the joints, see `turned_rows`

    Parameters
    ----------
    joints, tangents : Model;  n_c, n_t : int;  coefficients : Coefficients;  tangent_restitution : (n_c,)
    in_turn, projected, external : bool
    problem : ContactProblem for n rows
    """

    def __init__(
        self,
        joints: Model,
        tangents: Model,
        n_c: int,
        n_t: int,
        coefficients: Coefficients,
        tangent_restitution: Any,
        in_turn: bool,
        projected: bool,
        external: bool,
        problem: ContactProblem,
    ) -> None:
        n_q, n_j = joints.n_q, joints.n_c
        n = n_c + n_t + n_j
        self.joints, self.tangents, self.problem = joints, tangents, problem
        self.coefficients, self.in_turn = coefficients, in_turn
        self.coefficients.use(self.problem.mu)
        self.n_c, self.n_t, self.n_j, self.n, self.n_f = n_c, n_t, n_j, n, 0
        self.projected, self.turning, self.external, self.solved = projected, not joints.flat, external, False
        counts = {
            name: np.zeros(size, dtype=np.intp)
            for name, size in (("failed", n_j), ("left_out", n_c), ("reached", n if coefficients.two else 0))
        }
        self.arrays = {"p": np.zeros(n), "r_T": tangent_restitution, **counts}
        self.left_out, self.reached = indices(self.arrays["left_out"]), indices(self.arrays["reached"])
        self.tangent_restitution = doubles(tangent_restitution)
        self.p, self.failed = doubles(self.arrays["p"]), indices(self.arrays["failed"])
        self.numbers = np.zeros((n + 2 * n_j) * n_q + n + 2 * n_t)
        self.H = doubles(self.numbers)
        self.T, self.J = after(self.H, n_c * n_q), after(self.H, (n_c + n_t) * n_q)
        self.J_start = after(self.H, n * n_q)
        self.D = after(self.J_start, n_j * n_q)
        self.H_t = after(self.D, n_j * n_q)
        self.T_t, self.J_t = after(self.H_t, n_c), after(self.H_t, n_c + n_t)
        self.sliding, self.at_rest = after(self.H_t, n), after(self.H_t, n + n_t)
        self.elimination, self.blows = Elimination(n_j, n_c, n_q), Blows(n_q, n_c, n_t, n)
        self.blown = np.zeros(n * (n_q + 1) + n_q * n_q if coefficients.two else 0)
        x = Shelf(self.blown)
        self.answers, self.mobilities, self.masses = x.take(n * n_q), x.take(n), x.take(n_q * n_q)
        self.looked_at = np.zeros(n_c if projected else 0, dtype=np.intp)
        self.repair = np.zeros(2 * n_c + n_j + n + n_q * n_q + n * n_q + n * n if projected else 0)
        self.near = indices(self.looked_at)
        y = Shelf(self.repair)
        self.gaps, self.entered, self.joint_gaps, self.push = y.take(n_c), y.take(n_c), y.take(n_j), y.take(n)
        self.M, self.Y, self.S = y.take(n_q * n_q), y.take(n * n_q), y.take(n * n)
        self.on_joints = np.zeros((n_c + n_j) * (n_q + 1) + n_j * n_j if self.turning else 0)
        z = Shelf(self.on_joints)
        self.G, self.J_there, self.G_t = z.take(n_c * n_q), z.take(n_j * n_q), z.take(n_c)
        self.J_t_there, self.S_there = z.take(n_j), z.take(n_j * n_j)
