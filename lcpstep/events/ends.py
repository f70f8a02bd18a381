"""How a call of the loop over events ends, besides `lcpstep.kernels.status`, and what an event is."""

from __future__ import annotations

from lcpstep.trajectory import Kind, Status

NO_IMPULSES, NO_FORCES = -2, -3  # no impulses, or no forces, of the contacts that would do
INSIDE = -4  # a reset has put the state inside an obstacle
NO_SURFACE = -5  # the obstacle of a contact that is met has closed
STATUS = {
    NO_IMPULSES: Status.LCP_FAILED, NO_FORCES: Status.LCP_FAILED, INSIDE: Status.PROJECTION_FAILED,
    NO_SURFACE: Status.PROJECTION_FAILED,
}  # fmt: skip
IMPACT, ACCUMULATION, STICK, RELEASE = (int(kind) for kind in list(Kind)[:4])
