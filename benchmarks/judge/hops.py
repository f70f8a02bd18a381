"""Hops that a method does not see: how high they are, and what of a motion they explain.

A contact of `Moreau` that is struck lies up to h |u-| inside of its obstacle, and stays there while it rests. Thrown
off by the impact of another contact it is held again at the top of its hop, where u = 0, if it has not come out by
then: it never comes back, and strikes nothing. What it would have come back with, w = |v(end) - v(start)| / 2, the
motion then lacks for good, until steps are so short that h |u-| is less than the height of the hop.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from lcpstep.trajectory import Kind


def highest_hop(d: Description, m: Any) -> float:
    """How far a body gets from where it hops, in hops that are shorter than a step [units of q]."""
    if not d.contacts:
        return 0.0
    log = m.impacts[m.impacts.kind == Kind.IMPACT]
    rows = np.maximum(np.linalg.norm(physics.jacobians(d, m.q[0]), axis=-1), 1e-300)
    highest = 0.0
    for c in range(d.contacts):
        own = log[log.contact == c]
        length = np.diff(own.time)
        hops = (length < d.h) & (own.after[:-1] > 0.0)
        highest = max(highest, float(np.max(0.25 * (own.after[:-1] * length)[hops], initial=0.0)) / rows[c])
    return highest


def left_within(d: Description, m: Any, h: float, until: float) -> float:
    """How far a motion m goes, up to a time, by what it has from one of the hops that steps h of `Moreau` hide."""
    farthest = 0.0
    for c in range(d.contacts):
        log = m.impacts[m.impacts.contact == c]
        log = log[np.isin(log.kind, (Kind.IMPACT, Kind.RELEASE))]
        start, end = log[:-1], log[1:]
        length = end.time - start.time
        struck = np.maximum.accumulate(-np.minimum(start.before, 0.0)) if len(start) else length
        hides = (start.after > 0.0) & (end.before < 0.0) & (end.time < until)
        hides &= 0.25 * start.after * length < h * struck
        t, length = start.time[hides], length[hides]
        _, first = m.at(t + 0.25 * length)
        _, second = m.at(t + 0.75 * length)
        way = np.max(np.abs(second - first), axis=1, initial=0.0) * (until - t)
        farthest = max(farthest, float(np.max(way, initial=0.0)))
    return farthest
