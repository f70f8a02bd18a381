"""What the steps of `Moreau` by a tolerance do not show when contacts open and friction changes, as kernels.

Each row of a contact, its normal and then its tangent, has a force that keeps it closed or sticking, negative where
it would have to be pulled: for normals the impulse of a step over its length, or -(u+ - u) / (W h) where it has
none; for tangents mu p_N - |p_T - (u_T+ - u_T) / W|. See `adaptive_forces` for the errors that follow.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, inline
from lcpstep.dynamics import product
from lcpstep.stepping.adaptive_forces import hidden, late

ONE, FIRST, SECOND = range(3)  # the step, its halves
STICKS = 1.0 - 1e-9  # of its limit: friction below it; its speed does not tell, for sliding begins slowly


@by_address
class Switches(NamedTuple):
    """Rows of all contacts in the step and its halves: n normals, or n normals and n tangents."""

    force: Any  # (3, rows) mean forces that keep the row closed, or sticking
    impulse: Any  # (3, rows)
    holds: Any  # (3, rows) 1 where it was kept to the end
    held: Any  # (rows,) 1 where it was so at the start
    mobility: Any  # (rows,) when last in contact
    response: Any  # (rows,) largest velocity that an impulse makes
    turned: Any  # (rows,) impulse of friction with the wrong sign


@inline
def begin(s: Any, closed: Any, u: Any, slow: float) -> None:
    """A step begins; which contacts have lasted."""
    for i in range(len(closed)):
        s.held[i] = 1 if closed[i] > 0 and abs(u[i]) <= slow else 0
    for i in range(len(s.turned)):
        s.turned[i] = 0.0


@inline
def note(s: Any, part: int, h: float, plan: Any, state: Any, before: Any, slow: float, c: Any) -> None:
    """Rows of a part that has been taken; `before`: gap velocities at its start."""
    for i in range(len(state.u)):
        p = state.p[i]
        if p > 0.0:
            measure(s, i, plan, state, c)
        s.impulse[part, i], s.holds[part, i] = p, 1 if p > 0.0 else 0
        s.force[part, i] = p / h
        if p == 0.0 and s.mobility[i] > 0.0:
            s.force[part, i] = -(state.u[i] - before[i]) / (s.mobility[i] * h)
    if c is not None:
        note_friction(s, part, h, state, slow, c)


@inline
def measure(s: Any, i: int, plan: Any, state: Any, c: Any) -> None:
    """How a contact answers impulses."""
    total = most = 0.0
    for j in range(len(state.v)):
        change = plan.A_g[j, i] if c is None else c.X[i, j]
        total += state.G[i, j] * change
        most = max(most, abs(change))
    s.mobility[i], s.response[i] = total, most


def note_friction(s: Any, part: int, h: float, state: Any, slow: float, c: Any) -> None:
    """The same of the tangents."""
    n = len(state.u)
    for i in range(len(c.T_t)):
        k, mu, p, normal = n + i, c.problem.mu[i], c.p[n + i], c.p[i]
        if mu == 0.0 or normal == 0.0:
            s.holds[part, k], s.held[k] = 0, 0
            continue
        W, most = 0.0, 0.0
        for j in range(len(state.v)):
            W += c.T[i, j] * c.X[k, j]
            most = max(most, abs(c.X[k, j]))
        u, end = c.sliding[i], product(c.T, state.v, i) + c.T_t[i]
        s.mobility[k], s.response[k] = W, most
        if part != SECOND:
            s.held[k] = 1 if abs(u) <= slow and s.held[i] > 0 else 0
        s.impulse[part, k] = p
        s.holds[part, k] = 1 if abs(p) < STICKS * mu * normal else 0
        if W > 0.0:
            s.force[part, k] = (mu * normal - abs(p - (end - u) / W)) / h
        if part != ONE and min(u, end) < -slow and max(u, end) > slow:
            s.turned[k] = max(s.turned[k], 2.0 * abs(p) * abs(u) / (abs(u) + abs(end)))


@inline
def unseen(s: Any, h: float, even: bool) -> float:
    """Error of the velocities after two halves of h/2; `even` where impulses are means of both ends of a step."""
    worst = 0.0
    for k in range(len(s.held)):
        p = s.turned[k]
        if s.held[k] > 0:
            opened = 0.0 if s.holds[FIRST, k] == 0 else (0.5 * h if s.holds[SECOND, k] == 0 else h)
            one, first, second = s.force[ONE, k], s.force[FIRST, k], s.force[SECOND, k]
            if not even:  # forces at the ends of the parts: along a line
                one, first, second = first, 0.5 * (3.0 * first - one), 0.5 * (first + one)
            p = max(p, late(one, first, second, h, opened, h))
            if s.holds[ONE, k] > 0 and opened == h:
                p = max(p, differ(s, k, len(s.held)))
        worst = max(worst, p * s.response[k])
    return worst


@inline
def differ(s: Any, k: int, n: int) -> float:
    """By how much the step and its halves disagree about an impulse."""
    one, two = s.impulse[ONE, k], s.impulse[FIRST, k] + s.impulse[SECOND, k]
    if one > 0.0 and two > 0.0:
        return hidden(one, two)
    return abs(one - two)
