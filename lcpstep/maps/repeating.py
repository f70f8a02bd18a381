"""Whether a scene's functions repeat after its period, as maps from period to period take for granted.

    f(t + P, q, v) = f(t, q, v)

A map begins every period at the same time, so that what does not repeat leaps at its end, in silence. Compared at
some times of the first period and at the state at the start; what is noise, or fails there, tells nothing.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene
from lagrangian.asked import in_python
from lagrangian.checks import shown
from lagrangian.derivatives import Known

TIMES = (np.arange(8) + 0.6180339887498949) / 8.0  # of the period: at none of its simple parts
APART = 0.02  # of how far a function goes in these: less may be a period that is rounded
NOTHING = 1e-6  # of the largest number among them
KNOWN = Known()


def check_period(scene: Scene) -> None:
    """ValueError where a function of time is certainly another one a period later.

    Once for functions and parameters.
    """
    found = [x for x in _functions(scene) if callable(x[1])]
    parameters = np.append(np.asarray(scene.p), scene.period)
    with KNOWN.look([f for _, f, _ in found], scene.n_q, parameters) as new:
        for name, f, shape in found if new else ():
            _compare(scene, name, in_python(f, scene, shape), shape)


def _functions(scene: Scene) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    """Those that may depend on time, with the shape that they fill."""
    n, system = scene.n_q, scene.system
    yield "system.force", system.force, (n,)
    if isinstance(system, LinearSystem):
        yield "system.frame", system.frame, (n, 3)
    else:
        yield "system.mass", system.mass, (n, n)
    for name, c, rows in (("contacts", scene.contacts, scene.n_c), ("joints", scene.joints, scene.n_j)):
        yield f"{name}.motion", getattr(c, "motion", None), (rows, 3)
        yield f"{name}.gap", getattr(c, "gap", None), (rows,)
    if isinstance(scene.contacts, (Contacts, LinearContacts)) and scene.contacts.friction is not None:
        yield "friction.slip", scene.contacts.friction.slip, (scene.n_c,)


def _compare(scene: Scene, name: str, fill: Any, shape: tuple[int, ...]) -> None:
    state, period = (np.array(scene.q0), np.array(scene.v0)), scene.period

    def values(t: Any) -> Any:
        out = np.full((len(t), *shape), np.nan)
        for k in range(len(t)):
            fill(float(t[k]), *state, out[k])
        return out

    try:
        with np.errstate(all="ignore"):
            now, later, again = (values(t) for t in (TIMES * period, (1.0 + TIMES) * period, TIMES * period))
    except Exception:  # at a time that the map may never ask for, or it says so there
        return
    both = np.concatenate([now, later])
    if not np.all(np.isfinite(both)) or not np.array_equal(now, again):
        return
    apart = np.abs(later - now) > APART * np.ptp(both, axis=0) + NOTHING * np.max(np.abs(both), initial=0.0)
    if not np.any(apart):
        return
    k = int(np.argwhere(apart)[0][0])
    raise ValueError(
        f"period: {name} is {shown(now[k])} at t = {TIMES[k] * period:.9g} s and {shown(later[k])} a period of "
        f"{period:.9g} s later; expected the time after which it is the same again"
    )
