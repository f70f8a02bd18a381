"""States between the steps of a run, kept while it is made: those of some methods ask for a second run afterwards."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep.errorbar.looks import uneven
from lcpstep.recording import Kept
from lcpstep.stepping.located import Located
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
FEW = 200  # steps, which are run again instead: that tells more
BETWEEN = 600  # states between steps


def widened(method: Any, scene: Scene, kept: Kept) -> Kept:
    """What a run keeps for its error bar: more where states between its steps would ask for another run."""
    if not (isinstance(method, Located) and kept.all) or method.audit:
        return kept
    rubs = scene.contacts is not None and scene.contacts.friction is not None
    if rubs or scene.n_j > 0 or (method.order == 2 and (method.tolerance is None or _plain(scene))):
        return kept
    start, end = scene.t_span
    if method.tolerance is None and end - start < FEW * method.h:
        return kept
    return replace(kept, times=np.append(start, uneven(start, end, BETWEEN)))


def _plain(scene: Scene) -> bool:
    """Whether steps of order 2 by a tolerance may be known in between."""
    c = scene.contacts
    flat = c is None or (isinstance(c, LinearContacts) and c.motion is None)
    return isinstance(scene.system, LinearSystem) and flat


def narrowed(run: Trajectory, kept: Kept) -> Trajectory:
    """The run as it is without states between steps, whose impulses go to the next one kept."""
    stay = ~np.isin(run.t, kept.times[1:])
    stay[:1] = True
    places = np.flatnonzero(stay)
    if len(places) == len(run.t):
        return run
    impulse = np.add.reduceat(run.impulse[: places[-1] + 1], np.append(0, places[:-1] + 1), axis=0)
    joints, rubbing = run.joint_impulse[stay], run.friction_impulse[stay]
    return replace(
        run, t=run.t[stay], q=run.q[stay], v=run.v[stay], impulse=impulse, joint_impulse=joints,
        friction_impulse=rubbing,
    )  # fmt: skip
