"""What all steps agree on: what is rounding; when a span is a whole number of them, which are too long or too short.

Steps that are lost in the rounding of the times they are added to are refused: such a run would never end.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import LcpStepError
from lcpstep.kernels.roundings import MARGIN, RESOLUTION

WHOLE = 1e-9  # of a step: a span this close to a whole number of steps is taken as one
LATE = 1e-9  # of a step: what rounding may take from the end of the last one
RESTING = 1e-13  # of the size of the scene: a gap this small is closed
TOUCHING = 1e-9  # of the way that forces push in a step: likewise, where a motion begins at rest
UNTOLD = 4.0 * RESOLUTION  # of a time: its rounding, in which an obstacle moves on under a body
# Blows, Newton's iteration and joints of `Moreau`
TURNS = 200  # blows in a step of `Moreau` for each of its contacts; elastic ones go on in the next one
LEFT = 1e-6  # of the fastest approach: what is slower ends in a plastic blow
RETURNED = 2.0**-40  # of the fastest approach: blows that lead back so near to those before never end
CONVERGED = 1e-12  # change of a velocity that is iterated for, relative to it
CANCELLED = 0.1  # of the terms that it is the sum of: near rest it cannot be known better than these
ROUNDING = 1e-13  # of these terms: what is left of it is no motion
NO_APPROACH = 1e-11  # of the terms of a frictional contact's rate
CONTRADICTION = 1e-9  # of the terms of a joint's rate: what may be left of it


def largest(*numbers: Any) -> float:
    """The largest of all numbers by its size; 0 of none."""
    every = np.concatenate([np.ravel(x) for x in numbers]) if len(numbers) > 1 else numbers[0]
    return float(np.abs(every).max(initial=0.0))


def inverse(A: Any) -> NDArray[np.float64]:
    """The inverse of a small matrix; of one number without asking LAPACK."""
    return np.asarray(1.0 / A if A.size == 1 else np.linalg.inv(A))


def implicit_mass(M: Any, C: Any, K: Any, x: float) -> Any:
    """M + x C + x^2 K, by which implicit steps divide forces: x is the share of the step that these act on."""
    return M + x * C + x**2 * K


def check_steps(h: float, span: tuple[float, float], longest: bool) -> None:
    """LcpStepError if steps of h do not fit the span: longer than it, or lost in the rounding of its times.

    longest : whether h is a bound on steps that are chosen by a tolerance, and may be as long as it likes
    """
    start, end = span
    rounding = UNTOLD * max(abs(start), abs(end))
    if h > (end - start) * (1.0 + WHOLE) + rounding and not longest:
        raise LcpStepError(f"h: steps of {h:g} s are longer than the span of {end - start:g} s")
    if h < rounding and h < end - start:
        raise LcpStepError(
            f"h: steps of {h:g} s are lost in the rounding of times up to {max(abs(start), abs(end)):g} s; "
            f"expected at least {rounding:.2g} s"
        )


def unresolved(span: tuple[float, float], h: float) -> float:
    """Time by which whole steps of h may miss the end of the span: a share of one, or the rounding of the times."""
    return max(WHOLE * h, UNTOLD * max(abs(span[0]), abs(span[1])))


def number(span: tuple[float, float], h: float) -> int:
    """How many steps a span is divided into."""
    return divided(span, h)[-1][3]


@functools.lru_cache(maxsize=16)
def divided(span: tuple[float, float], h: float) -> tuple[tuple[float, float, int, int], ...]:
    """A span in steps of h, and a last shorter one where h does not divide it.

    Of each of these stretches: size of the steps, start, number of the first step, and that after the last one.
    """
    start, end = span
    steps = (end - start) / h
    fits = h * abs(steps - round(steps)) <= unresolved(span, h)
    whole = round(steps) if fits else int(steps)
    found = [((end - start) / whole if fits else h, start, 0, whole)] if whole > 0 else []
    if whole == 0 or not fits:
        last = start + whole * h
        found.append((end - last, last, whole, whole + 1))
    return tuple(found)


def start_side(scene: Scene, t: float) -> float:
    """The time t, or, where that is a corner of the scene to rounding, the next one that callbacks tell from it.

    They are asked for the side of the corner on which the motion goes on.
    """
    period = scene.period
    periodic = math.isfinite(period)
    margin = MARGIN * max(abs(t), period if periodic else scene.t_span[1] - scene.t_span[0])
    for corner in np.asarray(scene.corners).tolist():
        apart = t - corner
        if periodic:
            apart = (apart + 0.5 * period) % period - 0.5 * period
        if abs(apart) <= margin:
            return t + margin
    return t
