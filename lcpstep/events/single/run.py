"""Runs of general systems with one contact, whose smooth motion is integrated by DOP853."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled
from lcpstep.events import dop853
from lcpstep.events.bookkeeping import Wanted
from lcpstep.events.clock import clock
from lcpstep.events.contact import FREE, HOLD, MODE, NOW, keep
from lcpstep.events.plan import Plan, plan
from lcpstep.events.run import BetweenByModel, Run, one_contact_recorder, without_impulses
from lcpstep.events.single import loop
from lcpstep.events.single.equations import NEXT_STEP, Piece
from lcpstep.events.single.keep import evaluate as states_between
from lcpstep.model import Model
from lcpstep.recording import Kept, States

Array = NDArray[np.float64]
QUADRATURE = 10  # nodes per interval of the contact forces' impulse


def piece(scene: Scene, m: Model, p: Plan | None = None) -> Piece:
    """The first piece of motion, at the initial state; without a plan for the equations at single states."""
    n_q, n_c = scene.n_q, max(scene.n_c, 1)
    x = clock(scene, loop.N_NUMBERS)
    x[MODE], x[NOW], x[HOLD] = FREE, scene.t_span[0], -math.inf
    q, v = np.array(scene.q0), np.array(scene.v0)
    return Piece(
        model=m, contact=scene.n_c > 0, plan=p, corners=np.array(scene.corners), x=x, w=dop853.work(2 * n_q),
        q0=q.copy(), v0=v.copy(), q=q, v=v, a=np.zeros(n_q), y=np.zeros(2 * n_q),
        G=np.zeros((n_c, n_q)), g_t=np.zeros(n_c), g=np.zeros(n_c), MG=np.zeros(n_q), M=np.zeros((n_q, n_q)),
        G_shifted=np.zeros((n_c, n_q)), g_t_shifted=np.zeros(n_c), q_shifted=np.zeros(n_q),
        bias=np.zeros(n_c),
    )  # fmt: skip


class RungeKutta(Run):
    """A run whose smooth motion is integrated by DOP853."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, m: Model, fast: bool) -> None:
        super().__init__(method, scene, kept, one_contact_recorder(scene, kept, dense=kept.all))
        p = plan(scene, m, method, QUADRATURE)
        self.piece, self.fast = piece(scene, m, p), fast
        self.piece.x[loop.RESOLVED], self.piece.x[NEXT_STEP] = p.scan, 0.1 * p.scan
        self.run = compiled(loop.run) if fast else loop.run

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.piece.x[NOW])

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        return float(self.piece.x[loop.END])

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.piece.q0, self.piece.v0

    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""
        return int(self.run(self.piece, self.recorder.buffers, self.count, goal))

    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""
        keep(self.piece, self.recorder.buffers, self.count, self.now)

    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the pieces of motion that start there."""
        made = self.piece.model, self.fast
        dense = self.recorder.dense()
        return Pieces(without_impulses(s), self.kept.all, self.scene, made, self.piece.plan, dense)


@dataclass(eq=False)
class Pieces(BetweenByModel):
    """States between kept ones, by the dense output of the steps and the equations of contact."""

    plan: Plan
    dense: Array

    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""
        m, fast = self.model
        out = Wanted(times, row, *np.zeros((2, len(times), self.scene.n_q)))
        kernel = compiled(states_between) if fast else states_between
        kernel(piece(self.scene, m, self.plan), self.s, self.dense, out)
        return out.q, out.v
