"""Hausdorff distance of two polygonal graphs in the plane, such as velocities whose jumps are vertical segments.

    d(A, B) = max( sup over A of the distance to B, sup over B of the distance to A )        Euclidean

Exact to a relative `RESOLUTION`: the distance to a segment is convex, so that a segment of A whose two ends lie
within d of one segment of B lies within d as a whole; what this does not settle is halved. The nearest segment
is found by descending a tree of boxes. Early ends of the search: A. A. Taha, A. Hanbury, An efficient algorithm
for calculating the exact Hausdorff distance, IEEE Trans. Pattern Anal. Mach. Intell. 37, 2015.
"""

from __future__ import annotations

from math import hypot, sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.pointers import Doubles, Indices, max, min

RESOLUTION = 1e-6  # of the distance
ROUNDING = 4e-16  # of the size of the graphs: neighbouring numbers, which cannot be halved, lie 3.2e-16 apart
LEAF = 8  # segments in a leaf of the tree
DEPTH = 256  # of the stacks
EDGE = 0.1  # of a piece: no part is smaller
FIRST = 512  # points looked at first, for a bound that spares most of the others


class Graph:
    """Points of a polyline, and the boxes around its segments: a binary tree whose root is box 1.

    x, y : (n,);  boxes : (2 leaves, 4) least and largest x, least and largest y;  leaves : a power of two

    Parameters
    ----------
    x, y : arrays   of the points, at least one
    """

    def __init__(self, x: Any, y: Any) -> None:
        x, y = np.ascontiguousarray(x, dtype=float), np.ascontiguousarray(y, dtype=float)
        if len(x) == 1:
            x, y = np.repeat(x, 2), np.repeat(y, 2)
        made, leaves = tree(x, y)
        self.kept, self.n, self.leaves = (x, y, made), len(x), leaves
        self.x, self.y, self.boxes = doubles(x), doubles(y), doubles(made)
        self.size = float(np.max(np.abs(made[1])))


def tree(x: Any, y: Any) -> tuple[Any, int]:
    """Boxes around the segments of a polyline, and how many leaves."""
    first = np.arange(0, len(x) - 1, LEAF)
    leaves = 1
    while leaves < len(first):
        leaves *= 2
    boxes = np.empty((2 * leaves, 4))
    boxes[:, 0::2], boxes[:, 1::2] = np.inf, -np.inf
    for column, points in ((0, x), (2, y)):
        for shift, best in ((0, np.minimum), (1, np.maximum)):
            of_segments = best(points[:-1], points[1:])
            boxes[leaves : leaves + len(first), column + shift] = best.reduceat(of_segments, first)
    low = leaves
    while low > 1:
        pairs = boxes[low : 2 * low].reshape(-1, 2, 4)
        boxes[low // 2 : low, 0::2] = pairs[:, :, 0::2].min(axis=1)
        boxes[low // 2 : low, 1::2] = pairs[:, :, 1::2].max(axis=1)
        low //= 2
    return boxes, leaves


@cython.ccall
def hausdorff(a: Graph, b: Graph, least: float = 0.0) -> float:
    """Hausdorff distance of two polylines, or `least` where they are nearer: then all is settled at a glance."""
    nodes, pieces = np.zeros(DEPTH, dtype=np.intp), np.zeros(4 * DEPTH)
    rounding = ROUNDING * max(a.size, b.size)
    bound = farthest(a, b, least, rounding, indices(nodes), doubles(pieces))
    return farthest(b, a, bound, rounding, indices(nodes), doubles(pieces))


def farthest(a: Graph, b: Graph, bound: float, rounding: float, nodes: Indices, pieces: Doubles) -> float:
    """The largest distance of a point of a from b, or the bound if that is larger."""
    n, last = a.n, b.n - 2
    # Beyond an end the other graph does not go on
    segment = nearest(b, a.x[n - 1], a.y[n - 1], bound, last, nodes)
    bound = max(bound, to_segment(b, segment, a.x[n - 1], a.y[n - 1]))
    # Ahead of the same place in b lies what is nearest by so much: a point later by hardly another
    i, ahead = 0, 0
    while i < n:
        segment = nearest(b, a.x[i], a.y[i], bound, i if i < last else last, nodes)
        bound = max(bound, to_segment(b, segment, a.x[i], a.y[i]))
        i += n // FIRST if n >= FIRST else 1
    for i in range(n - 1):
        same = i + ahead
        same = 0 if same < 0 else same if same < last else last
        if covered(a.x[i], a.y[i], a.x[i + 1], a.y[i + 1], b, same, near_enough(bound)):
            continue
        top = 0
        pieces[0], pieces[1], pieces[2], pieces[3] = a.x[i], a.y[i], a.x[i + 1], a.y[i + 1]
        while top >= 0:
            x0, y0, x1, y1 = pieces[4 * top], pieces[4 * top + 1], pieces[4 * top + 2], pieces[4 * top + 3]
            top -= 1
            s0 = nearest(b, x0, y0, near_enough(bound), same, nodes)
            bound = max(bound, to_segment(b, s0, x0, y0))
            s1 = nearest(b, x1, y1, near_enough(bound), s0, nodes)
            bound = max(bound, to_segment(b, s1, x1, y1))
            ahead = s1 - i - 1
            enough = near_enough(bound)
            if covered(x0, y0, x1, y1, b, s0, enough) or covered(x0, y0, x1, y1, b, s1, enough):
                continue
            if hypot(x1 - x0, y1 - y0) <= RESOLUTION * bound + rounding or top + 2 >= DEPTH:
                continue
            share = 0.5 if s0 == s1 else divide(x0, y0, x1, y1, b, (s0 + s1 + 1) // 2)
            x, y = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
            top += 1
            pieces[4 * top], pieces[4 * top + 1], pieces[4 * top + 2], pieces[4 * top + 3] = x, y, x1, y1
            top += 1
            pieces[4 * top], pieces[4 * top + 1], pieces[4 * top + 2], pieces[4 * top + 3] = x0, y0, x, y
    return bound


def near_enough(bound: float) -> float:
    """What is no farther than that is no farther than the bound, as far as is asked."""
    return bound * (1.0 + RESOLUTION)


def divide(x0: float, y0: float, x1: float, y1: float, b: Graph, point: int) -> float:
    """Where to divide a piece whose ends lie near different segments: beside the point of b between these, which
    settles both parts at once where the graphs run side by side; in the middle where that is near an end or beyond.
    """
    ex, ey = x1 - x0, y1 - y0
    share = ((b.x[point] - x0) * ex + (b.y[point] - y0) * ey) / (ex * ex + ey * ey)
    return share if EDGE < share < 1.0 - EDGE else 0.5


def covered(x0: float, y0: float, x1: float, y1: float, b: Graph, segment: int, bound: float) -> bool:
    """Whether both ends, and so all points between them, lie within the bound of the segment."""
    return to_segment(b, segment, x0, y0) <= bound and to_segment(b, segment, x1, y1) <= bound


def nearest(g: Graph, x: float, y: float, enough: float, guess: int, nodes: Indices) -> int:
    """The segment nearest to a point, or the first one found to be near enough."""
    found, best = guess, to_segment(g, guess, x, y)
    if best <= enough:
        return found
    nodes[0], top = 1, 0
    while top >= 0:
        node = nodes[top]
        top -= 1
        if to_box(g, node, x, y) >= best:
            continue
        if node >= g.leaves:
            start = (node - g.leaves) * LEAF
            end = start + LEAF if start + LEAF < g.n - 1 else g.n - 1
            for s in range(start, end):
                d = to_segment(g, s, x, y)
                if d < best:
                    found, best = s, d
            if best <= enough:
                return found
        else:
            left = 2 * node
            if to_box(g, left, x, y) < to_box(g, left + 1, x, y):
                nodes[top + 1], nodes[top + 2] = left + 1, left
            else:
                nodes[top + 1], nodes[top + 2] = left, left + 1
            top += 2
    return found


def to_box(g: Graph, node: int, x: float, y: float) -> float:
    """Distance of a point from a box."""
    dx = max(max(g.boxes[4 * node] - x, x - g.boxes[4 * node + 1]), 0.0)
    dy = max(max(g.boxes[4 * node + 2] - y, y - g.boxes[4 * node + 3]), 0.0)
    return sqrt(dx * dx + dy * dy)


def to_segment(g: Graph, s: int, x: float, y: float) -> float:
    """Distance of a point from the segment between the points s and s + 1."""
    px, py = x - g.x[s], y - g.y[s]
    ex, ey = g.x[s + 1] - g.x[s], g.y[s + 1] - g.y[s]
    length = ex * ex + ey * ey
    if length > 0.0:
        share = min(max((px * ex + py * ey) / length, 0.0), 1.0)
        px, py = px - share * ex, py - share * ey
    return sqrt(px * px + py * py)
