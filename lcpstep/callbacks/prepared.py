"""A user's functions as Python asks them between runs: in machine code, where there is any, else in Python."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lagrangian import Scene, checks
from lagrangian.asked import in_python
from lagrangian.checks import Array, Callback
from lcpstep.callbacks import NotCompiled, compiling
from lcpstep.callbacks.faults import fault, forget, note
from lcpstep.kernels.function import Function


def prepared(
    f: Callback, scene: Scene, shape: tuple[int, ...]
) -> Callable[[float, Array, Array, Array], None]:
    """What fills in `out` (shape) at a state t, q, v; a callback that raises does so where a fault is asked for."""
    try:
        address = 0 if compiling.disabled() else compiling.address(f, len(shape))
    except NotCompiled:
        address = 0
    if address == 0:
        return in_python(f, scene, shape)
    asked = Function(address, np.array(scene.p), scene.n_q, scene.n_q, shape)

    def fill(t: float, q: Array, v: Array, out: Array) -> None:
        asked.sample(np.array([t]), np.array(q), np.array(v), out)

    return fill


def evaluate(
    name: str, f: Callback, scene: Scene, at: tuple[float, Array, Array], shape: tuple[int, ...]
) -> Array:
    """Value of a callback at a state; ValueError names it where it is not finite, as Python finds it."""
    out, noted = np.full(shape, np.nan), fault()
    try:
        prepared(f, scene, shape)(*at, out)
    except Exception:  # in Python, which says below what it was
        out.fill(np.nan)
    forget()  # what it has raised here, and nothing that the run has noted
    if noted is not None:
        note(noted)
    return out if np.all(np.isfinite(out)) else checks.evaluate(name, f, (*at, np.array(scene.p)), shape)
