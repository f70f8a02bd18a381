"""When motions come back to themselves, and whether that is more than rounding.

Where an event-driven motion sticks, forgets, and then amplifies rounding errors to its own size before it sticks
again, rounding alone can close a cycle. A stable orbit forgets small kicks; such a cycle does not.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, Scene
from lcpstep.maps.batch import periods
from lcpstep.maps.modes import started
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
TOLERANCE = 1e-6  # of a return, relative to the size of the motion
# How little a motion far from zero moves, of the distance; what it is held to move at least
FAR, LEAST = 0.1, 1e-4
SAMPLES = 33  # of a period
QUARTERS, FALLEN = 4, 0.5  # of a window; what a change falls to at least, from the first to the last of them
SLOWLY = 1e-3  # share by which a change falls clearly, to be extrapolated
# Of a motion that grows without bound: times its starts; from quarter to quarter
RUNAWAY, GROWING = 1e6, 10.0
KICKS, KICK = 3, 1e-10  # rounds of a cycle on which it is tried, and with what share of the motion's size


def return_time(states: Array, longest: int, tolerance: float) -> int:
    """Smallest n with states[k + n] = states[k] within the tolerance for all k, or 0 where there is none."""
    for n in range(1, min(longest, len(states) // 2) + 1):
        if np.max(np.abs(states[n:] - states[:-n])) <= tolerance:
            return n
    return 0


def in_the_end(states: Array, n: int) -> int:
    """The part of n periods after which a motion that changes little over n will return at last; n where none is.

    Near a flip a motion alternates about its orbit, ever less, and changes by less over two turns than over one. What
    it changes by over one goes to zero: the limit is told by Aitken's extrapolation, some n periods apart.
    """
    for m in (m for m in range(1, n) if n % m == 0):
        leap = (len(states) - 1 - m) // (2 * n) * n
        at = -1 - leap * np.arange(2, -1, -1)
        first, middle, last = np.max(np.abs(states[at] - states[at - m]), axis=1)
        before, after = first - middle, middle - last
        slowly = (
            after > SLOWLY * last and before > after and abs(last - after**2 / (before - after)) < last / 2
        )
        if leap and (slowly or last < FALLEN * first):
            return m
    return n


def settled_time(states: Array, longest: int, tolerance: float) -> int:
    """The return time, or 0 where the motion will return sooner than that, but not yet within the tolerance."""
    n = return_time(states, longest, tolerance)
    return n if in_the_end(states, n) == n else 0


def return_times(states: Array, longest: int, tolerance: Array) -> NDArray[np.int64]:
    """The same of motions (m, window, d) with a tolerance for each, (m,)."""
    times = [settled_time(x, longest, float(near)) for x, near in zip(states, tolerance, strict=True)]
    return np.array(times, dtype=np.int64)


def to_shoot_from(states: Array, longest: int, n: int | None = None) -> tuple[Array, int]:
    """A guess of a periodic point, and after how many periods it comes back, from a motion (window, d).

    The last state of a motion that repeats. Of one that does not, the state that comes closest to itself again: a
    chaotic motion passes near the unstable orbits that it is made of.

    Parameters
    ----------
    longest : after how many periods a motion may repeat to be recognised; 2 longest <= window
    n : periods to repeat after, below the window; where not given what the motion does, 1 where it does not repeat

    Source: D. Auerbach et al., Physical Review Letters 58 (1987) 2387 (close returns).
    """
    size = max(float(np.max(np.abs(states))), 1e-300)
    n = n or return_time(states, longest, TOLERANCE * size) or 1
    away = np.max(np.abs(states[n:] - states[:-n]), axis=1)
    return states[-1 if away[-1] <= TOLERANCE * size else int(np.argmin(away))], n


def sizes(scene: Scene | HybridScene, method: Method, states: Array, phase: float) -> Array:
    """Of motions whose states on the section are given, (m, window, d): what returns are measured by, (m,).

    The largest value of all coordinates; of motions far from zero, which move by little of it, how far they move: a
    period of theirs is looked at between the sections.
    """
    positions = slice(None, scene.n_x // 2 if isinstance(scene, Scene) else None)
    largest = np.maximum(np.max(np.abs(states), axis=(1, 2)), 1e-300)
    result = np.max(np.ptp(states[..., positions], axis=1), axis=1)
    if isinstance(scene, Scene):
        result = np.maximum(result, np.max(np.abs(states[..., scene.n_x // 2 :]), axis=(1, 2)))
    start = phase * scene.period
    for i in np.flatnonzero(result < FAR * largest):
        run = simulate(started(scene, states[i, -1], (start, start + scene.period)), method)
        at = run.at(np.linspace(start, run.t[-1], SAMPLES))
        result[i] = max(
            float(result[i]), float(np.max(np.ptp(at[0] if isinstance(at, tuple) else at, axis=0)))
        )
    return np.clip(result, LEAST * largest, largest)


def survive(
    scene: Scene | HybridScene,
    method: Method,
    states: Array,
    n: NDArray[np.int64],
    phase: float,
    allowed: Array,
) -> NDArray[np.bool_]:
    """Whether motions that return after n periods still do when they are kicked a little in every period.

    Parameters
    ----------
    states : (m, window, d)   of the motions, the last one is kicked
    n : (m,)   periods after which each returns, 0 for never
    allowed : (m,)   distance of a return
    """
    result = n > 0
    size = np.max(np.abs(states), axis=1)
    x, left = states[:, -1].copy(), (KICKS + 1) * n
    rates = slice(scene.n_x // 2 if isinstance(scene, Scene) else 0, None)  # a body at rest stays where it is
    while np.any(left > 0):
        on = np.flatnonzero(left > 0)
        kick = np.where(left[on, None] > n[on, None], KICK * size[on], 0.0)  # none in the last round
        x[on, rates] += kick[:, rates]
        run = periods(scene, method, x[on], 1, phase=phase, most=0, strict=False)
        x[on] = run.final
        left[on] = np.where(run.status == Status.DONE, left[on] - 1, 0)
        result[on] &= run.status == Status.DONE
    away = np.max(np.abs(x - states[:, -1]), axis=1)
    return np.asarray(result & (away <= allowed))


def run_away(states: Array, starts: Array) -> NDArray[np.bool_]:
    """Whether motions (m, window, d) from starts (s, d) grow without bound, by powers of ten from quarter to quarter.

    What drifts steadily, or along a belt, does not.
    """
    quarters = np.array([np.max(np.abs(x), axis=(1, 2)) for x in np.array_split(states, QUARTERS, axis=1)])
    far = quarters[-1] > RUNAWAY * float(np.max(np.abs(starts)))
    return np.asarray(far & np.all(quarters[1:] > GROWING * quarters[:-1], axis=0))


def periods_to_settle(states: Array, longest: int) -> int:
    """After how many periods a motion (window, d) will come back within TOLERANCE; 0 where it does not approach.

    It approaches where the largest change over n periods falls from each quarter of the window to the next, for the
    n <= longest that it changes least over, or the part of it after which it returns in the end.
    """

    def changes(n: int) -> Array:
        change = np.max(np.abs(states[n:] - states[:-n]), axis=1)
        return np.array([np.max(quarter) for quarter in np.array_split(change, QUARTERS)])

    size = max(float(np.max(np.abs(states))), 1e-300)
    least = min(range(1, min(longest, len(states) // 2) + 1), key=lambda n: changes(n)[-1])
    best = changes(in_the_end(states, least))
    falling = np.all(np.diff(best) < 0.0) and best[-1] < FALLEN * best[0]
    if not falling or best[-1] <= 0.0:
        return 0
    rate = math.log(best[-1] / best[0]) / ((QUARTERS - 1) / QUARTERS * len(states))
    return max(1, math.ceil(math.log(TOLERANCE * size / best[0]) / rate))
