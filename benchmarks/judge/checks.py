"""What physics demands of every run: each check is a function of the scene and the run, and gives findings."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.breaking import breaks_down, judged_until, up_to
from benchmarks.judge.describe import Description
from benchmarks.judge.endless import closed_up, grows_beyond
from benchmarks.judge.runs import CPU_EACH, Finding, Run, run
from benchmarks.judge.scales import EPS, drift
from benchmarks.judge.told import whole
from lcpstep.trajectory import Kind

CPU = 0.5  # seconds of a run, besides CPU_EACH of each of its steps and events
TURNS, SECONDS = 10**6, 0.06  # of a loop in Python: what it takes where the bounds are meant for
ROUNDING = 1e-9  # of the size of what is compared
EXACT = ("event-driven", "located-exact")


def finite(d: Description, r: Run) -> Iterator[Finding]:
    """No state and no impulse is infinite or not a number, unless the motion itself has come to its end."""
    m = r.motion
    for name in ("t", "q", "v", "impulse", "joint_impulse"):
        bad = ~np.isfinite(getattr(m, name))
        if np.any(bad):
            yield Finding(r.method, "not finite", f"{name} in {int(np.sum(bad))} entries, status {r.status}")
    if r.status == "NOT_FINITE" and breaks_down(d, r) == np.inf and not closed_up(d, r):
        yield Finding(r.method, "not finite", r.text)


def reaches_the_end(d: Description, r: Run) -> Iterator[Finding]:
    """DONE means that the end of the span has been reached, by increasing times."""
    t = r.motion.t
    if r.done and not (t[0] == d.t_span[0] and t[-1] == d.t_span[1]):
        yield Finding(r.method, "wrong span", f"states from {t[0]!r} to {t[-1]!r}, asked for {d.t_span}")
    if np.any(np.diff(t) < 0.0):
        yield Finding(r.method, "wrong span", "times decrease")


def in_order(d: Description, r: Run) -> Iterator[Finding]:
    """Events are logged in the order in which they happen, within the span."""
    when = r.motion.impacts.time
    if np.any(np.diff(when) < 0.0):
        k = int(np.argmin(np.diff(when)))
        yield Finding(r.method, "log out of order", f"{when[k + 1]:.17g} after {when[k]:.17g}")
    if len(when) and not (d.t_span[0] <= np.min(when) and np.max(when) <= d.t_span[1]):
        yield Finding(r.method, "log out of order", f"events from {np.min(when)!r} to {np.max(when)!r}")


def in_time(d: Description, r: Run) -> Iterator[Finding]:
    """CPU time within a bound per step and event; asked again, for the first run may have compiled."""
    work = r.motion.counts.steps + r.motion.counts.events
    if r.cpu > CPU + CPU_EACH * work:
        again = run(d, r.method).cpu
        if again > slowness() * (CPU + CPU_EACH * work):
            yield Finding(r.method, "slow", f"{again:.3g} s for {work} steps and events")


def slowness() -> float:
    """By how much the machine is slower at this moment than the one that the bounds are meant for; at least 1."""
    begin, x = time.process_time(), 0
    for i in range(TURNS):
        x += i
    return max(1.0, (time.process_time() - begin) / SECONDS)


def between(d: Description, r: Run) -> Iterator[Finding]:
    """States between the kept ones are told, right up to the end of what was computed.

    Where a run breaks down its last step has led nowhere, and what is between may be as far from what is kept; so are
    the events within the very step that the turn lies in, a little before it.
    """
    try:
        q, _ = r.at(whole(r))
    except (IndexError, ValueError) as error:
        yield Finding(r.method, "no states between", f"{type(error).__name__}: {error}, status {r.status}")
        return
    if r.motion.t[-1] > judged_until(d, r) - d.h:
        return
    if not np.allclose(q[-1], r.motion.q[-1], rtol=1e-12, atol=1e-9 * r.scales(d).length):
        text = f"at the end {q[-1].tolist()}, kept {r.motion.q[-1].tolist()}"
        yield Finding(r.method, "no states between", text)


def impulses(d: Description, r: Run) -> Iterator[Finding]:
    """Impulses are not negative, and nothing is pressed that is open."""
    m, log, sizes = r.motion, r.motion.impacts, r.scales(d)
    if not d.contacts:
        return
    largest = float(max(np.max(m.impulse, initial=0.0), np.max(log.impulse, initial=0.0)))
    least = float(min(np.min(m.impulse, initial=0.0), np.min(log.impulse, initial=0.0)))
    allowed = ROUNDING * largest + 1e3 * EPS * sizes.impulse
    if least < -allowed:
        yield Finding(r.method, "negative impulse", f"{least:.3g} beside {largest:.3g}")
    yield from open_impulses(d, r, allowed)


def open_impulses(d: Description, r: Run, rounding: float) -> Iterator[Finding]:
    """An impulse between two kept states asks for a gap that is closed at one of them (every event is kept)."""
    m, sizes = r.motion, r.scales(d)
    if len(m.t) < 2:
        return
    g = physics.gaps(d, m.t, m.q)
    u = physics.rates(d, m.t, m.q, m.v)
    h = np.diff(m.t)[:, None]
    if r.method.startswith("moreau"):
        low = g[:-1] + 0.5 * h * u[:-1]
    else:
        low = np.minimum(g[:-1], g[1:])
    fast = np.max(np.abs(u), axis=0)
    np.maximum.at(fast, m.impacts.contact, np.abs(m.impacts.before))
    reach = fast * np.max(h)
    allowed = ROUNDING * sizes.length + 1e3 * EPS * sizes.place + 10.0 * allowed_gap(d, r, reach)
    bad = (m.impulse[1:] > 1e3 * rounding) & (low > allowed + drift(d, m))
    if np.any(bad):
        k, c = np.argwhere(bad)[0]
        p, gap = m.impulse[k + 1, c], low[k, c]
        text = f"impulse {p:.3g} of contact {c} while its gap is {gap:.3g} at t = {m.t[k + 1]:.9g}"
        yield Finding(r.method, "impulse while open", text)


def allowed_gap(d: Description, r: Run, reach: Any) -> Any:
    """How far off a gap may be that counts as closed: its tolerance, and what curvature adds within a step."""
    curved = 1e-2 * reach if d.bent else 0.0
    return r.tolerance * (1.0 + r.scales(d).travel) + (0.0 if r.method in EXACT else curved)


def penetration(d: Description, r: Run) -> Iterator[Finding]:
    """Nothing lies within an obstacle, but for what the order of the method explains.

    Of a run that says itself that it breaks down the states are asked up to there.
    """
    if not d.contacts:
        return
    until = judged_until(d, r)
    r = up_to(r, until)
    deep, sizes = depth(d, r), r.scales(d)
    rounding = ROUNDING * sizes.length + 1e3 * EPS * float(np.max(sizes.place))
    if deep <= rounding + 10.0 * r.tolerance * (1.0 + sizes.travel):
        return
    words = f"{deep:.3g} in a motion of size {sizes.travel:.3g}"
    if r.method in EXACT or (r.method.startswith("located") and not d.bent):
        yield Finding(r.method, "penetration", f"{words}, status {r.status}")
        return
    if r.method == "moreau" and r.status != "NOT_FINITE" and within_a_step(d, r, rounding):
        return
    finer = up_to(run(d, r.method, 0.25), until)
    if finer.usable and deep > 1e-3 * sizes.length and depth(d, finer) > 0.7 * deep:
        finest = up_to(run(d, r.method, 0.0625), until)
        if finest.usable and depth(d, finest) > 0.7 * deep:
            text = f"{words}, {depth(d, finer):.3g} and {depth(d, finest):.3g} with a quarter and a 16th of the step"
            yield Finding(r.method, "penetration", text)


def within_a_step(d: Description, r: Run, rounding: float) -> bool:
    """Whether no gap is deeper than h max |u|, which theta = 1/2 explains and no step need keep away from.

    An open contact enters a step above -(h/2) u, and one that is struck goes on by (h/2) (1 - r) u. That is so of
    a run that ends early as well, as where walls close upon a body; one that leaves the finite numbers has no u.
    """
    low = -np.min(physics.gaps(d, r.motion.t, r.motion.q), axis=0)
    fast = np.max(np.abs(physics.rates(d, r.motion.t, r.motion.q, r.motion.v)), axis=0)
    return bool(np.all(low <= d.h * fast + rounding))


def depth(d: Description, r: Run) -> float:
    """The deepest place."""
    return float(-min(0.0, np.min(physics.gaps(d, r.motion.t, r.motion.q))))


def energy(d: Description, r: Run) -> Iterator[Finding]:
    """Nothing that is not fed gains energy, but for what the order of the method explains.

    By Newton's law of impact with friction it may, and by Moreau's where restitution differs.
    """
    law_gives = d.T and (d.law == "newton" or (d.law == "moreau" and np.ptp(d.rates()) > 0.0))
    if physics.fed(d) or law_gives:
        return
    until = judged_until(d, r)
    r = up_to(r, until)
    gained, sizes = gain(d, r), r.scales(d)
    events = r.motion.counts.events + r.motion.counts.steps
    rounding = 1e-12 * sizes.energies + 1e-13 * events * sizes.energy
    loose = 100.0 * r.tolerance * (1.0 + 0.01 * events)
    if gained <= rounding + (ROUNDING + loose) * sizes.energy + loose * sizes.energies:
        return
    if r.method in EXACT:
        yield Finding(r.method, "energy gained", f"{gained:.3g} of {sizes.energy:.3g} J")
        return
    finer = up_to(run(d, r.method, 0.25), until)
    if gained > 1e-3 * sizes.energy and finer.usable and gain(d, finer) > 0.7 * gained:
        finest, most = up_to(run(d, r.method, 0.0625), until), gain(d, finer)
        if finest.usable and (most > sizes.energy or gain(d, finest) > 0.7 * most):
            more = f"{most:.3g} and {gain(d, finest):.3g} with a quarter and a 16th of the step"
            yield Finding(r.method, "energy gained", f"{gained:.3g} of {sizes.energy:.3g} J, {more}")


def gain(d: Description, r: Run) -> float:
    """Largest rise of the energy above what it was before, less what the law of impact itself gives."""
    kinetic, potential = physics.energy(d, r.motion.q, r.motion.v)
    total = kinetic + potential
    return float(np.max(total - np.minimum.accumulate(total))) - given_by_the_law(d, r)


def given_by_the_law(d: Description, r: Run) -> float:
    """Energy that Moreau's law gives to contacts of different restitution; it is part of the law, at any step.

    Impulses do the work p (u+ + u-) / 2, and where p > 0 the law asks for u+ = -r u-: together sum (1 - r) p u- / 2.
    With one r for all that is -(1 - r) / (1 + r) p W p / 2 <= 0, for u+ = u- + W p. With several it may be positive
    by a contact that separates (u- > 0) within the obstacle, and that the blow on another presses back.
    """
    rates = d.rates()
    if r.method != "moreau" or d.bent or not d.contacts or np.ptp(rates) == 0.0:
        return 0.0
    m = r.motion
    u = physics.rates(d, m.t, m.q, m.v)[:-1]
    return float(np.sum(np.maximum(0.5 * np.sum((1.0 - rates) * m.impulse[1:] * u, axis=1), 0.0)))


def impact_law(d: Description, r: Run) -> Iterator[Finding]:
    """An impact leaves u+ >= -r u-, exactly that where it is the only contact, and never with a negative impulse."""
    log = r.motion.impacts
    log = log[log.kind == Kind.IMPACT]
    if not len(log) or d.law == "stronge":  # whose restitution is one of energy
        return
    wanted = -d.rates()[log.contact] * np.minimum(log.before, 0.0)
    scale = np.max(np.abs(log.before)) + np.max(np.abs(log.after))
    off = wanted - log.after
    if d.contacts == 1 and r.method.startswith(("event", "located")):
        off = np.abs(off)
    k = int(np.argmax(off))
    rows, fast = np.abs(physics.jacobians(d, r.motion.q)), np.max(np.abs(r.motion.v), axis=0)
    rounding = 1e2 * EPS * float(np.max(rows @ fast))  # of the terms of a gap's speed
    if off[k] > 1e-7 * scale + rounding and not r.method.startswith("moreau"):
        e = log[k]
        text = f"contact {e.contact} from {e.before:.6g} to {e.after:.6g} at t = {e.time:.9g}"
        yield Finding(r.method, "law of impact", text)


CHECKS: tuple[Callable[[Description, Run], Iterator[Finding]], ...] = (
    finite, reaches_the_end, in_order, in_time, between, impulses, penetration, energy, impact_law
)  # fmt: skip


def check(d: Description, r: Run) -> list[Finding]:
    """All findings of one run; of states that have grown to the largest numbers not even energies can be asked."""
    if r.status == "raised":
        return [Finding(r.method, "raised", r.text)]
    if r.motion is None or not len(r.motion.t):
        return []
    if r.status == "NOT_FINITE" and grows_beyond(d, r):
        return []
    found = list(finite(d, r))
    return found or [x for each in CHECKS[1:] for x in each(d, r)]
