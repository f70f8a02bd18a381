"""Whole numbers and tolerances that the kernels of `Located` share; the `.pxd` file has them as C knows them."""

from __future__ import annotations

from lcpstep.stepping.steps import LATE as LATE

# Why the loop returned
FINISHED, BUFFER_FULL, NOT_FINITE, LCP_FAILED, TOO_MANY_EVENTS, JOINTS_FAILED, NO_POSITION, STOPPED = range(8)
# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)
OPEN, CLOSED = 0, 1  # values of Work.status
GROUND, LEFT = 1, 2  # of Work.grounded: the piece begins at gap zero; and the contact has just lost its force
NOBODY, CORNER = -1, -2  # in the place of a contact: none; all whose velocity jumps at a corner
WHOLE, REST = 0, 1  # places of the matrices for a whole step and for the rest of one;
INERTIA = 2  # in their place: M alone

EPS = 2.0**-52
SAME_TIME = 8 * EPS  # relative: an impact as little after the end of a step belongs to it
ROUNDING = 64 * EPS  # of sums of a few terms, relative to their size
