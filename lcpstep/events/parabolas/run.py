"""Runs of systems with contacts and joints under constant accelerations."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.events.parabolas.loop import Course
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.running import Integrated
from lcpstep.events.scan import scan_interval
from lcpstep.kernels.model import Model
from lcpstep.recording import Kept


def is_constant(m: Model, joints: Model) -> bool:
    """Whether the acceleration is constant between events, and gaps are linear in q."""
    still = not any(f.given for f in (m.force, m.frame, m.motion, joints.motion))
    turns = m.omega != 0.0 and (np.any(m.arrays["cosine"]) or np.any(m.arrays["sine"]))
    forced = np.any(m.arrays["C"]) or np.any(m.arrays["K"]) or turns
    return bool(m.linear and m.flat and joints.flat and still and not forced)


class ParabolicRun(Integrated):
    """A run with any number of contacts and joints; m, joints : models of these and of those."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, m: Model, joints: Model) -> None:
        tolerances = method.rtol, method.atol
        s = self.system = Mechanism(m, joints, scene.n_j, tolerances, scene.t_span)
        s.start(scene.q0, scene.v0)
        super().__init__(method, scene, kept, s, scan_interval(scene, m, 0.0), True)
        self.course = Course(s)
