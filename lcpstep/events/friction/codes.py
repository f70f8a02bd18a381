"""Modes of a contact with friction, what comes next in a run, and what is logged."""

from __future__ import annotations

from lcpstep.trajectory import Kind, Status

OPEN, STICKS, SLIDES = range(3)  # mode of a contact
BEGIN, MOVE, JUMP, DECIDE, OBEY = range(5)  # what comes next
NO_IMPULSES, NO_FORCES = -2, -3  # no impulses, or no forces, of the contacts that would do
STATUS = {NO_IMPULSES: Status.LCP_FAILED, NO_FORCES: Status.LCP_FAILED}
IMPACT, ACCUMULATION, CLOSED, RELEASE, SLIP, STICK_TANGENT, REVERSE = (int(kind) for kind in Kind)
