"""The motion around a corner impact in three parts: to the corner, through the impact, on to the section."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.lengths import sizes
from lcpstep.maps.local import Local
from lcpstep.simulation import simulate
from lcpstep.trajectory import IMPACT_DTYPE, Kind, Status, Trajectory

Array = NDArray[np.float64]
Family = Callable[[float], Scene]
SIDE = 1e-9  # of the period: how far from a corner a jump of velocities is looked for
JUMP = 1e-6  # of the gap velocity, relative: a jump this large makes a corner one of degree one
SAMPLES = 32  # of a period, that tell how large a motion is
SOFT = 1e-6  # of the largest gap velocity: an impact softer than this grazes


class NotDifferentiable(LcpStepError):
    """The orbit has a contact at which no derivative exists: grazing, sticking, or a corner of degree one."""


@dataclass(frozen=True, eq=False)
class CornerImpact:
    """A periodic orbit with an impact at a corner of the forcing.

    Attributes
    ----------
    make : p -> scene
    p : parameter at which it happens
    x : (2 n_q,)   state (q, v) on the section, at t = phase x period
    phase, periods : of the section; after how many periods the orbit repeats
    corner : index of the corner in scene.corners
    time : of the corner impact, counted as the section's t is [s]
    before, after : gap velocities at the corner impact [m/s]
    others : (m,)   times of the orbit's other impacts [s]
    residual : max |P^n(x) - x| and |g| at the corner
    """

    make: Family
    p: float
    x: Array
    phase: float
    periods: int
    corner: int
    time: float
    before: float
    after: float
    others: Array
    residual: float

    @property
    def scene(self) -> Scene:
        """The scene at the parameter of the corner impact."""
        return self.make(self.p)


class Pieces:
    """The motion of a family of scenes in three parts: to the corner, through the impact, and on to the section."""

    def __init__(self, make: Family, method: EventDriven, phase: float, n: int) -> None:
        self.make, self.method, self.phase, self.n = make, method, phase, n
        self.corner, self.turn = 0, 0
        self.pauses = (phase, phase + n)  # phases between which the motion is free but for the corner impact

    @classmethod
    def of(cls, orbit: CornerImpact, method: EventDriven) -> Pieces:
        """Those of an orbit that is known."""
        pieces = cls(orbit.make, method, orbit.phase, orbit.periods)
        pieces.corner = orbit.corner
        T = orbit.scene.period
        pieces.turn = round((orbit.time - float(np.asarray(orbit.scene.corners)[orbit.corner])) / T)
        pieces.pause(orbit.time / T, orbit.others / T)
        return pieces

    def aim(self, p: float, x: Array, corner: int | None) -> None:
        """Which impact of the motion from x meets which corner."""
        scene = self.make(p)
        T = scene.period
        run = self.run(scene, x, self.phase * T, (self.phase + self.n) * T)
        if np.any(run.impacts.kind != Kind.IMPACT):
            raise NotDifferentiable("the contact closes for good on the orbit (chattering or sticking)")
        times, speeds = run.impacts.time / T, np.abs(run.impacts.before)
        if len(times) == 0:
            raise ValueError(f"x: the motion from {x.tolist()} has no impact within {self.n} periods")
        corners = np.asarray(scene.corners) / T
        if corner is not None and not 0 <= corner < len(corners):
            raise ValueError(f"corner: expected an index below {len(corners)}, got {corner!r}")
        distance = (times[:, None] - corners[None, :] + 0.5) % 1.0 - 0.5
        if corner is not None:
            distance[:, [k for k in range(len(corners)) if k != corner]] = np.inf
        i, self.corner = (int(k) for k in np.unravel_index(np.argmin(np.abs(distance)), distance.shape))
        self.turn = round(times[i] - distance[i, self.corner] - corners[self.corner])
        if np.min(speeds) < SOFT * np.max(speeds):
            raise NotDifferentiable("an impact of the orbit grazes: its speed is zero to rounding")
        self.pause(corners[self.corner] + self.turn, np.delete(times, i))
        self.check_degree(scene, float(np.max(speeds)))

    def pause(self, at: float, others: Array) -> None:
        """Phases half way from the corner impact to its neighbours, or to the section."""
        left = max([self.phase, *others[others < at]])
        right = min([self.phase + self.n, *others[others > at]])
        self.pauses = (left if left == self.phase else 0.5 * (left + at), 0.5 * (right + at))

    def scales(self, x: Array, p: float) -> Array:
        """How large the state from x on and the parameter are: what steps and residuals of (x, p) are a share of."""
        T = self.make(p).period
        times = np.linspace(self.phase, self.phase + self.n, SAMPLES * self.n + 1) * T
        run = self.run(self.make(p), x, times[0], times[-1], times)
        return np.append(sizes(run), abs(p) or 1.0)

    def check_degree(self, scene: Scene, speed: float) -> None:
        """The gap velocity must be continuous at the corner; speed: of the orbit's impacts."""
        t = (float(np.asarray(scene.corners)[self.corner])) + self.turn * scene.period
        q, v, p = (np.asarray(x, dtype=float) for x in (scene.q0, scene.v0, scene.p))
        early, late = (scene.gap(t + s * SIDE * scene.period, q, v)[1][0] for s in (-1.0, 1.0))
        jump = abs(late - early)
        frame = getattr(scene.system, "frame", None)
        if frame is not None:
            before, after = (
                checks.evaluate("frame", frame, (t + s * SIDE * scene.period, q, v, p), (scene.n_q, 3))
                for s in (-1.0, 1.0)
            )
            jump = max(jump, float(np.max(np.abs(after[:, 1] - before[:, 1]))))
        if jump > JUMP * max(speed, abs(early)):
            raise NotDifferentiable(
                f"corner {self.corner} is of degree one: the velocity jumps by {jump:.3g} there, where only the "
                f"acceleration may"
            )

    def corner_time(self, p: float) -> float:
        """When the corner comes at the parameter p [s]."""
        scene = self.make(p)
        return float(np.asarray(scene.corners)[self.corner]) + self.turn * scene.period

    def clear(self, scene: Scene) -> float:
        """How far it is from the corner to the nearest other one [s]."""
        corners = np.asarray(scene.corners) / scene.period
        away = np.abs((np.delete(corners, self.corner) - corners[self.corner] + 0.5) % 1.0 - 0.5)
        return float(np.min(away, initial=1.0)) * scene.period

    def to_corner(self, x: Array, p: float) -> Array:
        """F1: the state at the corner, as it would be there without the impact."""
        scene = self.make(p)
        start, rest = self.phase * scene.period, self.pauses[0] * scene.period
        return self.free(scene, self.moved(scene, x, start, rest), rest, self.corner_time(p))

    def from_corner(self, y: Array, p: float) -> Array:
        """F2: from the state at the corner, after the impact, to the section."""
        scene = self.make(p)
        rest, end = self.pauses[1] * scene.period, (self.phase + self.n) * scene.period
        return self.moved(scene, self.free(scene, y, self.corner_time(p), rest), rest, end)

    def gap(self, y: Array, p: float) -> Array:
        """H: the gap of the state y at the corner, (1,)."""
        scene, n = self.make(p), len(y) // 2
        return np.asarray(scene.gap(self.corner_time(p), y[:n], y[n:])[0])

    def rebound(self, y: Array, p: float) -> Array:
        """R: the state y after an impact at the corner."""
        n = len(y) // 2
        v = Local(self.make(p)).after_impact(self.corner_time(p), y[:n], y[n:])
        return np.concatenate([y[:n], v])

    def closing(self, z: Array) -> Array:
        """What must vanish: the state after n periods less that at the start, and the gap at the corner."""
        x, p = z[:-1], float(z[-1])
        y = self.to_corner(x, p)
        return np.append(self.from_corner(self.rebound(y, p), p) - x, self.gap(y, p))

    def described(self, z: Array, residual: float) -> CornerImpact:
        """The orbit through the state and the parameter z = (x, p)."""
        x, p = z[:-1], float(z[-1])
        scene, t = self.make(p), self.corner_time(p)
        n = len(x) // 2
        y = self.to_corner(x, p)
        u = float(scene.gap(t, y[:n], y[n:])[1][0])
        image = self.rebound(y, p)
        after = float(scene.gap(t, image[:n], image[n:])[1][0])
        T = scene.period
        late = self.free(scene, image, t, self.pauses[1] * T)
        first = self.impacts(scene, x, self.phase * T, self.pauses[0] * T)
        last = self.impacts(scene, late, self.pauses[1] * T, (self.phase + self.n) * T)
        others = np.concatenate([first["time"], last["time"]])
        speeds = np.concatenate([first["before"], last["before"], [u]])
        if u >= 0.0 or np.min(np.abs(speeds)) < SOFT * np.max(np.abs(speeds)):
            raise NotDifferentiable("an impact of the orbit grazes: its speed is zero to rounding")
        return CornerImpact(self.make, p, x, self.phase, self.n, self.corner, t, u, after, others, residual)

    def impacts(self, scene: Scene, x: Array, a: float, b: float) -> Any:
        """The impact log of the motion from x at a."""
        return self.run(scene, x, a, b).impacts if b > a else np.zeros(0, dtype=IMPACT_DTYPE)

    def moved(self, scene: Scene, x: Array, a: float, b: float) -> Array:
        """The state at b of the motion with contacts from x at a."""
        if b <= a:
            return x
        run = self.run(scene, x, a, b)
        return np.concatenate([run.q[-1], run.v[-1]])

    def free(self, scene: Scene, x: Array, a: float, b: float) -> Array:
        """The state at b of the motion without contacts from x at a."""
        return self.moved(replace(scene, contacts=None), x, a, b)

    def run(self, scene: Scene, x: Array, a: float, b: float, keep: Array | None = None) -> Trajectory:
        """The motion from x at a; its end alone, or the states at these times."""
        n = scene.n_q
        run = simulate(
            replace(scene, q0=x[:n], v0=x[n:], t_span=(a, b), exact=None),
            self.method,
            keep=[b] if keep is None else keep,
        )
        if run.status != Status.DONE:
            raise LcpStepError(f"the motion from x = {x.tolist()} at t = {a:g} s ended early: {run.message}")
        return run
