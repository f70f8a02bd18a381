"""What motions that have settled to one attractor say about it: states, impacts, exponents."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene
from lcpstep.analysis.attractor import Attractor
from lcpstep.analysis.exponents import exponent
from lcpstep.analysis.grid_error import on_other_grids
from lcpstep.analysis.listed import listed
from lcpstep.analysis.variation import PeriodMap
from lcpstep.events import EventDriven
from lcpstep.maps.batch import Periods

Array = NDArray[np.float64]
POINTS, CLOUD = 8000, 2000  # periods that an aperiodic attractor, and one of time-stepping, are sampled over
STARTS, FORGET, KICK = 32, 60, 1e-9  # of these samples: runs, periods until they have parted, by what kick
MOST, MOST_OF_MANY = 512, 64  # impacts of a period that are kept, of a periodic motion and of others


def described(
    P: PeriodMap, runs: Periods, members: list[int], n: int, points: int, share: float
) -> Attractor:
    """What these runs have settled to; it returns after n periods if n > 0."""
    x = runs.states[members[0], -1]
    if n and isinstance(P.method, EventDriven):
        sample = P.many(x, n, most=MOST)
    else:
        sample = _sampled(P, runs, members, n, points)
    kept = sample.impacts.size
    per = n if n else 1
    found = listed(sample, P.scene.period, 0)
    return Attractor(
        periods=n,
        impacts=_whole(float(np.sum(sample.impacts)) / kept * per, n),
        landings=_whole(float(np.sum(sample.ends)) / kept * per, n),
        points=sample.states[0][-n:] if n else sample.states.reshape(-1, sample.states.shape[-1]),
        impact_phase=found["impact_phase"],
        impact_before=found["impact_before"],
        impact_after=found["impact_after"],
        impact_number=found["impact_number"],
        impact_contact=found["impact_contact"],
        cloud=sample.states.reshape(-1, sample.states.shape[-1]),
        lyapunov=exponent(P, sample, x, n),
        share=share,
        modes=isinstance(P.scene, HybridScene),
    )


def _sampled(P: PeriodMap, runs: Periods, members: list[int], n: int, points: int) -> Periods:
    """Many short runs on one attractor.

    A single long one will not do: where an aperiodic motion sticks now and then, rounding alone closes a cycle.
    """
    many = STARTS if not n else min(STARTS, len(members))
    starts = runs.final[np.resize(np.array(members), many)]
    if not n:
        kicks = np.random.default_rng(0).uniform(-KICK, KICK, starts.shape)
        starts = starts + kicks * np.max(np.abs(runs.states[members]), axis=(0, 1))
    each = max(FORGET, -(-points // many)) if not n else max(n, -(-CLOUD // (many * n)) * n)
    drop = FORGET if not n else 0
    if not n and not isinstance(P.method, EventDriven):
        return on_other_grids(P, starts, each + drop, drop, MOST_OF_MANY)
    return P.many(starts, each + drop, drop, most=MOST if n else MOST_OF_MANY)


def _whole(number: float, n: int) -> float:
    return float(round(number)) if n else number
