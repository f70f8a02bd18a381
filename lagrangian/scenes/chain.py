"""An elastic chain that flies against a wall: n equal springs between n + 1 masses, those at the ends half as heavy.

A bar of unit mass, length and stiffness, cut into n pieces: its waves run with c = 1 m/s, and the continuous bar
presses on the wall with the constant force rho A c v = v during 2 L/c = 2 s. The front stops dead (restitution 0);
the chain then vibrates with its front held, until the contact force -k x_1 vanishes, and flies off; each stretch of
the motion is a sum of normal modes. What usually goes wrong: the contact force oscillates, an implicit step loses
the energy of the impact, the highest mode limits the step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import LinearSystem

PER_PERIOD = 24  # scan intervals in the period of the highest mode
BISECTIONS = 60


@checked
def elastic_chain(n: int = 10, speed: float = 1.0, distance: float = 0.1, t_end: float = 4.0) -> Scene:
    """Chain of n springs flying with `speed` [m/s] towards a wall at `distance` [m].

    The coordinates are the displacements of the masses, the first of which meets the wall at -distance.
    """
    checks.count("n", n)
    checks.positive("speed", speed)
    checks.positive("distance", distance)
    masses, K = chain_matrices(n)
    front = np.zeros((1, n + 1))
    front[0, 0] = 1.0
    return Scene(
        system=LinearSystem(M=np.diag(masses), K=K),
        contacts=LinearContacts(G=front, offset=distance, restitution=0.0),
        q0=np.zeros(n + 1),
        v0=np.full(n + 1, -speed),
        t_span=(0.0, t_end),
        parameters={"n": n, "speed": speed, "distance": distance},
        name="elastic-chain",
        exact=ChainMotion(n, speed, distance),
    )


def chain_matrices(n: int) -> tuple[Array, Array]:
    """Masses (n + 1,) and stiffness matrix of the chain."""
    masses = np.full(n + 1, 1.0 / n)
    masses[[0, -1]] *= 0.5
    K = 2.0 * np.eye(n + 1) - np.eye(n + 1, k=1) - np.eye(n + 1, k=-1)
    K[0, 0] = K[-1, -1] = 1.0
    return masses, n * K


class Modes(NamedTuple):
    """Normal modes: x = shapes @ (a cos(w t) + b sin(w t)/w), rigid motion where w = 0."""

    w: Array
    shapes: Array
    back: Array  # x -> amplitudes

    def at(self, x: Array, v: Array, tau: Array) -> tuple[Array, Array]:
        """Positions and velocities at the times tau (m,) after x, v; each (m, n)."""
        a, b = self.back @ x, self.back @ v
        angle = np.outer(tau, self.w)
        S = tau[:, None] * np.sinc(angle / np.pi)  # sin(w tau)/w
        return (np.cos(angle) * a + S * b) @ self.shapes.T, (
            np.cos(angle) * b - self.w**2 * S * a
        ) @ self.shapes.T


def modes(masses: Array, K: Array) -> Modes:
    """Normal modes of a chain."""
    root = np.sqrt(masses)
    w2, vectors = np.linalg.eigh(K / np.outer(root, root))
    w2[w2 < 1e-9 * w2[-1] / len(w2) ** 2] = 0.0
    return Modes(np.sqrt(w2), vectors / root[:, None], (vectors * root[:, None]).T)


@dataclass
class ChainMotion:
    """The motion of `elastic_chain` in modes, worked out as far as it is asked for."""

    n: int
    speed: float
    distance: float

    def __post_init__(self) -> None:
        self.stretches: list[tuple[float, bool, Array, Array]] = [  # from t on, front held, x, v
            (0.0, False, np.zeros(self.n + 1), np.full(self.n + 1, -self.speed))
        ]
        self._known = self.distance / self.speed
        self._modes: tuple[Modes, Modes] | None = None

    @property
    def impacts(self) -> list[float]:
        """Times at which the front has stopped, so far."""
        return [t for t, held, _, _ in self.stretches if held]

    @property
    def releases(self) -> list[float]:
        """Times at which it has left the wall, so far."""
        return [t for t, held, _, _ in self.stretches[1:] if not held]

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Displacements and velocities, each (m, n + 1)."""
        t = np.asarray(times, dtype=float)
        self._reach(float(np.max(t, initial=0.0)))
        starts = np.array([start for start, *_ in self.stretches])
        which = np.maximum(np.searchsorted(starts, t, side="right") - 1, 0)
        q, v = np.zeros((len(t), self.n + 1)), np.zeros((len(t), self.n + 1))
        for k in np.unique(which):
            q[which == k], v[which == k] = self._stretch(int(k), t[which == k])
        return q, v

    def force(self, times: Array) -> Array:
        """Force on the wall [N], (m,)."""
        q, _ = self(times)
        return np.where(q[:, 0] <= -self.distance, self.n * (q[:, 0] - q[:, 1]), 0.0)

    def _stretch(self, k: int, t: Array) -> tuple[Array, Array]:
        start, held, x, v = self.stretches[k]
        if k == 0:
            return x - self.speed * t[:, None], np.tile(v, (len(t), 1))
        if self._modes is None:
            masses, K = chain_matrices(self.n)
            self._modes = modes(masses, K), modes(masses[1:], K[1:, 1:])
        if not held:
            return self._modes[0].at(x, v, t - start)
        # Displacements from the wall: at -distance all springs are at rest
        q, dq = self._modes[1].at(x[1:] + self.distance, v[1:], t - start)
        front = np.full((len(t), 1), -self.distance)
        return np.hstack([front, q - self.distance]), np.hstack([0.0 * front, dq])

    def _reach(self, t_end: float) -> None:
        """Find the events up to t_end."""
        step = math.pi / self.n / PER_PERIOD  # the highest mode has w = 2 n
        while self._known <= t_end:
            k = len(self.stretches) - 1
            if k == 0:
                self._strike(self.distance / self.speed)
                continue
            times = np.asarray(self._known + step * np.arange(257), dtype=float)
            opening = self._opening(k, times)
            past = np.flatnonzero((opening[:-1] > 0.0) & (opening[1:] <= 0.0))
            if len(past) == 0:
                self._known = float(times[-1])
                continue
            a, b = float(times[past[0]]), float(times[past[0] + 1])
            for _ in range(BISECTIONS):
                middle = 0.5 * (a + b)
                a, b = (middle, b) if self._opening(k, np.array([middle]))[0] > 0.0 else (a, middle)
            if self.stretches[-1][1]:
                q, v = self._stretch(k, np.array([b]))
                self.stretches.append((b, False, q[0], v[0]))
                self._known = b
            else:
                self._strike(b)

    def _opening(self, k: int, times: Array) -> Array:
        """What stays positive while the stretch lasts: the contact force, or the gap."""
        q, _ = self._stretch(k, times)
        return q[:, 0] - q[:, 1] if self.stretches[k][1] else q[:, 0] + self.distance

    def _strike(self, t: float) -> None:
        q, v = (x[0] for x in self._stretch(len(self.stretches) - 1, np.array([t])))
        q[0], v[0] = -self.distance, 0.0
        # A front that is pulled off the wall as it strikes only loses its velocity
        held = q[0] > q[1] or (q[0] == q[1] and v[1] < 0.0)
        self.stretches.append((t, bool(held), q, v))
        self._known = t
