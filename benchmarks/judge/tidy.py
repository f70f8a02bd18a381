"""Scenes as people write them: few and round numbers, equal bodies, things that touch, lie, or meet at one instant.

Random numbers never make two impacts fall on one time, a force but touch zero, or a body come to rest on a wall.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.judge.describe import Description, numbers
from benchmarks.judge.tidy_rough import ROUGH, Draft, pick, several

GRAVITY = 0.0, 10.0, 9.81
RESTITUTION = 0.0, 0.5, 0.8, 0.9, 1.0, 1.0
SPANS, STEPS = (1.0, 2.0, 3.0, 5.0), (0.01, 0.002, 0.001)


def tidy(seed: int, index: int) -> Description:
    """Scene number `index` of a seed."""
    rng = np.random.default_rng([seed, index, 7])
    family = str(rng.choice(sorted(FAMILIES)))
    draft = FAMILIES[family](rng, pick(rng, *GRAVITY))
    m, n = len(draft["G"]), len(draft["q0"])
    draft.setdefault("M", np.eye(n))
    draft.setdefault("offset", np.array(draft.pop("gap", 0.0)) - np.array(draft["G"]) @ draft["q0"])
    equal = rng.random() < 0.7
    restitution = pick(rng, *RESTITUTION) if equal else tuple(pick(rng, 0.0, 0.5, 1.0) for _ in range(m))
    if draft.get("law", "newton") == "moreau" and np.ndim(restitution):
        restitution = restitution[0]  # with several this law may give energy
    arrays = {k: numbers(np.asarray(v, dtype=float)) for k, v in draft.items() if np.ndim(v)}
    return Description(
        **(draft | arrays), t_span=(0.0, pick(rng, *SPANS)), h=pick(rng, *STEPS), restitution=restitution,
        family=family, general=bool(rng.random() < 0.2), gaps=bool(rng.random() < 0.2),
    )  # fmt: skip


def stack(rng: Any, g: float) -> Draft:
    """Bodies one above the other, over a floor, perhaps below a ceiling."""
    n = int(rng.integers(1, 5))
    G, gap = list(np.eye(n) - np.eye(n, k=-1)), list(several(rng, n, 0.0, 0.0, 0.1, 0.5, 1.0))
    q0, masses = np.cumsum(gap), several(rng, n, 1.0, 1.0, 1.0, 0.5, 2.0, 3.0)
    if rng.random() < 0.2:
        G, gap = [*G, -np.eye(n)[-1]], [*gap, pick(rng, 0.0, 0.5, 1.0)]
    one = rng.random() < 0.7
    v0 = np.full(n, pick(rng, 0.0, 0.0, 1.0, -1.0, 2.0)) if one else several(rng, n, 0.0, 1.0, -1.0, 2.0)
    return {"G": G, "gap": gap, "q0": q0, "v0": v0, "M": np.diag(masses), "constant": -g * masses}


def table(rng: Any, g: float) -> Draft:
    """The same on a table that shakes, often as hard as gravity pulls."""
    draft = stack(rng, g or 10.0)
    m, size = len(draft["G"]), pick(rng, 0.01, 0.05, 0.1, 1.0)
    omega, phase = pick(rng, 1.0, 5.0, 10.0, 2.0 * math.pi, math.sqrt(10.0 / size)), pick(rng, 0.0, 0.5, -0.5)
    first = np.eye(m)[0]
    offset = np.array(draft.pop("gap")) - np.array(draft["G"]) @ draft["q0"]
    return draft | {
        "amplitude": size * first, "phase": np.full(m, phase * math.pi), "omega": omega,
        "form": int(rng.random() < 0.2), "offset": offset + size * math.sin(phase * math.pi) * first,
    }  # fmt: skip


def row(rng: Any, g: float) -> Draft:
    """Beads on a line, free or between walls; the first runs into the others, the last perhaps as well."""
    n = int(rng.integers(2, 6))
    G, gap = list(np.diff(np.eye(n), axis=0)), list(several(rng, n - 1, 0.0, 0.0, 0.5, 1.0))
    q0, v0 = np.concatenate([[0.0], np.cumsum(gap)]), np.zeros(n)
    v0[0] = pick(rng, 1.0, 2.0)
    v0[1] = pick(rng, 0.0, v0[0])
    v0[-1] = pick(rng, v0[-1], -1.0, -2.0)
    if rng.random() < 0.5:
        G, gap = [np.eye(n)[0], *G, -np.eye(n)[-1]], [pick(rng, 0.0, 1.0), *gap, pick(rng, 0.0, 1.0)]
    return {"G": G, "gap": gap, "q0": q0, "v0": v0, "M": np.diag(several(rng, n, 1.0, 1.0, 1.0, 2.0))}


def box(rng: Any, g: float) -> Draft:
    """A point in the plane in a corner or a box, upright or standing on its edge."""
    q0 = np.array([pick(rng, 0.0, 0.5, 1.0), pick(rng, 0.0, 1.0)])
    G, gap, half = np.eye(2), q0, math.sqrt(0.5)
    kind = rng.random()
    if kind < 0.4:
        G, gap = np.vstack([G, -G]), np.concatenate([q0, 1.0 - q0])
    elif kind < 0.6:
        G, gap, q0 = np.array([[half, half], [-half, half]]), np.full(2, pick(rng, 0.0, 1.0)), np.zeros(2)
    return {
        "G": G,
        "gap": gap,
        "q0": q0,
        "v0": several(rng, 2, 0.0, -1.0, 1.0, -2.0),
        "constant": np.array([0.0, -g]),
    }


def feet(rng: Any, g: float) -> Draft:
    """A block, height and tilt, that falls flat, or on one foot first, on two feet or three."""
    G = np.array([[1.0, x] for x in ((-0.5, 0.5) if rng.random() < 0.7 else (-0.5, 0.0, 0.5))])
    tilt = pick(rng, 0.0, 0.0, 0.1, -0.1)
    q0 = np.array([abs(0.5 * tilt) + pick(rng, 0.0, 0.1, 1.0), tilt])
    M = np.diag([1.0, pick(rng, 1.0 / 12.0, 0.1, 0.25)])
    v0 = np.array([0.0, pick(rng, 0.0, 0.0, 1.0, -1.0)])
    return {"G": G, "gap": G @ q0, "q0": q0, "v0": v0, "M": M, "constant": np.array([-g, 0.0])}


def stops(rng: Any, g: float) -> Draft:
    """Masses on springs, one of them before a stop or between two, pushed in time or at rest."""
    n, k = int(rng.integers(1, 4)), pick(rng, 1.0, 4.0, 100.0)
    i = int(rng.integers(n))
    G, gap = [-np.eye(n)[i]], [pick(rng, 0.0, 0.1, 1.0)]
    if rng.random() < 0.5:
        G, gap = [*G, np.eye(n)[i]], [*gap, pick(rng, gap[0], 1.0)]
    draft = {
        "G": G, "gap": gap, "q0": np.zeros(n), "v0": several(rng, n, 0.0, 1.0), "M": np.eye(n) * pick(rng, 1.0, 2.0),
        "K": k * (2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)), "constant": several(rng, n, 0.0, 1.0, 10.0),
    }  # fmt: skip
    if rng.random() < 0.4:
        draft["C"] = pick(rng, 0.1, 1.0) * np.eye(n)
    if rng.random() < 0.6:
        draft |= {
            "cosine": pick(rng, 1.0, 10.0) * np.eye(n)[0],
            "force_omega": pick(rng, 1.0, 2.0, 3.0, math.sqrt(k)),
        }
    return draft


def bowl(rng: Any, g: float) -> Draft:
    """A ball in a round bowl, at its rim, its bottom, or its middle."""
    q0 = pick(rng, (1.0, 0.0), (0.0, -1.0), (0.0, 0.0), (0.6, 0.8), (0.5, 0.0))
    v0 = pick(rng, (0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (2.0, 1.0), (0.0, 8.0))
    return {
        "G": np.zeros((1, 2)), "bend": np.array([-1.0]), "offset": np.array([0.5]), "q0": np.array(q0),
        "v0": np.array(v0), "constant": np.array([0.0, -g]),
    }  # fmt: skip


def rod(rng: Any, g: float) -> Draft:
    """Three bodies over floors, two of them on one rod or over a pulley."""
    G, sign = np.eye(3)[: int(rng.integers(1, 4))], pick(rng, 1.0, -1.0)
    q0, v, masses = (
        np.array([pick(rng, 0.0, 1.0), 1.0, 1.0]),
        pick(rng, 0.0, 1.0, -1.0),
        several(rng, 3, 1.0, 2.0),
    )
    J = np.array([[1.0, -sign, 0.0]])
    return {
        "G": G, "gap": G @ q0, "q0": q0, "v0": np.array([v, sign * v, pick(rng, 0.0, -1.0)]), "M": np.diag(masses),
        "J": J, "joint_offset": -J @ q0, "constant": -g * masses,
    }  # fmt: skip


def pendulum(rng: Any, g: float) -> Draft:
    """A point on a rod of length 1 before a wall, which may touch its circle."""
    q0 = np.array(pick(rng, (1.0, 0.0), (0.0, -1.0), (0.6, -0.8)))
    return {
        "G": np.array([pick(rng, (1.0, 0.0), (-1.0, 0.0), (0.0, 1.0))]), "gap": [pick(rng, 0.0, 0.5, 1.0)], "q0": q0,
        "v0": np.array([-q0[1], q0[0]]) * pick(rng, 0.0, 1.0, -1.0, 3.0), "constant": np.array([0.0, -g]),
        "J": np.zeros((1, 2)), "joint_bend": np.array([1.0]), "joint_offset": np.array([-0.5]),
    }  # fmt: skip


SMOOTH = {f.__name__: f for f in (stack, table, row, box, feet, stops, bowl, rod, pendulum)}
FAMILIES = SMOOTH | ROUGH
