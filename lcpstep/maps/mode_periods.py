"""Many runs of a system with modes over many periods of its forcing, as a kernel: the map of states, x -> P(x).

A state on the section tells its mode (see `lagrangian.hybrid`). Each period starts afresh at the time of the section,
so that following n periods is iterating the stroboscopic map n times. A switch at the very start of a period only
puts the mode right.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.events.hybrid.field import Machine, approaches, field, guard_gradient, scalar
from lcpstep.events.hybrid.kinds import ARRIVE, NOT_SLIDING, SWITCH_LEAD
from lcpstep.events.hybrid.loop import Switching
from lcpstep.events.hybrid.state import Motion
from lcpstep.kernels.function import Functions
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE
from lcpstep.kernels.vectors import copy, largest, product
from lcpstep.maps.saltation.switches import Tangent, walk
from lcpstep.pointers import Doubles, abs, after, indices_after, max, whole

ON_SURFACE = 1e-9  # |H|, relative to the state, that is zero: the same as for a scene that starts sliding
UNREACHED = -1
UNKNOWN = -1  # in place of a mode
NO_LIMIT = 1 << 62


class Placing:
    """Tells the mode of a motion through a state.

    Parameters
    ----------
    machine : Machine
    mode_of : CalledBack   a function filling in the number of the mode, or None where the one surface tells it
    p : (n_p,)   parameters;  sliding : int   the mode of that surface
    """

    def __init__(self, machine: Machine, mode_of: Any, p: Any, sliding: int) -> None:
        self.m, self.asked, self.sliding, self.called = machine, mode_of is not None, sliding, mode_of
        address = mode_of.address if mode_of is not None else 0
        self.mode_of, self.out_array = Functions([address], p, machine.n, 0, (1,)), np.zeros(1)
        self.out = doubles(self.out_array)

    def mode_at(self, t: float, x: Any) -> int:
        """The mode of a motion through x (n,) at the time t, or UNKNOWN."""
        x = np.array(x, dtype=float)
        return self.place(t, doubles(x))

    def place(self, t: float, x: Doubles) -> int:
        """The same from within a kernel."""
        if self.asked:
            self.mode_of.fill(0, t, x, x, self.out)
            return whole(self.out[0]) if self.out[0] >= 0.0 else UNKNOWN
        below, above = self.m.below[self.sliding], self.m.above[self.sliding]
        H = scalar(self.m, self.m.surfaces, self.sliding, t, x)
        if not abs(H) <= ON_SURFACE * largest(x, 1.0, self.m.n):
            return below if H < 0.0 else above
        L1, L2 = approaches(self.m, self.sliding, t, x)
        if L1 >= 0.0 >= L2:
            return self.sliding
        return below if L1 < 0.0 and L1 + L2 < 0.0 else above


class Follow:
    """What to follow, how far, where the answers go, and where the kernel is; m runs, `kept` periods of each.

    s, tangent      the motion, and its derivative;  course: of the motion
    taken           periods, of all runs together
    run, period     at hand
    under_way       whether a period has begun and not ended

    Parameters
    ----------
    motion : Motion;  tangent : Tangent;  placing : Placing
    t_start, t_end : times of the section;  drop, periods : periods before the kept ones; in all
    arrays : dict of arrays, all but the first three filled in
        starts : (m, n);  targets : (k, n);  radius : (k,);  scale : (n,)   a run ends near a target
        states : (m, kept, n);  tangents : (m, kept, n, n), or (m, 0, n, n) for none
        impacts : (m, kept, most, 3)   time, rates of the guard before and after, of the first switches of a period
        landings : (m, kept, most)   times at which sliding begins;  counts : (m, kept, 2)   how many of both
        reached, taken, codes : (m,);  final : (m, n)
    """

    def __init__(
        self, motion: Motion, tangent: Tangent, placing: Placing, t_start: float, t_end: float, drop: int,
        periods: int, arrays: dict[str, Any],
    ) -> None:  # fmt: skip
        n, own = motion.n, {name: np.ascontiguousarray(x) for name, x in arrays.items()}
        self.kept_arrays, self.s, self.tangent, self.n = own, motion, tangent, n
        self.course, self.placing, self.numbers = Switching(motion), placing, np.zeros((3, n))
        self.x, self.rate = doubles(self.numbers), after(doubles(self.numbers), n)
        self.g_x = after(self.x, 2 * n)
        self.t_start, self.t_end, self.drop, self.periods = t_start, t_end, drop, periods
        self.runs, self.n_targets, self.kept = len(own["starts"]), len(own["targets"]), periods - drop
        self.most, self.tangents_wanted = own["impacts"].shape[2], own["tangents"].shape[1] > 0
        self.starts, self.targets, self.radius = (
            doubles(own["starts"]),
            doubles(own["targets"]),
            doubles(own["radius"]),
        )
        self.scale, self.states, self.tangents = (
            doubles(own["scale"]),
            doubles(own["states"]),
            doubles(own["tangents"]),
        )
        self.impacts, self.landings = doubles(own["impacts"]), doubles(own["landings"])
        self.final, self.counts, self.reached = (
            doubles(own["final"]),
            indices(own["counts"]),
            indices(own["reached"]),
        )
        self.run_taken, self.codes = indices(own["taken"]), indices(own["codes"])
        self.taken, self.run, self.period, self.mode, self.under_way = 0, 0, 0, 0, False
        if self.runs > 0:
            copy(self.x, self.starts, n)


@cython.ccall
def follow(f: Follow, until: int) -> int:
    """Every run in turn, up to so many periods; DONE, BUFFER_FULL, or why there is no derivative.

    Not all runs need be over; those that ended early say why in their `codes`.
    """
    with cython.nogil:
        return go_through(f, until)


def go_through(f: Follow, until: int) -> int:
    """The same from within a kernel."""
    while f.run < f.runs and f.taken < until:
        code = DONE
        if f.period < f.periods and f.reached[f.run] == UNREACHED:
            code = one_period(f)
            if code == BUFFER_FULL:
                return code
            f.taken += 1
            if code == DONE and f.period >= f.drop:
                noted = note(f, f.run * f.kept + f.period - f.drop)
                if noted != DONE:
                    return noted
            copy(f.x, f.s.y, f.n)
            f.period += 1
            if code == DONE:
                f.reached[f.run] = near(f, f.x)
        if code != DONE or f.period >= f.periods or f.reached[f.run] != UNREACHED:
            end_run(f, code)
    return DONE


def end_run(f: Follow, code: int) -> None:
    """How the run at hand ended, and on to the next one."""
    copy(after(f.final, f.run * f.n), f.x, f.n)
    f.codes[f.run], f.run_taken[f.run] = code, f.period
    f.run, f.period = f.run + 1, 0
    if f.run < f.runs:
        copy(f.x, after(f.starts, f.run * f.n), f.n)


def one_period(f: Follow) -> int:
    """The motion from x on over a period, or the rest of it; a status, or BUFFER_FULL."""
    if not f.under_way:
        f.mode = f.placing.place(f.t_start, f.x)
        copy(f.s.y, f.x, f.n)
        if f.mode == UNKNOWN:
            return NOT_FINITE
        f.s.start_from(f.t_start, f.mode)
    code = f.course.go_on(NO_LIMIT)
    f.under_way = code == BUFFER_FULL
    return code


def near(f: Follow, x: Doubles) -> int:
    """The first target within its radius of the state, or UNREACHED."""
    for k in range(f.n_targets):
        distance = 0.0
        for i in range(f.n):
            distance = max(distance, abs(f.targets[k * f.n + i] - x[i]) / f.scale[i])
        if distance <= f.radius[k]:
            return k
    return UNREACHED


def note(f: Follow, k: int) -> int:
    """What happened in the k-th kept period of all, which has begun at x; a status."""
    n, size = f.n, SWITCH_LEAD + 2 * f.n
    copy(after(f.states, k * n), f.s.y, n)
    if f.tangents_wanted:
        code = walk(f.tangent, f.s.log, f.s.switches, f.mode, f.t_start, f.x, f.t_end)
        if code != DONE:
            return code
        copy(after(f.tangents, k * n * n), f.tangent.J, n * n)
    switches, landings = 0, 0
    for e in range(f.s.switches):
        line = after(f.s.log, e * size)
        if not line[0] > f.t_start:
            continue
        if switches < f.most:
            note_switch(f, line, after(f.impacts, (k * f.most + switches) * 3))
        if f.s.m.below[whole(line[2])] != NOT_SLIDING and f.s.m.kind[whole(line[3])] == ARRIVE:
            if landings < f.most:
                f.landings[k * f.most + landings] = line[0]
            landings += 1
        switches += 1
    count = indices_after(f.counts, 2 * k)
    count[0], count[1] = switches, landings
    return DONE


def note_switch(f: Follow, line: Doubles, out: Doubles) -> None:
    """Time of a switch, and the rate of its guard before and after."""
    n, t, source, target = f.n, line[0], whole(line[1]), whole(line[2])
    before, later = after(line, SWITCH_LEAD), after(line, SWITCH_LEAD + n)
    g_t = guard_gradient(f.s.m, source, whole(line[3]), t, before)
    copy(f.g_x, f.s.m.g_x, n)
    field(f.s.m, source, t, before, f.rate)
    out[0], out[1] = t, g_t + product(f.g_x, f.rate, 0, n)
    field(f.s.m, target, t, later, f.rate)
    out[2] = g_t + product(f.g_x, f.rate, 0, n)
