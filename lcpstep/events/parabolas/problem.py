"""The complementarity problem of a set of closed contacts, as kernels; joints are eliminated from it.

    0 <= W z + b  complementary to  z >= 0

W is the Delassus matrix of the contacts on the joints, see `rows.on_joints`; z are impulses (`impact`) or forces
(`forces`). Opposite contacts can make it a problem without an answer by as little as rounding of b; then b is lifted
by it. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 5.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.status import SOLVED

if not cython.compiled:
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.kernels.vectors import clear
    from lcpstep.lcp.kernel import solve_small

CHECKED = 1e-10  # relative violation that an answer found without the solver may have


def solve_contacts(s: Mechanism) -> bool:
    """Solve the members' problem with `b`; z, at least zero, and who carries a force.

    `noise` is the rounding of b. Where the solver fails (W has lost too many digits), all that could are said to
    carry one, with z = 0: an answer to be checked.
    """
    k = s.n_members
    z, b = s.contact.z, s.contact.b
    clear(z, k)
    contact_matrix(s)
    solved = solve_small(s.W, b, z, k, s.lcp) == SOLVED
    if not solved:
        for a in range(k):
            b[a] += s.contact.noise[a]
            z[a] = 0.0
        solved = solve_small(s.W, b, z, k, s.lcp) == SOLVED
    for a in range(k):
        z[a] = z[a] if solved else 0.0
        s.contact.loaded[s.contact.member[a]] = 1 if z[a] > 0.0 or not solved else 0
    return solved


def contact_matrix(s: Mechanism) -> None:
    """W of the member contacts on the joints, which must have been held."""
    k = s.n_members
    for a in range(k):
        for b in range(k):
            s.W[a * k + b] = s.S[(s.n_j + s.contact.member[a]) * s.n_r + s.n_j + s.contact.member[b]]
