"""Whether a finished run has gone on in a moving frame as if the frame's velocity did not jump.

    M q'' + C q' + K q = f - M c'' - C c' - K c,      c'' is a force; a jump of c' is a blow -M (c'+ - c'-)

Forces of a frame are asked for at times and have no blow in them. Steps and flights that see q + c instead, in which
the frame rests, need none.
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, Scene
from lcpstep.corner_times import repeated
from lcpstep.kernels.roundings import MARGIN
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
KNOWN: WeakKeyDictionary[Scene, Array] = WeakKeyDictionary()  # a scene's functions stay what they are


def jolted(run: Trajectory) -> str:
    """When the velocity of the frame has jumped in a run whose steps do not see that, in words; "" if it has not."""
    scene, order = run.scene, getattr(run.method, "order", 0)
    if getattr(scene.system, "frame", None) is None or len(run.t) == 0:
        return ""
    outside = _can_be_seen_from_outside(scene)
    if outside and order in (2, "exact"):
        return ""
    known = jolts_of(scene)
    if not len(known):
        return ""
    begin, end = scene.t_span[0], float(run.t[-1])
    rounding = MARGIN * max(abs(begin), abs(end))  # not at the ends
    times = repeated(known, scene.period, begin + rounding, end - rounding, 1)
    if not len(times) or _by_flights(run):
        return ""
    return (
        f"the velocity of the frame jumps at t = {times[0]:.9g} s, and the forces of a frame have no blow in them: "
        f"take coordinates at rest, and obstacles that move{', or Located of order 2' if outside else ''}"
    )


def jolts_of(scene: Scene) -> Array:
    """Times in [0, period), or in the span, at which the velocity of the frame jumps; looked for once."""
    known = KNOWN.get(scene)
    if known is None:
        from lcpstep.turns import jolts

        known = KNOWN[scene] = jolts(scene)
    return known


def _by_flights(run: Trajectory) -> bool:
    """Whether a run is one of `EventDriven` in closed form, whose flights are those of q + c."""
    from lcpstep.events.flight.run import Flights

    return isinstance(run.dense, Flights)


def _can_be_seen_from_outside(scene: Scene) -> bool:
    """Whether `Located` steps such a linear scene in coordinates in which its frame rests (`pieces.prepare`)."""
    contacts = scene.contacts
    if scene.n_j > 0 or (contacts is not None and contacts.friction is not None):
        return False
    return contacts is None or isinstance(contacts, LinearContacts)
