"""Runs of systems with contacts and joints."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.events.general.ends import NO_IMPULSES, NO_SURFACE
from lcpstep.events.general.loop import Course
from lcpstep.events.general.smooth import Smooth, Watched
from lcpstep.events.general.state import Mechanism
from lcpstep.events.running import FIRST_STEP, QUADRATURE, Integrated
from lcpstep.events.scan import scan_interval
from lcpstep.gaps import no_way_out
from lcpstep.gauss import gauss
from lcpstep.kernels.model import Model
from lcpstep.model import joint_model, model
from lcpstep.recording import Kept
from lcpstep.trajectory import Status
from lcpstep.turns import turns


def is_constant(m: Model, joints: Model) -> bool:
    """Whether the acceleration is constant between events, and gaps are linear in q."""
    still = not any(f.given for f in (m.force, m.frame, m.motion, joints.motion))
    turns = m.omega != 0.0 and (np.any(m.arrays["cosine"]) or np.any(m.arrays["sine"]))
    forced = np.any(m.arrays["C"]) or np.any(m.arrays["K"]) or turns
    return bool(m.linear and m.flat and joints.flat and still and not forced)


def start(scene: Scene, method: Any) -> Mechanism:
    """The state at the start of the span; `method` has rtol and atol."""
    return mechanism(scene, model(scene), Smooth(2 * scene.n_q, scene.n_q, method.rtol, method.atol))


def mechanism(scene: Scene, m: Model, smooth: Smooth | Watched) -> Mechanism:
    """The same by the motion that goes from event to event."""
    joints = joint_model(scene) if scene.n_j > 0 else m
    constant, scan = is_constant(m, joints), scan_interval(scene, m, 0.0)
    smooth.state[: scene.n_q], smooth.state[scene.n_q :] = scene.q0, scene.v0
    smooth.next_step = FIRST_STEP * scan
    corners = () if constant else turns(scene).stops
    smooth.mechanism = Mechanism(
        m, joints, scene.n_j, constant, smooth, scan, scene.t_span, corners, scene.period, *gauss(QUADRATURE)
    )
    return smooth.mechanism


class General(Integrated):
    """A run with any number of contacts and joints; `system`: its state at the start, if made elsewhere."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, system: Mechanism | None = None) -> None:
        s = self.system = system or start(scene, method)
        super().__init__(method, scene, kept, s, s.smooth, s.scan, scene.n_c + scene.n_j, s.constant)
        self.course = Course(s, self.recorder.record, self.tally)

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        s, where = self.system, self.where
        if code == NO_IMPULSES:
            members = s.contact.members(s.n_members)
            words = f"no impulses of the contacts {members} end their approach"
            return f"{no_way_out(self.scene, self.now, self.state[0], members) or words} {where}"
        if code == NO_SURFACE:
            return f"the obstacle of contact {s.event_contact} closes in, and leaves no room {where}"
        if code == Status.TOO_MANY_EVENTS:
            return f"{self.bound}; the last at contacts {s.contact.latest()}, closed are {self.closed_ones}, {where}"
        return super().why(code)
