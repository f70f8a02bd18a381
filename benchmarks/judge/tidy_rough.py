"""Scenes as people write them, with friction: at the edge of sliding, sticking or tipping, or round numbers off.

Slopes as steep as mu, pushes of mu m g, springs that stop a body where its dead zone ends, belts of round speed.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

Draft = dict[str, Any]
STEEP = (0.6, 0.8), (0.8, 0.6), (math.sqrt(0.5), math.sqrt(0.5)), (5.0 / 13.0, 12.0 / 13.0), (0.0, 1.0)


def pick(rng: Any, *values: Any) -> Any:
    """One of these."""
    return values[rng.integers(len(values))]


def several(rng: Any, n: int, *values: float) -> Any:
    """So many of these (n,)."""
    return np.array([pick(rng, *values) for _ in range(n)])


def rough(rng: Any, mu: Any, T: Any) -> Draft:
    """Friction of these coefficients; perhaps they are those of what sticks, or that has more."""
    mu = np.asarray(mu, dtype=float)
    drawn = {"T": np.atleast_2d(T), "mu": mu, "law": pick(rng, "moreau", "moreau", "newton")}
    if rng.random() > 0.3:
        return drawn
    if rng.random() < 0.5:
        return drawn | {"mu_s": mu, "mu": pick(rng, 0.5, 0.8, 1.0) * mu}
    return drawn | {"mu_s": mu * pick(rng, 1.0, 1.25, 2.0) + pick(rng, 0.0, 0.0, 0.1)}


def slope(rng: Any, g: float) -> Draft:
    """A block on a slope whose tangent is mu, or a little more or less; thrown up or down it, or onto it."""
    sine, cosine = pick(rng, *STEEP)
    mu = max(
        0.0, pick(rng, sine / cosine, sine / cosine, 0.5, 1.0, sine / cosine - 0.25, sine / cosine + 0.25)
    )
    q0, v0, m = (
        np.array([0.0, pick(rng, 0.0, 0.0, 1.0)]),
        pick(rng, 0.0, 0.0, 1.0, -1.0, 2.0),
        pick(rng, 1.0, 2.0),
    )
    turn = (
        np.array([[cosine, sine], [-sine, cosine]]) if rng.random() < 0.5 else np.eye(2)
    )  # to world coordinates
    pull = np.array([-sine, -cosine]) if turn[0, 1] == 0.0 else np.array([0.0, -1.0])
    T, G = turn
    return {
        "G": [G], "gap": [q0[1]], "q0": turn.T @ q0, "v0": turn.T @ np.array([v0, pick(rng, 0.0, -q0[1])]),
        "M": m * np.eye(2), "constant": m * g * pull,
    } | rough(rng, [mu], T)  # fmt: skip


def pushed(rng: Any, g: float) -> Draft:
    """A block on a level floor, at rest, sliding, or on a spring; pushed or shaken as hard as friction holds it."""
    m, mu, w = pick(rng, 1.0, 2.0), pick(rng, 0.1, 0.25, 0.5, 1.0), pick(rng, 1.0, 2.0, 5.0, 2.0 * math.pi)
    hold = mu * m * (g or 10.0)
    push = hold * pick(rng, 0.0, 0.0, 1.0, 0.5, -1.0, 2.0)
    draft = {
        "G": [[0.0, 1.0]], "q0": np.zeros(2), "v0": [pick(rng, 0.0, 1.0, -1.0, 2.0), 0.0], "M": m * np.eye(2),
        "constant": np.array([push, -m * (g or 10.0)]),
    } | rough(rng, [mu], [1.0, 0.0])  # fmt: skip
    kind = rng.random()
    if kind < 0.3:
        draft |= {"cosine": np.array([hold * pick(rng, 1.0, 0.5, 2.0), 0.0]), "force_omega": w}
    elif kind < 0.5:
        draft |= {"sway": [hold / (m * w) * pick(rng, 1.0, 0.5, 2.0)], "omega": w}
    if rng.random() < 0.3:
        draft["slip"] = [pick(rng, 1.0, -1.0, 0.5)]
    if rng.random() < 0.4:
        k = pick(rng, 1.0, 4.0, 100.0)
        draft |= {
            "K": np.diag([k, 0.0]),
            "q0": np.array([pick(rng, 0.0, 1.0, 2.0, 2.5, 3.0, 4.0) * hold / k, 0.0]),
        }
    if rng.random() < 0.2:
        draft["C"] = np.diag([pick(rng, 0.1, 1.0, 2.0), 0.0])
    return draft


def ladder(rng: Any, g: float) -> Draft:
    """A rod, its middle and its turn, between a floor and a wall, both rough or one of them, for small turns."""
    far, up = pick(rng, (0.3, 0.4), (0.4, 0.3), (0.5, 0.5))
    mu = [pick(rng, 0.25, 0.5, far / (2.0 * up), 1.0), pick(rng, 0.0, 0.25, 0.5)]
    G, T = np.array([[0.0, 1.0, far], [1.0, 0.0, -up]]), np.array([[1.0, 0.0, up], [0.0, 1.0, -far]])
    gap, inertia = several(rng, 2, 0.0, 0.0, 0.0, 0.1), pick(rng, (far**2 + up**2) / 3.0, 0.1)
    v0 = np.array([pick(rng, 0.0, 0.0, -1.0), pick(rng, 0.0, 0.0, -1.0), pick(rng, 0.0, 0.0, 1.0)])
    return {
        "G": G, "gap": gap, "q0": np.zeros(3), "v0": v0 * (gap.max() > 0.0), "M": np.diag([1.0, 1.0, inertia]),
        "constant": np.array([pick(rng, 0.0, 0.0, -1.0), -g, 0.0]),
    } | rough(rng, mu, T)  # fmt: skip


def spin(rng: Any, g: float) -> Draft:
    """A disc or a ball that lands with spin, so that it just sticks in the impact, rolls, or slides on."""
    R, share, mu, down = pick(rng, 1.0, 0.5), pick(rng, 0.5, 0.4, 1.0), pick(rng, 0.1, 0.25, 0.5, 1.0), 1.0
    height = pick(rng, 0.0, 0.5)
    just = (1.0 + 1.0 / share) * mu * down  # slip that the impulse mu m |v| ends
    v, turn = (
        pick(rng, 0.0, 0.0, 1.0, just, 2.0 * just),
        pick(rng, 0.0, 0.0, 1.0, just, -just, 2.0 * just) / R,
    )
    G, T, gap = [[0.0, 1.0, 0.0]], [[1.0, 0.0, R]], [height]
    if rng.random() < 0.4:
        G, T, gap = [*G, [-1.0, 0.0, 0.0]], [*T, [0.0, 1.0, R]], [*gap, pick(rng, 0.0, 1.0)]
    return {
        "G": np.array(G), "gap": gap, "q0": np.zeros(3), "v0": [v, pick(rng, -down, -down, 0.0), turn],
        "M": np.diag([1.0, 1.0, share * R * R]), "constant": [0.0, -g, 0.0],
    } | rough(rng, np.full(len(G), mu), T) | {"law": pick(rng, "moreau", "newton", "stronge")}  # fmt: skip


def pile(rng: Any, g: float) -> Draft:
    """Blocks on each other, the lowest on a floor or a belt; one is pushed or slides."""
    n, mu, m = int(rng.integers(1, 4)), pick(rng, 0.1, 0.25, 0.5), pick(rng, 1.0, 2.0)
    step = np.eye(n) - np.eye(n, k=-1)
    G, T = np.kron(step, [0.0, 1.0]), np.kron(step, [1.0, 0.0])
    v0, i = np.zeros(2 * n), int(rng.integers(n))
    v0[2 * i] = pick(rng, 0.0, 1.0, -1.0, 2.0)
    constant = np.kron(np.ones(n), [0.0, -m * g])
    constant[2 * i] = pick(rng, 0.0, 0.0, 1.0, 2.0) * mu * m * g * pick(rng, 1, n - i)
    draft = {
        "G": G, "gap": np.zeros(n), "q0": np.zeros(2 * n), "v0": v0, "M": m * np.eye(2 * n), "constant": constant
    } | rough(rng, np.full(n, mu) if rng.random() < 0.7 else several(rng, n, 0.0, 0.1, 0.5), T)  # fmt: skip
    if rng.random() < 0.5:
        draft["slip"] = np.eye(n)[0] * pick(rng, 1.0, -1.0, 0.5)
    if rng.random() < 0.3:
        draft["K"] = np.diag(np.eye(2 * n)[2 * (n - 1)]) * pick(rng, 1.0, 10.0)
    return draft


def tip(rng: Any, g: float) -> Draft:
    """A block on two feet, pushed at its middle or its top, or sliding, that may tip: at mu = width / height."""
    half, height = pick(rng, (0.5, 0.5), (0.5, 1.0), (1.0, 0.5), (0.25, 0.5))
    mu = pick(rng, half / height, half / height, 0.5, 0.25, 1.0)
    push, at = mu * (g or 10.0) * pick(rng, 0.0, 1.0, 1.0, 0.5, 2.0), pick(rng, 0.0, height)
    G, T = [[0.0, 1.0, -half], [0.0, 1.0, half]], [[1.0, 0.0, height]] * 2
    draft = {
        "G": np.array(G), "gap": [0.0, 0.0], "q0": np.zeros(3), "v0": [pick(rng, 0.0, 0.0, 1.0, -1.0), 0.0, 0.0],
        "M": np.diag([1.0, 1.0, pick(rng, (half**2 + height**2) / 3.0, 0.25)]),
        "constant": np.array([push, -(g or 10.0), -push * at]),
    } | rough(rng, [mu, mu], T)  # fmt: skip
    return draft | ({"slip": [pick(rng, 1.0, -1.0)] * 2} if rng.random() < 0.2 else {})


def vee(rng: Any, g: float) -> Draft:
    """A disc in a groove of two rough walls at 45 degrees, turned by a torque, spinning, or dropped into it."""
    s, R, mu = math.sqrt(0.5), pick(rng, 1.0, 0.5), pick(rng, 0.25, 0.5, 1.0)
    gap = pick(rng, 0.0, 0.0, s)
    most = (g or 10.0) * R * 2.0 * s * mu / (1.0 + mu * mu)  # of the torque that both walls hold together
    spun = pick(rng, 0.0, 0.0, 1.0, -1.0, 10.0)
    return {
        "G": np.array([[s, s, 0.0], [-s, s, 0.0]]), "gap": [gap, gap], "q0": np.zeros(3), "v0": [0.0, 0.0, spun],
        "M": np.diag([1.0, 1.0, 0.5 * R * R]), "constant": [0.0, -g, most * pick(rng, 0.0, 0.0, 1.0, 0.5, 2.0)],
    } | rough(rng, [mu, mu], [[s, -s, R], [s, s, R]])  # fmt: skip


def pulley(rng: Any, g: float) -> Draft:
    """A block on a rough table, and the weight that pulls it over a pulley, perhaps down to a floor."""
    m, mu, v = several(rng, 2, 1.0, 1.0, 2.0), pick(rng, 0.25, 0.5, 1.0), pick(rng, 0.0, 0.0, 1.0, -1.0)
    G, T, gap, J = [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]], [0.0], np.array([[1.0, 0.0, 1.0]])
    if rng.random() < 0.4:
        G, T, gap = [*G, [0.0, 0.0, 1.0]], [*T, [0.0, 0.0, 0.0]], [*gap, pick(rng, 0.0, 0.5)]
    weight = pick(rng, m[1], mu * m[0], 0.5 * mu * m[0])
    return {
        "G": np.array(G), "gap": gap, "q0": np.zeros(3), "v0": [v, 0.0, -v], "M": np.diag([m[0], m[0], weight]),
        "J": J, "joint_offset": [0.0], "constant": -g * np.array([0.0, m[0], weight]),
    } | rough(rng, [mu, 0.0][: len(G)], T)  # fmt: skip


def rail(rng: Any, g: float) -> Draft:
    """A bead on a rough rod, held from both sides, level or as steep as mu, perhaps on a spring."""
    sine, cosine = pick(rng, *STEEP)
    mu, room = pick(rng, sine / cosine, 0.5, 0.25), pick(rng, 0.0, 0.0, 0.1)
    push = pick(rng, 0.0, 0.0, 1.0, 10.0)
    draft = {
        "G": np.array([[0.0, 1.0], [0.0, -1.0]]), "gap": [0.0, room], "q0": np.zeros(2),
        "v0": [pick(rng, 0.0, 1.0, -1.0), 0.0], "M": np.eye(2), "constant": np.array([-g * sine, push - g * cosine]),
    } | rough(rng, [mu, mu], [[1.0, 0.0], [1.0, 0.0]])  # fmt: skip
    if rng.random() < 0.3:
        draft |= {"cosine": [0.0, pick(rng, 10.0, 20.0)], "force_omega": pick(rng, 1.0, 5.0)}
    return draft | ({"K": np.diag([pick(rng, 1.0, 10.0), 0.0])} if rng.random() < 0.3 else {})


def crate(rng: Any, g: float) -> Draft:
    """A point in the plane in a corner or a box of rough walls."""
    q0 = np.array([pick(rng, 0.0, 0.5, 1.0), pick(rng, 0.0, 0.5)])
    G, T, gap = np.eye(2), np.eye(2)[::-1], q0
    if rng.random() < 0.5:
        G, T, gap = np.vstack([G, -G]), np.vstack([T, T]), np.concatenate([q0, 1.0 - q0])
    draft = {
        "G": G, "gap": gap, "q0": q0, "v0": several(rng, 2, 0.0, -1.0, 1.0, 2.0),
        "constant": np.array([pick(rng, 0.0, 0.0, -1.0, -5.0), -g]),
    } | rough(rng, np.full(len(G), pick(rng, 0.1, 0.5, 1.0)), T)  # fmt: skip
    return draft | ({"slip": pick(rng, 1.0, -1.0) * np.eye(len(G))[1]} if rng.random() < 0.3 else {})


def cart(rng: Any, g: float) -> Draft:
    """A cart on a rough rail that a pendulum drags along, its inertia that of small swings."""
    m, mu = pick(rng, 1.0, 2.0), pick(rng, 0.1, 0.25, 0.5)
    turn = pick(rng, 0.0, 0.5, 0.5 * math.pi, -0.5 * math.pi, math.pi)
    return {
        "G": np.array([[0.0, 1.0, 0.0]]), "gap": [0.0], "q0": [0.0, 0.0, turn],
        "v0": [pick(rng, 0.0, 1.0), 0.0, pick(rng, 0.0, 0.0, 1.0)], "pendulum": m * g, "b": [0.0, 0.0, 1.0],
        "M": np.array([[2.0 * m, 0.0, m], [0.0, 2.0 * m, 0.0], [m, 0.0, m]]), "constant": [0.0, -2.0 * m * g, 0.0],
    } | rough(rng, [mu], [1.0, 0.0, 0.0])  # fmt: skip


ROUGH = {
    f"rough {f.__name__}": f for f in (slope, pushed, ladder, spin, pile, tip, vee, pulley, rail, crate, cart)
}
