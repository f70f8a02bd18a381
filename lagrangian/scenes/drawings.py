"""How the ready scenes look: for each a function of time and coordinates, with its sizes from the scene's parameters.

Beads have no size where they move; here each is drawn as a disc and pushed aside by those below it, so that two discs
touch exactly where a gap is closed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from lagrangian.drawing import Circle, Drawing, Line, Point, Polygon, Shape, box, spring, turned
from lagrangian.profiles import rotating_cam

Shapes = Sequence[Shape]
OUTLINE = 240  # corners of a cam
SLIM = 0.08  # of a mechanism: what is drawn with a size of its own
SPOKES = 4


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


def sprung(t: float, q: Any, *, stop: float, size: float) -> Shapes:
    """A block on a spring, left of a stop."""
    w, wall = 0.3 * size, -1.8 * size
    return [
        Line([(wall, -0.5 * w), (wall, 1.5 * w)], fixed=True),
        Line([(stop, -0.5 * w), (stop, 1.5 * w)], fixed=True),
        Line(spring((wall, 0.5 * w), (q[0] - w, 0.5 * w), 0.5 * w)),
        Polygon(box(q[0] - w, 0.0, q[0], w), contacts=(0,)),
    ]


def on_belt(t: float, x: Any, *, size: float, belt: float = 0.0, contacts: tuple[int, ...] = ()) -> Shapes:
    """A block on a spring, on a floor or a belt that runs with a speed."""
    w, wall, end = 0.3 * size, -2.0 * size, 2.0 * size
    pitch = 0.5 * size
    first = math.floor(2.0 * end / pitch)
    marks = [wall + (k * pitch + belt * t) % (first * pitch) for k in range(first)] if belt else []
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


def on_slope(t: float, q: Any, *, slope: float, size: float, reach: float) -> Shapes:
    """A block on a slope that falls to the right; q are the places along it and off it."""
    floor = turned([(-size, 0.0), (reach, 0.0)], -slope)
    block = turned(box(q[0] - 0.5 * size, q[1], q[0] + 0.5 * size, q[1] + 0.6 * size), -slope)
    return [Line(floor, fixed=True), Polygon(block, contacts=(0,))]


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


def cam(t: float, q: Any, *, p: Any, outline: Any, relative: bool) -> Shapes:
    """A cam that turns below its follower; its outline is that at the angle 0."""
    out = np.zeros((1, 3))
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


def _size(scene: Any) -> float:
    return max(1e-3, *(abs(float(x)) for x in np.ravel(scene.q0)))


def _walls(scene: Any) -> tuple[float, ...]:
    return (float(scene.parameters["width"]),) if "width" in scene.parameters else ()


def _table(draw: Callable[..., Shapes]) -> Callable[[Any, Any], Drawing]:
    return lambda scene, p: partial(draw, p=scene.p, size=max(2.0 * _size(scene), 0.05))


def _sprung(scene: Any, p: Any) -> Drawing:
    return partial(sprung, stop=p["stop"], size=max(abs(p["amplitude"]), abs(p["q0"]), abs(p["stop"])))


def _beads(upright: bool, floor: bool) -> Callable[[Any, Any], Drawing]:
    def make(scene: Any, p: Any) -> Drawing:
        r = 0.25 * float(np.ptp(scene.q0) or 1.0) / scene.n_q
        return partial(beads, r=r, upright=upright, walls=_walls(scene), floor=floor)

    return make


# By name: how the scene's drawing is made from the scene and its parameters
MAKERS: dict[str, Callable[[Any, Any], Drawing]] = {
    **dict.fromkeys(
        ("bouncing-ball", "dyadic-ball", "elastic-ball", "grazing"), lambda s, p: partial(ball, size=_size(s))
    ),
    **dict.fromkeys(("ball-on-table", "chattering-table"), _table(ball_on_sine)),
    "jumping-table": lambda s, p: partial(ball_on_kinked, p=s.p, size=max(2.0 * _size(s), 0.3)),
    **dict.fromkeys(("impact-oscillator", "sticking-oscillator", "chaotic-oscillator"), _sprung),
    "pendulum-stop": lambda s, p: partial(pendulum, length=p["length"]),
    "double-pendulum": lambda s, p: partial(two_rods, points=p["form"] == "rods", wall=p["wall"]),
    "kane-pendulum": lambda s, p: partial(two_rods, points=False, floor=float(s.p[1])),
    "bowl": lambda s, p: partial(in_bowl, radius=p["radius"]),
    "elastic-gas": _beads(upright=False, floor=True),
    "falling-gas": _beads(upright=True, floor=True),
    "column": _beads(upright=True, floor=True),
    "newtons-cradle": _beads(upright=False, floor=False),
    "inelastic-collapse": _beads(upright=False, floor=False),
    "galperin": lambda s, p: partial(blocks, sides=(0.2, 0.2 + 0.2 * p["k"]), upright=False),
    "heavy-on-light": lambda s, p: partial(blocks, sides=(0.3, 1.0), upright=True),
    "block-on-feet": lambda s, p: partial(feet, n=p["n"], width=p["width"]),
    "stack": lambda s, p: partial(stacked, n=p["n"]),
    "elastic-chain": lambda s, p: partial(chain, distance=p["distance"]),
    "rocking-block": lambda s, p: partial(rocking, b=p["b"], h=p["h"]),
    "coulomb-oscillator": lambda s, p: partial(on_belt, size=abs(p["x0"]) or 1.0, contacts=(0,)),
    "slipping-wheel": lambda s, p: partial(
        wheel, radius=p["radius"], reach=p["v0"] * s.t_span[1] + p["radius"]
    ),
    "sliding-block": lambda s, p: partial(
        on_slope, slope=0.0, size=0.2, reach=p["v0"] ** 2 / (p["mu"] * p["g"])
    ),
    "slope-landing": lambda s, p: partial(on_slope, slope=p["slope"], size=0.2, reach=p["v0"] * s.t_span[1]),
    "slider-crank": lambda s, p: partial(crank, p=s.p),
    "woodpecker": lambda s, p: partial(pecking, height=0.05),
    "falling-rod": lambda s, p: partial(leaning_rod, half=s.p[0], reach=1.5),
    "cam-follower": lambda s, p: partial(
        cam, p=s.p, outline=cam_outline(s.p), relative=p["coordinates"] == "relative"
    ),
    **dict.fromkeys(
        ("bilinear-oscillator", "driven-bilinear-oscillator"), lambda s, p: partial(two_springs, size=1.5)
    ),
    "dry-friction-oscillator": lambda s, p: partial(on_belt, size=1.0),
    "stick-slip-oscillator": lambda s, p: partial(on_belt, size=1.0, belt=p["belt"]),
}


def drawing_of(scene: Any) -> Drawing | None:
    """The drawing of a ready scene; None for one that has no shape, as a controller."""
    make = MAKERS.get(scene.name)
    return None if make is None else make(scene, scene.parameters)
