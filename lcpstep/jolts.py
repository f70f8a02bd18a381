"""Whether a finished run has gone on in a moving frame as if the frame's velocity did not jump.

    M q'' + C q' + K q = f - M c'' - C c' - K c,      c'' is a force; a jump of c' is a blow -M (c'+ - c'-)

Forces of a frame are asked for at times and have no blow in them. Steps that see q + c instead, in which the frame
rests, need none.
"""

from __future__ import annotations

from math import floor, isinf
from weakref import WeakKeyDictionary

import numpy as np

from lagrangian import LinearContacts, Scene
from lcpstep.trajectory import Trajectory

KNOWN: WeakKeyDictionary[Scene, list[float]] = WeakKeyDictionary()  # a scene's functions stay what they are
ROUNDINGS = 8.0 * float(np.finfo(float).eps)  # of a time: what rests of a sum of periods


def jolted(run: Trajectory) -> str:
    """When the velocity of the frame has jumped in a run whose steps do not see that, in words; "" if it has not."""
    scene, order = run.scene, getattr(run.method, "order", 0)
    if getattr(scene.system, "frame", None) is None or len(run.t) == 0:
        return ""
    outside = _can_be_seen_from_outside(scene)
    if outside and order in (2, "exact"):
        return ""
    known = KNOWN.get(scene)
    if known is None:
        from lcpstep.turns import jolts

        known = KNOWN[scene] = jolts(scene).tolist()
    t = _first(known, scene.t_span[0], float(run.t[-1]), scene.period) if known else None
    if t is None:
        return ""
    return (
        f"the velocity of the frame jumps at t = {t:.9g} s, and the forces of a frame have no blow in them: take "
        f"coordinates at rest, and obstacles that move{', or Located of order 2' if outside else ''}"
    )


def _can_be_seen_from_outside(scene: Scene) -> bool:
    """Whether `Located` steps such a linear scene in coordinates in which its frame rests (`pieces.prepare`)."""
    contacts = scene.contacts
    if scene.n_j > 0 or (contacts is not None and contacts.friction is not None):
        return False
    return contacts is None or isinstance(contacts, LinearContacts)


def _first(jolts: list[float], begin: float, end: float, period: float) -> float | None:
    """The first of these times, or of their repetitions, within a span, not at its ends."""
    rounding = ROUNDINGS * max(abs(begin), abs(end))
    begin, end = begin + rounding, end - rounding
    later = [x if isinf(period) else x + (1 + floor((begin - x) / period)) * period for x in jolts]
    return min((x for x in later if begin < x < end), default=None)
