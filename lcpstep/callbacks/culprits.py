"""Which callback of a scene has stopped a run, in words: the one that raised an exception, or is not finite."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, Scene
from lagrangian.joints import state as joint_state
from lcpstep.callbacks.faults import fault

Array = NDArray[np.float64]
BEYOND = 1e-3, 2e-3  # [s] later than a time, differences look at what has no bias (lcpstep.kernels.biases)


def culprit(scene: Scene, times: Iterable[float], q: Array, v: Array) -> str:
    """Which callback has raised an exception, or is not finite at one of the times, in words."""
    found = failing(scene, times, q, v)
    return found or "the motion left the finite numbers, or a matrix is singular or not positive definite,"


def failing(scene: Scene, times: Iterable[float], q: Array, v: Array) -> str:
    """The callback that has raised an exception, or is not finite at one of the times; "" if none does.

    It is asked for at the state that the motion has reached, and at those that this leads to in a straight line.
    """
    raised, times = fault(), list(times)
    beyond = [times[-1] + later for later in BEYOND if times]
    states = [(t, q, v) for t in times] + [(t, q + (t - times[0]) * v, v) for t in times + beyond]
    states += [(t, q, v) for t in beyond]
    # Coefficients of friction have sliding velocities in their place
    if raised is not None and len(raised.v) == scene.n_q:
        states = [(raised.t, raised.q, raised.v)]
    try:
        for t, x, x_t in states:
            at = t, x, x_t, np.array(scene.p)
            scene.system.trial(*at)
            if scene.contacts is not None:
                scene.contacts.state(*at)
            if scene.joints is not None:
                joint_state(scene.joints, *at)
    except ValueError as error:
        return str(error) + ";"
    if raised is not None:
        return f"{raised};"
    return ""


def hybrid_culprit(scene: HybridScene, mode: str) -> str:
    """The same of a system with modes that has stopped in this one."""
    raised = fault()
    if raised is None:
        return f"the field of mode {mode!r}, a guard of it or the state is not finite"
    try:
        scene.system.trial(raised.t, raised.q, np.array(scene.p))
    except ValueError as error:
        return str(error)
    return str(raised)
