"""Balls above floors and tables, beads on a line, a point in a bowl.

Beads have no size where they move; here each is drawn as a disc and pushed aside by those below it, so that two discs
touch exactly where a gap is closed.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lagrangian.drawing import Circle, Line, Polygon, Shape, box
from lagrangian.scenes.drawings.common import SLIM, Shapes


def ball(t: float, q: Any, *, size: float) -> Shapes:
    """A ball above a floor."""
    r = SLIM * size
    floor = Line([(-0.5 * size, 0.0), (0.5 * size, 0.0)], fixed=True)
    return [floor, Circle((0.0, q[0] + r), r, contacts=(0,))]


def ball_on_sine(t: float, q: Any, *, p: Any, size: float) -> Shapes:
    """A ball above a table that moves as a sine."""
    return on_table(q, p[0] * math.sin(p[1] * t + p[2]), size)


def ball_on_kinked(t: float, q: Any, *, p: Any, size: float) -> Shapes:
    """A ball above a table whose velocity jumps."""
    return on_table(q, (p[1] if t < p[0] else p[2]) * (t - p[0]), size)


def on_table(q: Any, s: float, size: float) -> Shapes:
    """A ball above a table at the height s."""
    r = SLIM * size
    table = Polygon(box(-0.5 * size, s - 0.3 * r, 0.5 * size, s), fixed=True)
    return [table, Circle((0.0, q[0] + r), r, contacts=(0,))]


def in_bowl(t: float, q: Any, *, radius: float) -> Shapes:
    """A point in a bowl."""
    r = 0.5 * SLIM * radius
    angles = np.linspace(math.pi, 2.0 * math.pi, 61)
    wall = [((radius + r) * math.cos(a), (radius + r) * math.sin(a)) for a in angles]
    return [Line(wall, fixed=True), Circle((q[0], q[1]), r, contacts=(0,))]


def beads(t: float, q: Any, *, r: float, upright: bool, walls: tuple[float, ...], floor: bool) -> Shapes:
    """Beads on a line, a wall or floor at 0, and one at each of `walls`."""
    n = len(q)

    def place(along: float, across: float) -> tuple[float, float]:
        return (across, along) if upright else (along, across)

    ends = [0.0] * floor + [wall + 2.0 * n * r for wall in walls]
    shapes: list[Shape] = [Line([place(at, -3.0 * r), place(at, 3.0 * r)], fixed=True) for at in ends]
    for k in range(n):
        touching = {k, k + 1} if floor else {k - 1, k}
        known = tuple(sorted(c for c in touching if 0 <= c < n - 1 + floor + len(walls)))
        shapes.append(Circle(place(q[k] + (2 * k + 1) * r, 0.0), r, contacts=known))
    return shapes
