"""Random scenes, each from its seed and number alone.

A family says what the contacts look like; masses, springs, damping, forces, what moves, the start and the span are
drawn here. Numbers have three digits, so that a scene can be read; offsets follow from the gaps at the start.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.judge.describe import Description
from benchmarks.judge.shapes import FAMILIES, digits
from benchmarks.judge.start import started, timed


def draw(seed: int, index: int) -> Description:
    """Scene number `index` of a seed."""
    rng = np.random.default_rng([seed, index])
    family = str(rng.choice(sorted(FAMILIES)))
    return dressed(rng, family)


def dressed(rng: Any, family: str) -> Description:
    """A random scene of a family."""
    shape = FAMILIES[family](rng)
    shape["G"] = np.atleast_2d(np.vectorize(digits)(shape["G"]))
    n = shape["G"].shape[1]
    matrices = _matrices(rng, n, shape)
    forces = _forces(rng, n, shape, matrices)
    moves = _motions(rng, n, shape)
    bent = {k: tuple(digits(x) for x in shape[k]) for k in ("bend", "round") if k in shape}
    m = len(shape["G"])
    equal = m == 1 or rng.random() < 0.5
    restitution = _restitution(rng) if equal else tuple(_restitution(rng) for _ in range(m))
    kinds = _kinds(rng, n, family)
    if kinds.get("general"):
        moves.pop("frame", None)
    draft = Description(
        q0=(0.0,) * n, v0=(0.0,) * n, t_span=(0.0, 1.0), h=0.1, G=_rows(shape["G"]),
        offset=(0.0,) * m, restitution=restitution, family=family,
        **matrices, **forces, **moves, **bent, **kinds, **_joints(shape),
    )  # fmt: skip
    return timed(rng, started(rng, draft, shape))


def _rows(x: Any) -> Any:
    return tuple(tuple(digits(y) for y in row) for row in np.atleast_2d(x))


def _joints(shape: Any) -> dict[str, Any]:
    if "J" not in shape:
        return {}
    found = {"J": _rows(shape["J"]), "joint_offset": (0.0,) * len(shape["J"])}
    if shape["joint_bend"] is not None:
        found["joint_bend"] = tuple(map(float, shape["joint_bend"]))
    return found


def _restitution(rng: Any) -> float:
    kind = rng.random()
    if kind < 0.25:
        return 0.0
    return 1.0 if kind < 0.4 else digits(rng.uniform(0.0, 1.0), 2)


def _matrices(rng: Any, n: int, shape: Any) -> dict[str, Any]:
    """Mass, stiffness and damping."""
    root = np.ones(n)
    if "M" in shape:
        M = shape["M"]
    else:
        kind = rng.random()
        decades = 4.5 if kind < 0.1 else 0.5
        masses = 10.0 ** rng.uniform(-decades, decades, n) if kind < 0.6 else np.ones(n)
        M, root = np.diag(masses), np.sqrt(masses)
        if n > 1 and 0.1 < kind < 0.3:
            M = M + 0.3 * np.outer(root, root) * rng.uniform(0.0, 1.0)
    w = 10.0 ** rng.uniform(0.0, 3.0) if rng.random() < 0.3 else 10.0 ** rng.uniform(-0.5, 1.0)
    if "K" in shape:
        K = shape["K"] * w * w * float(np.min(np.diag(M)))
    elif shape.get("free") or rng.random() < 0.35:
        K = np.zeros((n, n))
    else:
        base = rng.normal(size=(n, n)) / math.sqrt(n)
        K = (base @ base.T) * np.outer(root, root) * w * w
    C = np.zeros((n, n))
    if rng.random() < 0.4:
        C = (
            np.diag(np.diag(M)) * rng.uniform(0.0, 1.0) * 10.0 ** rng.uniform(-2, 0.3)
            + rng.uniform(0, 0.05 / w) * K
        )
    return {name: _symmetric(x) for name, x in (("M", M), ("K", K), ("C", C)) if np.any(x)}


def _symmetric(x: Any) -> Any:
    rounded = np.vectorize(digits)(np.tril(x))
    return _rows(rounded + np.tril(rounded, -1).T)


def _forces(rng: Any, n: int, shape: Any, matrices: dict[str, Any]) -> dict[str, Any]:
    """Constant and harmonic forces."""
    M = np.diag(np.array(matrices["M"]))
    constant = np.zeros(n)
    if "down" in shape and rng.random() < 0.9:
        constant[shape["down"]] = -9.81 * M[shape["down"]]
    elif rng.random() < 0.7:
        constant = rng.normal(size=n) * M * 10.0 ** rng.uniform(-1, 1)
    found = {"constant": tuple(digits(x) for x in constant)} if np.any(constant) else {}
    if rng.random() < 0.35:
        size = 10.0 ** rng.uniform(-1, 1) * M
        for name in ("cosine", "sine"):
            if rng.random() < 0.7:
                found[name] = tuple(digits(x) for x in rng.normal(size=n) * size)
        found["force_omega"] = digits(10.0 ** rng.uniform(-0.5, 1.3))
    return found


def _motions(rng: Any, n: int, shape: Any) -> dict[str, Any]:
    """Obstacles and frames that move."""
    kind, m = rng.random(), len(shape["G"])
    if kind > 0.3 or "J" in shape:
        return {}
    omega = digits(10.0 ** rng.uniform(-0.3, 1.5))
    size = digits(10.0 ** rng.uniform(-3, -0.3))
    found: dict[str, Any] = {"omega": omega, "form": int(rng.random() < 0.3)}
    if kind < 0.22:
        found["amplitude"] = (
            tuple(digits(x) for x in size * rng.choice([0.0, 1.0, 1.0, -0.5], m)) if m > 1 else (size,)
        )
        found["phase"] = tuple(digits(x) for x in rng.choice([0.0, rng.uniform(0.0, 6.0)], m))
    else:
        found["frame"] = tuple(digits(x) for x in size * rng.normal(size=n))
    return found


def _kinds(rng: Any, n: int, family: str) -> dict[str, Any]:
    """Whether the library knows that the scene is linear, and whether it is."""
    kind = rng.random()
    if kind < 0.1:
        return {"general": True}
    if kind < 0.15:
        return {"function": True}
    if kind < 0.3 or (family == "curved" and kind < 0.5):
        b = tuple(digits(x) for x in rng.normal(size=n))
        return {
            "general": True, "b": b, "pendulum": digits(10.0 ** rng.uniform(-1, 1)),
            "spread": digits(rng.uniform(0.0, 1.0)) if rng.random() < 0.6 else 0.0,
        }  # fmt: skip
    return {}
