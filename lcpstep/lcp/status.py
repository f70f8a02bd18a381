"""How the search for a solution of a complementarity problem ended: one number for kernels, one name for people."""

from __future__ import annotations

from enum import IntEnum

SOLVED, RAY, INFEASIBLE, MAX_ITERATIONS, FAILED = range(5)  # kernels return these
TOLERANCE = 1e-10  # residual below which an answer is called solved, unless asked otherwise
ENOUGH = 1000  # pivots granted unless asked otherwise, and as many more per unknown:
PER_UNKNOWN = 20
NOT_FINITE = -1  # in the place of a status: the problem holds what is no number


class Status(IntEnum):
    """How a solver ended.

    SOLVED          the judged residual is at most the tolerance asked for
    RAY             no solution found: the pivots left along a ray, which is the certificate
    INFEASIBLE      no z >= 0 has W z + b >= 0; the certificate proves it
    MAX_ITERATIONS  the iteration limit came first
    FAILED          an answer was found, but the judge refused it
    """

    SOLVED = SOLVED
    RAY = RAY
    INFEASIBLE = INFEASIBLE
    MAX_ITERATIONS = MAX_ITERATIONS
    FAILED = FAILED


# Of the judge:
MERE = 1e-14  # relative error that may be rounding
LITTLE = 1e-2  # part of the size of its row that b keeps as a rule
LOST = 1e-12  # part of the size of its row below which b is lost in rounding
FINER = 1e-2  # steps between the two in which it is looked for what is left

# Of saddle point problems, A x = r + G^T z:
ROUNDING = 4 * 2.2e-16  # of the terms that x is what they leave
NOTHING = 1e-20  # of the largest terms: as small as what proximal steps leave of a z that is zero
