"""Modes of a contact, what comes next in a run, what is logged, and how a run ends besides `kernels.status`."""

from __future__ import annotations

from lcpstep.trajectory import Kind, Status

# Mode of a contact. One that leans does not slide either, but has all the friction that it can: another one, which
# sticks, keeps it from sliding. Without friction what is closed slides, and from an impact on, until the forces
# decide, SLIDES says no more than closed
OPEN, STICKS, SLIDES, LEANS = range(4)
# What comes next: the start, smooth motion, impacts, modes by the forces, modes found ahead, a new mode of the system
BEGIN, MOVE, JUMP, SETTLE, OBEY, SWITCH = range(6)
LOOKED, ENTERED, JUMPED = range(3)  # whether guards of modes wait to be looked at, and why
# Of `Kind`, whose STICK says that a contact stays closed, whether it sticks or slides
IMPACT, ACCUMULATION, STAYS_CLOSED, RELEASE, SLIP, STICK_TANGENT, REVERSE, JAM = (int(kind) for kind in Kind)
RELATIVE_STEP = 7.4e-5  # of differences of the field, of fourth order: eps^(1/5)/10
EDGE = 1e-9  # relative distance of a friction force from the edge of its cone, below which it is on it; and alike
LOW = 1e-6  # of the positions at hand: higher gaps are as well known by their difference
NO_IMPULSES, NO_FORCES = -2, -3  # no impulses, or no forces, of the contacts that would do
INSIDE = -4  # a reset has put the state inside an obstacle
NO_SURFACE = -5  # the obstacle of a contact that is met has closed
STATUS = {
    NO_IMPULSES: Status.LCP_FAILED, NO_FORCES: Status.LCP_FAILED, INSIDE: Status.PROJECTION_FAILED,
    NO_SURFACE: Status.PROJECTION_FAILED,
}  # fmt: skip
