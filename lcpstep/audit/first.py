"""The first look at a run: kernels certify most pieces of flat contacts (`flights`, `curves`), in one pass."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.flat import Flat
from lcpstep.audit.flights import Swing, clear_flights
from lcpstep.audit.limits import AT_EVENT, BESIDE, NEGLIGIBLE
from lcpstep.audit.motion import Oscillation
from lcpstep.events.flight.run import flight_of

NEVER = np.zeros(0)


def look(p: Any) -> NDArray[np.bool_]:
    """Which pieces of which contacts are certified, (m, n_c), none of them closed; p: `pieces.Pieces`."""
    found = np.zeros((len(p.t) - 1, p.scene.n_c), dtype=np.uint8)
    if isinstance(p.problem, Flat) and isinstance(p.motion, Oscillation):
        by_flights(p, p.problem, found)
    return found.view(np.bool_)


def by_flights(p: Any, problem: Flat, found: Any) -> None:
    """Flights in closed form."""
    m, motion, state = p.m, p.motion, problem.obstacle.state
    cells = problem.obstacle.cells(len(found))
    gap = Swing(
        cells, m.motion, m.frame, state, limits(p), flight_of(p.scene, m, motion.o, p.run.dense.given)
    )
    if not gap.known:
        return
    obstacle = np.zeros((len(p.t), 1, 3))
    if m.motion.given:
        m.motion.sample(p.t, state[0], state[1], obstacle)
    cuts = p.cuts if problem.obstacle.moves else NEVER
    skipped = p.unknown | p.closed[:, 0]
    clear_flights(gap, p.t, p.run.q, motion.y, motion.w, obstacle, p.touched.view(np.uint8),
                  skipped.view(np.uint8), cuts, found)  # fmt: skip


def limits(p: Any) -> tuple[float, float, float]:
    """How long events last, and what is negligible, see `clear.Gap`."""
    return AT_EVENT * p.scale, BESIDE * p.scale, NEGLIGIBLE * p.largest
