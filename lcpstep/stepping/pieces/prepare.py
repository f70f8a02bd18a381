"""What the kernels of `Located` start from: constants of steps of one size, and the state at the start of a span."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.kernels.clock import Clock
from lcpstep.kernels.dynamics import moves, varies
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import MARGIN, NOISE
from lcpstep.model import ends
from lcpstep.stepping.extent import extent, is_stiff
from lcpstep.stepping.pieces.carried import displaced
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.steps import implicit_mass, inverse
from lcpstep.turns import turns

if TYPE_CHECKING:
    from lcpstep.stepping.located import Located

Array = NDArray[np.float64]
# Impacts in one step after which the rest of a chattering sequence, if it ends within the step, is taken as one: the
# frozen acceleration of order two makes no error by that
MANY, MANY_EXACTLY = 200, 20_000
PER_PERIOD = 16  # pieces of exact motion per period of a moving frame or obstacle
NO_GAP = 1e-3  # of a tolerance


def carried_where_possible(m: Model, order: int | str) -> Model:
    """The model, from now on in the coordinates in which a moving frame rests, where its steps allow that.

    There the frame puts no force on the system; the obstacles move with it instead, and where they are is known
    exactly at any time, while the force -(M c'' + C c' + K c) within a step is not. On the cam-follower that is worth
    a factor of twenty in the error.
    """
    m.carried = bool(order != 4 and m.linear and m.flat and m.frame.given)
    return m


def plan(scene: Scene, m: Model, method: Located, h: float) -> Plan:
    """Constants of steps of size h."""
    stiff, constant = is_stiff(m), m.linear and m.flat
    most, made = longest(scene, m, method), matrices(m, method, h)
    piece = min(method.h, most)
    own = made["A_inverse"][0] if m.linear and piece == h else implicit(m, method, piece)
    long = size(scene, m, method, piece, own)
    t_scale = max(abs(scene.t_span[0]), abs(scene.t_span[1]))
    if math.isfinite(scene.period):  # a callback may know the time no better than its phase
        t_scale = max(t_scale, scene.period)
    return Plan({
        "h": h, "stiff": m.linear and stiff, "steady": m.linear and not stiff and not varies(m),
        "plain": constant and not moves(m), "constant": constant,
        "slack": NOISE * long, "per_step": method.max_per_step,
        "many": MANY if method.order == 2 else MANY_EXACTLY,
        "exact": method.order == "exact", "longest": most,
        "clock": Clock(scene.t_span, turns(scene).stops, scene.period),
        "margin": MARGIN * t_scale,
    } | made)  # fmt: skip


def matrices(m: Model, method: Located, h: float) -> dict[str, Array]:
    """A_inverse, AG and WA of steps of size h, see `Plan`."""
    n_q, n_c, G = m.n_q, m.n_c, m.arrays["G"]
    A_inverse, AG, WA = np.zeros((2, n_q, n_q)), np.zeros((2, n_c, n_q)), np.zeros((2, n_c, n_c))
    if m.linear:
        A_inverse[:] = implicit(m, method, h)
    if m.linear and m.flat:
        AG[:] = (A_inverse[0] @ G.T).T
        WA[:] = G @ AG[0].T
    return {"A_inverse": A_inverse, "AG": AG, "WA": WA}


def implicit(m: Model, method: Located, h: float) -> Array:
    """What steps of size h multiply forces with, (M + h/2 C + h^2/4 K)^-1; M^-1 where they are explicit."""
    if not (is_stiff(m) and method.order == 2):
        return m.arrays["M_inverse"]
    M, C, K = (m.arrays[name] for name in ("M", "C", "K"))
    return inverse(implicit_mass(M, C, K, 0.5 * h))


def size(scene: Scene, m: Model, method: Located, piece: float, pushes: Array) -> float:
    """Lengths at hand at the start [m]: places, offsets, what moves in a piece of motion: what rounding is of.

    1 where nothing is there yet, and where gaps are functions, of which nothing is known but the places. By a
    tolerance steps are shorter than h; what they may be wrong by is no gap.
    """
    at, pushed = (scene.t_span[0], scene.q0, scene.v0), method.tolerance is None
    own = extent(m, *at, method.h, piece, pushes, pushed)
    if method.tolerance is not None:
        own = max(own, min(1.0, NO_GAP * method.tolerance / NOISE))
    return own or 1.0


def longest(scene: Scene, m: Model, method: Located) -> float:
    """Longest piece on which a Taylor polynomial is exact and gap velocities turn but once in a quarter of it."""
    if method.order != "exact":
        return np.inf
    a = m.arrays
    stiffness, damping = (largest_eigenvalue(a["M_inverse"] @ a[name]) for name in ("K", "C"))
    rate = max(np.sqrt(stiffness), damping, abs(m.omega), 2.0 * np.pi / PER_PERIOD / scene.period)
    return float(1.0 / rate) if rate > 0.0 else np.inf


def largest_eigenvalue(A: Array) -> float:
    """Magnitude of the largest eigenvalue; of one number, or of zeros, without asking LAPACK."""
    if A.size == 1 or not A.any():
        return float(abs(A[0, 0]))
    return float(np.max(np.abs(np.linalg.eigvals(A))))


def start(scene: Scene, m: Model, p: Plan) -> Work:
    """State at the start of the scene's span, with the work space of a step."""
    w = Work(m.n_q, m.n_c)
    w.seen["q"][:], w.seen["v"][:] = scene.q0, scene.v0
    if m.carried:
        c, c_t = displaced(m, scene.t_span[0])
        w.seen["q"] += c
        w.seen["v"] += c_t
    if p.plain and m.n_q * m.n_c > 1:  # of one coordinate and contact they are the whole, as they stand
        for name, marks in ranges(m.arrays).items():
            w.seen[name][:] = marks
    return w


def ranges(a: dict[str, Array]) -> dict[str, Any]:
    """First and last coordinate that an impulse of each contact changes, first and last contact that feels it."""
    G = np.abs(a["G"])
    MG = G @ np.abs(a["M_inverse"])
    found = {}
    for what, matrix in (("coordinate", MG + G), ("contact", MG @ G.T)):
        begin, end = ends(matrix).T
        found |= {f"first_{what}": begin, f"last_{what}": end - 1}
    return found
