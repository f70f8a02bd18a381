"""Pendulums, rods, wheels, toys and machines."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from lagrangian.drawing import Circle, Line, Point, Polygon, box, spring, turned
from lagrangian.profiles import rotating_cam
from lagrangian.scenes.drawings.common import OUTLINE, SLIM, SPOKES, Shapes


def pendulum(t: float, q: Any, *, length: float) -> Shapes:
    """A bob on a rod, right of a stop; q is the angle, or the bob's place."""
    x, y = (length * math.sin(q[0]), -length * math.cos(q[0])) if len(q) == 1 else (q[0], q[1])
    r = SLIM * length
    return [
        Line([(-r, -1.2 * length), (-r, -0.7 * length)], fixed=True),
        Line([(0.0, 0.0), (x, y)]),
        Point((0.0, 0.0), fixed=True),
        Circle((x, y), r, contacts=(0,)),
    ]


def links(t: float, q: Any, *, left: float, right: float) -> Shapes:
    """Links hinged to each other above a floor from left to right; q are the places of the hinges."""
    places = [(float(x), float(y)) for x, y in np.reshape(q, (-1, 2))]
    hinges = [Point(place, contacts=(k,)) for k, place in enumerate(places)]
    return [Line([(left, 0.0), (right, 0.0)], fixed=True), Line(places), *hinges]


def two_rods(
    t: float, q: Any, *, points: bool, wall: float | None = None, floor: float | None = None
) -> Shapes:
    """Two rods of unit length, whose tip meets a wall or a floor; q are the angles, or both points."""
    a = (q[0], q[1]) if points else (math.sin(q[0]), -math.cos(q[0]))
    b = (q[2], q[3]) if points else (a[0] + math.sin(q[1]), a[1] - math.cos(q[1]))
    limit = (
        [(wall, -2.2), (wall, 0.3)] if wall is not None else [(-0.5, -(floor or 0.0)), (2.0, -(floor or 0.0))]
    )
    joints = [Point((0.0, 0.0), fixed=True), Point(a), Point(b, contacts=(0,))]
    return [Line(limit, fixed=True), Line([(0.0, 0.0), a, b], contacts=(0,)), *joints]


def pecking(t: float, q: Any, *, height: float) -> Shapes:
    """A sleeve around a pole, and a bird on it; q are the height of the sleeve and two angles."""
    pole, half, inner, bird = 0.0025, 0.0058, 0.0031, 0.025
    sides = [Line([(x, q[0] - height), (x, q[0] + height)], fixed=True) for x in (-pole, pole)]
    sleeve = turned([(-inner, half), (-inner, -half)], q[1], (0.0, q[0]))
    other = turned([(inner, half), (inner, -half)], q[1], (0.0, q[0]))
    joint = turned([(0.010, 0.0)], q[1], (0.0, q[0]))[0]
    body = turned([(0.015, 0.0)], q[2], joint)[0]
    beak = turned([(0.015 - 0.0201, 0.020)], q[2], joint)[0]
    return [
        *sides,
        Line(sleeve, contacts=(1, 2)),
        Line(other, contacts=(1, 2)),
        Line([(0.0, q[0]), joint]),
        Line(spring(joint, body, 0.2 * bird)),
        Circle(body, 0.15 * bird),
        Line([body, beak]),
        Point(beak, contacts=(0,)),
    ]


def leaning_rod(t: float, q: Any, *, half: float, reach: float) -> Shapes:
    """A rod on a floor; q are its centre and angle."""
    floor = Line([(-reach, 0.0), (reach, 0.0)], fixed=True)
    dx, dy = half * math.cos(q[2]), half * math.sin(q[2])
    tip = (q[0] - dx, q[1] - dy)
    return [floor, Line([tip, (q[0] + dx, q[1] + dy)]), Point(tip, contacts=(0,))]


def wheel(t: float, q: Any, *, radius: float, reach: float) -> Shapes:
    """A wheel on a floor; q are x, height and angle."""
    middle = (q[0], q[1] + radius)
    spokes = [2.0 * math.pi * k / SPOKES + q[2] for k in range(SPOKES)]
    rim = [(middle[0] + radius * math.cos(a), middle[1] + radius * math.sin(a)) for a in spokes]
    floor = Line([(-2.0 * radius, 0.0), (reach, 0.0)], fixed=True)
    return [floor, Circle(middle, radius, contacts=(0,)), *(Line([middle, end], fixed=True) for end in rim)]


def crank(t: float, q: Any, *, p: Any) -> Shapes:
    """Crank, rod, and a slider in its guide; p as in `slider_crank`."""
    l1, l2, a, b, c = p[:5]
    pin = (l1 * math.cos(q[0]), l1 * math.sin(q[0]))
    middle = (pin[0] + l2 * math.cos(q[1]), pin[1] + l2 * math.sin(q[1]))
    ends = (l2 - l1 - 1.5 * a, l2 + l1 + 1.5 * a)
    guide = [Line([(ends[0], y), (ends[1], y)], fixed=True) for y in (b + c, -b - c)]
    slider = Polygon(turned(box(-a, -b, a, b), q[2], middle), contacts=(0, 1, 2, 3))
    return [
        *guide,
        slider,
        Line([(0.0, 0.0), pin, middle]),
        Point((0.0, 0.0), fixed=True),
        Point(pin),
        Point(middle),
    ]


def cam(t: float, q: Any, *, p: Any, relative: bool) -> Shapes:
    """A cam that turns below its follower."""
    out, outline = np.zeros((1, 3)), cam_outline(tuple(p))
    rotating_cam(t, q, q, p, out)
    tip = p[2] + q[0] + (out[0, 0] if relative else 0.0)
    size = float(np.max(np.abs(outline)))
    w, beta = 0.1 * size, p[0] * t + p[1]
    top, head = p[2] + 4.2 * size, tip + 1.5 * size
    foot = [(0.0, tip), (w, tip + w), (w, head), (-w, head), (-w, tip + w)]
    return [
        Polygon(turned(outline, beta), fixed=True),
        Point((0.0, 0.0), fixed=True),
        Line([(-0.5 * size, top), (0.5 * size, top)], fixed=True),
        Line(spring((0.0, head), (0.0, top), w)),
        Polygon(foot, contacts=(0,)),
    ]


@lru_cache(8)
def cam_outline(p: Any) -> Any:
    """Places (n, 2) of a cam's outline, whose point at the angle beta is on top when it has turned by that."""
    still = np.array(p, dtype=float)
    still[0], out = 1.0, np.zeros((1, 3))
    still[1] = 0.0
    angles = np.linspace(0.0, 2.0 * math.pi, OUTLINE, endpoint=False)
    radius = []
    for beta in angles:
        rotating_cam(float(beta), out[0], out[0], still, out)
        radius.append(p[2] + out[0, 0])
    return np.stack([radius * np.sin(angles), radius * np.cos(angles)], axis=1)
