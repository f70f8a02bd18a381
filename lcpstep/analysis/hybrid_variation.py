"""Derivative of a motion with modes by its initial state: variational flows and saltation matrices.

The formulas, sliding included, stand in `lcpstep.maps.saltation.switches`; here they walk along a finished run. For
the stroboscopic map of a scene with a period see `lcpstep.analysis.variation.PeriodMap`, for returns to a switch
`lcpstep.maps.SwitchMap`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lcpstep.errors import LcpStepError
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.trajectory import HybridTrajectory, log_of
from lcpstep.maps.modes import told
from lcpstep.maps.saltation.switches import Tangent
from lcpstep.refusals import refused
from lcpstep.trajectory import Status

Array = NDArray[np.float64]


def monodromy(run: HybridTrajectory) -> Array:
    """Derivative of the end of a motion by its start, (n_x, n_x).

    Raises
    ------
    LcpStepError   the system has contacts, the motion ended early, or a guard of it is not transversal
    """
    if run.scene.contacts is not None:
        raise refused("modes-maps", run.scene)
    if run.status != Status.DONE:
        raise LcpStepError(f"the motion ended early: {run.message}")
    scene = run.scene
    s, mode = Tangent(machine(scene)), scene.system.names.index(scene.mode)
    start, end = float(run.pieces.t[0]), float(run.pieces.t[-1])
    return told(s.along(log_of(run), mode, start, scene.x0, end), scene, s.derivative)
