"""Whether a method gives the same answer to the same question in other words.

How much may differ is told by companions of the method itself: the scene disturbed by rounding, or by the tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from benchmarks.judge.agree import disturbed, positions
from benchmarks.judge.describe import Description
from benchmarks.judge.graze import grazes
from benchmarks.judge.physics import jacobians, room
from benchmarks.judge.runs import Finding, Run, run
from benchmarks.judge.scales import EPS
from benchmarks.judge.told import looks, told_until
from benchmarks.judge.variants import VARIANTS, Variant, fits, rest
from lcpstep.trajectory import Kind

ROUNDING = 1e-12  # of the size of the motion: the disturbance of companions
NOISE, TOLD = 300.0, 1e-4
STRONG = 1e-3  # of the fastest impact: what is looked for in the other log
FALL = 100.0  # roundings of a gap
LATE = 1e-6  # of the shortest time: how far apart partners may be where nothing else says more


@dataclass(frozen=True, eq=False)
class Base:
    """A run, where it is, and how far its companions are from it."""

    d: Description
    run: Run
    looks: Any
    q: Any
    allowed: Any
    told: float  # until then it is where its companions are
    alone: float = np.inf  # until then its strong impacts are those of its companions

    @property
    def size(self) -> float:
        """Length that positions are compared with."""
        return self.run.scales(self.d).length

    @cached_property
    def grazes(self) -> float:
        """Until then no error decides whether a contact strikes; looked for where something is suspected."""
        return grazes(self.d, self.run.motion, self.looks, self.allowed)


def base(d: Description, r: Run) -> Base:
    """A run with its companions."""
    times = looks(d, float(r.motion.t[-1]))
    q, size = positions(r, times), r.scales(d).length
    noise = np.zeros(len(times))
    companions = [run(disturbed(d, max(ROUNDING, r.tolerance), size, 20 + k), r.method) for k in range(2)]
    for other in companions:
        noise = np.maximum(noise, distance(other, times, q))
    events = r.motion.counts.events + r.motion.counts.steps
    floor = (1e-9 + 1e-14 * events + (10.0 + 0.1 * events) * r.tolerance) * size
    floor += r.tolerance + 1e3 * EPS * float(np.max(np.abs(q), initial=0.0))
    floor += 1e2 * EPS * max(map(abs, d.t_span)) * fastest(d, r)
    unclear = np.flatnonzero(noise > max(TOLD, 100.0 * r.tolerance) * size)
    told = float(times[unclear[0]]) if len(unclear) else np.inf
    start = d.t_span[0]
    until = told_until(d, r)
    if until <= start:  # walls that strike together where it begins: rounding says which is the first
        told = start
    elif d.T:  # later as well, where friction makes an impact of both of two that do without each other
        told = min(told, until)
    allowed = floor + NOISE * noise
    b = Base(d, r, times, q, allowed, told)
    unlike = [x[0] for other in companions if other.done and (x := without_partner(b, other, Variant("", d)))]
    return replace(b, alone=min(unlike, default=np.inf))


def fastest(d: Description, r: Run) -> float:
    """The largest speed of the motion and of what carries it: rounding of a time moves both by it."""
    frame = float(np.max(np.abs(d.row("frame")), initial=0.0))
    return max(float(np.max(np.abs(r.motion.v), initial=0.0)), d.omega * frame)


def distance(r: Run, times: Any, q: Any, variant: Variant | None = None) -> Any:
    """How far a motion has been from places q until each time; infinite where it is not known."""
    found = np.full(len(times), np.inf)
    if r.usable:
        shift, unit = (variant.shift, variant.unit) if variant else (0.0, 1.0)
        ends = r.motion.t[[0, -1]] - shift
        rounding = 1e-12 * abs(ends[1]) + 2.0 * EPS * abs(shift)
        there = (times >= ends[0] - rounding) & (times <= ends[1] + rounding)
        moments = np.clip(times[there] + shift, *r.motion.t[[0, -1]])
        moved = positions(r, moments)
        moved = moved @ unit.T if np.ndim(unit) else moved
        found[there] = np.max(np.abs(moved - q[there]), axis=1, initial=0.0)
        found[times < ends[0]] = 0.0
    return np.maximum.accumulate(found)


def varied(d: Description, r: Run, rng: Any, how_many: int) -> Iterator[Finding]:
    """Some variants of a run, drawn at random."""
    if not r.done or not r.usable:
        return
    b = base(d, r)
    names = [x for x in (*VARIANTS, "keep", "rest") if fits(x, d, r.method)]
    for name in rng.choice(names, min(how_many, len(names)), replace=False):
        if name == "keep":
            yield from kept(b, rng)
            continue
        try:
            v = rest(d, rng, r.motion, promised(r)) if name == "rest" else VARIANTS[str(name)](d, rng)
            other = run(v.scene, r.method)
        except ValueError:  # a state that rounding has put within an obstacle is no start
            continue
        yield from same(b, other, v)


def kept(b: Base, rng: Any) -> Iterator[Finding]:
    """The same run that keeps other states."""
    keep = [3, "impacts", b.looks][int(rng.integers(3))]
    try:
        other = run(b.d, b.run.method, keep=keep)
    except ValueError:
        return
    if isinstance(keep, np.ndarray) and other.done and len(other.motion.t) != len(keep):
        text = f"{len(other.motion.t)} states of {len(keep)} times {keep.tolist()}"
        yield Finding(b.run.method, "other: keep=times", text)
    elif isinstance(keep, np.ndarray) and other.done and other.usable:
        apart = np.max(np.abs(other.motion.q - b.q), axis=1)
        yield from _first(b, np.maximum.accumulate(apart), "keep=times")
    yield from same_events(b, other, Variant(f"keep={keep if np.ndim(keep) == 0 else 'times'!r}", b.d))


def same(b: Base, other: Run, v: Variant) -> Iterator[Finding]:
    """The same ending, places and events."""
    if other.status == "refused":
        return
    end = float(b.run.motion.t[-1])
    beyond = other.usable and other.motion.t[-1] - v.shift > end and other.status != "cut short"
    if not other.done and not beyond:  # a later end may lie where there is no way on
        if b.told == np.inf and not jams(v.scene, other):
            yield Finding(b.run.method, f"other: {v.name}", f"{other.status} in place of DONE; {v.scene!r}")
        return
    found = list(_first(b, distance(other, b.looks, b.q, v), v.name, v.scene, v.until))
    yield from found or same_events(b, other, v)


def jams(d: Description, r: Run) -> bool:
    """Whether a run ended for want of impulses where walls had left no room, which rounding decides.

    With y > 0 and y G = 0 no impulse changes y u, and where y g = 0 that is no more than 0 unless the walls part. But
    Newton's law asks for u+ >= -r u- > 0 of a contact that is struck and for u+ >= 0 of the others closed: y u+ > 0.
    So no impulses end an approach of all together, and impacts in turn only hand it on.
    """
    if r.status not in ("LCP_FAILED", "TOO_MANY_EVENTS") or r.motion is None or not len(r.motion.t):
        return False
    sizes = r.scales(d)
    return room(d, float(r.motion.t[-1])) <= 1e-9 * sizes.length + 1e3 * EPS * float(np.max(sizes.place))


def _first(b: Base, apart: Any, name: str, scene: Any = None, until: float = np.inf) -> Iterator[Finding]:
    bad = np.flatnonzero((apart > b.allowed) & (b.looks < min(b.told, until)))
    if len(bad) and b.looks[bad[0]] < b.grazes:
        k = int(bad[0])
        text = f"{apart[k]:.3g} off at t = {b.looks[k]:.9g} in a motion of size {b.size:.3g}"
        yield Finding(b.run.method, f"other: {name}", text + (f"; {vars(scene)}" if scene else ""))


def same_events(b: Base, other: Run, v: Variant) -> Iterator[Finding]:
    """Every strong impact of either log has a partner in the other, as long as they have in those of companions.

    Many bodies, or walls, that come to rest together hop in an order that no two runs share, and end at one place:
    of that places tell nothing where they are looked at.
    """
    if other.done and b.run.done and (found := without_partner(b, other, v)):
        t, c, u = found
        text = f"impact of contact {c} at t = {t:.9g} with {u:.3g} has no partner; {v.scene!r}"
        yield Finding(b.run.method, f"other events: {v.name}", text)


def without_partner(b: Base, other: Run, v: Variant) -> tuple[float, int, float] | None:
    """The first strong impact of one log without a partner in the other, of any contact where some depend on others.

    Which of these carries the impulse is no part of the answer. A tolerance promises velocities v to within ten times
    tolerance (1 + |v|), and with them gap velocities G v: a slower approach is one of a contact that rests as well.
    So is one as slow as a fall u^2 = 2 a e from a gap e of rounding, with which a run may begin anew, or of the
    tolerance of an event-driven run, which leaves out lower hops.
    """
    until = min(b.told, b.alone, v.until, float(b.run.motion.t[-1]))
    found = _alone(b, other, v, until)
    return found and _alone(b, other, v, min(until, b.grazes))


def _alone(b: Base, other: Run, v: Variant, until: float) -> tuple[float, int, float] | None:
    """The same, of those before a time."""
    logs = [impacts(b.run), impacts(other)]
    rows = jacobians(b.d, np.array(b.d.q0))
    dependent = np.linalg.matrix_rank(rows) < len(rows)
    start = v.scene.t_span[0] - v.shift + 1e-9 * b.d.length
    times = [logs[0].time, logs[1].time - v.shift]
    contacts = [logs[0].contact, logs[1].contact if v.order is None else v.order[logs[1].contact]]
    fast = max((float(np.max(np.abs(x.before), initial=0.0)) for x in logs), default=0.0)
    sizes = b.run.scales(b.d)
    fast = max(fast, 1e-6 * sizes.reach / sizes.time)
    end = until * (1.0 - 1e-12) - 1e-9 * b.d.length
    far = np.sum(np.abs(rows), axis=-1)
    # A tolerance is one of coordinates
    beside = np.sum(np.abs(jacobians(v.scene, np.array(v.scene.q0))), axis=-1)
    if len(beside) == len(far):  # else of a scene with other contacts
        far = np.maximum(far, beside if v.order is None else beside[np.argsort(v.order)])
    left_out = b.run.tolerance * (1.0 + sizes.travel) if b.run.method.startswith("event-driven") else 0.0
    low = FALL * EPS * sizes.place + left_out * far
    fallen = np.sqrt(2.0 * low * far * sizes.reach) / sizes.time
    slow = np.maximum(np.maximum(STRONG * fast, fallen), promised(b.run) * far)
    found = []
    for i, j in ((0, 1), (1, 0)):
        strong = (np.abs(logs[i].before) > slow[contacts[i]]) & (times[i] < end) & (times[i] > start)
        t, c, u = times[i][strong], contacts[i][strong], logs[i].before[strong]
        late = LATE * sizes.time + 10.0 * _allowed(b, t) / np.abs(u)
        late = late + b.d.h if b.run.method.startswith("moreau") else late
        away = np.full(len(t), np.inf)
        for k in range(b.d.contacts):
            away[c == k] = nearest(times[j][(contacts[j] == k) | dependent], t[c == k])
        alone = np.flatnonzero(away > late)
        if len(alone):
            k = int(alone[0])
            found.append((float(t[k]), int(c[k]), float(u[k])))
    return min(found, default=None)


def nearest(times: Any, to: Any) -> Any:
    """How far each of the times `to` is from the nearest of these; infinite where there are none."""
    if not len(times):
        return np.full(len(to), np.inf)
    times = np.sort(times)
    after = np.searchsorted(times, to)
    before, after = np.maximum(after - 1, 0), np.minimum(after, len(times) - 1)
    return np.minimum(np.abs(to - times[before]), np.abs(to - times[after]))


def promised(r: Run) -> float:
    """Errors of velocities that a tolerance allows."""
    return 10.0 * r.tolerance * (1.0 + float(np.max(np.abs(r.motion.v), initial=0.0)))


def _allowed(b: Base, times: Any) -> Any:
    """What places may be wrong by at these times."""
    return b.allowed[np.minimum(np.searchsorted(b.looks, times), len(b.looks) - 1)]


def impacts(r: Run) -> Any:
    """The impacts proper of a log."""
    log = r.motion.impacts
    return log[log.kind == Kind.IMPACT]
