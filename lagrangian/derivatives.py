"""Derivatives that a user gives, compared with the functions they belong to.

    f(x + h) - f(x + h/2)   against   the integral of f' over the same interval, by Gauss's rule with three nodes

along each coordinate, in time or along the motion, over intervals from the whole scale down to rounding.
Intervals never touch x itself, so that a corner there does no harm. A derivative is wrong where no interval agrees to
a twentieth and all disagree by one factor, or all that are short enough for a function that is seen to be smooth.
Noise, tables and corners do not come out like that; where nothing is certain nothing is said.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterable
from contextlib import contextmanager
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lagrangian.checks import Array, shown

LENGTHS = 2.0 / 8.0 ** np.arange(8)  # of the intervals and half as much, in units of the scale
NODES = np.array([0.5 - math.sqrt(0.15), 0.5, 0.5 + math.sqrt(0.15)])
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
AGREE = 0.05  # relative: less may be the user's own approximation
RESOLVED = 0.02  # relative: Gauss's rule against the midpoint rule
SAME = math.cos(0.3)  # of the angle between (difference, integral) over two intervals
STEEPEST = 3.0  # times steeper may a function be over the next shorter interval
CONVERGING = (4.0, 100.0)  # by how much slopes change less from length to length: 8, or 64 where f'' = 0
ENOUGH = 3  # intervals that disagree
SETS = 4  # of parameters that the same functions are looked at with
NEGLIGIBLE = 1e-3  # of the largest change of a row: what a user may leave out
ROUNDING = 16 * np.finfo(float).eps

Truth = NDArray[np.bool_]
State = tuple[float, Array, Array]  # t, q, v, or a direction in these


class Direction(NamedTuple):
    """Where to look along, and from which state."""

    base: State
    along: State  # as long as the scale
    unit: float  # how long that is, in units of what is differentiated by
    both_sides: bool  # for coordinates: one of the sides may lie inside an obstacle
    names: Callable[[int], tuple[str, str]]  # of a row's derivative, and of what it is the derivative of
    members: tuple[Direction, ...] = ()  # directions that are looked along together


class Relation(NamedTuple):
    """A function with its derivative along some directions, both (rows,)."""

    value: Callable[[State], Array]
    slope: Callable[[State, State], Array]  # at a state, along a direction
    directions: list[Direction]


def compare(relation: Relation) -> None:
    """Raises ValueError where a derivative is certainly wrong."""
    looks = [_look(relation, d) for d in relation.directions]
    largest = np.max([side.steepness() for sides in looks for side in sides], axis=0)
    for direction, sides in zip(relation.directions, looks, strict=True):
        if not np.any(_wrong(sides, largest)):
            continue
        for member in direction.members or (direction,):
            own = _look(relation, member) if direction.members else sides
            for row in np.flatnonzero(_wrong(own, largest))[:1]:
                raise ValueError(_message(member, own[0], int(row)))


class Look(NamedTuple):
    """Differences of a function and integrals of its derivative, (lengths, rows)."""

    difference: Array
    integral: Array
    unresolved: Array  # the integral by Gauss's rule less that by the midpoint rule
    rounding: Array
    side: float

    @property
    def change(self) -> Array:
        """The larger of the two."""
        return np.maximum(np.abs(self.difference), np.abs(self.integral))

    @property
    def right(self) -> Truth:
        """Where both agree."""
        return np.abs(self.difference - self.integral) <= AGREE * self.change + self.rounding

    @property
    def wrong(self) -> Truth:
        """Where they disagree, and it is no matter of numerics."""
        apart = np.abs(self.difference - self.integral)
        sure = (np.abs(self.unresolved) <= RESOLVED * self.change) & (10.0 * self.rounding <= apart)
        return ~self.right & sure

    def steepness(self) -> Array:
        """(rows,) of the function or its derivative, at most."""
        rate = np.where(self.right | self.wrong, self.change, 0.0) / LENGTHS[:, None]
        return np.asarray(np.max(rate, axis=0))

    def certain(self, row: int) -> bool:
        """Whether the derivative of a row is wrong by one factor: over all intervals that tell anything, the longest
        among them, or over the shortest ones if these show the function to be smooth, and no table.
        """
        tell = np.flatnonzero(self.wrong[:, row] | self.right[:, row])
        last = len(tell)  # where the shortest intervals begin that agree with each other
        while last > 0 and self.wrong[tell[last - 1], row] and self._alike(tell[last - 1 :], row):
            last -= 1
        k = tell[last:]
        whole = last == 0 and len(tell) > 0 and tell[0] == 0
        return len(k) >= ENOUGH and (whole or self._smooth(k, row))

    def _alike(self, k: Any, row: int) -> bool:
        """Whether all these intervals show the same factor, and the function gets no steeper."""
        x, y = self.difference[k, row], self.integral[k, row]
        angles = np.abs(x * x[0] + y * y[0]) / np.hypot(x, y) / np.hypot(x[0], y[0])
        slope, noise = np.abs(x) / LENGTHS[k], self.rounding[k, row] / LENGTHS[k]
        return bool(np.all(angles >= SAME) and np.all(slope[1:] <= STEEPEST * slope[:-1] + noise[1:]))

    def _smooth(self, k: Any, row: int) -> bool:
        """Whether slopes over ever shorter intervals converge, as those of a bent and smooth function do."""
        slope, noise = self.difference[k, row] / LENGTHS[k], self.rounding[k, row] / LENGTHS[k]
        change = np.abs(np.diff(slope))
        known = change[1:] > 10.0 * noise[2:]
        fewer, more = CONVERGING
        return bool(np.any(known & (fewer * change[1:] <= change[:-1]) & (change[:-1] <= more * change[1:])))


def _wrong(sides: list[Look], largest: Array) -> Truth:
    """(rows,) whether the derivative is wrong on every side, and matters."""
    found = np.min([side.steepness() for side in sides], axis=0) > NEGLIGIBLE * largest
    for side in sides:
        found &= np.count_nonzero(side.wrong, axis=0) >= ENOUGH
    for row in np.flatnonzero(found):
        found[row] = all(s.certain(int(row)) for s in sides)
    return found


def _look(relation: Relation, d: Direction) -> list[Look]:
    """Along a direction, and the other way where both sides count."""
    return [_one_side(relation, d, side) for side in ((1.0, -1.0) if d.both_sides else (1.0,))]


def _one_side(relation: Relation, d: Direction, side: float) -> Look:
    parts = [_interval(relation, d, side * h) for h in LENGTHS]
    difference, integral, unresolved, rounding = (np.array(x) for x in zip(*parts, strict=True))
    return Look(difference, integral, unresolved, rounding, side)


def _interval(relation: Relation, d: Direction, h: float) -> tuple[Array, Array, Array, Array]:
    """Difference, integral, how far that is resolved, and rounding, between x + h/2 and x + h."""
    ends = [relation.value(moved(d, s)) for s in (0.5 * h, h)]
    slopes = [relation.slope(moved(d, 0.5 * h * (1.0 + s)), d.along) for s in NODES]
    integral = 0.5 * h * (WEIGHTS @ slopes)
    blurred = max(_ratio(x, along) for x, along in zip(d.base, d.along, strict=True))
    rounding = ROUNDING * (np.max(np.abs(ends), axis=0) + blurred * np.max(np.abs(slopes), axis=0))
    return ends[1] - ends[0], integral, integral - 0.5 * h * slopes[1], rounding


def _ratio(x: Any, along: Any) -> float:
    """How many times as large as the way the place is from which it leads; rounding of the place is that of x."""
    x, along = np.abs(np.atleast_1d(x)), np.abs(np.atleast_1d(along))
    return float(np.max(x[along > 0.0] / along[along > 0.0], initial=0.0))


def moved(d: Direction, s: float) -> State:
    """The state so far along a direction."""
    (t, q, v), (dt, dq, dv) = d.base, d.along
    return t + s * dt, q + s * dq, v + s * dv


def within(span: tuple[float, float], t: float, unit: float) -> float:
    """How long a direction of time is from t, so that the longest interval, twice that, keeps to the span.

    A table, or a file, has nothing to say beyond it. Negative where it leads back.
    """
    start, end = span
    room = max(end - t, t - start)
    return math.copysign(min(unit, 0.5 * room), 1.0 if end - t >= room else -1.0)


def _message(d: Direction, look: Look, row: int) -> str:
    """Which entry is wrong, what it is and what it should be, over the interval that tells it best."""
    k = np.flatnonzero(look.wrong[:, row])
    doubt = (np.abs(look.unresolved) + look.rounding)[k, row] / look.change[k, row]
    best = k[np.argmin(doubt)]
    length = 0.5 * LENGTHS[best] * look.side * d.unit
    t, q, v = moved(d, 0.75 * LENGTHS[best] * look.side)
    given, found = look.integral[best, row] / length, look.difference[best, row] / length
    derivative, function = d.names(row)
    return (
        f"{derivative} is {given:.6g} near t = {t:.9g}, q = {shown(q)}, v = {shown(v)}, "
        f"but differences of {function} give {found:.6g}"
    )


class Known:
    """Sets of functions that have been looked at, as long as they live, and with which parameters."""

    def __init__(self) -> None:
        self.parameters: dict[Any, set[bytes]] = {}
        self.more: WeakKeyDictionary[Any, Known] = WeakKeyDictionary()

    @contextmanager
    def look(self, functions: Iterable[Any], what: Any, parameters: Any) -> Generator[bool]:
        """Whether to look at `what` of these functions with these parameters; noted if nothing was wrong.

        Not for more than a few sets of parameters, for a study has thousands of them.
        """
        seen, numbers = self._of(functions).parameters.setdefault(what, set()), parameters.tobytes()
        new = numbers not in seen and len(seen) < SETS
        yield new
        if new:
            seen.add(numbers)

    def _of(self, functions: Iterable[Any]) -> Known:
        """What is known of these functions together; of ones that cannot be remembered, nothing."""
        known = self
        for f in functions:
            try:
                known = known.more.get(f) or known.more.setdefault(f, Known())
            except TypeError:
                return Known()
        return known
