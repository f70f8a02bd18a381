"""Blocks: on springs, belts, slopes and feet, in piles, rocking."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

from lagrangian.drawing import Line, Point, Polygon, Shape, box, spring, turned
from lagrangian.scenes.drawings.common import Shapes


def sprung(t: float, q: Any, *, stop: float, size: float) -> Shapes:
    """A block on a spring, left of a stop."""
    w, wall = 0.3 * size, -1.8 * size
    return [
        Line([(wall, -0.5 * w), (wall, 1.5 * w)], fixed=True),
        Line([(stop, -0.5 * w), (stop, 1.5 * w)], fixed=True),
        Line(spring((wall, 0.5 * w), (q[0] - w, 0.5 * w), 0.5 * w)),
        Polygon(box(q[0] - w, 0.0, q[0], w), contacts=(0,)),
    ]


def on_swaying(t: float, q: Any, *, p: Any, size: float) -> Shapes:
    """A block on a spring, on a belt; p as in `mass_on_belt`."""
    at = p[0] * t + p[1] * (math.cos(p[2] * t + p[3]) - math.cos(p[3]))
    return on_belt(t, q, size=size, moved=at, contacts=(0,))


def on_belt(
    t: float,
    x: Any,
    *,
    size: float,
    belt: float = 0.0,
    moved: float | None = None,
    contacts: tuple[int, ...] = (),
) -> Shapes:
    """A block on a spring, on a floor or a belt that runs with a speed, or has moved so far."""
    far = belt * t if moved is None else moved
    w, wall, end = 0.3 * size, -2.0 * size, 2.0 * size
    pitch = 0.5 * size
    first = math.floor(2.0 * end / pitch)
    marks = (
        [wall + (k * pitch + far) % (first * pitch) for k in range(first)]
        if belt or moved is not None
        else []
    )
    return [
        Line([(wall, w), (wall, 0.0), (end, 0.0)], fixed=True),
        *(Line([(at, 0.0), (at - 0.1 * w, -0.3 * w)], fixed=True) for at in marks),
        Line(spring((wall, 0.5 * w), (x[0] - 0.5 * w, 0.5 * w), 0.5 * w)),
        Polygon(box(x[0] - 0.5 * w, 0.0, x[0] + 0.5 * w, w), contacts=contacts),
    ]


def two_springs(t: float, x: Any, *, size: float) -> Shapes:
    """A mass between two springs, the right one where x is positive."""
    w = 0.2 * size
    rest = w + max(x[0], 0.0)
    return [
        Line([(-2.0 * size, -w), (-2.0 * size, w)], fixed=True),
        Line([(2.0 * size, -w), (2.0 * size, w)], fixed=True),
        Line(spring((-2.0 * size, 0.0), (x[0] - w, 0.0), w)),
        Line(spring((2.0 * size, 0.0), (rest, 0.0), w)),
        Polygon(box(x[0] - w, -w, x[0] + w, w)),
    ]


def blocks(t: float, q: Any, *, sides: tuple[float, ...], upright: bool) -> Shapes:
    """Square blocks on a line above a floor, or right of a wall."""
    far = 1.5 * max(sides)
    ground = [(-far, 0.0), (far, 0.0)] if upright else [(0.0, 2.0 * far), (0.0, 0.0), (4.0 * far, 0.0)]
    shapes: list[Shape] = [Line(ground, fixed=True)]
    below = 0.0
    for k, a in enumerate(sides):
        at = q[k] + below
        corners = box(-0.5 * a, at, 0.5 * a, at + a) if upright else box(at, 0.0, at + a, a)
        shapes.append(Polygon(corners, contacts=tuple(c for c in (k, k + 1) if c < len(sides))))
        below += a
    return shapes


def feet(t: float, q: Any, *, n: int, width: float) -> Shapes:
    """A block on feet; q are height and angle."""
    places = [(width * (k / (n - 1) - 0.5), 0.0) for k in range(n)]
    body = turned(box(-0.5 * width, 0.0, 0.5 * width, 0.3 * width), q[1], (0.0, q[0]))
    standing = [Point(at, contacts=(k,)) for k, at in enumerate(turned(places, q[1], (0.0, q[0])))]
    return [
        Line([(-width, 0.0), (width, 0.0)], fixed=True),
        Polygon(body, contacts=tuple(range(n))),
        *standing,
    ]


def stacked(t: float, q: Any, *, n: int) -> Shapes:
    """Blocks of unit width on each other; q are height and angle of each."""
    tall = 0.3
    shapes: list[Shape] = [Line([(-1.0, 0.0), (1.0, 0.0)], fixed=True)]
    for k in range(n):
        corners = turned(box(-0.5, 0.0, 0.5, tall), q[2 * k + 1], (0.0, q[2 * k] + k * tall))
        shapes.append(Polygon(corners, contacts=(2 * k, 2 * k + 1)))
    return shapes


def chain(t: float, q: Any, *, distance: float) -> Shapes:
    """Masses joined by springs, right of a wall."""
    n = len(q) - 1
    at = [(k / n + x, 0.0) for k, x in enumerate(q)]
    wall = Line([(-distance, -0.15), (-distance, 0.15)], fixed=True)
    springs = [Line(spring(a, b, 0.05, 3)) for a, b in pairwise(at)]
    return [wall, *springs, *(Point(place, contacts=(0,) if k == 0 else ()) for k, place in enumerate(at))]


def rocking(t: float, q: Any, *, b: float, h: float) -> Shapes:
    """A block on its corners; q is the size of the angle, drawn about the left corner, or x, y and angle."""
    floor = Line([(-3.0 * b, 0.0), (3.0 * b, 0.0)], fixed=True)
    block = box(-b, -h, b, h)
    if len(q) == 3:
        return [floor, Polygon(turned(block, q[2], (q[0], q[1])), contacts=(0, 1))]
    middle = turned([(b, h)], q[0])[0]
    return [floor, Polygon(turned(block, q[0], (middle[0] - b, middle[1])), contacts=(0,))]


def on_slope(t: float, q: Any, *, slope: float, size: float, reach: float) -> Shapes:
    """A block on a slope that falls to the right; q are the places along it and off it."""
    floor = turned([(-size, 0.0), (reach, 0.0)], -slope)
    block = turned(box(q[0] - 0.5 * size, q[1], q[0] + 0.5 * size, q[1] + 0.6 * size), -slope)
    return [Line(floor, fixed=True), Polygon(block, contacts=(0,))]
