"""Whether a finished run has become faster within a step than its start, forces and obstacles can have made it.

    T(end) <= (sqrt(2 T(start)) + h sqrt(f^T M^-1 f))^2 / 2 + sum of p |g_t|

A force makes sqrt(2 T) grow at most by the length of its acceleration in the metric of M, an obstacle gives at most
what its impulse p does along its own motion g_t, and an impact with a restitution up to 1, or a joint that stands
still, gives nothing. Where obstacles leave no place to a body, or turn too far within a step, steps can go to any
speed in silence, and what comes after may look like a motion again. Asked of systems with constant masses, where an
obstacle or a joint bends, for steps of one size; friction and joints that move do work of their own.
Source: B. Brogliato, Nonsmooth Mechanics (2016), section 5.4, energy at impacts.
"""

from __future__ import annotations

import numpy as np

from lagrangian import LinearSystem
from lcpstep.callbacks.faults import cause, forget
from lcpstep.doubts.balance import driven
from lcpstep.doubts.turned import LATER, asked
from lcpstep.trajectory import Trajectory

PARTS = 8  # of the run, in each of which a step is looked at
MOST = 4.0  # times what it may have: twice the speed


def outrun(run: Trajectory) -> str:
    """In which step the energy grows beyond what may be, in words; "" where it does in none that was looked at."""
    contacts, scene = run.scene.contacts, run.scene
    rubs = contacts is not None and contacts.friction is not None
    masses = (
        True if isinstance(scene.system, LinearSystem) else not callable(getattr(scene.system, "mass", len))
    )
    if not any(asked(run)) or rubs or not masses or driven(scene.joints):
        return ""
    from lcpstep.kernels.outrun import steepest
    from lcpstep.model import looked_at

    times, k, start, end = steepest(
        looked_at(scene), run.t, run.q, run.v, run.impulse, run.method.h * (1.0 + LATER), PARTS
    )
    cause()  # a callback that fails at a state that the run has not asked it for
    forget()
    if times <= MOST:
        return ""
    before, later = run.t[int(k)], run.t[int(k) + 1]
    log = run.impacts[(run.impacts.time >= before) & (run.impacts.time <= later)]
    given = np.sum(np.maximum(0.0, 0.5 * log.impulse * (log.before + log.after)))  # restitutions that differ
    if end <= MOST * (end / times + given):
        return ""
    return (
        f"its kinetic energy grows from {start:.3g} J to {end:.3g} J within a step at t = {before:.9g} s, where it "
        f"can be {end / times:.3g} J by forces and obstacles: the run is wrong from there on"
    )
