"""Derivative of a motion with modes by its initial state: variational flows and saltation matrices.

    J' = F_x J in a mode,    D = R_x + (F+ - R_x F- - R_t) H_x / (H_x F- + H_t) at a switch

with the reset R and the guard H; sliding that begins loses a dimension by the same formula, for there F+ is
Filippov's field. Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.42-3.43; R. Leine, H. Nijmeijer,
Dynamics and Bifurcations of Non-Smooth Mechanical Systems (Springer 2004), chapter 7.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.derivative import differences
from lcpstep.errors import LcpStepError
from lcpstep.events.hybrid.field import field, guard_gradient
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
TOLERANCE = 1e-12  # of the variational flow


class Variation:
    """The factors of the derivative of one motion."""

    def __init__(self, run: HybridTrajectory) -> None:
        if run.status != Status.DONE:
            raise LcpStepError(f"the motion ended early: {run.message}")
        self.run, self.names = run, run.scene.system.names
        self.machine, _ = machine(run.scene, plain=True)

    def factors(self) -> list[Array]:
        """Flows and saltation matrices in the order of time, (n_x, n_x) each."""
        run, result = self.run, []
        t, x, mode = run.pieces.t[0], np.array(run.scene.x0), run.scene.mode
        for event in run.switches:
            result.append(self.flow(t, event.time, x, mode))
            result.append(self.saltation(event))
            t, x, mode = float(event.time), np.array(event.after), str(event.target)
        result.append(self.flow(t, float(run.pieces.t[-1]), x, mode))
        return result

    def field(self, mode: str, t: float, x: Array) -> Array:
        """The vector field of a mode."""
        out = np.zeros(len(x))
        field(self.machine, self.names.index(mode), t, np.ascontiguousarray(x), out)
        return out

    def flow(self, a: float, b: float, x: Array, mode: str) -> Array:
        """Derivative of the smooth motion over a span."""
        from scipy.integrate import solve_ivp

        n = len(x)
        if b <= a:
            return np.eye(n)

        def right_hand_side(t: float, y: Array) -> Array:
            A = differences(lambda z: self.field(mode, t, z), y[:n])
            return np.concatenate([self.field(mode, t, y[:n]), (A @ y[n:].reshape(n, n)).ravel()])

        start = np.concatenate([x, np.eye(n).ravel()])
        done = solve_ivp(right_hand_side, (a, b), start, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE)
        if not done.success:
            raise LcpStepError(f"the variational flow could not be integrated: {done.message}")
        return np.asarray(done.y[n:, -1].reshape(n, n))

    def saltation(self, event: np.record) -> Array:
        """D of one switch."""
        t, before, k = float(event.time), np.array(event.before), int(event.guard)
        mode = self.names.index(str(event.source))
        H_t = guard_gradient(self.machine, mode, k, t, before)
        H_x = self.machine.work.g_x.copy()
        F_before = self.field(str(event.source), t, before)
        F_after = self.field(str(event.target), t, np.array(event.after))
        R_x, R_t = np.eye(len(before)), np.zeros(len(before))
        if self.machine.has_reset[k]:
            R_x = differences(lambda x: self.reset(k, t, x), before)
            R_t = differences(lambda s: self.reset(k, float(s[0]), before), np.array([t]))[:, 0]
        crossing = float(H_x @ F_before + H_t)
        if not abs(crossing) > 0.0:
            raise LcpStepError(f"at t = {t:.12g} a guard of mode {event.source!r} is not transversal")
        return R_x + np.outer(F_after - R_x @ F_before - R_t, H_x) / crossing

    def reset(self, k: int, t: float, x: Array) -> Array:
        """R of guard k."""
        out = np.zeros(len(x))
        self.machine.resets[k](t, np.ascontiguousarray(x), self.machine.p, out)
        return out


def monodromy(run: HybridTrajectory) -> Array:
    """Derivative of the end of a motion by its start, (n_x, n_x).

    Raises
    ------
    LcpStepError   the motion ended early, or a guard of it is not transversal
    """
    result = np.eye(run.scene.system.n_x)
    for factor in Variation(run).factors():
        result = factor @ result
    return result
