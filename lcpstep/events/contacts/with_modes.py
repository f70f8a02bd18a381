"""Runs of systems with modes that have contacts: the run of any system with contacts, whose force is that of a mode.

`switching` says how, and why so.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import HybridScene, Scene
from lagrangian.mechanical import mechanics
from lcpstep.callbacks.culprits import hybrid_culprit
from lcpstep.events.codes import INSIDE
from lcpstep.events.contacts.run import ContactRun
from lcpstep.events.contacts.switching import Watched
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.run import SWITCHES, switch_log, undecided
from lcpstep.events.hybrid.trajectory import HybridTrajectory, Pieces
from lcpstep.recording import Kept
from lcpstep.refusals import refused
from lcpstep.trajectory import Status


class RunWithModes(ContactRun):
    """One run; `modes` is the scene with its modes, `scene` that of its mechanics, `log` the switches so far."""

    def __init__(self, method: Any, modes: HybridScene, kept: Kept) -> None:
        if modes.system.surfaces:
            raise refused("modes-surfaces", modes)
        self.modes, self.machine = modes, machine(modes)
        self.fields = self.machine.fields
        super().__init__(method, mechanics(modes), kept)
        self.log = self.system.watch.take()[2]

    def start(self, scene: Scene, method: Any) -> Any:
        """The motion at the start of the span, in its mode."""
        modes, s = self.modes, super().start(scene, method)
        long = modes.t_span[1] - modes.t_span[0]
        watched = Watched(
            self.machine, modes.t_span[1], method.rtol, method.atol, long, method.max_events, 0, SWITCHES, scene.n_q
        )  # fmt: skip
        watched.share(s)
        s.watch.mode = s.model.mode = modes.system.names.index(modes.mode)
        s.watch.now = modes.t_span[0]
        return s

    @property
    def mode(self) -> str:
        """Name of the mode at hand."""
        return self.modes.system.names[self.system.watch.mode]

    def advance(self, goal: int) -> int:
        """Call the kernel, and take over the switches that it has noted."""
        code = super().advance(goal)
        self.log = np.concatenate([self.log, self.system.watch.take()[2]])
        return code

    def trajectory(self, code: int) -> HybridTrajectory:
        """Everything computed so far."""
        s, names = self.states(), self.modes.system.names
        impulse, friction, _ = self.shares(s)
        start = names.index(self.modes.mode)
        entered = np.concatenate([[start], self.log[:, 2]]).astype(np.int64)
        mode = entered[np.searchsorted(self.log[:, 0], s.t, side="right")]
        dense = self.recorder.dense() if self.kept.all else np.zeros((0, 7, self.modes.n_x))
        pieces = Pieces(t=s.t, h=s.length, mode=mode, x=np.hstack([s.q, s.v]), dense=dense)
        return HybridTrajectory(
            scene=self.modes, method=self.method, t=pieces.t, x=pieces.x, mode=np.array(names)[mode],
            switches=switch_log(self.modes, self.log), status=self.status(code), message=self.message(code),
            counts=self.counts, pieces=pieces, impulse=impulse, friction_impulse=friction,
            impacts=self.recorder.log(self.scene.t_span[1]),
        )  # fmt: skip

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code in (Status.ENDLESS_SWITCHING, Status.NOT_TRANSVERSAL):
            return undecided(self.modes, self.system.watch, Status(code), self.log)
        if code == INSIDE:
            return (
                f"the reset of the switch to mode {self.mode!r} leads inside the obstacle of contact "
                f"{self.system.rows.culprit} {self.where}"
            )
        if code == Status.NOT_FINITE and not self.system.coefficients.fault():
            return f"{hybrid_culprit(self.modes, self.mode)} {self.where}"
        return f"{super().why(code)}, mode {self.mode!r}"
