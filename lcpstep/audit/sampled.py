"""Gaps that are known in samples alone: looked at ever finer where they are small."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.result import Found
from lcpstep.audit.windows import Windows

Array = NDArray[np.float64]
LOOKS = 17  # in a window
ROUNDS = 8  # of closer looks


def sampled(problem: Any, w: Windows) -> tuple[Array, list[Found]]:
    """The smallest gap seen in every window, and events that the run has missed.

    A window is looked at again, in its parts, where the gap might reach zero between two samples if it turned as fast
    as it has been seen to.
    """
    least, found = np.full(len(w.a), np.inf), []
    owner = np.arange(len(w.a))
    missed: set[int] = set()
    for _ in range(ROUNDS):
        if not len(w.a):
            break
        share = np.linspace(0.0, 1.0, LOOKS)
        t = w.a[:, None] + (w.b - w.a)[:, None] * share
        k, c = np.repeat(w.k, LOOKS), np.repeat(w.c, LOOKS)
        looks, error = problem.looked(k, c, t.ravel())
        g = looks.reshape(t.shape)
        inner = g.copy()
        inner[w.first, 0], inner[w.last, -1] = np.inf, np.inf
        np.minimum.at(least, owner, inner.min(axis=1))
        for i in np.flatnonzero(np.any(inner < -error, axis=1)):
            if owner[i] not in missed:
                j = int(np.argmax(inner[i] < -error))
                found.append(Found(float(t[i, j]), int(w.c[i]), float(t[i, max(j - 1, 0)])))
                missed.add(int(owner[i]))
        turn = np.abs(np.diff(g, 2, axis=1)).max(axis=1)
        again = (inner.min(axis=1) < 2.0 * turn) & ~np.isin(owner, list(missed))
        w, owner, inner = w.chosen(again), owner[again], inner[again]
        lowest = np.argmin(inner, axis=1)
        h = (w.b - w.a) / (LOOKS - 1)
        a, b = w.a + h * np.maximum(lowest - 1, 0), w.a + h * np.minimum(lowest + 1, LOOKS - 1)
        w = w._replace(a=a, b=b, first=w.first & (lowest <= 1), last=w.last & (lowest >= LOOKS - 2))
    return least, found
