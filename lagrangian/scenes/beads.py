"""Beads of no size on a line: gas, blocks, cradle, collapse, column.

    g_i = q_i - q_{i-1} >= 0 between neighbours, and the walls at the ends of the line

What usually goes wrong: one simultaneous problem takes the place of a sequence of impacts, nearly equal velocities
hide the next event in the last bits, piles sink or gain energy.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.bouncing_ball import ball_motion
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
RESTING = 1e-300  # a relative velocity below it is none


def line(
    q0: ArrayLike,
    v0: ArrayLike,
    masses: ArrayLike,
    restitution: float,
    t_end: float,
    name: str,
    parameters: dict[str, float | str],
    floor: bool = False,
    ceiling: float | None = None,
    g: float = 0.0,
    exact: Callable[[Array], tuple[Array, Array]] | None = None,
) -> Scene:
    """Beads on a line, each kept from passing the next, the floor at 0 and the ceiling."""
    masses = checks.vector("masses", masses)
    n = len(masses)
    rows, offset = [np.eye(n)[k + 1] - np.eye(n)[k] for k in range(n - 1)], [0.0] * (n - 1)
    if floor:
        rows, offset = [np.eye(n)[0], *rows], [0.0, *offset]
    if ceiling is not None:
        rows, offset = [*rows, -np.eye(n)[-1]], [*offset, ceiling]
    return Scene(
        system=LinearSystem(M=np.diag(masses), force=Harmonic(constant=-g * np.asarray(masses))),
        contacts=LinearContacts(
            G=rows,
            offset=offset,
            restitution=restitution,
        ),
        q0=q0,
        v0=v0,
        t_span=(0.0, t_end),
        parameters=parameters,
        name=name,
        exact=exact,
    )


@checked
def elastic_gas(n: int = 12, width: float = 1.0, t_end: float = 2.0) -> Scene:
    """Gas of n equal elastic beads between two walls (Tonks): they pass through each other and swap their names."""
    checks.count("n", n)
    checks.positive("width", width)
    place = np.sort((GOLDEN * np.arange(1, n + 1)) % 1.0) * width
    speed = 2.0 * ((math.sqrt(2.0) * np.arange(1, n + 1)) % 1.0) - 1.0

    def exact(times: Array) -> tuple[Array, Array]:
        along = (place + np.asarray(times)[:, None] * speed) % (2.0 * width)
        back = along > width
        return in_order(np.where(back, 2.0 * width - along, along), np.where(back, -speed, speed))

    return line(
        place,
        speed,
        np.ones(n),
        1.0,
        t_end,
        "elastic-gas",
        {"n": n, "width": width},
        True,
        width,
        exact=exact,
    )


@checked
def falling_gas(n: int = 12, g: float = 9.81, t_end: float = 3.0) -> Scene:
    """Beads, n of them, equal and elastic, that fall on a floor: independent bouncing balls that swap their names."""
    checks.count("n", n)
    height = 1.0 + np.sort((GOLDEN * np.arange(1, n + 1)) % 1.0)
    balls = [ball_motion(float(h), 0.0, checks.positive("g", g), 1.0) for h in height]

    def exact(times: Array) -> tuple[Array, Array]:
        q, v = (np.hstack(x) for x in zip(*(ball(times) for ball in balls), strict=True))
        return in_order(q, v)

    return line(
        height, np.zeros(n), np.ones(n), 1.0, t_end, "falling-gas", {"n": n, "g": g}, True, g=g, exact=exact
    )


def in_order(q: Array, v: Array) -> tuple[Array, Array]:
    """Positions sorted along each row, and the velocities with them."""
    order = np.argsort(q, axis=1, kind="stable")
    return np.take_along_axis(q, order, 1), np.take_along_axis(v, order, 1)


@checked
def galperin(k: int = 2, t_end: float = 20.0) -> Scene:
    """Block of mass 100^k pushing one of mass 1 against a wall: [pi 10^k] collisions in all, those with the wall too.

    In the coordinates sqrt(m) q the pair is a ray of light between two mirrors at the angle atan(10^-k), which a
    straight line unfolds. Source: G. Galperin, Playing pool with pi, Regular and Chaotic Dynamics 8 (2003).
    """
    if k != 0:
        checks.count("k", k)
    heavy = 10.0**k  # square root of the mass
    angle = math.atan(1.0 / heavy)
    x0, y0, speed = 2.0 * heavy, 1.0, heavy

    def exact(times: Array) -> tuple[Array, Array]:
        x, y = x0 - speed * np.asarray(times), y0
        turned, r = np.arctan2(y, x), np.hypot(x, y)
        mirror = np.minimum(np.floor(turned / angle), collisions(k))
        odd = mirror % 2 == 1
        phi = np.where(odd, (mirror + 1) * angle - turned, turned - mirror * angle)
        course = np.where(odd, (mirror + 1) * angle - math.pi, math.pi - mirror * angle)
        q = np.stack([r * np.sin(phi), r * np.cos(phi) / heavy], axis=1)
        return q, speed * np.stack([np.sin(course), np.cos(course) / heavy], axis=1)

    return line([1.0, 2.0], [0.0, -1.0], [1.0, heavy**2], 1.0, t_end, "galperin", {"k": k}, True, exact=exact)


def collisions(k: int) -> int:
    """How often the blocks of `galperin` collide: the mirrors that the unfolded ray crosses."""
    turns = math.pi / math.atan(10.0**-k)
    return math.ceil(turns - 1e-9) - 1


@checked
def newtons_cradle(spacing: float = 0.0, restitution: float = 1.0, t_end: float = 3.0) -> Scene:
    """Cradle of three equal balls; the first strikes the others with 1 m/s at t = 1, touching or `spacing` [m] apart.

    Touching, Newton's law holds for both contacts at once: -(2 r - 1)/3, (1 + r)/3, (1 + r)/3, which is (-1/3, 2/3,
    2/3) for r = 1. Apart, one impact follows the other: (0, 0, 1).
    """
    r = restitution
    if not checks.number("spacing", spacing) >= 0.0:
        raise ValueError(f"spacing: expected a number >= 0, got {spacing!r}")
    q0, v0 = np.array([-1.0, 0.0, spacing]), np.array([1.0, 0.0, 0.0])
    after = np.array([1.0 - 2.0 * r, 1.0 + r, 1.0 + r]) / 3.0

    def touching(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)[:, None]
        struck = t >= 1.0
        start = np.array([0.0, 0.0, 0.0])
        return np.where(struck, start + (t - 1.0) * after, q0 + t * v0), np.where(struck, after, v0)

    exact = touching if spacing == 0.0 else sequence(q0, v0, r)
    parameters: dict[str, float | str] = {"spacing": spacing, "restitution": r}
    return line(q0, v0, np.ones(3), r, t_end, "newtons-cradle", parameters, exact=exact)


@checked
def inelastic_collapse(restitution: float = 0.05, speed: float = 0.5, t_end: float = 6.0) -> Scene:
    """Three equal balls in a line, the outer ones closing in: infinitely many impacts iff r <= 7 - 4 sqrt(3).

    Source: P. Constantin, E. Grossman, M. Mungan, Inelastic collisions of three particles on a line as a
    two-dimensional billiard, Physica D 83 (1995).

    Parameters
    ----------
    speed : of the third ball, towards the first, which moves with 1 m/s [m/s]
    """
    r = restitution
    q0, v0 = np.array([-1.0, 0.0, 2.0]), np.array([1.0, 0.0, -speed])
    return line(
        q0, v0, np.ones(3), r, t_end, "inelastic-collapse", {"restitution": r, "speed": speed},
        exact=sequence(q0, v0, r),
    )  # fmt: skip


def sequence(q0: Array, v0: Array, restitution: float) -> Callable[[Array], tuple[Array, Array]]:
    """Motion of equal free balls on a line, impact after impact; where these accumulate, one body from then on.

    It follows gaps and relative velocities, which lose no digits where positions do.
    """
    r, n = restitution, len(q0)
    t, g, u = 0.0, np.diff(q0), np.diff(v0)
    q, v = q0.copy(), v0.copy()
    pieces: list[tuple[float, Array, Array]] = [(0.0, q, v)]
    scale = float(np.max(np.abs(v0)))
    while True:
        closing = np.flatnonzero(u < -RESTING * scale)
        if len(closing) == 0:
            break
        waits = np.maximum(g[closing], 0.0) / -u[closing]
        i = closing[np.argmin(waits)]
        dt = float(np.min(waits))
        t, q, g = t + dt, q + dt * v, np.maximum(g + dt * u, 0.0)
        g[i] = 0.0
        p = -0.5 * (1.0 + r) * u[i]
        v = v.copy()
        v[i], v[i + 1] = v[i] - p, v[i + 1] + p
        if i > 0:
            u[i - 1] -= p
        if i < n - 2:
            u[i + 1] -= p
        u[i] *= -r
        if np.max(np.abs(u)) <= 1e-17 * scale:
            u, v = np.zeros(n - 1), np.full(n, float(np.mean(v0)))
        pieces.append((t, q, v))
    starts = np.array([t for t, _, _ in pieces])

    def exact(times: Array) -> tuple[Array, Array]:
        k = np.maximum(np.searchsorted(starts, times, side="right") - 1, 0)
        q = np.array([pieces[i][1] + (t - starts[i]) * pieces[i][2] for i, t in zip(k, times, strict=True)])
        v = np.array([pieces[i][2] for i in k])
        return q.reshape(-1, n), v.reshape(-1, n)

    return exact


@checked
def column(
    n: int = 20, spacing: float = 0.05, restitution: float = 0.5, g: float = 9.81, t_end: float = 5.0
) -> Scene:
    """Column of n beads of 1 kg, `spacing` [m] apart, falling on a floor; in the end all lie still, touching."""
    checks.count("n", n)
    heights = checks.positive("spacing", spacing) * np.arange(1, n + 1)
    parameters: dict[str, float | str] = {"n": n, "spacing": spacing, "restitution": restitution, "g": g}
    checks.positive("g", g)
    return line(heights, np.zeros(n), np.ones(n), restitution, t_end, "column", parameters, True, g=g)


def weights_above(masses: Sequence[float] | Array, g: float) -> Array:
    """Force in each contact of a pile at rest, from the floor up: all that lies above it [N]."""
    return g * np.cumsum(np.asarray(masses, dtype=float)[::-1])[::-1]
