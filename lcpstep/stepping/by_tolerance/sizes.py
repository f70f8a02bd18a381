"""Steps by a tolerance, as Python sees them: their sizes.

The control itself, what it aims at and where that comes from: `control`.
"""

from __future__ import annotations

import math

from lcpstep.kernels.roundings import MARGIN, RESOLUTION
from lcpstep.stepping.steps import WHOLE

# Why the loop returned, besides what `kernels.status` has, DONE at the end of the span: for what Python makes
WANTED = -3
LEVELS = 52  # halvings of the longest step, at most
OWN = LEVELS + 2  # place of the matrices of a part as long as no level's; those of its halves come next
ROUNDED = 8 * RESOLUTION  # relative differences that are rounding
PLENTY = 0.8  # of the share, that twice the step is expected to take where it is tried
LEAST_SHARE = 1e-3  # of the tolerance, in steps with events, or with a force that jumps
NEAR = 3.0  # errors of what ends a piece or a mode: from where on it may have come to zero
FIRST = 1e-6  # of the span: the first step
LOOK = 4096  # attempts between two looks at the outside world, at most


def sizes(span: tuple[float, float], h: float) -> tuple[float, int, int, int]:
    """The longest step, at most h; the end of the span in finest steps; the finest level, and the first."""
    start, end = span
    coarse = max(1, math.ceil((end - start) / h - WHOLE))
    h_max = (end - start) / coarse
    least = MARGIN * max(abs(start), abs(end))
    finest = min(LEVELS, 62 - coarse.bit_length())
    if least > 0.0:
        finest = max(0, min(finest, math.floor(math.log2(h_max / least)) - 1))
    first = max(0, min(finest, math.ceil(math.log2(h_max / (FIRST * (end - start))))))
    return h_max, coarse << finest, finest, first
