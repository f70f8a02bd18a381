"""How a run ended, as kernels return it: the numbers of `lcpstep.trajectory.Status`."""

(
    DONE,
    INTERRUPTED,
    NOT_FINITE,
    LCP_FAILED,
    NEWTON_FAILED,
    TOO_MANY_EVENTS,
    STEP_TOO_SMALL,
    JOINTS_FAILED,
    PROJECTION_FAILED,
    ENDLESS_SWITCHING,
    NOT_TRANSVERSAL,
    PAINLEVE_INCONSISTENT,
    PAINLEVE_INDETERMINATE,
) = range(13)
BUFFER_FULL = -1  # not ended: what has been kept must be taken away first
