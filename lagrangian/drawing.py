"""What a mechanism looks like, as data: shapes in the plane, given by a function of time and coordinates.

    drawing(t, q) -> [Circle((0.0, q[0]), 0.05, contacts=(0,)), Line([(-1, 0), (1, 0)], fixed=True)]

A scene carries such a function; what draws the shapes is no matter of its own. Lengths are in the scene's units, x to
the right and y up.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.plain import Unavailable

Place = Sequence[float]  # x, y [m]
Drawing = Callable[[float, Any], Sequence["Shape"]]


@dataclass(frozen=True, kw_only=True)
class Look:
    """What all shapes have.

    Attributes
    ----------
    contacts : numbers of the contacts whose impacts this shape shows
    fixed : whether it belongs to what does not move, floors and walls
    """

    contacts: tuple[int, ...] = ()
    fixed: bool = False


@dataclass(frozen=True)
class Point(Look):
    """A dot at a place (x, y) [m], of one size on any scale."""

    at: Place


@dataclass(frozen=True)
class Line(Look):
    """A line from place to place [m]."""

    points: Sequence[Place]


@dataclass(frozen=True)
class Circle(Look):
    """A disc about a centre (x, y) with a radius [m]; one that is fixed is drawn as a ring."""

    centre: Place
    radius: float


@dataclass(frozen=True)
class Polygon(Look):
    """A filled outline through its corners [m]."""

    corners: Sequence[Place]


Shape = Point | Line | Circle | Polygon
CORNERS: dict[type, Callable[[Any], Any]] = {
    Point: lambda x: [x.at],
    Line: lambda x: x.points,
    Circle: lambda x: [x.centre],
    Polygon: lambda x: x.corners,
}


def drawn(drawing: Drawing, t: float, q: Array) -> list[Shape]:
    """The shapes at a time and coordinates.

    Raises
    ------
    ValueError   the function fails, or gives something else than shapes of finite numbers; the message says where
    """
    where = f"at t = {t:.9g}, q = {checks.shown(q)}"
    try:
        given = drawing(t, checks.read_only(q))
        shapes = list(given) if isinstance(given, Iterable) else None
    except Unavailable:
        raise
    except Exception as error:  # the user's code may raise anything; the message says whose it is
        raise ValueError(f"drawing: f(t, q) failed {where}: {checks.said(error)}") from error
    if shapes is None:
        raise ValueError(f"drawing: f(t, q) is to return shapes in a list, not {given!r}, {where}")
    for shape in shapes:
        if not isinstance(shape, Shape):
            raise ValueError(f"drawing: expected Point, Line, Circle or Polygon, got {shape!r} {where}")
        places(shape, where)
    return shapes


def places(shape: Shape, where: str = "") -> Array:
    """The numbers of a shape, (n, 2): corners, or the centre; ValueError where they are none."""
    try:
        result = np.array(CORNERS[type(shape)](shape), dtype=float)
    except (TypeError, ValueError):
        result = np.zeros((0, 0))
    sound = result.ndim == 2 and result.shape[1] == 2 and bool(np.all(np.isfinite(result)))
    more = ""
    if isinstance(shape, Circle):
        r, more = shape.radius, ", and a finite radius above zero"
        sound = sound and isinstance(r, (int, float, np.integer, np.floating)) and 0.0 < r < math.inf
    if not sound:
        raise ValueError(f"drawing: expected places (x, y) of finite numbers{more}, got {shape!r} {where}")
    return result


def extent(shape: Shape) -> tuple[float, float, float, float]:
    """The smallest rectangle around a shape: x and y from, x and y to."""
    at = places(shape)
    r = shape.radius if isinstance(shape, Circle) else 0.0
    (x0, y0), (x1, y1) = np.min(at, axis=0) - r, np.max(at, axis=0) + r
    return float(x0), float(y0), float(x1), float(y1)


def turned(points: Sequence[Place] | Array, angle: float, about: Place = (0.0, 0.0)) -> list[Place]:
    """Places turned by an angle [rad], counterclockwise about the origin, then moved to `about`."""
    s, c = math.sin(angle), math.cos(angle)
    moved = np.asarray(points, dtype=float) @ np.array([[c, s], [-s, c]]) + np.asarray(about, dtype=float)
    return list(map(tuple, moved.tolist()))


def box(left: float, bottom: float, right: float, top: float) -> list[Place]:
    """Corners of a rectangle."""
    return [(left, bottom), (right, bottom), (right, top), (left, top)]


def spring(start: Place, end: Place, width: float, turns: int = 8) -> list[Place]:
    """Corners of a zigzag from one place to another."""
    a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    along = (b - a) / (math.hypot(*(b - a)) or 1.0)
    across = 0.5 * width * np.array([-along[1], along[0]])
    sides = [0.0, *(1.0 if k % 2 else -1.0 for k in range(2 * turns)), 0.0]
    shares = [0.0, *((k + 0.5) / (2 * turns) for k in range(2 * turns)), 1.0]
    return [
        tuple((a + share * (b - a) + side * across).tolist())
        for share, side in zip(shares, sides, strict=True)
    ]
