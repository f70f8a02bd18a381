"""How the smooth motion of a general system is computed between events, and to what tolerance."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import by_address
from lcpstep.events.run import scan_interval
from lcpstep.model import Model


@by_address
class Plan(NamedTuple):
    """Span, tolerances, and the quadrature of constraint forces."""

    scan: float  # longest interval of the scan for events
    nodes: Any  # of the quadrature, on [0, 1]
    weights: Any
    rtol: float
    atol: float
    t_end: float


def plan(scene: Scene, m: Model, method: Any, nodes: int) -> Plan:
    """The plan for a scene, with this many nodes of the quadrature; `method` has rtol and atol."""
    x, weights = np.polynomial.legendre.leggauss(nodes)
    return Plan(
        scan=scan_interval(scene, m, 0.0), nodes=0.5 * (1.0 + x), weights=0.5 * weights, rtol=method.rtol,
        atol=method.atol, t_end=scene.t_span[1],
    )  # fmt: skip
