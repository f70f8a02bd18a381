"""The first look at a run: kernels certify most pieces of flat contacts (`flights`, `curves`), in one pass."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.curved import Curved
from lcpstep.audit.curves import Curve, clear_curves, hulls
from lcpstep.audit.flat import Flat
from lcpstep.audit.flights import clear_flights
from lcpstep.audit.limits import AT_EVENT, BESIDE, NEGLIGIBLE, PRESSED, UNKNOWN
from lcpstep.audit.motion import Oscillation
from lcpstep.audit.obstacle import Obstacle
from lcpstep.audit.swing import Swing
from lcpstep.events.flight.run import flight_of
from lcpstep.intervals import NotEnclosed
from lcpstep.kernels.function import Function

NEVER = np.zeros(0)
GROUPS, FEW = (64, 8), 32  # pieces that are looked at together; so many groups are worth it


def look(p: Any) -> NDArray[np.bool_]:
    """Which pieces of which contacts are certified, (m, n_c); p: `pieces.Pieces`."""
    found = np.zeros((len(p.t) - 1, p.scene.n_c), dtype=np.uint8)
    if isinstance(p.problem, Flat):
        by, o = by_flights if isinstance(p.motion, Oscillation) else by_curves, p.problem.obstacle
        try:
            finer_at_releases(p, o)
            by(p, o, found)
        except NotEnclosed as why:
            p.problem.why = str(why)
    elif p.problem.bound is None:
        by_groups(p, p.problem, found)
    return found.view(np.bool_)


def finer_at_releases(p: Any, o: Obstacle) -> None:
    """Bounds of what moves as fine as an event lasts, where contacts open: gaps rise there with the cube of time."""
    if o.moves and isinstance(p.motion, Oscillation):
        opens = (p.closed[:-1] & ~p.closed[1:]).any(axis=1)
        if np.count_nonzero(opens) >= FEW:
            o.refine(p.t[1:-1][opens], len(p.closed))


def by_flights(p: Any, o: Obstacle, found: Any) -> None:
    """Flights in closed form."""
    m, motion, states = p.m, p.motion, p.run.dense.s
    flight = flight_of(p.scene, m, motion.o, p.run.dense.given)
    gap = Swing(o.cells(len(found)), m.motion, m.frame, o.state, limits(p), flight)
    if gap.known:
        touched, kind, cuts = marks(p, o)
        clear_flights(gap, p.t, states.q, states.v, touched, kind, cuts, found)


def by_curves(p: Any, o: Obstacle, found: Any) -> None:
    """Polynomials between kept states."""
    m, motion = p.m, p.motion
    absolute, relative = p.problem.error
    absolute = np.ascontiguousarray(absolute) if np.ndim(absolute) else np.full((1, p.scene.n_q), absolute)
    G, offset = (np.ascontiguousarray(x) for x in (p.problem.G, p.problem.offset))
    frame = m.frame if motion.absolute else Function(0, np.zeros(0), 1, 1, (1, 3))
    gap = Curve(o.cells(len(found)), m.motion, frame, G[:, 0], o.state, limits(p), motion.degree)
    B = np.ascontiguousarray(motion.B)
    touched, kind, cuts = marks(p, o)
    drift = np.zeros((0, p.scene.n_q)) if p.problem.drift is None else p.problem.drift
    met = sampled(o, p.t, G, motion.absolute)
    clear_curves(gap, p.t, B, G, offset, met, absolute, relative, drift, touched, kind, cuts, found)


def by_groups(p: Any, problem: Curved, found: Any) -> None:
    """Gaps of any form that are clear by their places alone, first those of many pieces together."""
    B, left = np.ascontiguousarray(p.motion.B), ~(p.closed | p.unknown[:, None])
    for group in GROUPS:
        first = np.arange(0, len(B), group)
        asked = np.logical_or.reduceat(left & (found == 0), first).any(axis=1)
        if group > 1 and len(first) < FEW:
            continue
        lo, hi = np.full((len(first), B.shape[2]), np.inf), np.full((len(first), B.shape[2]), -np.inf)
        hulls(B, group, lo, hi)
        end = np.minimum(first + group, len(B))
        error = np.maximum.reduceat(np.broadcast_to(problem.error[0], (len(B), B.shape[2])), first)
        error = error + problem.error[1] * np.maximum(np.abs(lo), np.abs(hi))
        lowest = problem.lowest(p.t[first][asked], p.t[end][asked], (lo - error)[asked], (hi + error)[asked])
        clear = np.zeros((len(first), found.shape[1]), dtype=bool)
        clear[asked] = lowest > 0.0
        found |= np.repeat(clear, end - first, axis=0) & left


def sampled(o: Obstacle, t: Any, G: Any, with_frame: bool) -> Any:
    """What the contacts meet at every kept state, (m + 1, n_c, 3); one row of zeros where nothing moves."""
    if not o.moves:
        return np.zeros((1, o.n_c, 3))
    out, t = np.zeros((len(t), o.n_c, 3)), np.ascontiguousarray(t)
    if o.m.motion.given:
        o.m.motion.sample(t, o.state[0], o.state[1], out)
    if with_frame:
        c = np.zeros((len(t), 1, 3))
        o.m.frame.sample(t, o.state[0], o.state[1], c)
        out += G[:, :1] * c
    return out


def marks(p: Any, o: Obstacle) -> tuple[Any, Any, Any]:
    """Events of the run, what kind pieces are of, see `flights`, and corners."""
    kind = p.closed.view(np.uint8) * np.uint8(PRESSED)
    if p.unknown.any():
        kind[p.unknown] = UNKNOWN
    return p.touched.view(np.uint8), kind, p.cuts if o.moves else NEVER


def limits(p: Any) -> tuple[float, float, float]:
    """How long events last, and what is negligible, see `clear.Gap`."""
    return AT_EVENT * p.scale, BESIDE * p.scale, NEGLIGIBLE * p.largest
