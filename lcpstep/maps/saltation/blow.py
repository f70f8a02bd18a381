"""The law of an impact that has happened as a map of states, differentiated: which contacts stick and slide in it.

    v+ = v + M^-1 C^T p,   K v+ + rate+ = -r (K v + rate)

K: joints, normals that get an impulse, tangents that stick; C: the same, with the friction of those that slide. Rates
differ where obstacles, frames or belts take on another velocity at a corner of the scene.
Moreau's law with the set of contacts and directions that the run has found. Source: as `impact`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.errors import LcpStepError
from lcpstep.events.codes import OPEN
from lcpstep.events.contacts import point
from lcpstep.lengths import derivative
from lcpstep.trajectory import Kind

Array = NDArray[np.float64]
EDGE = 1e-7  # sliding velocity left in an impact that is none, relative
LIKE = 1e-6  # velocities that the law must give back, relative to their change
SLACK = 100.0  # tolerances of the run, by which velocities may be off
STEP = 1e-4  # of differences


class Blow:
    """The impact between two pieces of a `rubbing.Walk`."""

    def __init__(self, walk: Any, before: Any, after: Any, events: Any) -> None:
        self.s, self.n, self.t = walk.s, walk.n, float(after.t)
        self.sizes, self.latest = walk.sizes, walk.scale
        self.lasted, self.p = before.end - before.t, np.array(walk.scene.p)
        self.x, self.v_after = before.x_end, after.x[walk.n :]
        contacts: Any = walk.scene.contacts
        self.friction, r = contacts.friction, np.asarray(contacts.restitution, dtype=float)
        self.r_T, method = self.friction.tangential(r), walk.run.method
        self.noise = SLACK * (method.atol + method.rtol * float(np.max(np.abs(self.v_after))))
        self.turned = (
            self.rates_after(walk, before, after) if walk.at_corner(self.t) else np.zeros(self.s.n_r)
        )
        strikes = [e for e in events if e.kind == Kind.IMPACT]
        self.active = sorted({int(e.contact) for e in strikes})
        if len(strikes) > len(self.active) or self.late(strikes):
            raise LcpStepError(
                f"several impacts follow one another at t = {self.t:g} s: no derivative is known"
            )
        # a closed contact keeps its place: only what strikes rebounds
        self.r = np.where(np.asarray(before.mode) == OPEN, r, 0.0)
        self.sliding = self.directions()
        told, change = self.law(self.t, self.x), np.max(np.abs(self.v_after - self.x[self.n :]))
        if np.max(np.abs(told - self.v_after)) > LIKE * change + self.noise:
            raise LcpStepError(
                f"the impact at t = {self.t:g} s is not one of Moreau's law with one set of contacts "
                "(another `law`, or contacts that are struck in turn): no derivative is known"
            )

    def rates_after(self, walk: Any, before: Any, after: Any) -> Array:
        """By how much the rates of rows jump at a corner of the scene."""
        rates = []
        for piece, hold in ((after, walk.hold_from_the_start), (before, walk.hold_to_the_end)):
            hold(piece)
            rates.append(point.rows(self.s, self.t, self.x)[2].copy())
        return np.asarray(rates[0] - rates[1])

    def late(self, strikes: Any) -> bool:
        """Whether a contact strikes with another speed than it came with, by an impact at the same instant."""
        R, _, rate, _ = point.rows(self.s, self.t, self.x)
        came, size = R @ self.x[self.n :] + rate, np.max(np.abs(self.v_after - self.x[self.n :]))
        speeds = [(float(e.before), came[self.s.n_j + int(e.contact)]) for e in strikes]
        return any(abs(told - had) > LIKE * size + self.noise for told, had in speeds)

    def directions(self) -> dict[int, float]:
        """Contact: direction of the friction impulse, for those that slide through the impact: u_T+ + r u_T- != 0."""
        n_j, n_c = self.s.n_j, self.s.n_c
        R, _, rate, _ = point.rows(self.s, self.t, self.x)
        before, after = (
            (R @ self.x[self.n :] + rate)[n_j + n_c :],
            (R @ self.v_after + rate + self.turned)[n_j + n_c :],
        )
        left, mu = after + self.r_T * before, self.mu(self.t, self.x, before)
        size = EDGE * (np.abs(after) + np.abs(before)) + self.noise
        return {c: -float(np.sign(left[c])) for c in self.active if abs(left[c]) > size[c] or mu[c] == 0.0}

    def mu(self, t: float, x: Array, u: Array) -> Array:
        """Coefficients at the sliding velocities u before the impact, (n_c,)."""
        return np.asarray(self.friction.coefficients(t, x[: self.n], u, self.p)[0])

    def matrices(self, t: float, x: Array) -> tuple[Array, Array, Array]:
        """K (rows, n_q), M^-1 C^T (n_q, rows), and (3, rows): 1 + r, rates of the rows, by how much these jump."""
        n_j, n_c = self.s.n_j, self.s.n_c
        R, MR, rate, _ = point.rows(self.s, t, np.ascontiguousarray(x))
        stuck = [c for c in self.active if c not in self.sliding]
        rows = [*range(n_j), *(n_j + c for c in self.active), *(n_j + n_c + c for c in stuck)]
        C, mu = MR.copy(), self.mu(t, x, (R @ x[self.n :] + rate)[n_j + n_c :])
        for c, way in self.sliding.items():
            C[n_j + c] += way * mu[c] * MR[n_j + n_c + c]
        r = np.array([0.0] * n_j + [self.r[c] for c in self.active] + [self.r_T[c] for c in stuck])
        return R[rows], C[rows].T, np.stack([1.0 + r, rate[rows], self.turned[rows]])

    def law(self, t: float, x: Array) -> Array:
        """v+ (n_q,)."""
        K, C, (share, rate, turned) = self.matrices(t, x)
        v = x[self.n :]
        return np.asarray(v - C @ np.linalg.pinv(K @ C) @ (share * (K @ v + rate) + turned))

    def derivatives(self) -> tuple[Array, Array]:
        """R_x (2 n_q, 2 n_q) and R_t (2 n_q,) of the state after the impact, (q, v+)."""
        n = self.n
        R_x, R_t = np.eye(2 * n), np.zeros(2 * n)
        K, C, (share, _, _) = self.matrices(self.t, self.x)
        R_x[n:, n:] -= C @ np.linalg.pinv(K @ C) @ (share[:, None] * K)
        if not self.s.constant:
            m = 2 * n if callable(self.friction.mu) else n  # linear in v where mu does not depend on it
            R_x[n:, :m] = derivative(
                lambda x: self.law(self.t, np.append(x, self.x[m:])), self.x[:m], STEP, self.sizes[:m]
            )
        d = STEP * max(self.lasted, 1e-3 * self.latest)
        before, earlier, later, after = (self.law(self.t + k * d, self.x) for k in (-2.0, -1.0, 1.0, 2.0))
        R_t[n:] = (8.0 * (later - earlier) - after + before) / (12.0 * d)
        return R_x, R_t
