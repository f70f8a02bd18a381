"""Whether a finished run has gone on in a moving frame as if the frame's velocity did not jump.

    M q'' + C q' + K q = f - M c'' - C c' - K c,      c'' is a force; a jump of c' is a blow -M (c'+ - c'-)

Forces of a frame are asked for at times and have no blow in them. Steps that see q + c instead, in which the frame
rests, need none.
"""

from __future__ import annotations

from math import floor, isinf
from weakref import WeakKeyDictionary

from lagrangian import LinearSystem, Scene
from lcpstep.trajectory import Trajectory

KNOWN: WeakKeyDictionary[Scene, list[float]] = WeakKeyDictionary()  # a scene's functions stay what they are


def jolted(run: Trajectory) -> str:
    """When the velocity of the frame has jumped in a run whose steps do not see that, in words; "" if it has not."""
    from lcpstep.model import at_hand
    from lcpstep.turns import jolts

    scene, m = run.scene, at_hand(run.scene)
    if not isinstance(scene.system, LinearSystem) or scene.system.frame is None or len(run.t) == 0:
        return ""
    if m is not None and m.carried:
        return ""
    begin, end, period = scene.t_span[0], float(run.t[-1]), scene.period
    if scene not in KNOWN:
        KNOWN[scene] = jolts(scene).tolist()
    later = (x if isinf(period) else x + (1 + floor((begin - x) / period)) * period for x in KNOWN[scene])
    t = min((x for x in later if begin < x < end), default=None)
    if t is None:
        return ""
    return (
        f"the velocity of the frame jumps at t = {t:.9g} s, and the forces of a frame have no blow in them: take "
        f"coordinates at rest and the obstacle's `motion`, or Located of order 2"
    )
