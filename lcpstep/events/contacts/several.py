"""Whether contacts that all slide may have other forces than those found, as kernels.

    0 <= A p + b  complementary to  p >= 0,    A = R_N M^-1 (R_N - s mu R_T)^T

Without friction A is symmetric, and all answers leave the same accelerations, as those of a body wedged between
walls. With friction there is one answer where its symmetric part is positive definite; elsewhere every set of
contacts that carry a force is tried. Two such answers leave the motion open, as where belts that run against
each other may tip a block over either of its feet.
Source: R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (SIAM 2009), chapter 3.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.coulomb import ContactProblem, motion_of
from lcpstep.kernels.linear import factorise, positive_definite, solve
from lcpstep.kernels.vectors import largest
from lcpstep.pointers import abs

MOST = 8  # contacts that slide at once: of more not every set is tried
CLEARLY = 1e-9  # relative: forces and accelerations that are less may be zero


def opened_or_closed(c: ContactProblem, n: int) -> int:
    """The first of n sliding contacts with a force by one alone of two answers, `impulse` and another; or -1."""
    if n < 2 or n > MOST or is_smooth(c, n) or is_sure(c, n):
        return -1
    for pressed in range(1 << n):
        if answers(c, n, pressed):
            for i in range(n):
                if (c.b[i] > 0.0) != (c.impulse[i] > 0.0) and parts(c, n, i):
                    return i
    return -1


def parts(c: ContactProblem, n: int, i: int) -> bool:
    """Whether contact i accelerates otherwise under the forces `b` than under those found.

    Contacts that say the same share a force in many ways: one of them may carry none and stays closed all the same.
    """
    one, size = motion_of(c, c.impulse, i, n)
    two, more = motion_of(c, c.b, i, n)
    return abs(two - one) > CLEARLY * (size + more)


def is_smooth(c: ContactProblem, n: int) -> bool:
    """Whether none of the contacts has friction."""
    smooth = True
    for a in range(n):
        smooth = smooth and c.mu[c.ids[a]] == 0.0
    return smooth


def is_sure(c: ContactProblem, n: int) -> bool:
    """Whether the symmetric part of the matrix is positive definite."""
    for i in range(n):
        for j in range(n):
            c.W[i * n + j] = 0.5 * (c.mobility[i * n + j] + c.mobility[j * n + i])
    return positive_definite(c.W, n)


def answers(c: ContactProblem, n: int, pressed: int) -> bool:
    """Whether forces of just these contacts, bits of `pressed`, into `b`, are an answer, and clearly so."""
    for i in range(n):
        carries = pressed >> i & 1
        c.b[i] = -c.rate[i] if carries == 1 else 0.0
        for j in range(n):
            c.W[i * n + j] = c.mobility[i * n + j] if carries == 1 else 0.0
        c.W[i * n + i] = c.mobility[i * n + i] if carries == 1 else 1.0
    if not factorise(c.W, c.carrier, n):
        return False
    solve(c.W, c.carrier, c.b, n)
    most = largest(c.b, 0.0, n)
    for i in range(n):
        alpha, size = motion_of(c, c.b, i, n)
        if (pressed >> i & 1) == 1 and c.b[i] <= CLEARLY * most:
            return False
        if (pressed >> i & 1) == 0 and alpha <= CLEARLY * size:
            return False
    return True
