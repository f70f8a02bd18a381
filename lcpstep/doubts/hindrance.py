"""What of a scene keeps a run from going on, though nothing has failed: in words, from where it stands."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.callbacks.culprits import failing
from lcpstep.doubts.kinks import valley
from lcpstep.doubts.room import closes_upon
from lcpstep.doubts.sticking import held
from lcpstep.model import unrepeatable

Array = NDArray[np.float64]
LOOKS = 17  # ahead in a straight line


def hindrance(scene: Scene, t: float, until: float, q: Array, v: Array) -> str:
    """Why steps from the state at time t become ever shorter, or events follow one another; "" where nothing tells.

    until : what lies ahead up to here is looked at
    """
    names = " and ".join(unrepeatable(scene, t, q, v))
    if names:
        return f"{names} must be functions of time and state, and are not"
    found = closes_upon(scene, t, q) or valley(scene, t, q, v) or held(scene, t, q, v)
    if found:
        return found
    fails = failing(scene, np.linspace(t, max(t, until), LOOKS), q, v)
    return f"ahead of it {fails.rstrip(';')}" if fails else ""
