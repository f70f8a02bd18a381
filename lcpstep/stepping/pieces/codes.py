"""Whole numbers and tolerances that the kernels of `Located` share; the `.pxd` file has them as C knows them."""

from __future__ import annotations

from lcpstep.kernels.roundings import RESOLUTION

# Why the loop returned, besides what `kernels.status` has: at an event; or, within the loop alone, for another round,
# in which nothing is known yet of the piece that begins
STOPPED, AGAIN = -2, -3
OPEN, CLOSED = 0, 1  # values of Work.status
GROUND, LEFT = 1, 2  # of Work.grounded: the piece begins at gap zero; and the contact has just lost its force
NOBODY, CORNER = -1, -2  # in the place of a contact: none; all whose velocity jumps at a corner
WHOLE, REST = 0, 1  # places of the matrices for a whole step and for the rest of one;
INERTIA = 2  # in their place: M alone

SAME_TIME = 8 * RESOLUTION  # relative: an impact as little after the end of a step belongs to it
STOPS = 1e-9  # restitution: what rebounds no faster has no hops whose times could accumulate
