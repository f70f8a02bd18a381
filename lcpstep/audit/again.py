"""Runs that are audited: an event that was not noticed is taken, and the run goes on from it.

The window in which it was found gets stops, at its start and where the gap is below zero, as if these were corners of
the scene: so the next run looks there, and finds the event by its own means.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.audit.certify import audit
from lcpstep.audit.result import Found
from lcpstep.recording import Kept
from lcpstep.trajectory import Trajectory

MOST = 200  # runs


def audited(method: Any, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
    """The run of a method that has every event which an audit of it finds; with its `audit`."""
    asked, taken = scene, []
    everything = Kept.parse(1, scene.t_span)
    for _ in range(MOST):
        run = method.run(asked, everything, progress)
        found = audit(run)
        if not found.missed:
            break
        taken.append(found.missed[0])
        asked = looking_at(asked, found.missed[0])
    result = replace(found, taken=tuple(taken))
    if not kept.all:
        run = method.run(asked, kept, progress)
    return replace(run, scene=scene, audit=result)


def looking_at(scene: Scene, x: Found) -> Scene:
    """The scene with stops where an event was found."""
    times = np.array([x.start, x.time])
    if np.isfinite(scene.period):
        times = times % scene.period
    return replace(scene, corners=np.unique(np.concatenate([np.asarray(scene.corners), times])))
