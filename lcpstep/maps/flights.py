"""Many flights over many periods of the forcing, as kernels: the stroboscopic map, iterated.

Each period starts afresh at the time of the section, so that equal states have equal images to the last bit, and
following n periods is iterating the stroboscopic map n times.

A state that recurs exactly during the periods to be dropped has shown its whole future, and whole cycles of it are
skipped. But where a motion sticks, forgets, and then amplifies rounding errors to its own size before it sticks
again, rounding alone can close a cycle. So the cycle must first survive small kicks, one in every period of it: a
stable orbit forgets them.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import IMPACT, STAYS_CLOSED
from lcpstep.events.flight.contact import ON_THE_SURFACE
from lcpstep.events.flight.loop import Course
from lcpstep.events.flight.motion import Flight
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.status import BUFFER_FULL, DONE
from lcpstep.maps.answers import Answers
from lcpstep.maps.tangent import along_events, begin_tangent, carry
from lcpstep.maps.task import INSIDE, UNREACHED, Task
from lcpstep.pointers import abs, after, max

NO_LIMIT = 2**62
KICKS, KICK = 3, 1e-10  # rounds of a cycle on which it is tried, and with what share of the motion's size


class Runs:
    """The runs of a task, one after the other; also where the kernel is, when it has returned before the end.

    s, aside        the flight under way, and one to ask
    course          of the first
    answers         of the task
    taken           periods taken, of all runs
    run, begun      the run at hand, and whether it has begun; code: why the loop over events last returned
    period          its next one
    age, power      the search for a cycle: periods since the state old_q, old_v, and when it is taken anew
    kicked, noisy   rounds of a cycle that has been kicked; periods that are still to be kicked
    length, speed   largest |q| and |v|
    """

    def __init__(self, s: Flight, aside: Flight, task: Task) -> None:
        self.s, self.aside, self.answers, self.course = s, aside, Answers(task), Course(s)
        self.taken = self.run = self.code = self.period = self.age = self.power = self.kicked = self.noisy = 0
        self.begun = False
        self.old_q = self.old_v = self.length = self.speed = 0.0


@cython.ccall
def follow(r: Runs, until: int) -> bool:
    """Every run in turn; whether all are done, or so many periods have been taken; called from Python."""
    with cython.nogil:
        return follow_all(r, until)


def follow_all(r: Runs, until: int) -> bool:
    """The same as a kernel."""
    while r.run < r.answers.runs:
        if not r.begun:
            begin(r, r.run)
        while r.period < r.answers.periods and r.code == DONE and r.answers.reached[r.run] == UNREACHED:
            if r.taken >= until:
                return False
            r.code = one_period(r, r.run, r.period - r.answers.drop)
            r.taken += 1
            r.period += 1
            look_for_cycle(r)
            if r.code == DONE:
                answer(r, r.run, r.period - 1 - r.answers.drop)
        r.answers.final[2 * r.run], r.answers.final[2 * r.run + 1] = r.s.q[0], r.s.v[0]
        r.answers.codes[r.run], r.answers.taken[r.run] = r.code, r.period
        r.begun = False
        r.run += 1
    return True


def begin(r: Runs, i: int) -> None:
    """Run i at its start."""
    r.s.q[0], r.s.v[0] = r.answers.starts[2 * i], r.answers.starts[2 * i + 1]
    r.begun, r.code, r.period = True, DONE, 0
    r.age, r.power, r.kicked, r.noisy, r.length, r.speed = 0, 1, 0, 0, 0.0, 0.0
    if r.answers.strict and not admissible(r.s, r.answers.t_start):
        r.code = INSIDE
    r.old_q, r.old_v = r.s.q[0], r.s.v[0]


def admissible(s: Flight, t: float) -> bool:
    """Whether the state s.q, s.v lies outside of the obstacle, up to rounding."""
    if not s.contact:
        return True
    gap = s.offset + s.G * s.q[0]
    if s.motion.given:
        s.motion.fill(t, s.q, s.v, s.moving)
        gap -= s.moving[0]
    return gap >= -ON_THE_SURFACE * max(1.0, abs(s.q[0]))


def one_period(r: Runs, i: int, k: int) -> int:
    """The state s.q, s.v one period later; its events noted if k >= 0."""
    r.s.restart(r.answers.t_start, r.answers.t_end)
    r.s.tally.clear()
    r.s.record.row = r.s.record.event = 0
    code, tangent, last = BUFFER_FULL, k >= 0 and r.answers.has_tangents, r.answers.t_start
    J = after(r.answers.tangents, 4 * (i * r.answers.kept + k) if tangent else 0)
    if tangent:
        begin_tangent(J)
    while code == BUFFER_FULL:
        code = r.course.go_on(NO_LIMIT)
        if k >= 0:
            note_events(r, i, k)
        if tangent:
            last = along_events(r.aside, r.s.record, J, last)
        r.s.record.event = 0
    if tangent:
        carry(r.aside, J, r.answers.t_end - last)
    return code


def note_events(r: Runs, i: int, k: int) -> None:
    """Impacts and landings of the k-th kept period of run i."""
    for e in range(r.s.record.event):
        event = after(r.s.record.events, e * COLUMNS)
        if event[5] == IMPACT:
            r.answers.note_impact(i, k, event[0], event[2], event[3])
        elif event[5] == STAYS_CLOSED and event[0] > r.answers.t_start:
            r.answers.note_landing(i, k, event[0])


def look_for_cycle(r: Runs) -> None:
    """R. Brent's search for a cycle among the periods to be dropped; its kicks; cycles are skipped."""
    r.age += 1
    r.length, r.speed = max(r.length, abs(r.s.q[0])), max(r.speed, abs(r.s.v[0]))
    dropped = r.period < r.answers.drop
    if dropped and r.noisy > 0:
        r.s.q[0] = r.s.q[0] + KICK * r.length
        r.s.v[0] = r.s.v[0] + KICK * r.speed
        r.noisy -= 1
        r.old_q, r.old_v, r.age, r.power = r.s.q[0], r.s.v[0], 0, 1
    elif dropped and r.age > 0 and r.s.q[0] == r.old_q and r.s.v[0] == r.old_v:
        if r.kicked < KICKS:
            r.kicked += 1
            r.noisy = r.age
        else:
            r.period += (r.answers.drop - r.period) // r.age * r.age
            r.age = -NO_LIMIT
    elif r.age == r.power:
        r.old_q, r.old_v, r.age = r.s.q[0], r.s.v[0], 0
        r.power *= 2


def answer(r: Runs, i: int, k: int) -> None:
    """The state after a period, the k-th kept one if k >= 0, and whether it is near a target."""
    if k >= 0:
        place = 2 * (i * r.answers.kept + k)
        r.answers.states[place], r.answers.states[place + 1] = r.s.q[0], r.s.v[0]
    for c in range(r.answers.n_targets):
        along = abs(r.s.q[0] - r.answers.targets[2 * c]) / r.answers.scale[0]
        across = abs(r.s.v[0] - r.answers.targets[2 * c + 1]) / r.answers.scale[1]
        if max(along, across) <= r.answers.radius[c]:
            r.answers.reached[i] = c
            break
