"""Attractors that many starts go to, found without following each of them for the whole transient.

Some are followed in full. Of the others those that come near a periodic attractor of these need no more; only what
is left is looked at as the first ones were. So basins of few periodic attractors cost a tenth, where a period is
dear.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, Scene
from lcpstep.analysis.attractors import Attractors, attractors
from lcpstep.analysis.neighbourhoods import smallest
from lcpstep.events import EventDriven
from lcpstep.maps.batch import periods
from lcpstep.simulation import Method

Array = NDArray[np.float64]
FIRST = 16  # starts that are followed in full


def search(
    scene: Scene | HybridScene, method: Method, starts: Array, phase: float, longest: int
) -> Attractors:
    """The attractors that these starts go to within `longest` periods, the one with the largest share first."""
    if len(starts) <= FIRST or not isinstance(method, EventDriven):  # time-stepping scatters what it repeats
        return attractors(scene, method, starts, phase=phase, transient=longest)
    first = attractors(scene, method, starts[:FIRST], phase=phase, transient=longest)
    near, owner = smallest(first.found)
    if len(owner) == 0:
        return attractors(scene, method, starts, phase=phase, transient=longest)
    others = starts[FIRST:]
    went = periods(scene, method, others, longest, drop=longest, phase=phase, targets=near).reached
    label = np.append(first.label, np.append(owner, -1)[went])
    if np.any(went < 0):
        some = np.append(np.arange(FIRST), FIRST + np.flatnonzero(went < 0))
        again = attractors(scene, method, starts[some], phase=phase, transient=longest)
        number = dict(zip(first.label.tolist(), again.label[:FIRST].tolist(), strict=True))
        label = np.array([number[k] if k >= 0 else -1 for k in label.tolist()])
        label[some] = again.label
        first = again
    share = np.array([np.mean(label == k) for k in range(len(first.found))])
    order = np.argsort(-share, kind="stable")
    place = np.append(np.argsort(order), -1)
    found = tuple(replace(first.found[k], share=float(share[k])) for k in order)
    return replace(first, found=found, starts=starts, label=place[label])
