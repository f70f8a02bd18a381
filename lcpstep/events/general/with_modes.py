"""Runs of systems with modes that have contacts: the run of any system with contacts, whose force is that of a mode.

`switching` says how, and why so.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import HybridScene, Scene
from lagrangian.mechanical import mechanics
from lcpstep.culprits import hybrid_culprit
from lcpstep.events.general.ends import INSIDE
from lcpstep.events.general.run import General, mechanism
from lcpstep.events.general.smooth import Watched
from lcpstep.events.general.state import Mechanism
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.run import SWITCHES, switch_log, undecided
from lcpstep.events.hybrid.trajectory import HybridTrajectory, Pieces
from lcpstep.model import model_of_modes
from lcpstep.recording import Kept
from lcpstep.refusals import refused
from lcpstep.trajectory import Status


def start(scene: HybridScene, part: Scene, method: Any) -> Mechanism:
    """The state at the start of the span, in its mode; `part` is the scene without modes."""
    m = machine(scene)
    smooth = Watched(
        m, scene.t_span[1], method.rtol, method.atol, scene.t_span[1] - scene.t_span[0], method.max_events, 0,
        SWITCHES, part.n_q,
    )  # fmt: skip
    mode = scene.system.names.index(scene.mode)
    smooth.start(scene.t_span[0], scene.x0, mode)
    model = model_of_modes(part, m.fields)
    model.mode = mode
    return mechanism(part, model, smooth)


class RunWithModes(General):
    """One run; `modes` is the scene with its modes, `scene` that of its mechanics, `log` the switches so far."""

    def __init__(self, method: Any, modes: HybridScene, kept: Kept) -> None:
        if modes.contacts is not None and modes.contacts.friction is not None:
            raise refused("modes-friction", modes)
        if modes.system.surfaces:
            raise refused("modes-surfaces", modes)
        self.modes = modes
        part = mechanics(modes)
        super().__init__(method, part, kept, start(modes, part, method))
        self.log = self.system.watch.take()[2]

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
        s, n_c, names = self.states(), self.scene.n_c, self.modes.system.names
        start = names.index(self.modes.mode)
        entered = np.concatenate([[start], self.log[:, 2]]).astype(np.int64)
        mode = entered[np.searchsorted(self.log[:, 0], s.t, side="right")]
        dense = self.recorder.dense() if self.kept.all else np.zeros((0, 7, self.modes.n_x))
        pieces = Pieces(t=s.t, h=s.length, mode=mode, x=np.hstack([s.q, s.v]), dense=dense)
        return HybridTrajectory(
            scene=self.modes, method=self.method, t=pieces.t, x=pieces.x, mode=np.array(names)[mode],
            switches=switch_log(self.modes, self.log), status=self.status(code), message=self.message(code),
            counts=self.counts, pieces=pieces, impulse=np.ascontiguousarray(s.impulse[:, :n_c]),
            impacts=self.recorder.events(self.scene.t_span[1]),
        )  # fmt: skip

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code in (Status.ENDLESS_SWITCHING, Status.NOT_TRANSVERSAL):
            return undecided(self.modes, self.system.watch, Status(code), self.log)
        if code == INSIDE:
            return (
                f"the reset of the switch to mode {self.mode!r} leads inside the obstacle of contact "
                f"{self.system.culprit} {self.where}"
            )
        if code == Status.NOT_FINITE:
            return f"{hybrid_culprit(self.modes, self.mode)} {self.where}"
        return f"{super().why(code)}, mode {self.mode!r}"
