"""Points of a motion on Poincare sections: at every impact, and once per period of the forcing.

Source: G. Osorio, Complex Behavior in Impacting Systems, sections 3.2.3 and 3.3.1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.maps.batch import periodic
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Kind

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Sections:
    """A long motion, seen at its impacts and once per period T of the forcing.

    Attributes
    ----------
    phase : (n,)   time of each impact within its period, as a share of T in [0, 1)
    before, after : (n,)   gap velocities at each impact [m/s]
    q, v : (m, n_q)   states at the times k T
    labels : of the states, with their units
    """

    phase: Array
    before: Array
    after: Array
    q: Array
    v: Array
    labels: tuple[str, ...]


def sections(
    scene: Scene,
    method: Method,
    periods: int,
    drop: int,
    progress: Callable[[float], None] | None = None,
) -> Sections:
    """Run the scene for `periods` periods of its forcing and look at it after the first `drop` of them.

    Raises
    ------
    ValueError   the scene has no period, or there is nothing left after `drop`
    """
    periodic(scene)
    if not 0 <= drop < periods:
        raise ValueError(f"drop: expected 0 <= drop < periods = {periods}, got {drop}")
    times = np.arange(drop, periods) * scene.period
    long = replace(scene, t_span=(0.0, periods * scene.period))
    run = simulate(long, method, keep=times, progress=progress)
    log = run.impacts[(run.impacts.kind == Kind.IMPACT) & (run.impacts.time > times[0])]
    return Sections((log.time / scene.period) % 1.0, log.before, log.after, run.q, run.v, scene.labels)
