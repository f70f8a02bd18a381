"""Scenes in which an event is easily missed, drawn at random, each with what is true of its first flight.

An oscillator of one turn a second, or a free body, passes an obstacle that reaches towards it for a short time, or at
one place; the widths are 1e-1 to 1e-5 of a period. Whether it is met, the free motion says, which is known in closed
form: its smallest gap is found by looking at it densely where it can be small, and polished.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
TURN = 2.0 * math.pi
LOOKS = 4001
ZOOMS = 6
SPAN = 10.0


@dataclass(frozen=True)
class Case:
    """A scene, what kind it is, how narrow, and what is known of its first flight.

    gap : gap(t, q) [m];  free : the exact free motion q(t);  near : times between which the gap can be small
    """

    kind: str
    width: float
    scene: Scene
    gap: Callable[[float, Any], float]
    free: Callable[[float], Any]
    near: tuple[float, float]

    @cached_property
    def least(self) -> float:
        """The smallest gap of the exact free motion [m]."""
        return self.lowest[0]

    @cached_property
    def lowest(self) -> tuple[float, float]:
        """The same with its time."""
        return lowest(lambda times: [self.gap(t, self.free(t)) for t in times.tolist()], *self.near)

    def gaps(self, run: Trajectory, times: Array) -> list[float]:
        """The gaps of the motion that a run without an event has computed [m]."""
        return [self.gap(t, q) for t, q in zip(times.tolist(), computed(run, times), strict=True)]

    def least_of(self, run: Trajectory) -> float:
        """The smallest of them [m]."""
        a, b = max(self.near[0], run.t[0]), min(self.near[1], run.t[-1])
        return lowest(lambda times: self.gaps(run, times), a, b)[0]


def computed(run: Trajectory, times: Array) -> Array:
    """Positions between kept states; of steps by cubics: `Trajectory.at` makes them again, and looks for events."""
    if isinstance(run.method, EventDriven):
        return run.at(times)[0]
    return np.asarray(CubicHermiteSpline(run.t, run.q, run.v)(times))


def bell(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """An obstacle that reaches up for a short time: p = (height, width, time)."""
    s = (t - p[2]) / p[1]
    e = p[0] * math.exp(-s * s)
    out[0, 0], out[0, 1], out[0, 2] = e, -2.0 * s * e / p[1], (4.0 * s * s - 2.0) * e / p[1] ** 2


def bump(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """The same with a beginning and an end."""
    s = (t - p[2]) / p[1]
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0
    if abs(s) < 1.0:
        w = 1.0 - s * s
        out[0, 0], out[0, 1] = p[0] * w**3, -6.0 * p[0] * s * w * w / p[1]
        out[0, 2] = (24.0 * s * s * w - 6.0 * w * w) * p[0] / p[1] ** 2


def ground(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """A bump at one place of the ground: p = (height, width, place, offset)."""
    s = (q[0] - p[2]) / p[1]
    out[0] = q[1] + p[3] - p[0] * math.exp(-s * s)


def ground_q(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its Jacobian."""
    s = (q[0] - p[2]) / p[1]
    out[0, 0], out[0, 1] = 2.0 * s / p[1] * p[0] * math.exp(-s * s), 1.0


def ground_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its acceleration at v' = 0."""
    s = (q[0] - p[2]) / p[1]
    out[0] = (2.0 - 4.0 * s * s) / p[1] ** 2 * p[0] * math.exp(-s * s) * v[0] * v[0]


def swing(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Forces of a body that goes along the ground at constant speed and swings above it."""
    out[0], out[1] = 0.0, -TURN * TURN * q[1]


@contextmanager
def blind() -> Iterator[None]:
    """Without the knowledge of what turns fast: the scan is as fine as the motion alone asks for."""
    with (
        patch("lcpstep.turns.stops.sources", return_value=[]),
        patch("lcpstep.events.scan.fastest_turn", return_value=math.inf),
    ):
        yield


def moving(kind: str, rng: np.random.Generator) -> Case:
    """An oscillator above an obstacle that reaches up once, by a free height or just as far as the motion."""
    width = 10.0 ** rng.uniform(-5.0, -1.0)
    phase, at = rng.uniform(0.0, TURN), rng.uniform(0.3, SPAN - 0.3)
    motion = bell if rng.random() < 0.5 else bump
    above = math.cos(TURN * at + phase) + 1.05
    height = rng.uniform(0.05, 1.0)
    if kind == "tangent":
        height = above * (1.0 + rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, -2.0))
    p = np.array([height, width, at])
    scene = Scene(
        system=LinearSystem(M=1.0, K=TURN**2),
        contacts=LinearContacts(G=1.0, offset=1.05, restitution=0.8, motion=motion),
        q0=math.cos(phase), v0=-TURN * math.sin(phase), t_span=(0.0, SPAN), p=p, name=f"{kind} {width:.2g}",
    )  # fmt: skip
    out = np.zeros((1, 3))

    def gap(t: float, q: Any) -> float:
        motion(t, None, None, p, out)
        return float(q[0]) + 1.05 - float(out[0, 0])

    def free(t: float) -> Any:
        return (math.cos(TURN * t + phase),)

    return Case(kind, width, scene, gap, free, (at - 4.0 * width, at + 4.0 * width))


def over_ground(kind: str, rng: np.random.Generator) -> Case:
    """A body that passes over a narrow bump of the ground, as functions of its place."""
    width = 10.0 ** rng.uniform(-5.0, -1.0)
    phase, at = rng.uniform(0.0, TURN), rng.uniform(0.3, SPAN - 0.3)
    above = math.cos(TURN * at + phase) + 1.05
    height = rng.uniform(0.05, 1.0)
    if kind == "ground, tangent":
        height = above * (1.0 + rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-7.0, -2.0))
    p = np.array([height, width, at, 1.05])
    scene = Scene(
        system=System(2, np.eye(2), swing),
        contacts=Contacts(1, ground, ground_q, bias=ground_bias, restitution=0.8),
        q0=[0.0, math.cos(phase)], v0=[1.0, -TURN * math.sin(phase)], t_span=(0.0, SPAN), p=p,
        name=f"{kind} {width:.2g}",
    )  # fmt: skip

    def gap(t: float, q: Any) -> float:
        s = (q[0] - at) / width
        return float(q[1]) + 1.05 - height * math.exp(-s * s)

    def free(t: float) -> Any:
        return t, math.cos(TURN * t + phase)

    return Case(kind, width, scene, gap, free, (at - 4.0 * width, at + 4.0 * width))


def grazing(kind: str, rng: np.random.Generator) -> Case:
    """A forced oscillator whose wall lies as far as it swings, to a share of 1e-2 to 1e-9: double roots."""
    rate, phase = rng.uniform(0.5, 4.0) * TURN, rng.uniform(0.0, TURN)
    amplitude = rng.uniform(0.1, 2.0)
    share = rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, -2.0)
    offset = amplitude * (1.0 + share)
    q0 = amplitude * math.cos(phase)
    while q0 + offset <= 1e-3 * amplitude:
        phase = rng.uniform(0.0, TURN)
        q0 = amplitude * math.cos(phase)
    scene = Scene(
        system=LinearSystem(M=1.0, K=rate**2), contacts=LinearContacts(G=1.0, offset=offset, restitution=0.8),
        q0=q0, v0=-amplitude * rate * math.sin(phase), t_span=(0.0, SPAN), name=kind,
    )  # fmt: skip

    def gap(t: float, q: Any) -> float:
        return float(q[0]) + offset

    def free(t: float) -> Any:
        return (amplitude * math.cos(rate * t + phase),)

    return Case(kind, 1.0, scene, gap, free, (0.0, SPAN))


KINDS: dict[str, Callable[[str, np.random.Generator], Case]] = {
    "burr": moving, "tangent": moving, "ground": over_ground, "ground, tangent": over_ground, "double root": grazing,
}  # fmt: skip


def smallest(gap: Callable[[float], float], a: float, b: float) -> float:
    """The smallest value between a and b."""
    return lowest(lambda times: [gap(t) for t in times.tolist()], a, b)[0]


def lowest(gaps: Callable[[Array], list[float]], a: float, b: float) -> tuple[float, float]:
    """The smallest value between a and b and its place: dense looks, and denser ones around the best."""
    best, place = math.inf, a
    for _ in range(ZOOMS):
        times = np.linspace(a, b, LOOKS if math.isinf(best) else LOOKS // 40)
        values = gaps(times)
        k = int(np.argmin(values))
        if values[k] < best:
            best, place = values[k], float(times[k])
        a, b = float(times[max(k - 1, 0)]), float(times[min(k + 1, len(times) - 1)])
    return best, place
