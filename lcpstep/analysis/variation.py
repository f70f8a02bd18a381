"""Derivative of a motion with impacts with respect to its initial state: variational flow and saltation matrices.

Between events J' = F_x J. At an impact of the state x = (q, v) on the surface H(t, x) = g = 0, with x+ = R(t, x-),

    D = R_x + (F+ - R_x F- - R_t) H_x / (H_x F- + H_t),      H_x F- + H_t = u-  (time is a state: rheonomic)

Where infinitely many impacts end, or an impact without rebound, the contact closes and the surplus over the
surface is lost: the projection along M^-1 G^T onto g = u = 0, of rank two less. Closed, the flow is the
constrained one; a release is continuous and has D = 1. Source: G. Osorio, Complex Behavior in Impacting Systems,
eqs. 3.42-3.43 (sign of F_x- there: by differences); A. Nordmark, P. Piiroinen, Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import LinearContacts, LinearSystem, Scene, checks
from lcpstep.analysis.derivative import differences
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.maps.batch import Periods, periods
from lcpstep.maps.follow import Follower
from lcpstep.maps.local import Local
from lcpstep.maps.saltation.rubbing import Walk
from lcpstep.maps.stroboscopic import StroboscopicMap
from lcpstep.simulation import simulate
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
IMPACTS = 512  # of a period by time-stepping that a derivative is made of


def factors(run: Trajectory) -> list[Array]:
    """The derivative of a motion's end by its start, as matrices to be multiplied from the left one by one.

    Parameters
    ----------
    run : trajectory of `lcpstep.EventDriven` that kept its states at events or at every step

    Returns
    -------
    list of (2 n_q, 2 n_q)   smooth flows and saltation matrices in the order of time

    Raises
    ------
    LcpStepError   the run ended early, or has events at which its end has no derivative, as simultaneous impacts
    """
    scene, contacts = run.scene, run.scene.contacts
    linear = isinstance(scene.system, LinearSystem) and isinstance(contacts, LinearContacts)
    if not linear or scene.n_j > 0 or scene.n_c > 1 or contacts.friction is not None:
        return Walk(run).factors()
    if run.status != Status.DONE:
        raise LcpStepError(f"the motion ended early: {run.message}")
    return _Variation(run).factors()


def saltation(local: Local, t: float, q: Array, before: Array, after: Array) -> Array:
    """D of an impact, (2 n_q, 2 n_q)."""
    n = len(q)
    G, u = local.rates(t, q, before)
    F_before = np.concatenate([before, local.acceleration(t, q, before)])
    F_after = np.concatenate([after, local.acceleration(t, q, after)])
    R_x, R_t = impact_law(local, t, q, before)
    H_x = np.concatenate([G, np.zeros(n)])
    return R_x + np.outer(F_after - R_x @ F_before - R_t, H_x) / u


def impact_law(local: Local, t: float, q: Array, v: Array) -> tuple[Array, Array]:
    """R_x (2 n_q, 2 n_q) and R_t (2 n_q,) of the state after an impact, (q, v+)."""
    n, r = len(q), local.restitution
    MG, W = local.response(t, q, v)
    G, _ = local.rates(t, q, v)
    R_x, R_t = np.eye(2 * n), np.zeros(2 * n)
    R_x[n:, n:] -= (1.0 + r) / W * np.outer(MG, G)
    R_t[n:] = -(1.0 + r) / W * MG * local.bias(t, q, v)
    return R_x, R_t


def landing(local: Local, t: float, q: Array, v: Array) -> Array:
    """The projection where the contact closes for good: what is left of a deviation, (2 n_q, 2 n_q)."""
    n = len(q)
    MG, W = local.response(t, q, v)
    G, _ = local.rates(t, q, v)
    loss = np.outer(MG, G) / W
    D = np.eye(2 * n)
    D[:n, :n] -= loss
    D[n:, n:] -= loss
    return D


class _Variation:
    """Walks along a trajectory of a linear system with one contact, whose flows are matrix exponentials."""

    def __init__(self, run: Trajectory) -> None:
        self.run, self.local = run, Local(run.scene)

    def factors(self) -> list[Array]:
        run, spans = self.run, []
        jumps: list[tuple[int, float, float, int]] = []
        t, closed, row = float(run.t[0]), False, 0
        for event in run.impacts:
            # A chattering sequence counts as closed from its last impact on; its end is noted for later.
            now = t if event.kind == Kind.ACCUMULATION else min(float(event.time), float(run.t[-1]))
            if event.kind == Kind.STICK and jumps and jumps[-1][0] == Kind.ACCUMULATION:
                now = t
            spans.append((t, now, closed, row))
            row = max(int(np.searchsorted(run.t, now, side="right")) - 1, 0)
            jumps.append((event.kind, now, event.impulse, row))
            closed = event.kind == Kind.STICK or (closed and event.kind != Kind.RELEASE)
            t = now
        spans.append((t, float(run.t[-1]), closed, row))
        flows = self.flows(spans)
        result = [flows[0]]
        for jump, flow in zip(jumps, flows[1:], strict=True):
            result += [self.jump(*jump), flow]
        return result

    def jump(self, kind: int, t: float, impulse: float, row: int) -> Array:
        """The matrix of an event."""
        q, v = self.run.q[row], self.run.v[row]
        if kind == Kind.IMPACT:
            before = self.local.before_impact(t, q, v, impulse)
            return saltation(self.local, t, q, before, v)
        if kind == Kind.STICK:
            return landing(self.local, t, q, v)
        return np.eye(2 * len(q))

    def flows(self, spans: list[tuple[float, float, bool, int]]) -> list[Array]:
        """The smooth flow over each span."""
        from scipy.linalg import expm

        free, constrained = self.matrices()
        stack = np.array([(b - a) * (constrained if closed else free) for a, b, closed, _ in spans])
        return list(expm(stack))

    def matrices(self) -> tuple[Array, Array]:
        """State matrices of a linear system, free and with its contact closed."""
        m, n = self.local.model.arrays, self.run.scene.n_q
        free = state_matrix(self.local)
        if self.run.scene.n_c == 0:
            return free, free
        G, inverse = m["G"][0], m["M_inverse"]
        MG, W = inverse @ G, float(G @ inverse @ G)
        keep = np.eye(n) - np.outer(MG, G) / W
        both = np.block([[keep, np.zeros((n, n))], [np.zeros((n, n)), keep]])
        return free, both @ free


def flow(scene: Scene, duration: float) -> Array:
    """Derivative of the free motion of a linear system over a time [s] by its start, (2 n_q, 2 n_q)."""
    from scipy.linalg import expm

    return np.asarray(expm(duration * state_matrix(Local(scene))))


def state_matrix(local: Local) -> Array:
    """A of x' = A x + .. for a linear system in free motion, x = (q, v)."""
    m, n = local.model.arrays, local.scene.n_q
    return np.block([[np.zeros((n, n)), np.eye(n)], [-m["M_inverse"] @ m["K"], -m["M_inverse"] @ m["C"]]])


def monodromy(scene: Scene, method: EventDriven, x: ArrayLike, t: tuple[float, float]) -> Array:
    """Derivative of the state at t[1] by the state x = (q, v) at t[0], (2 n_q, 2 n_q).

    Raises
    ------
    ValueError   x lies inside of the obstacle
    LcpStepError   the motion ended early, or the scene has more than one contact
    """
    run = _motion(scene, method, x, t)
    result = np.eye(2 * scene.n_q)
    for factor in factors(run):
        result = factor @ result
    return result


def _motion(scene: Scene, method: EventDriven, x: ArrayLike, t: tuple[float, float]) -> Trajectory:
    from dataclasses import replace

    x = checks.array("x", x, (2 * scene.n_q,))
    n = scene.n_q
    return simulate(replace(scene, q0=x[:n], v0=x[n:], t_span=t), method, keep="impacts")


class PeriodMap(StroboscopicMap):
    """The stroboscopic map of an event-driven motion, modes or not, with its derivative by saltation matrices."""

    def jacobian(self, x: ArrayLike) -> Array:
        """DP(x), (2 n_q, 2 n_q)."""
        return np.asarray(self.along(x, 1)[1][0])

    def along(self, x: ArrayLike, n: int, drop: int = 0) -> tuple[Array, Array]:
        """Images of the n iterations after the first `drop`, (n, d), and the derivative of each, (n, d, d)."""
        most = 0 if isinstance(self.method, EventDriven) else IMPACTS  # of which derivatives are made
        run = self.follow(x, drop + n, drop, most=most, tangents=True)
        if run.tangents.shape[1]:
            return run.states[0], run.tangents[0]
        before = self.follow(x, drop).final[0] if drop else checks.array("x", x, (self.scene.n_x,))
        points = [before, *run.states[0, :-1]]
        return run.states[0], np.array([self.differentiated(y) for y in points])

    def many(self, starts: ArrayLike, n: int, drop: int = 0, *, most: int) -> Periods:
        """Runs from many states, that need not lie outside of the obstacle to the last digit, with derivatives."""
        return periods(
            self.scene,
            self.method,
            starts,
            n,
            drop=drop,
            phase=self.phase,
            most=most,
            strict=False,
            tangents=True,
        )

    def from_impacts(self, log: Array, counts: NDArray[np.int64]) -> Array:
        """Derivatives of periods with these impacts, (m, n, 2, 2); see `lcpstep.maps.tangent.along_logs`."""
        scene = cast(Scene, self.scene)  # those of time-stepping
        return np.asarray(Follower(scene, EventDriven()).tangents_of(log, counts, self.time))

    def differentiated(self, x: Array) -> Array:
        """DP(x) by walking along the motion's events, or by differences where it has none to walk along."""
        if not isinstance(self.method, EventDriven):
            return differences(self, x)
        scene = cast(Scene, self.scene)  # systems with modes have told theirs
        return monodromy(scene, self.method, x, (self.time, self.time + self.scene.period))
