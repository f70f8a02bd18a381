"""Bounds of what keeps closed contacts closed, sticking or sliding, with dry friction: linear systems event by event.

Under constant and harmonic forces, with constant normals G, tangents T and coefficients mu, the multipliers x of the
rows held, those of sliding contacts with their friction, are

    x = -(R M^-1 C^T)^-1 (R M^-1 (F(t) - C v - K q) + bias(t)),   R = (G; T_stick),  C = (G - s mu T_slide; T_stick)

so that each of the guards lambda_N >= 0, mu_s lambda_N -+ lambda_T >= 0 (sticks) and s (T v + slip) >= 0 (slides) is
linear in q and v, which are polynomials, and has two harmonics. Source: as of `events.contacts.held`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep.audit.polynomials import Polynomials
from lcpstep.audit.windows import Seen, Windows
from lcpstep.intervals import Interval

Array = NDArray[np.float64]
STILL = 1e-9  # of the velocities: what slides no faster in the middle of a piece sticks
SINGULAR = 1e-10  # of the largest singular value: contacts that share their forces in several ways
ROUNDING = 1e-13  # of the numbers that a guard is made of
NOISE = 4e-15  # of the positions, which velocities are differences of
WAVES = 4  # cosine and sine of the force, and of the belts


def is_known(scene: Scene) -> bool:
    """Whether a scene's closed contacts have guards of this form."""
    system, contacts = scene.system, scene.contacts
    if not (isinstance(system, LinearSystem) and isinstance(contacts, LinearContacts)) or scene.n_j > 0:
        return False
    friction: Any = contacts.friction
    still = contacts.motion is None and system.frame is None and not system.sparse
    return bool(
        still and isinstance(system.force, Harmonic) and friction is not None
        and not (callable(friction.mu) or callable(friction.tangent) or callable(friction.slip))
    )  # fmt: skip


class Cones:
    """The guards of closed contacts over windows, as if the smallest of them were a gap.

    Parameters
    ----------
    scene : Scene, of which `is_known`;  motion : Polynomials;  v : (m + 1, n_q);  closed : (m, n_c)
    error : (absolute, relative)   of positions and velocities
    """

    why = ""

    def __init__(
        self, scene: Scene, motion: Polynomials, v: Array, closed: Any, error: tuple[float, float]
    ) -> None:
        system: Any = scene.system
        contacts: Any = scene.contacts
        friction, n = contacts.friction, scene.n_c
        self.motion, self.closed, self.error = motion, closed, error
        self.rates = rates(motion)
        self.M_inverse, self.C, self.K = np.linalg.inv(system.M), np.asarray(system.C), np.asarray(system.K)
        self.G, self.T = np.asarray(contacts.G, dtype=float), np.asarray(friction.tangent, dtype=float)
        self.mu = np.asarray(friction.mu, dtype=float)
        self.mu_s = self.mu if friction.mu_s is None else np.asarray(friction.mu_s, dtype=float)
        self.force = [np.asarray(x, dtype=float) for x in system.force.terms(scene.n_q)]
        self.slip, self.omega = [np.zeros(n)] * 3, (float(system.force.omega), 0.0)
        if isinstance(friction.slip, Harmonic):
            self.slip = [np.asarray(x, dtype=float) for x in friction.slip.terms(n)]
            self.omega = self.omega[0], float(friction.slip.omega)
        elif friction.slip is not None:
            self.slip = [np.asarray(friction.slip, dtype=float), np.zeros(n), np.zeros(n)]
        self.modes = self.found(v)
        self.known: dict[tuple[int, ...], Array | None] = {}

    def found(self, v: Array) -> Array:
        """Of every contact in every piece: the direction in which it slides, 0 where it sticks, (m, n_c)."""
        t, h, w = self.motion.t, np.diff(self.motion.t), self.omega[1]
        k = np.arange(len(h))
        half, d = self.motion.windows(k, t[:-1] + 0.5 * h, t[1:]), 2.0 * self.motion.degree
        with np.errstate(all="ignore"):
            middle = np.nan_to_num(d * (half[:, 1] - half[:, 0]) / h[:, None], posinf=0.0, neginf=0.0)
            loose = np.nan_to_num(ROUNDING * np.max(np.abs(half), axis=(1, 2)) / h, posinf=0.0)
        out = np.zeros((len(h), len(self.G)))
        known = (v[:-1], t[:-1], 0.0), (v[1:], t[1:], 0.0), (middle, t[:-1] + 0.5 * h, loose)
        for velocity, at, noise in known:
            waves = np.outer(np.cos(w * at), self.slip[1]) + np.outer(np.sin(w * at), self.slip[2])
            u = velocity @ self.T.T + self.slip[0] + waves
            size = 1.0 + np.max(np.abs(velocity), axis=1)[:, None] + sum(np.abs(x) for x in self.slip)
            slides = np.abs(u) > STILL * size + np.reshape(noise, (-1, 1))
            out = np.where((out == 0.0) & slides, np.sign(u), out)
        return out

    def guards(self, key: tuple[int, ...]) -> Array | None:
        """Of one pattern of modes: rows of what (q, v, 1, waves) count, (n_c, 3, 2 n_q + 1 + WAVES); None: unknown.

        key : of every contact 2 where it is open, else its direction
        """
        n, mode = len(self.K), np.array(key)
        shut = np.flatnonzero(mode != 2)
        stick, slide = shut[mode[shut] == 0], np.where(mode == 2, 0, mode)
        R = np.concatenate([self.G[shut], self.T[stick]])
        columns = np.concatenate([self.G[shut] - (slide * self.mu)[shut, None] * self.T[shut], self.T[stick]])
        W = R @ self.M_inverse @ columns.T
        if np.linalg.svd(W, compute_uv=False)[-1] <= SINGULAR * np.max(np.abs(W)):
            return None
        constant, cosine, sine = self.force
        pushed = np.concatenate([-self.K, -self.C, np.stack([constant, cosine, sine], axis=1)], axis=1)
        free = np.concatenate([R @ self.M_inverse @ pushed, np.zeros((len(R), 2))], axis=1)
        free[len(shut) :, -2:] = self.omega[1] * np.stack([self.slip[2], -self.slip[1]], axis=1)[stick]
        x = -np.linalg.solve(W, free)
        rows = np.zeros((len(mode), 3, 2 * n + 1 + WAVES))
        for i, c in enumerate(shut):
            rows[c] = x[i]
            if mode[c] == 0:
                tangent = x[len(shut) + int(np.flatnonzero(stick == c)[0])]
                rows[c, 1], rows[c, 2] = self.mu_s[c] * x[i] - tangent, self.mu_s[c] * x[i] + tangent
            elif self.mu[c] > 0.0:
                own = [np.zeros(n), self.T[c], [self.slip[0][c], 0.0, 0.0, self.slip[1][c], self.slip[2][c]]]
                rows[c, 1] = mode[c] * np.concatenate(own)
        return rows

    def rows(self, w: Windows) -> tuple[Array, Any]:
        """The guards of every window, (n, 3, 2 n_q + 1 + WAVES), and in which these are known."""
        modes = np.where(self.closed, self.modes, 2.0)[w.k].astype(int)
        patterns, which = np.unique(modes, axis=0, return_inverse=True)
        out, known = np.zeros((len(w.k), 3, 2 * len(self.K) + 1 + WAVES)), np.ones(len(w.k), dtype=bool)
        for i, x in enumerate(patterns):
            key = tuple(x.tolist())
            if key not in self.known:
                self.known[key] = self.guards(key)
            at, rows = np.flatnonzero(which.ravel() == i), self.known[key]
            if rows is None:
                known[at] = False
            else:
                out[at] = rows[w.c[at]]
        return out, known

    def seen(self, w: Windows, *, rough: bool) -> Seen:
        """The smallest guard over windows, by its ends and how it bends in between, or by its own bounds."""
        n, h, (rows, known) = len(self.K), w.b - w.a, self.rows(w)
        q, v, a, j = (x.windows(w.k, w.a, w.b) for x in self.rates)
        whole = self.motion.t[w.k + 1] - self.motion.t[w.k]
        waves = [wave(x, Interval(w.a, w.b)) for x in self.omega]
        sizes = np.max(np.abs(q), axis=1), np.max(np.abs(v), axis=1)
        lower, at = np.full(len(h), np.inf), np.full((2, len(h)), np.inf)
        error = np.zeros(len(h))
        for g in range(3):
            row = rows[:, g]
            parts = [along(x, y, row[:, i : i + n]) for x, y, i in ((q, a, 0), (v, j, n))]
            ends = np.stack(
                [np.sum(row[:, :n] * q[:, k] + row[:, n : 2 * n] * v[:, k], axis=1) for k in (0, -1)]
            )
            size = np.abs(row[:, 2 * n]) + sum(
                np.sum(np.abs(row[:, i : i + n]) * x, axis=1) for i, x in ((0, sizes[0]), (n, sizes[1]))
            )
            spread = np.sum(np.abs(row[:, : 2 * n]), axis=1)
            noise = NOISE * self.motion.degree / whole * np.sum(np.abs(row[:, n : 2 * n]) * sizes[0], axis=1)
            for k, (cosine, sine, values) in enumerate(waves):
                c, s = row[:, 2 * n + 1 + 2 * k], row[:, 2 * n + 2 + 2 * k]
                parts += [scaled(cosine, c), scaled(sine, s)]
                ends = ends + c * values[0] + s * values[1]
                size = size + np.abs(c) + np.abs(s)
            ends = ends + row[:, 2 * n]
            place, curve = sum(x.lo for x, _ in parts) + row[:, 2 * n], sum(y.hi for _, y in parts)
            bent = np.minimum(*ends) - 0.125 * np.maximum(curve, 0.0) * h * h
            own = self.error[0] * spread + (self.error[1] + ROUNDING) * size + noise
            lower, at = np.minimum(lower, np.maximum(place, bent) + own), np.minimum(at, ends)
            error = np.maximum(error, own)
        lower, unknown = np.where(known, lower - error, -np.inf), np.full(len(h), np.inf)
        no = np.zeros(len(h), dtype=bool)
        return Seen(lower, -unknown, unknown, -unknown, unknown, at[0], at[1], error, error, no, error)


def rates(motion: Polynomials) -> list[Polynomials]:
    """The motion with its first three derivatives."""
    found, h = [motion], np.where(np.diff(motion.t) > 0.0, np.diff(motion.t), np.inf)[:, None, None]
    for _ in range(3):
        x = found[-1]
        found.append(Polynomials(x.t, x.degree * np.diff(x.B, axis=1) / h))
    return found


def along(x: Array, bend: Array, row: Array) -> tuple[Interval, Interval]:
    """Bounds of a row's product with polynomials (n, degree + 1, n_q), and with their second derivatives."""
    found = []
    for y in (x, bend):
        z = np.einsum("nki,ni->nk", y, row)
        slack = ROUNDING * np.max(np.abs(z), axis=1)
        found.append(Interval(z.min(axis=1) - slack, z.max(axis=1) + slack))
    return found[0], found[1]


def wave(omega: float, t: Interval) -> tuple[tuple[Interval, Interval], tuple[Interval, Interval], Array]:
    """Cosine and sine of omega t over windows, each with its second derivative; values (2, 2, n) at both ends."""
    angle = omega * t
    cosine, sine = angle.cos(), angle.sin()
    values = np.stack([[f(omega * x) for x in (t.lo, t.hi)] for f in (np.cos, np.sin)])
    bend = -omega * omega
    return (cosine, bend * cosine), (sine, bend * sine), values


def scaled(x: tuple[Interval, Interval], factor: Array) -> tuple[Interval, Interval]:
    """The same bounds, times a number of every window."""
    own = Interval(factor, factor)
    return x[0] * own, x[1] * own
