"""Why the loop of the theta-method returned, as Python sees it: a status of the run, or what is to be done first."""

from __future__ import annotations

from lcpstep.kernels.status import BUFFER_FULL as BUFFER_FULL
from lcpstep.trajectory import Kind, Status

FINISHED, NOT_FINITE, LCP_FAILED = int(Status.DONE), int(Status.NOT_FINITE), int(Status.LCP_FAILED)
NEWTON_FAILED, JOINTS_FAILED = int(Status.NEWTON_FAILED), int(Status.JOINTS_FAILED)
PROJECTION_FAILED = int(Status.PROJECTION_FAILED)
NEED_LCP = -2  # solve the problem at hand
# Kinds of events
NO_EVENT = -1
IMPACT, STICK, RELEASE = int(Kind.IMPACT), int(Kind.STICK), int(Kind.RELEASE)
MAX_ITERATIONS = 25  # of Newton, per step
