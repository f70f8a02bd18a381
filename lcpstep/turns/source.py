"""What moves by itself in a scene, and bounds of its place, speed and curve over windows of time.

A frame and the obstacles of flat contacts give all three (s, s', s''); gaps of any form give a place (g) and a curve
(dg/dt at rest), at the initial position.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import FunctionType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene
from lcpstep.callbacks import fingerprint
from lcpstep.intervals import Interval, Moving, NotEnclosed, enclose
from lcpstep.intervals.callbacks import Enclosed, plain

Array = NDArray[np.float64]
LOOKS = 64  # per window, of a function that cannot be evaluated on intervals
FEWEST = 3  # the same where there are many windows
MOST_LOOKS = 32_768  # at all windows of a size, unless these are FEWEST
GOLDEN = 0.6180339887498949
FRAME = "system.frame"
OURS = "lagrangian."  # modules whose functions turn no faster than their period, and name their corners


@dataclass(eq=False)
class Source:
    """One function of time.

    name    of the argument of the scene that it is
    f       the function;  also: that which gives the place, where f itself gives the curve alone
    at      q, v, p, at which it is asked for
    rows    numbers of contacts or coordinates
    sampled why it cannot be evaluated on intervals, or ""
    """

    name: str
    f: Any
    also: Any
    at: tuple[Array, Array, Array]
    rows: int
    sampled: str = ""

    steady = False  # whether a curve that stays what it is is none: it turns where it changes

    @property
    def key(self) -> tuple[Any, ...]:
        """What its answers depend on."""
        functions = self.f, _read_by(self.f), self.also, _read_by(self.also)
        return self.name, self.rows, *functions, *[x.tobytes() for x in self.at]

    @property
    def order(self) -> int:
        """How often the curve is integrated for the place."""
        return 2 if self.also is None else 1

    def ways(self) -> list[Source]:
        """Ways to see where it turns, the best first; the last one always gives bounds."""
        return [self]

    def bounds(self, a: Array, b: Array) -> Enclosed:
        """Place, speed and curve in the windows [a, b] of time: bounds of shape (n, rows, 3)."""
        if not self.sampled:
            try:
                return self.enclosed(a, b)
            except NotEnclosed as why:
                self.sampled = str(why)
        return self.looked_at(a, b)

    def enclosed(self, a: Array, b: Array) -> Enclosed:
        """The same by interval arithmetic."""
        q, v, p = self.at
        state = [[Interval(np.full(len(a), x), np.full(len(a), x)) for x in y] for y in (q, v)]
        t = Interval(a, b)
        if self.also is None:
            return enclose(self.f, t, state[0], state[1], p, (self.rows, 3))
        rate = enclose(self.f, t, state[0], state[1], p, (self.rows,))
        place = enclose(self.also, t, state[0], state[1], p, (self.rows,))
        lo, hi = (np.stack([x, y, y], axis=2) for x, y in ((place.lo, rate.lo), (place.hi, rate.hi)))
        return Enclosed(lo, hi, rate.branched | place.branched)

    def values(self, times: Array) -> Array:
        """Place, speed and curve at many times, (n, rows, 3)."""
        if not self.sampled:
            try:
                return _finite(self.enclosed(times, times).lo)
            except NotEnclosed as why:
                self.sampled = str(why)
        return self.values_told(times)

    def values_told(self, times: Array) -> Array:
        """The same as the function tells them, one after the other: bounds have both sides of a jump nearby."""
        return _finite(np.array([self.value(t) for t in times.tolist()]))

    def looked_at(self, a: Array, b: Array) -> Enclosed:
        """The same by samples, which need not show everything."""
        looks = min(LOOKS, max(FEWEST, MOST_LOOKS // max(len(a), 1)))
        k = np.arange(looks)
        shares = (k + k * GOLDEN % 1.0) / looks
        times = (a[:, None] + shares * (b - a)[:, None]).ravel().tolist()
        values = _finite(np.array([self.value(t) for t in times])).reshape(len(a), looks, self.rows, 3)
        return Enclosed(values.min(axis=1), values.max(axis=1), np.zeros(len(a), dtype=bool))

    def value(self, t: float) -> Array:
        """Place, speed and curve at one time, (rows, 3); zero where the function has no value."""
        q, v, p = (x.copy() for x in self.at)
        shape = (self.rows, 3) if self.also is None else (self.rows,)
        try:
            out = np.zeros(shape)
            self.f(t, q, v, p, out)
            if self.also is not None:
                place = np.zeros(shape)
                self.also(t, q, v, p, place)
                out = np.stack([place, out, out], axis=1)
        except Exception:  # the motion may never come there
            return np.zeros((self.rows, 3))
        return out


def _read_by(f: Any) -> Any:
    """What a function reads from around it, and what it is; equal to nothing where that may change unseen."""
    f = plain(f)
    text = fingerprint.dependencies(f) if isinstance(f, FunctionType) else fingerprint.UNKNOWN
    return object() if f is not None and fingerprint.UNKNOWN in text else text


def _finite(values: Array) -> Array:
    """Zero in the place of what is no number."""
    return np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)


@dataclass(eq=False)
class Belt(Source):
    """The sliding velocity of a belt, which is place and speed; its rate is the curve, or itself where `steady`.

    A belt that runs on as it does turns nowhere, however fast it is.
    """

    steady: bool = False

    def ways(self) -> list[Source]:
        """By the rate, or by the velocity alone where that is not known."""
        return [self, replace(self, steady=True)]

    def bounds(self, a: Array, b: Array) -> Enclosed:
        """Place, speed and curve in the windows [a, b]; NotEnclosed where the rate has no bounds."""
        return super().bounds(a, b) if self.steady else self.enclosed(a, b)

    def enclosed(self, a: Array, b: Array) -> Enclosed:
        """The same by interval arithmetic."""
        if self.steady:
            return super().enclosed(a, b)
        q, v, p = self.at
        state = [[Moving(np.full(len(a), x), np.full(len(a), x), 0.0) for x in y] for y in (q, v)]
        found = enclose(self.f, Moving(a, b, 1.0), state[0], state[1], p, (self.rows,), rates=True)
        if not np.any(np.isfinite(found.hi[..., 1] - found.lo[..., 1])):
            raise NotEnclosed("bounds of its rate are not known")
        return Enclosed(found.lo[..., [0, 0, 1]], found.hi[..., [0, 0, 1]], found.branched)


def sources(scene: Scene) -> list[Source]:
    """What moves by itself in a scene, but for the functions of the ready ones."""
    found: list[tuple[Any, ...]] = []
    system: Any = scene.system
    contacts: Any = scene.contacts
    if isinstance(system, LinearSystem) and system.frame is not None and scene.n_c > 0:
        found.append((FRAME, system.frame, None, scene.n_q))
    if isinstance(contacts, LinearContacts) and contacts.motion is not None:
        found.append(("contacts.motion", contacts.motion, None, scene.n_c))
    if isinstance(contacts, Contacts) and contacts.gap_t is not None:
        found.append(("contacts.gap_t", contacts.gap_t, contacts.gap, scene.n_c))
    users = [x for x in found if not _ours(x[1])]
    if not users:
        return []
    p, nowhere = np.array(scene.p), np.zeros(scene.n_q)  # functions of time alone are the same in all states
    at = {True: (nowhere, nowhere, p), False: (np.array(scene.q0), np.array(scene.v0), p)}
    return [Source(name, f, also, at[also is None], rows) for name, f, also, rows in users]


def frame_of(scene: Scene) -> tuple[Source | None, bool]:
    """The frame of a scene, and whether it is one of the ready functions, which name their corners."""
    system: Any = scene.system
    if not isinstance(system, LinearSystem) or system.frame is None:
        return None, False
    nowhere = np.zeros(scene.n_q)
    found = Source(FRAME, system.frame, None, (nowhere, nowhere, np.array(scene.p)), scene.n_q)
    return found, _ours(system.frame)


def belts(scene: Scene) -> list[Source]:
    """The belts of a scene."""
    friction = None if scene.contacts is None else scene.contacts.friction
    if friction is None or not callable(friction.slip):
        return []
    if _ours(friction.slip):
        return []
    state = np.array(scene.q0), np.array(scene.v0), np.array(scene.p)
    return [Belt("friction.slip", friction.slip, friction.slip, state, scene.n_c)]


def _ours(f: Any) -> bool:
    """Whether a function is one of the ready scenes'."""
    return f"{getattr(plain(f), '__module__', '')}.".startswith(OURS)
