"""Whether a finished run has gone on in a moving frame as if the frame's velocity did not jump.

    M q'' + C q' + K q = f - M c'' - C c' - K c,      c'' is a force; a jump of c' is a blow -M (c'+ - c'-)

Forces of a frame are asked for at times and have no blow in them. Steps that see q + c instead, in which the frame
rests, need none.
"""

from __future__ import annotations

from math import floor, isinf
from weakref import WeakKeyDictionary

from lagrangian import Scene
from lcpstep.trajectory import Trajectory

KNOWN: WeakKeyDictionary[Scene, list[float]] = WeakKeyDictionary()  # a scene's functions stay what they are


def jolted(run: Trajectory) -> str:
    """When the velocity of the frame has jumped in a run whose steps do not see that, in words; "" if it has not."""
    from lcpstep.model import at_hand

    scene, m = run.scene, at_hand(run.scene)
    if getattr(scene.system, "frame", None) is None or (m is not None and m.carried) or len(run.t) == 0:
        return ""
    known = KNOWN.get(scene)
    if known is None:
        from lcpstep.turns import jolts

        known = KNOWN[scene] = jolts(scene).tolist()
    begin, end, period = scene.t_span[0], float(run.t[-1]), scene.period
    later = [x if isinf(period) else x + (1 + floor((begin - x) / period)) * period for x in known]
    t = min((x for x in later if begin < x < end), default=None) if later else None
    if t is None:
        return ""
    return (
        f"the velocity of the frame jumps at t = {t:.9g} s, and the forces of a frame have no blow in them: take "
        f"coordinates at rest and the obstacle's `motion`, or Located of order 2"
    )
