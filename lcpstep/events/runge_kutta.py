"""Runs of general systems with one contact, whose smooth motion is integrated by DOP853."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled
from lcpstep.events import dop853
from lcpstep.events import integrator as loop
from lcpstep.events.flow import FREE, MODE, N_NUMBERS, SCALE, Piece
from lcpstep.events.run import Run, between, scan_interval
from lcpstep.model import Model
from lcpstep.recording import Kept, States

Array = NDArray[np.float64]
QUADRATURE = 10  # nodes per interval of the contact forces' impulse


def flow(scene: Scene, m: Model, method: Any) -> loop.Flow:
    """How the smooth motion of the scene is computed."""
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE)
    return loop.Flow(
        nodes=0.5 * (1.0 + nodes), weights=0.5 * weights, contact=scene.n_c > 0, scan=scan_interval(scene, m, 0.0),
        rtol=method.rtol, atol=method.atol, corners=np.array(scene.corners), period=scene.period,
        t_end=scene.t_span[1], max_events=method.max_events,
    )  # fmt: skip


def piece(scene: Scene, m: Model) -> Piece:
    """Work space of a piece of motion, at the initial state."""
    n_q, n_c = scene.n_q, max(scene.n_c, 1)
    x = np.zeros(N_NUMBERS)
    x[MODE] = FREE
    x[SCALE] = scene.period if math.isfinite(scene.period) else scene.t_span[1] - scene.t_span[0]
    q, v = np.array(scene.q0), np.array(scene.v0)
    return Piece(
        x=x, q0=q.copy(), v0=v.copy(), q=q, v=v, a=np.zeros(n_q), y=np.zeros(2 * n_q),
        G=np.zeros((n_c, n_q)), g_t=np.zeros(n_c), g=np.zeros(n_c), MG=np.zeros(n_q), M=np.zeros((n_q, n_q)),
        G_shifted=np.zeros((n_c, n_q)), g_t_shifted=np.zeros(n_c),
        q_shifted=np.zeros(n_q),
    )  # fmt: skip


class RungeKutta(Run):
    """A run whose smooth motion is integrated by DOP853."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, m: Model, fast: bool) -> None:
        super().__init__(method, scene, kept, dense=kept.all)
        self.model, self.flow, self.piece = m, flow(scene, m, method), piece(scene, m)
        self.work, self.tableau = dop853.work(2 * scene.n_q), dop853.tableau()
        self.fast = fast
        self.run = compiled(loop.run) if fast else loop.run
        self.x = np.zeros(loop.N_NUMBERS)
        self.x[loop.NOW] = scene.t_span[0]
        self.x[loop.HOLD] = self.x[loop.LAST_EVENT] = -math.inf
        self.x[loop.RESOLVED] = self.flow.scan
        self.x[loop.NEXT_STEP] = 0.1 * self.flow.scan

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.x[loop.NOW])

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        return float(self.x[loop.END])

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.piece.q0, self.piece.v0

    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""
        m, f, p, w, record = self.model, self.flow, self.piece, self.work, self.recorder.buffers
        return int(self.run(m, f, p, self.tableau, w, record, self.count, self.x, goal))

    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""
        loop.keep(self.piece, self.recorder.buffers, self.count, self.x, self.now)

    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the pieces of motion that start there."""
        dense, n_q = self.recorder.dense(), self.scene.n_q

        def evaluate(times: Array, row: Any) -> tuple[Array, Array]:
            out = loop.Wanted(times, row, np.zeros((len(times), n_q)), np.zeros((len(times), n_q)))
            work = dop853.work(2 * n_q)
            kernel = compiled(loop.evaluate) if self.fast else loop.evaluate
            kernel(self.model, self.flow, piece(self.scene, self.model), work, s, dense, out)
            return out.q, out.v

        result: Callable[[Array], tuple[Array, Array]] = between(self.kept.all, s, evaluate)
        return result
