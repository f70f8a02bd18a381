"""What the contacts of a random scene look like: rows of G, curvature, joints. Each function is a family."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

Shape = dict[str, Any]


def digits(x: Any, n: int = 3) -> Any:
    """The number with n digits, so that a scene can be read."""
    return float(f"{float(x):.{n}g}")


def wall(rng: Any) -> Shape:
    """One coordinate and one wall."""
    return {"G": [[rng.choice([1.0, -1.0])]]}


def slit(rng: Any) -> Shape:
    """Walls on both sides of one coordinate of a few; the clearance may be zero."""
    n = int(rng.integers(1, 4))
    rows = np.zeros((2, n))
    rows[0, 0], rows[1, 0] = 1.0, -1.0
    return {"G": rows, "slit": True}


def groove(rng: Any) -> Shape:
    """A point in the plane between two planes, from acute to obtuse."""
    angles = rng.uniform(0.05, 1.5, 2)
    return {
        "G": [[math.sin(angles[0]), math.cos(angles[0])], [-math.sin(angles[1]), math.cos(angles[1])]],
        "down": 1,
    }


def wedge(rng: Any) -> Shape:
    """A point in space and three to five planes about the vertical: the tip of a cone with flat sides."""
    m = int(rng.integers(3, 6))
    turn = rng.uniform(0, 2 * math.pi) + 2 * math.pi * np.arange(m) / m
    tilt = rng.uniform(0.1, 1.4, m)
    rows = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)], axis=1)
    return {"G": rows, "down": 2}


def corner(rng: Any) -> Shape:
    """As many walls as coordinates, each along one of them."""
    n = int(rng.integers(2, 5))
    return {"G": np.diag(rng.choice([1.0, -1.0], n))}


def square(rng: Any) -> Shape:
    """As many random planes as coordinates."""
    n = int(rng.integers(2, 5))
    return {"G": rng.normal(size=(n, n))}


def anything(rng: Any) -> Shape:
    """Any number of coordinates and contacts."""
    return {"G": rng.normal(size=(int(rng.integers(1, 9)), int(rng.integers(1, 7))))}


def redundant(rng: Any) -> Shape:
    """Rows that depend on others: copies, multiples, sums."""
    n = int(rng.integers(1, 5))
    rows = list(np.round(rng.normal(size=(int(rng.integers(1, 4)), n)), 1) + np.eye(n)[0])
    rows = [row if np.any(row) else np.eye(n)[0] for row in rows]
    for _ in range(int(rng.integers(1, 4))):
        weights = rng.choice([0.0, 1.0, 1.0, 2.0], len(rows))
        total = weights @ np.array(rows)
        rows.append(total if np.any(total) else rows[0])
    return {"G": rows}


def feet(rng: Any) -> Shape:
    """A block, height and tilt, on two to eight feet."""
    m = int(rng.integers(2, 9))
    places = np.linspace(-0.5, 0.5, m)
    return {
        "G": np.stack([np.ones(m), places], axis=1),
        "M": np.diag([1.0, rng.uniform(0.05, 0.3)]),
        "down": 0,
    }


def beads(rng: Any) -> Shape:
    """Beads on a line, with or without walls at the ends."""
    n = int(rng.integers(2, 7))
    rows = [np.eye(n)[i + 1] - np.eye(n)[i] for i in range(n - 1)]
    if rng.random() < 0.7:
        rows.append(np.eye(n)[0])
    if rng.random() < 0.5:
        rows.append(-np.eye(n)[n - 1])
    return {"G": rows, "free": rng.random() < 0.7, "down": int(rng.integers(n))}


def chain(rng: Any) -> Shape:
    """Masses joined by springs, some of them before a wall."""
    n = int(rng.integers(2, 7))
    m = int(rng.integers(1, min(n, 4) + 1))
    at = rng.choice(n, m, replace=False)
    rows = np.zeros((m, n))
    rows[np.arange(m), at] = rng.choice([1.0, -1.0], m)
    K = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    if rng.random() < 0.5:
        K[0, 0] = K[-1, -1] = 1.0
    return {"G": rows, "K": K}


def curved(rng: Any) -> Shape:
    """Bowls, balls and bent walls."""
    n, m = int(rng.integers(1, 4)), int(rng.integers(1, 4))
    bowl = rng.random() < 0.5
    bend = -rng.uniform(0.3, 2.0, m) if bowl else rng.uniform(-1.0, 1.0, m)
    rows = rng.normal(size=(m, n)) * (0.0 if bowl and rng.random() < 0.5 else 1.0)
    return {"G": rows, "bend": bend, "round": rng.choice([0.0, 0.0, 0.3, 1.0], m), "down": n - 1}


def jointed(rng: Any) -> Shape:
    """Coordinates held together by rods, straight or as pendulums, before walls."""
    n = int(rng.integers(2, 6))
    m = int(rng.integers(1, 4))
    pendulum = rng.random() < 0.4
    j = 1 if pendulum else int(rng.integers(1, min(n, 3)))
    J = np.zeros((j, n)) if pendulum else np.round(rng.normal(size=(j, n)), 1) + np.eye(n)[:j]
    if not pendulum:
        J = np.where(J.any(axis=1, keepdims=True), J, np.eye(n)[:j])  # a row of zeros holds nothing
    shape = {
        "G": rng.normal(size=(m, n)),
        "J": J,
        "joint_bend": np.ones(j) if pendulum else None,
        "down": n - 1,
    }
    if not pendulum and j == 2 and rng.random() < 0.3:
        J[1] = 2.0 * J[0]
    return shape


FAMILIES = {
    f.__name__: f
    for f in (
        wall, slit, groove, wedge, corner, square, anything, redundant, feet, beads, chain, curved, jointed
    )
}  # fmt: skip
